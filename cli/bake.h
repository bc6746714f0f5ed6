// kiln bake: the state that its options, its work and its report share.
#ifndef KILN_CLI_BAKE_H
#define KILN_CLI_BAKE_H

#include "work.h"

/// Seconds are reported by stage.
typedef enum bake_stage { BAKE_LOAD, BAKE_FILTER, BAKE_SAVE, BAKE_STAGES } bake_stage;

typedef enum bake_tuning { BAKE_EXACT, BAKE_SHARP, BAKE_SOFT } bake_tuning;

typedef struct bake {
    cli_arguments arguments;
    // By the rows.
    const char *output, *irradiance_path, *sh_path, *roughness_text;
    int size, level_count, shape, format, zstd, lobe, textbook;
    int engine_index; ///< -1 without --for
    int tuning;       ///< a bake_tuning; -1 while that is the engine's to say
    int samples, phi_steps, theta_steps;
    int irradiance_size, sh_bands, layout, threads;
    double sh_window, rotation, exposure;
    bool mirror, json, quiet, verbose, sh_radiance, sh_irradiance;
    // By what they mean together.
    char folder[2][4096];      ///< names of folders, with the slash at their end that was left out
    const kiln_engine *engine; ///< NULL without --for
    bool has_roughness, stores_sh; ///< stores_sh: in the file's metadata
    float roughness[KILN_MAX_LEVELS];

    cli_work work;
    kiln_map source;
    kiln_environment made;
    int source_width, source_height, file_count, main_count;
    kiln_shape source_shape;
    bake_stage stage;
    double seconds[BAKE_STAGES], since;
} bake;

extern const cli_option bake_options[];
extern const char *const bake_lobes[], *const bake_shapes[], *const bake_methods[],
                                                                 *const bake_tunings[];

/// Reads the command line and checks everything that can be checked before the work. CLI_GO or an exit
/// code.
int bake_read_options(bake *b, const cli_command *command, const cli_call *call);
/// Prints what was done, in words or as JSON.
void bake_report(bake *b);

#endif
