// A window on the scenes, by GLFW. The library is looked for at run time.
#ifndef KILN_VIEWER_WINDOW_H
#define KILN_VIEWER_WINDOW_H

#include "viewer.h"

/// {0} is a good default.
typedef struct view_window_def {
    const char *title;
    int width, height; ///< of the picture; 0 for 1280 x 720
    view_options options;
    /// Called once with the renderer before anything is drawn, to set environments. May be NULL.
    kiln_result (*prepare)(void *user, view_renderer *renderer, kiln_error *error);
    /// Asked before each frame; false closes the window. May be NULL.
    bool (*go_on)(void *user);
    void *user;
    bool has_environment; ///< scenes that need one can be chosen
    /// Asked in compare, ten times a second, until the textbook's environment is set and `done` is 1;
    /// before that it is the share that is. `wait`: to return only then. NULL where compare cannot be
    /// chosen.
    kiln_result (*textbook)(void *user, view_renderer *renderer, bool wait, double *done,
                            kiln_error *error);
    /// Not NULL: draws one frame, reads the window's own pixels into it and returns.
    kiln_image *screenshot;
} view_window_def;

/// Opens the window and stays until it is closed. Fails with a sentence where there is no GLFW, no
/// screen or no OpenGL ES 3.0.
KILN_CHECKED kiln_result view_window(kiln_context *context, const view_window_def *def,
                                     kiln_error *error);

#endif
