// Renders a view by Monte Carlo integration, without prefiltered levels, split sums or small
// tables. The picture has the same rays and the same reflection model as the real-time picture,
// which can be measured against it (view_compare).
#ifndef KILN_VIEWER_REFERENCE_H
#define KILN_VIEWER_REFERENCE_H

#include "viewer.h"

/// Settings of view_reference; {0} selects the default of each.
typedef struct view_reference_def {
    double noise;    ///< wanted relative standard error of a pixel, 1e-4 to 1; 0 for 0.01
    int batch_limit; ///< largest number of samples for each ray; 0 for 16384
    /// a random walk between microfacets computes the bounces from the second one on, in place of
    /// each ball's compensation method
    bool walk;
    /// lights that shine beside the environment, in the environment's frame (view_set_lights); NULL
    /// for none
    const kiln_lights *lights;
    int bounces; ///< a light path may meet this many balls; 0 for no limit
    /// balls do not reflect one another, as in the real-time picture; with view_options.occlusion
    /// they look black to one another. The furnace scene always does this
    bool alone;
    /// Receives the standard error of each pixel and channel, in the form of the picture; the
    /// caller frees it. NULL if the standard errors are not wanted.
    kiln_image *deviation;
    /// number of threads, 1 to 256; 0 for one thread per core. The picture is the same for every
    /// number of threads
    int thread_count;
    /// Called now and then from the calling thread with the finished fraction, 0 to 1. Returning
    /// false cancels. May be NULL.
    bool (*progress)(void *user, const char *stage, double fraction);
    void *progress_user;
} view_reference_def;

/// Noise and effort of a picture, over the pixels that show a ball or the ground.
typedef struct view_reference_report {
    double noise;       ///< RMS of the pixels' relative standard errors
    double batches;     ///< mean number of samples of each ray
    size_t pixel_count; ///< number of pixels that show a ball or the ground
    size_t noisy_count; ///< number of pixels that reached batch_limit before the wanted noise
} view_reference_report;

/// Renders a picture of linear radiance: three channels, row 0 at the top. `source` is the
/// unfiltered environment, a map of any shape whose texels are uniformly bright; NULL for scenes
/// without an environment. `report` may be NULL.
KILN_CHECKED kiln_result view_reference(kiln_context *context, const view_options *options,
                                        const kiln_map *source, int width, int height,
                                        const view_reference_def *def, kiln_image *image,
                                        view_reference_report *report, kiln_error *error);

/// How two linear pictures of a view differ over the pixels whose centre shows a ball.
typedef struct view_error {
    double rms, largest; ///< RMS and largest difference, over the mean of the true picture
    double screen;       ///< RMS difference of the tone-mapped values, in steps of 255
    int ball_count;
    double ball[VIEW_MAX_BALLS]; ///< RMS difference within each ball, over the ball's mean
    /// RMS difference within each ball of the tone-mapped values, in steps of 255
    double ball_screen[VIEW_MAX_BALLS];
} view_error;

/// The part of view_error's figures on the screen that the reference's noise causes, from the
/// standard errors in view_reference_def.deviation. Errors and noise are independent, so a figure
/// without the noise is the square root of the difference of the squares. Sets `screen` and
/// `ball_screen` only.
view_error view_noise(const view_options *options, const kiln_image *truth,
                      const kiln_image *deviation);

/// Replaces `image` by (image - truth) / mean of the truth, or with `colours` by a colour:
/// blue for too dark, red for too bright, white for no difference, fully saturated from 25 % on.
view_error view_compare(const view_options *options, kiln_image *image, const kiln_image *truth,
                        bool colours);

#endif
