// What keys and mouse do to a view: the same in the window and in the page.
#ifndef KILN_VIEWER_CONTROLS_H
#define KILN_VIEWER_CONTROLS_H

#include "viewer.h"

/// Drags in pixels of a picture of this height: orbit, and turn the environment.
void view_orbit(view_options *options, double right, double down, int height);
void view_turn(view_options *options, double right, int height);
/// Moves closer (steps > 0) or away.
void view_zoom(view_options *options, double steps);

/// A key by its character, lower case; true where the view changed. `allowed` says which scenes may
/// be chosen.
bool view_key(view_options *options, char key, const bool allowed[VIEW_SCENE_COUNT]);

/// What the keys do, one line each, ending in NULL.
extern const char *const view_keys[];

#endif
