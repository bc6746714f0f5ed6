// The errors of the real-time picture that kiln render --error prints.
#ifndef KILN_CLI_RENDER_ERROR_H
#define KILN_CLI_RENDER_ERROR_H

#include "reference.h"

/// Errors of a view for each way to look reflections up, against one reference.
typedef struct render_errors {
    view_error by[VIEW_REFLECTIONS_COUNT];
    view_error noise; ///< part of each error that is the reference's noise (view_noise)
    view_reference_report reference;
} render_errors;

/// Prints a table: one line for each ball and one for all balls.
void render_print_errors(const view_options *options, const render_errors *errors);
/// Prints the same as a JSON object. `name` is the environment's; NULL for none.
void render_print_json(const char *name, const view_options *options, int width, int height,
                       const render_errors *errors);

#endif
