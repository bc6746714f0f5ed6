// Shared functions of the demo: pictures of maps, and the HTML of its pages.
#ifndef DEMO_H
#define DEMO_H

#include <kiln/kiln.h>
#include <stdbool.h>
#include <stdio.h>

// ---------------------------------------------------------------------------------------- pictures

/// The exposure of the demo's pictures, and the direction from which balls are seen.
typedef struct demo_view {
    double exposure; ///< factor on the radiance before the tone curve
    double yaw;      ///< rotation of the viewer about +Y, radians
} demo_view;

/// One mip level of a cube map.
typedef struct demo_level {
    const kiln_map *cube;
    int level;
} demo_level;

/// Chooses the view of a panorama. The exposure maps the geometric mean of its arithmetic and its
/// geometric mean luminance to 0.2, a middle grey. The viewer is turned so that the main light
/// comes from the side.
kiln_result demo_view_choose(kiln_context *context, const kiln_map *panorama,
                             const kiln_spectrum *spectrum, demo_view *view, kiln_error *error);

/// Sets `value` to the radiance of a cube's level in a direction, by bilinear interpolation, also
/// across the edges of faces.
void demo_cube_sample(const kiln_map *cube, int level, const double direction[3], double value[3]);

/// Draws the panorama, scaled to `height` rows.
kiln_result demo_picture_panorama(kiln_context *context, const kiln_map *panorama, int height,
                                  const demo_view *view, kiln_image *image, kiln_error *error);
/// Draws a cube's level unfolded as a cross: one pixel for each texel, but faces of at most
/// `largest` pixels a side.
kiln_result demo_picture_cross(kiln_context *context, const kiln_map *cube, int level, int largest,
                               const demo_view *view, kiln_image *image, kiln_error *error);
/// Draws the unfolded faces of a cube of edge `size`: the relative error of each texel in the
/// colours of demo_error_colors.
kiln_result demo_picture_errors(kiln_context *context, const double *errors, int size,
                                kiln_image *image, kiln_error *error);
/// Draws a ball. It mirrors the radiance of a cube's level; with `matte` each point shows the
/// level's value in the direction of the normal.
kiln_result demo_picture_ball(kiln_context *context, demo_level level, bool matte, int diameter,
                              const demo_view *view, kiln_image *image, kiln_error *error);
/// Draws spherical harmonics as a panorama; negative values are black.
kiln_result demo_picture_sh(kiln_context *context, const kiln_sh *sh, int height,
                            const demo_view *view, kiln_image *image, kiln_error *error);
/// Draws a matte ball lit by the spherical harmonics of irradiance.
kiln_result demo_picture_sh_ball(kiln_context *context, const kiln_sh *sh, int diameter,
                                 const demo_view *view, kiln_image *image, kiln_error *error);
/// Draws a row of balls, one for each of `levels`, in front of the environment, blurred by level 2.
kiln_result demo_picture_row(kiln_context *context, const demo_level *levels, int count, int width,
                             int height, const demo_view *view, kiln_image *image,
                             kiln_error *error);
/// Draws a table of A and B of the split sum: its two channels as red and green.
kiln_result demo_picture_table(kiln_context *context, const kiln_image *table, kiln_image *image,
                               kiln_error *error);

/// Colours of relative errors, one for each power of ten or so from 1e-7 (dark) to 1 (light).
enum { DEMO_ERROR_COLORS = 7 };
extern const unsigned char demo_error_colors[DEMO_ERROR_COLORS][3];

// -------------------------------------------------------------------------------------------- page

typedef struct demo_page {
    FILE *file;
    const char *scratch; ///< path of a temporary file, which may be overwritten and removed
    kiln_context *context;
} demo_page;

/// Writes the HTML of a page before its first section: head, style and title.
void demo_page_head(FILE *file);
/// Writes the HTML of a page after its last section; `words` are the footer's text.
void demo_page_foot(FILE *file, const char *words);
/// Writes text as HTML, with &, < and > escaped.
void demo_page_text(FILE *file, const char *text);
/// Writes an <img> element that contains the picture, and frees the picture.
kiln_result demo_page_picture(demo_page *page, kiln_image *image, const char *style_class,
                              const char *alt, kiln_error *error);
/// Writes a legend of the colours of demo_error_colors.
void demo_page_legend(FILE *file);

/// Writes a legend of the colours in which kiln_assignment_compare draws differences, for both
/// signs.
kiln_result demo_signed_legend(demo_page *page, kiln_error *error);
/// demo_page_open creates a page's file in `folder`; it returns NULL on failure. demo_page_close
/// prints the file's name and returns `result`, or the failure to write.
FILE *demo_page_open(const char *folder, const char *name, kiln_error *error);
kiln_result demo_page_close(FILE *file, const char *folder, const char *name, kiln_result result,
                            kiln_error *error);

/// Writes assignment.html and tables.html into `folder`; `scratch` is demo_page.scratch.
kiln_result demo_assignment_page(kiln_context *context, const char *folder, const char *scratch,
                                 kiln_error *error);
kiln_result demo_tables_page(kiln_context *context, const char *folder, const char *scratch,
                             kiln_error *error);

/// Name of the file that gallery.mjs writes in the demo's folder. If the file exists, gallery.html
/// is made from it.
#define DEMO_GALLERY "gallery.part"
kiln_result demo_gallery_page(const char *folder, bool *made, kiln_error *error);

#endif
