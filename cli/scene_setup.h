// Options that `kiln render` and `kiln view` share: the view, and the environment that lights it.
#ifndef KILN_CLI_SCENE_SETUP_H
#define KILN_CLI_SCENE_SETUP_H

#include "work.h"

#include "viewer.h"

/// Indices of the option rows that kiln render and kiln view share. The rows of the command follow
/// them.
enum {
    SCENE,
    SCENE_METHOD,
    SCENE_MATERIAL,
    SCENE_SIZE,
    SCENE_SAMPLES,
    SCENE_EXPOSURE,
    SCENE_ROTATE,
    SCENE_BACKGROUND,
    SCENE_AZIMUTH,
    SCENE_ELEVATION,
    SCENE_DISTANCE,
    SCENE_FOV,
    SCENE_DEBUG,
    SCENE_LEVEL,
    SCENE_SPLIT,
    SCENE_AS_PRINTED,
    SCENE_OCCLUSION,
    SCENE_REFLECTIONS,
    SCENE_STRAIGHT,
    SCENE_DIFFUSE,
    SCENE_BAKE_SIZE,
    SCENE_LAYER,
    SCENE_NEGATIVE,
    SCENE_SUN,
    SCENE_LIGHTS,
    SCENE_LIGHTS_SHARE,
    SCENE_GROUND,
    SCENE_OPTIONS
};

/// Values of the shared options. This must be the first member of the command's structure, because
/// the shared rows' offsets refer to it.
typedef struct scene_setup {
    view_options options;
    int scene; ///< a view_scene; -1 if no option names a scene
    const char *size;
    int cube_diffuse;
    int width, height;
    int bake_size;     ///< edge of the environment's level 0 in texels
    int negative;      ///< a kiln_negative, which decides what becomes of negative texels
    const char *layer; ///< layer of the environment's file; NULL for the default
    const char *input; ///< name of the environment's file; NULL for a sky
    int sun;           ///< KILN_SUN_KEEP or KILN_SUN_EXTRACT
    kiln_lights_def lights;
    kiln_lights taken; ///< lights that scene_load took out of the environment
} scene_setup;

/// What every option --size of a picture says of its value. scene_read_size reads the value.
#define SCENE_SIZE_WORDS                                                                           \
    .value = "WxH", .help = "width and height of a picture in pixels, each 1 to 16384",            \
    .unset = "1280x720"

/// The option rows that kiln render and kiln view share. Each command's table of options begins
/// with them.
#define SCENE_ROWS                                                                                 \
    [SCENE] =                                                                                      \
        {"scene",                                                                                  \
         CLI_CHOICE,                                                                               \
         offsetof(scene_setup, scene),                                                             \
         0,                                                                                        \
         0,                                                                                        \
         -1,                                                                                       \
         "SCENE",                                                                                  \
         .word = view_scene_name,                                                                  \
         .help =                                                                                   \
             "assignment: two rows of five copper balls under one directional light, the upper "   \
             "row with Kulla and Conty's lobe, the lower row with light reflected once; ibl: the " \
             "same rows in the environment; furnace: the same rows in uniform white light; grid: " \
             "balls with roughness growing to the right and metallic upwards; compare: left of a " \
             "line the exact bake, right of the line the textbook's bake",                         \
         .unset = "ibl with an ENV, else assignment",                                              \
         .group = "Picture"},                                                                      \
    [SCENE_METHOD] = {"method",                                                                    \
                      CLI_CHOICE,                                                                  \
                      offsetof(scene_setup, options.method),                                       \
                      .value = "METHOD",                                                           \
                      .word = view_method_name,                                                    \
                      .keep = true,                                                                \
                      .help =                                                                      \
                          "how the upper row returns the light that a single reflection between "  \
                          "microfacets loses; single returns nothing; handout is Kulla and "       \
                          "Conty's method with the factor of the GAMES202 assignment",             \
                      .unset = "kulla-conty, and handout for the scene assignment"},               \
    [SCENE_MATERIAL] = {"material",                                                                \
                        CLI_CHOICE,                                                                \
                        offsetof(scene_setup, options.material),                                   \
                        .value = "MATERIAL",                                                       \
                        .word = view_material_name,                                                \
                        .keep = true,                                                              \
                        .help = "what the balls are made of",                                      \
                        .unset = "gold"},                                                          \
    [SCENE_SIZE] = {"size", CLI_TEXT, offsetof(scene_setup, size), SCENE_SIZE_WORDS},              \
    [SCENE_SAMPLES] =                                                                              \
        {"samples",                                                                                \
         CLI_INTEGER,                                                                              \
         offsetof(scene_setup, options.samples),                                                   \
         1,                                                                                        \
         8,                                                                                        \
         4,                                                                                        \
         "N",                                                                                      \
         .help = "cast N x N rays for each pixel, and average them before tone mapping"},          \
    [SCENE_EXPOSURE] =                                                                             \
        {"exposure", CLI_NUMBER, offsetof(scene_setup, options.exposure),     -64, 64,             \
         0,          "STOPS",    .help = "multiply the brightness by 2^STOPS"},                    \
    [SCENE_ROTATE] = {"rotate",                                                                    \
                      CLI_NUMBER,                                                                  \
                      offsetof(scene_setup, options.rotation),                                     \
                      -3600,                                                                       \
                      3600,                                                                        \
                      0,                                                                           \
                      "DEGREES",                                                                   \
                      .help = "turn the environment about the vertical axis"},                     \
    [SCENE_BACKGROUND] = {"background",                                                            \
                          CLI_NUMBER,                                                              \
                          offsetof(scene_setup, options.background),                               \
                          0,                                                                       \
                          1,                                                                       \
                          0,                                                                       \
                          "ROUGHNESS",                                                             \
                          .help =                                                                  \
                              "roughness by which the environment behind the balls is blurred",    \
                          .keep = true,                                                            \
                          .unset = "0"},                                                           \
    [SCENE_AZIMUTH] = {"azimuth",                                                                  \
                       CLI_NUMBER,                                                                 \
                       offsetof(scene_setup, options.camera.azimuth),                              \
                       -360,                                                                       \
                       360,                                                                        \
                       0,                                                                          \
                       "DEGREES",                                                                  \
                       .help = "angle of the camera around the balls",                             \
                       .keep = true,                                                               \
                       .unset = "that of the scene",                                               \
                       .group = "Camera"},                                                         \
    [SCENE_ELEVATION] = {"elevation",                                                              \
                         CLI_NUMBER,                                                               \
                         offsetof(scene_setup, options.camera.elevation),                          \
                         -89,                                                                      \
                         89,                                                                       \
                         0,                                                                        \
                         "DEGREES",                                                                \
                         .help = "angle of the camera above the balls",                            \
                         .keep = true,                                                             \
                         .unset = "that of the scene"},                                            \
    [SCENE_DISTANCE] = {"distance",                                                                \
                        CLI_NUMBER,                                                                \
                        offsetof(scene_setup, options.camera.distance),                            \
                        10,                                                                        \
                        10000,                                                                     \
                        0,                                                                         \
                        "D",                                                                       \
                        .help = "distance of the camera from the balls, each of which is 72 wide", \
                        .keep = true,                                                              \
                        .unset = "that of the scene"},                                             \
    [SCENE_FOV] = {"fov",                                                                          \
                   CLI_NUMBER,                                                                     \
                   offsetof(scene_setup, options.camera.fov),                                      \
                   1,                                                                              \
                   150,                                                                            \
                   0,                                                                              \
                   "DEGREES",                                                                      \
                   .help = "vertical field of view",                                               \
                   .keep = true,                                                                   \
                   .unset = "that of the scene"},                                                  \
    [SCENE_DEBUG] = {"debug",                                                                      \
                     CLI_CHOICE,                                                                   \
                     offsetof(scene_setup, options.debug),                                         \
                     .value = "VIEW",                                                              \
                     .word = view_debug_name,                                                      \
                     .help = "show instead of the picture: a level of the environment, a table, "  \
                             "or on the balls the albedo E or Fresnel's reflectance F",            \
                     .group = "What is shown"},                                                    \
    [SCENE_LEVEL] = {"level", CLI_INTEGER, offsetof(scene_setup, options.debug_level),  0, 15,     \
                     0,       "K",         .help = "the level that --debug level shows"},          \
    [SCENE_SPLIT] = {"split",                                                                      \
                     CLI_NUMBER,                                                                   \
                     offsetof(scene_setup, options.split),                                         \
                     0,                                                                            \
                     1,                                                                            \
                     0.5,                                                                          \
                     "X",                                                                          \
                     .help = "position of the dividing line in the scene compare, from the left "  \
                             "edge 0 to the right edge 1"},                                        \
    [SCENE_AS_PRINTED] = {"as-printed", CLI_FLAG, offsetof(scene_setup, options.as_printed),       \
                          .help = "draw the scene assignment with the mistake of figure 6 of the " \
                                  "GAMES202 handout, in which the shader reads the balls' colour " \
                                  "instead of the table of the average albedo"},                   \
    [SCENE_OCCLUSION] = {"occlusion", CLI_FLAG, offsetof(scene_setup, options.occlusion),          \
                         .help = "let balls shade one another from the light of the environment"}, \
    [SCENE_REFLECTIONS] =                                                                          \
        {"reflections",                                                                            \
         CLI_CHOICE,                                                                               \
         offsetof(scene_setup, options.reflections),                                               \
         .value = "WAY",                                                                           \
         .word = view_reflections_name,                                                            \
         .keep = true,                                                                             \
         .help = "how reflections of rough balls are looked up in the environment's levels: "      \
                 "straight, once in the mirror direction; bent, once in a direction bent towards " \
                 "the normal (Lagarde and de Rousiers 2014); one, two or three, by as many "       \
                 "lookups that are fitted to the lobe, and by spherical harmonics",                \
         .unset = "bent"},                                                                         \
    [SCENE_STRAIGHT] = {"straight", CLI_RENAMED,                                                   \
                        .help = "this option is now --reflections straight"},                      \
    [SCENE_DIFFUSE] = {"diffuse",                                                                  \
                       CLI_CHOICE,                                                                 \
                       offsetof(scene_setup, cube_diffuse),                                        \
                       .value = "SOURCE",                                                          \
                       .word = scene_diffuse_word,                                                 \
                       .help = "source of the light of diffuse surfaces: spherical harmonics of "  \
                               "three bands (sh), or an irradiance cube (cube)"},                  \
    [SCENE_BAKE_SIZE] = {"bake-size",                                                              \
                         CLI_INTEGER,                                                              \
                         offsetof(scene_setup, bake_size),                                         \
                         16,                                                                       \
                         2048,                                                                     \
                         256,                                                                      \
                         "N",                                                                      \
                         .help = "texels along the edge of a face of the baked environment"},      \
    [SCENE_LAYER] = CLI_LAYER_ROW(scene_setup), [SCENE_NEGATIVE] = CLI_NEGATIVE_ROW(scene_setup),  \
    [SCENE_SUN] = {"sun",                                                                          \
                   CLI_CHOICE,                                                                     \
                   offsetof(scene_setup, sun),                                                     \
                   .value = "WHICH",                                                               \
                   .word = scene_sun_word,                                                         \
                   .help = "what becomes of the sun and other compact lights: keep leaves them "   \
                           "in the environment, extract takes the light with the largest share "   \
                           "out and draws a disc of light of its true size instead",               \
                   .group = "Sun and lamps"},                                                      \
    [SCENE_LIGHTS] = CLI_LIGHTS_ROW(scene_setup),                                                  \
    [SCENE_LIGHTS_SHARE] = CLI_LIGHTS_SHARE_ROW(scene_setup),                                      \
    [SCENE_GROUND] = {"ground", CLI_FLAG, offsetof(scene_setup, options.ground),                   \
                      .help = "draw a grey, matte ground under the balls, with their shadows"}
/// Return the word of --diffuse or --sun with this index, or NULL after the last word.
const char *scene_diffuse_word(int index);
const char *scene_sun_word(int index);

/// Reads the value of --size, "WIDTHxHEIGHT" in pixels; 1280 and 720 if it is NULL. Returns CLI_GO
/// or an exit code.
int scene_read_size(const cli_command *command, const char *size, int *width, int *height);
/// Converts and checks the shared options after cli_read_arguments. `may_change`: the user can
/// change the scene later, so an environment is accepted for a scene that uses none. Returns CLI_GO
/// or an exit code.
int scene_read(const cli_arguments *a, bool may_change, scene_setup *s);
/// Returns whether the scene needs an environment.
bool scene_has_environment(const scene_setup *s);
/// Loads the environment or computes a sky, and moves the lights that --sun extract asks for from
/// `source` to s->taken. Returns CLI_GO or CLI_FAILED.
int scene_load(cli_work *work, scene_setup *s, kiln_map *source);
/// Number of samples for each texel of the importance-sampled bake in VIEW_SLOT_TEXTBOOK.
enum { SCENE_TEXTBOOK_SAMPLES = 1024 };
/// Bakes the environment and sets it and the lights in the renderer. scene_bake_slot sets one slot,
/// exactly if `samples` is 0; scene_bake sets every slot that the scene needs. Both return CLI_GO
/// or CLI_FAILED.
int scene_bake_slot(cli_work *work, const scene_setup *s, const kiln_map *source, view_slot slot,
                    int samples, view_renderer *renderer);
int scene_bake(cli_work *work, const scene_setup *s, const kiln_map *source,
               view_renderer *renderer);

#endif
