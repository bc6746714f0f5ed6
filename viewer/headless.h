// An OpenGL ES 3.0 context without a window, created by EGL, whose library is loaded at run time.
#ifndef KILN_VIEWER_HEADLESS_H
#define KILN_VIEWER_HEADLESS_H

#include "viewer.h"

typedef struct view_headless view_headless;

/// Creates a context and makes it current: on Mesa's surfaceless platform, or on the default
/// display if that platform is missing. Fails with KILN_ERROR_UNSUPPORTED if there is no EGL or EGL
/// offers no OpenGL ES 3.0.
KILN_CHECKED kiln_result view_headless_create(view_headless **headless, kiln_error *error);
/// Destroys a GL context made by view_headless_create. `headless` may be NULL.
void view_headless_destroy(view_headless *headless);
/// The function, for view_create, that finds a GL function by its name.
view_function view_headless_lookup(const char *name);

#endif
