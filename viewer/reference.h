// The scenes by integration, without prefiltered levels, split sums or tables of a few texels: what
// the real-time picture ought to be, with the same rays and the same reflection model.
#ifndef KILN_VIEWER_REFERENCE_H
#define KILN_VIEWER_REFERENCE_H

#include "viewer.h"

/// {0} is a good default.
typedef struct view_reference_def {
    double noise;    ///< wanted standard error of a pixel, relative, 1e-4 to 1; 0 for 0.01
    int batch_limit; ///< at most so many samples of each ray; 0 for 16384
    bool walk;   ///< bounces from the second one on by a random walk between the microfacets, in
                 ///< place of the method of those balls that have one
    int bounces; ///< light that would meet more balls than these is lost; 0 for all of it
    bool alone;  ///< balls do not see one another, as the real-time picture has it; with occlusion
                 ///< they are black to one another. Always so in the furnace
    int thread_count; ///< 1 to 256; 0 for one a core. The picture does not depend on it
    /// Called now and then from the calling thread. Returning false cancels. May be NULL.
    bool (*progress)(void *user, const char *stage, double fraction);
    void *progress_user;
} view_reference_def;

/// How it went, over the pixels that show a ball.
typedef struct view_reference_report {
    double noise;       ///< RMS of the pixels' standard errors, relative
    double batches;     ///< mean number of samples of each ray
    size_t pixel_count; ///< pixels that show a ball
    size_t noisy_count; ///< those that reached the limit before the wanted noise
} view_reference_report;

/// Linear light, three channels, row 0 at the top. `source` is the environment itself, any map, its
/// texels uniformly bright; NULL for scenes without one. `report` may be NULL.
KILN_CHECKED kiln_result view_reference(kiln_context *context, const view_options *options,
                                        const kiln_map *source, int width, int height,
                                        const view_reference_def *def, kiln_image *image,
                                        view_reference_report *report, kiln_error *error);

/// How two linear pictures of a view differ over the pixels whose centre shows a ball.
typedef struct view_error {
    double rms, largest; ///< relative to the truth's mean over these pixels
    double screen;       ///< RMS of what a screen shows, of 255
    int ball_count;
    double ball[VIEW_MAX_BALLS];        ///< RMS of each ball, relative to its own mean
    double ball_screen[VIEW_MAX_BALLS]; ///< as `screen`
} view_error;

/// Leaves image - truth in `image`, over that mean, or as colours: blue too dark, red too bright,
/// white none, full at 25 %.
view_error view_compare(const view_options *options, kiln_image *image, const kiln_image *truth,
                        bool colours);

#endif
