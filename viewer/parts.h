// What the viewer's files share among themselves.
#ifndef KILN_VIEWER_PARTS_H
#define KILN_VIEWER_PARTS_H

#include "viewer.h"

/// Writes the sentence unless `error` is NULL.
void view_describe(kiln_error *error, kiln_result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/// The same, and is `result`.
#define view_fail(error, result, ...) (view_describe((error), (result), __VA_ARGS__), (result))

/// A shader with its #includes in place, without version and precision lines; ends in NUL.
extern const char view_shader_screen_vert[], view_shader_scene_frag[];

/// What the handout's figure 6 reads for E_avg: the albedo texture.
extern const double view_handout_albedo[3];

#endif
