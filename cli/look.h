// What `kiln render` and `kiln view` share: the options of a view, and its environment.
#ifndef KILN_CLI_LOOK_H
#define KILN_CLI_LOOK_H

#include "cli.h"

#include "viewer.h"

/// Numbers of the shared options; a command's own come before.
enum {
    LOOK_SCENE = 16,
    LOOK_METHOD,
    LOOK_MATERIAL,
    LOOK_SIZE,
    LOOK_SAMPLES,
    LOOK_EXPOSURE,
    LOOK_ROTATE,
    LOOK_BACKGROUND,
    LOOK_AZIMUTH,
    LOOK_ELEVATION,
    LOOK_DISTANCE,
    LOOK_FOV,
    LOOK_DEBUG,
    LOOK_LEVEL,
    LOOK_SPLIT,
    LOOK_AS_PRINTED,
    LOOK_OCCLUSION,
    LOOK_STRAIGHT,
    LOOK_DIFFUSE,
    LOOK_BAKE_SIZE,
};

extern const struct poptOption look_options[];

typedef struct look {
    view_options options;
    int width, height;
    int bake_size;     ///< edge of the environment's level 0
    const char *input; ///< the environment's name, NULL for a sky
} look;

/// CLI_GO or an exit code.
int look_read(const cli_arguments *a, look *l);
/// The scene needs an environment.
bool look_has_environment(const look *l);
/// Loads the environment, or makes a sky. CLI_GO or CLI_FAILED.
int look_load(cli_job *job, const look *l, kiln_map *source);
/// Samples a texel of the textbook's bake.
enum { LOOK_TEXTBOOK_SAMPLES = 1024 };
/// Bakes it for the renderer, one slot (`samples` 0: exactly) or all that the scene needs. CLI_GO or
/// CLI_FAILED.
int look_bake_slot(cli_job *job, const look *l, const kiln_map *source, view_slot slot, int samples,
                   view_renderer *renderer);
int look_bake(cli_job *job, const look *l, const kiln_map *source, view_renderer *renderer);

#endif
