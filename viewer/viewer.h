// The real-time renderer: rows of balls under a light or in a baked environment, on OpenGL ES 3.0,
// which is WebGL 2. The renderer draws into whatever context is current; headless.h and window.h
// make contexts. It sees libkiln's public header only.
//
// One source serves the command, the window and the page, so the three show the same picture.
// Lengths are those of the assignment's scene: balls of radius 36 at a spacing of 80.
#ifndef KILN_VIEWER_H
#define KILN_VIEWER_H

#include <kiln/brdf.h>

// ----------------------------------------------------------------------------------------- options

typedef enum view_scene {
    VIEW_SCENE_ASSIGNMENT, ///< two rows of five copper balls under one directional light
    VIEW_SCENE_IBL,        ///< the same rows in the environment
    VIEW_SCENE_FURNACE,    ///< the same rows, reflecting everything, in uniform white
    VIEW_SCENE_GRID,       ///< roughness from left to right by metallic from bottom to top
    VIEW_SCENE_COMPARE, ///< ibl with the exact bake left of the handle, the textbook's right of it
    VIEW_SCENE_COUNT
} view_scene;

/// What makes up for the light that bounces more than once between microfacets.
typedef enum view_method {
    VIEW_METHOD_SINGLE,              ///< nothing: one bounce
    VIEW_METHOD_KULLA_CONTY,         ///< Kulla and Conty 2017, bounces summed from the second on
    VIEW_METHOD_KULLA_CONTY_HANDOUT, ///< F E / (1 - F (1 - E)) as the assignment prints it
    VIEW_METHOD_FDEZ_AGUERA,         ///< Fdez-Aguera 2019
    VIEW_METHOD_TURQUIN,             ///< Turquin 2019
    VIEW_METHOD_COUNT
} view_method;

typedef enum view_material {
    VIEW_MATERIAL_GOLD,
    VIEW_MATERIAL_COPPER,
    VIEW_MATERIAL_ALUMINIUM,
    VIEW_MATERIAL_SILVER,
    VIEW_MATERIAL_IRON,
    VIEW_MATERIAL_TITANIUM,
    VIEW_MATERIAL_WHITE,   ///< reflects everything: F0 = 1
    VIEW_MATERIAL_HANDOUT, ///< the assignment's copper
    VIEW_MATERIAL_PLASTIC, ///< a dielectric of index 1.5, red underneath
    VIEW_MATERIAL_CHALK,   ///< the same, white underneath
    VIEW_MATERIAL_COUNT,
    VIEW_METAL_COUNT = VIEW_MATERIAL_WHITE ///< those from measured indices of refraction
} view_material;

/// What is shown instead of the picture.
typedef enum view_debug {
    VIEW_DEBUG_NONE,
    VIEW_DEBUG_LEVEL,           ///< a level of the environment, unrolled as a panorama
    VIEW_DEBUG_TABLE_E,         ///< the tables, n.v to the right, roughness upwards
    VIEW_DEBUG_TABLE_E_AVERAGE, ///<
    VIEW_DEBUG_TABLE_SPLIT,     ///< A in red, B in green
    VIEW_DEBUG_E,               ///< E(n.v, roughness) on the balls
    VIEW_DEBUG_F,               ///< Fresnel's reflectance at n.v on the balls
    VIEW_DEBUG_COUNT
} view_debug;

/// Turns about `target`. Azimuth 0 looks along -Z; degrees.
typedef struct view_camera {
    double target[3];
    double azimuth, elevation, distance;
    double fov; ///< vertical
} view_camera;

/// One view: everything that the picture depends on, besides environment and tables. Start from
/// view_defaults.
typedef struct view_options {
    view_scene scene;
    view_method method;     ///< of the upper row; the lower one is always single. All of the grid
    view_material material; ///< not of the assignment's and the furnace's balls
    view_camera camera;
    double rotation; ///< of the environment about +Y in degrees, as kiln_map_convert turns it
    double exposure; ///< stops
    view_debug debug;
    int debug_level;   ///< 0 to level_count - 1
    double split;      ///< where the handle of compare is, 0 at the left to 1
    double background; ///< roughness at which the environment is seen behind the balls, 0 to 1
    int samples;       ///< n x n rays a pixel on a regular grid, 1 to 8; their mean is tone-mapped
    bool as_printed;   ///< assignment: the handout's figure 6 with its mistake
    bool one_row;      ///< without the upper row, as the handout's figure 5
    bool occlusion;    ///< balls shade one another's ambient light
    bool bent;         ///< rough balls look the environment up nearer to their normal
    bool cube_diffuse; ///< diffuse light from the irradiance cube, else from spherical harmonics
} view_options;

/// The scene as it is meant to be seen.
view_options view_defaults(view_scene scene);

/// Words for command lines and addresses: "assignment", "kulla-conty", "gold", "level", ... NULL
/// beyond the last.
const char *view_scene_name(int scene);
const char *view_method_name(int method);
const char *view_material_name(int material);
const char *view_debug_name(int debug);

// ------------------------------------------------------------------------------------------- scene

enum { VIEW_MAX_BALLS = 64 };

typedef struct view_ball {
    double centre[3], radius;
    double roughness, metallic;
    double f0[3];        ///< specular at normal incidence
    double f82[3];       ///< at 82 degrees, as kiln_fresnel_f82 has it
    double f_average[3]; ///< 2 int F(mu) mu dmu
    double albedo[3];    ///< of the diffuse base; 0 for metals
    view_method method;
    bool measured; ///< the metal's own F, to the share `metallic`
} view_ball;

/// The balls of a view; returns how many.
int view_balls(const view_options *options, view_ball balls[VIEW_MAX_BALLS]);
/// Position of the camera and its axes: right, up, backwards. Unit and orthogonal.
void view_camera_axes(const view_camera *camera, double eye[3], double right[3], double up[3],
                      double back[3]);

/// Radiance, exposed, to what a screen shows, 0 to 1, as shaders/tone.glsl does it. The two may be
/// the same.
void view_tone(view_scene scene, const double radiance[3], double shown[3]);

// ------------------------------------------------------------------------------------- environment

/// Bakes what the shaders read of any map: GGX levels in a cube, the last of 8 texels, a cube of
/// irradiance, and harmonics. A cube with levels is taken as baked already. With `samples` above 0 the
/// levels are the textbook's, of so many samples a texel (it has 1024). `size` 16 to 2048, 0 for 256.
KILN_CHECKED kiln_result view_bake(kiln_context *context, const kiln_map *source, int size,
                                   int samples, kiln_environment *environment, kiln_error *error);

// ---------------------------------------------------------------------------------------- renderer

typedef struct view_renderer view_renderer;

/// Looks a GL function up by its name: eglGetProcAddress or glfwGetProcAddress.
typedef void (*view_function)(void);
typedef view_function view_lookup(const char *name);

/// Compiles the shaders in the current GL ES 3.0 context and makes exact tables. `lookup` is ignored
/// under emscripten. `context` must outlive the renderer.
KILN_CHECKED kiln_result view_create(kiln_context *context, view_lookup *lookup,
                                     view_renderer **renderer, kiln_error *error);
/// May be NULL. The GL context must be current.
void view_destroy(view_renderer *renderer);
/// The GL's own name: "llvmpipe (LLVM 15.0.6, 256 bits)".
const char *view_gl_name(const view_renderer *renderer);

typedef enum view_slot {
    VIEW_SLOT_EXACT,
    VIEW_SLOT_TEXTBOOK, ///< right of compare's handle
    VIEW_SLOT_COUNT
} view_slot;

/// An environment as kiln makes it: GGX levels in a cube with roughness[] rising from 0, harmonics of
/// the radiance with 3 bands or more, and a cube of irradiance / pi, which may be NULL.
KILN_CHECKED kiln_result view_set_environment(view_renderer *renderer, view_slot slot,
                                              const kiln_map *levels, const kiln_sh *sh,
                                              const kiln_map *irradiance, kiln_error *error);

/// Replaces the renderer's own tables of one model: the assignment's where the model's G is one of
/// Schlick's, else the environment's. E and E_avg may store the complement; any size, axis and places
/// of texels. Each may be NULL to keep what is there.
KILN_CHECKED kiln_result view_set_tables(view_renderer *renderer, const kiln_table *e,
                                         const kiln_table *e_average, const kiln_table *split,
                                         kiln_error *error);

/// Draws into the framebuffer that is bound, tone-mapped for an 8-bit sRGB screen.
void view_draw(view_renderer *renderer, const view_options *options, int width, int height);

/// Draws into a picture of three channels, row 0 at the top: linear light, or tone-mapped values
/// from 0 to 1.
KILN_CHECKED kiln_result view_picture(view_renderer *renderer, const view_options *options,
                                      int width, int height, bool linear, kiln_image *image,
                                      kiln_error *error);

/// How far the furnace is from vanishing: the largest and the RMS difference from 1 over the balls
/// that are compensated, silhouettes included.
KILN_CHECKED kiln_result view_furnace_residual(view_renderer *renderer, const view_options *options,
                                               int width, int height, double *largest, double *rms,
                                               kiln_error *error);

#endif
