// Effects of keys and mouse on a view, shared by the window and the web page.
#ifndef KILN_VIEWER_CONTROLS_H
#define KILN_VIEWER_CONTROLS_H

#include "viewer.h"

/// A drag by `right` and `down` pixels in a picture of `height` pixels: view_orbit moves the camera
/// about its target, view_turn turns the environment.
void view_orbit(view_options *options, double right, double down, int height);
void view_turn(view_options *options, double right, int height);
/// Moves the camera closer (steps > 0) or away (steps < 0) by a tenth of its distance a step.
void view_zoom(view_options *options, double steps);

/// Handles the key with this lower-case character; returns true if the view changed. `allowed` says
/// for each scene whether keys may choose that scene.
bool view_key(view_options *options, char key, const bool allowed[VIEW_SCENE_COUNT]);

/// Help: one line for each key; the list ends in NULL.
extern const char *const view_keys[];

#endif
