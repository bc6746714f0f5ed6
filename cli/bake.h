// The state of kiln bake, shared by its options (bake_options.c), its work (bake.c) and its report
// (bake_report.c).
#ifndef KILN_CLI_BAKE_H
#define KILN_CLI_BAKE_H

#include "json.h"
#include "work.h"

/// The stages of a bake whose seconds the report lists.
typedef enum bake_stage { BAKE_LOAD, BAKE_FILTER, BAKE_SAVE, BAKE_STAGES } bake_stage;

typedef enum bake_tuning { BAKE_EXACT, BAKE_SHARP, BAKE_SOFT } bake_tuning;

/// A plan that bakes of equal options share, one bake after the other.
typedef struct bake_plan {
    kiln_plan *plan; ///< NULL before the first bake
    uint64_t key;    ///< the `plan_key` of the bakes that the plan serves
    kiln_shape shape;
    int size; ///< shape and size of the sources that the plan serves
} bake_plan;

typedef struct bake {
    cli_arguments arguments;
    // Values of the options, which the parser writes here by the option rows of bake_options.c.
    const char *output, *irradiance_path, *sh_path, *lights_path, *layer;
    const char *roughness_text, *sun_text, *clamp_text;
    int size, level_count, shape, format, zstd, lobe, textbook;
    int engine_index; ///< index of the engine of --for in kiln's list; -1 without --for
    int tuning;       ///< a bake_tuning; -1 if the engine decides
    int samples, phi_steps, theta_steps;
    int irradiance_size, sh_bands, layout, negative, threads;
    double sh_window, exposure;
    kiln_lights_def lights;
    bool mirror, json, quiet, verbose, sh_radiance, sh_irradiance;
    // Values that follow from several options together. The first are the names of the output
    // folders of levels and irradiance, with a final slash, which the user may omit.
    char folder[2][4096];
    const kiln_engine *engine; ///< engine of --for; NULL without --for
    /// has_roughness: --roughness is given; stores_sh: the output file's metadata holds spherical
    /// harmonics
    bool has_roughness, stores_sh;
    /// true: the file goes to standard output; `output` is then "-" with the ending of its format
    bool to_stdout;
    float roughness[KILN_MAX_LEVELS];
    const char *rotation_text;    ///< text of --rotate; NULL without the option
    double rotation, pitch, roll; ///< angles of --rotate in degrees
    int up;                       ///< a kiln_up
    kiln_sun sun;
    double clamp; ///< radiance of --clamp; 0 if the library chooses

    // What a batch sets. plan: the plan to use and to replace where it does not fit; NULL to bake
    // without a plan. plan_key: a number that is equal for bakes whose options give the same plan.
    bake_plan *plan;
    uint64_t plan_key;
    bool makes_folders; ///< the folders of the outputs need not be there yet
    /// called with the path and the bytes of each file that is written; may be NULL
    void (*watch)(void *user, const char *path, const void *bytes, size_t size);
    void *watch_user;
    /// prints the result in place of bake_report; may be NULL
    void (*report)(struct bake *b);

    cli_work work;
    kiln_map source;
    kiln_environment made;
    kiln_environment_report saved;
    int source_width, source_height;
    kiln_shape source_shape;
    bake_stage stage;
    double seconds[BAKE_STAGES], since;
} bake;

extern const cli_option bake_options[];
extern const char *const bake_lobes[], *const bake_shapes[], *const bake_methods[],
                                                                 *const bake_tunings[];

/// Parses the command line and checks all that can be checked before the work. Returns CLI_GO or an
/// exit code.
int bake_read_options(bake *b, const cli_command *command, const cli_call *call);
/// Checks the values of all options, which b->arguments and the fields of `b` hold already. Returns
/// CLI_GO or an exit code.
int bake_check_options(bake *b);
/// Returns whether the option in this row of bake_options decides what the written files hold.
bool bake_changes_files(int option);
/// Sets sun and clamp from --sun and --clamp, and checks the options of lights. Returns CLI_GO or
/// an exit code.
int bake_read_sun(bake *b, bool has_lights, bool has_share);
/// Takes lights out of the source, or clamps it, for methods other than kiln_bake.
int bake_sun_of_source(bake *b);
/// Says on standard error which lights were taken out, or what light was lost.
void bake_say_sun(bake *b);
/// Does the work of one input with checked options. Returns the exit code.
int bake_run(bake *b);
/// The same with the context of b->work, which the caller has created and destroys. Leaves the
/// error in b->work.error.
int bake_in_context(bake *b);
/// Frees a plan. The object can be used again.
void bake_plan_free(bake_plan *plan);
/// Prints the result of the bake, in words or as JSON.
void bake_report(bake *b);
/// Writes the result as members of the JSON object that is open.
void bake_report_members(const bake *b, json *j);

/// Returns whether an output path holds {name}: each input is then an environment of its own.
bool bake_is_for_several(const bake *b);
/// Returns a copy of `path` with the name of `input` in place of each {name}; NULL if memory runs
/// out. The name is the last part of the input's path without its ending.
char *bake_name_path(const char *path, const char *input);
/// Returns CLI_GO, or says that an input such as . or .. has no name and returns CLI_WRONG.
int bake_check_name(const cli_command *command, const char *input);
/// Bakes each input. Returns the exit code: of a failure if an input failed.
int bake_run_several(const bake *b);

#endif
