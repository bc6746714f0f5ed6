// A GL ES 3.0 context without a window, by EGL. The library is looked for at run time.
#ifndef KILN_VIEWER_HEADLESS_H
#define KILN_VIEWER_HEADLESS_H

#include "viewer.h"

typedef struct view_headless view_headless;

/// Makes a context and makes it current: on Mesa's surfaceless platform or, where that is not to be
/// had, on the default display. Fails with a sentence where there is no EGL or it offers no ES 3.0.
KILN_CHECKED kiln_result view_headless_create(view_headless **headless, kiln_error *error);
/// May be NULL.
void view_headless_destroy(view_headless *headless);
/// For view_create.
view_function view_headless_lookup(const char *name);

#endif
