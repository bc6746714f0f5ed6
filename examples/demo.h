// The demo's parts: pictures made of maps, and the page they stand on.
#ifndef DEMO_H
#define DEMO_H

#include <kiln/kiln.h>
#include <stdbool.h>
#include <stdio.h>

// ---------------------------------------------------------------------------------------- pictures

/// How radiance becomes light on a screen, and where the viewer of the balls stands.
typedef struct demo_view {
    double exposure; ///< radiance is multiplied by it before the tone curve
    double yaw;      ///< radians that the viewer is turned about +Y
} demo_view;

/// One level of a cube.
typedef struct demo_level {
    const kiln_map *cube;
    int level;
} demo_level;

/// Middle grey between the arithmetic and the geometric mean of the panorama's luminance; the
/// viewer so that the light comes from beside.
kiln_result demo_view_choose(kiln_context *context, const kiln_map *panorama,
                             const kiln_spectrum *spectrum, demo_view *view, kiln_error *error);

/// Radiance of a cube's level in a direction: bilinear, across the edges of faces too.
void demo_cube_sample(const kiln_map *cube, int level, const double direction[3], double value[3]);

/// The panorama, `height` rows.
kiln_result demo_picture_panorama(kiln_context *context, const kiln_map *panorama, int height,
                                  const demo_view *view, kiln_image *image, kiln_error *error);
/// A cube's level unfolded, one pixel a texel, faces of at most `largest` pixels.
kiln_result demo_picture_cross(kiln_context *context, const kiln_map *cube, int level, int largest,
                               const demo_view *view, kiln_image *image, kiln_error *error);
/// Errors of each texel of a cube of `size`, in the colours of demo_error_color.
kiln_result demo_picture_errors(kiln_context *context, const double *errors, int size,
                                kiln_image *image, kiln_error *error);
/// A ball that mirrors a level, or with `matte` shows it in the direction of its normal.
kiln_result demo_picture_ball(kiln_context *context, demo_level level, bool matte, int diameter,
                              const demo_view *view, kiln_image *image, kiln_error *error);
/// Spherical harmonics as a panorama, negative values black.
kiln_result demo_picture_sh(kiln_context *context, const kiln_sh *sh, int height,
                            const demo_view *view, kiln_image *image, kiln_error *error);
/// Spherical harmonics of irradiance on a matte ball.
kiln_result demo_picture_sh_ball(kiln_context *context, const kiln_sh *sh, int diameter,
                                 const demo_view *view, kiln_image *image, kiln_error *error);
/// A row of balls before the environment as level 2 blurs it.
kiln_result demo_picture_row(kiln_context *context, const demo_level *levels, int count, int width,
                             int height, const demo_view *view, kiln_image *image,
                             kiln_error *error);
/// Two channels as red and green.
kiln_result demo_picture_table(kiln_context *context, const kiln_image *table, kiln_image *image,
                               kiln_error *error);

/// From 1e-7 (dark) to 1 (light) on a logarithmic scale.
enum { DEMO_ERROR_COLORS = 7 };
extern const unsigned char demo_error_colors[DEMO_ERROR_COLORS][3];

// -------------------------------------------------------------------------------------------- page

typedef struct demo_page {
    FILE *file;
    const char *scratch; ///< a file that may be written and removed
    kiln_context *context;
} demo_page;

/// Head, style and title up to the first section.
void demo_page_head(FILE *file);
/// `words` stand below the page.
void demo_page_foot(FILE *file, const char *words);
/// Text with &, < and > escaped.
void demo_page_text(FILE *file, const char *text);
/// <img> with the picture inside, which is released.
kiln_result demo_page_picture(demo_page *page, kiln_image *image, const char *style_class,
                              const char *alt, kiln_error *error);
/// The scale of the error maps.
void demo_page_legend(FILE *file);

/// The scale of kiln_assignment_compare's maps.
kiln_result demo_signed_legend(demo_page *page, kiln_error *error);
/// A page of its own; NULL where it cannot be written. Closing says what it wrote and returns `result`,
/// or the failure to write.
FILE *demo_page_open(const char *folder, const char *name, kiln_error *error);
kiln_result demo_page_close(FILE *file, const char *folder, const char *name, kiln_result result,
                            kiln_error *error);

/// assignment.html and tables.html in `folder`; `scratch` as in demo_page.
kiln_result demo_assignment_page(kiln_context *context, const char *folder, const char *scratch,
                                 kiln_error *error);
kiln_result demo_tables_page(kiln_context *context, const char *folder, const char *scratch,
                             kiln_error *error);

/// What gallery.mjs leaves in `folder`. Where it is there, it becomes gallery.html.
#define DEMO_GALLERY "gallery.part"
kiln_result demo_gallery_page(const char *folder, bool *made, kiln_error *error);

#endif
