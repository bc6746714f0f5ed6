// A window that shows the scenes, by GLFW, whose library is loaded at run time.
#ifndef KILN_VIEWER_WINDOW_H
#define KILN_VIEWER_WINDOW_H

#include "viewer.h"

/// Settings of view_window; {0} selects the default of each.
typedef struct view_window_def {
    const char *title;
    int width, height; ///< size of the picture in pixels; 0 for 1280 x 720
    view_options options;
    /// Called once with the renderer before the first frame, to set environments. May be NULL.
    kiln_result (*prepare)(void *user, view_renderer *renderer, kiln_error *error);
    /// Called before each frame; returning false closes the window. May be NULL.
    bool (*go_on)(void *user);
    void *user;
    bool has_environment; ///< lets the keys choose scenes that need an environment
    /// Called ten times a second while VIEW_SCENE_COMPARE is shown, until it has set the sampled
    /// environment (VIEW_SLOT_TEXTBOOK). `done` receives the finished share of that bake, 0 to 1.
    /// With `wait` it must return only after it has finished. NULL: keys cannot choose the scene.
    kiln_result (*textbook)(void *user, view_renderer *renderer, bool wait, double *done,
                            kiln_error *error);
    /// If not NULL: the window draws one frame, copies its pixels to this picture and closes.
    kiln_image *screenshot;
} view_window_def;

/// Opens the window and returns when it is closed. Fails with KILN_ERROR_UNSUPPORTED if there is no
/// GLFW, no screen or no OpenGL ES 3.0.
KILN_CHECKED kiln_result view_window(kiln_context *context, const view_window_def *def,
                                     kiln_error *error);

#endif
