// Renders rows of balls under one light or in a baked environment, on OpenGL ES 3.0 (WebGL 2).
//
// In: a view (view_options), a prefiltered environment with its harmonics, tables of the reflection
// model. Out: pixels in the bound framebuffer, or a picture of three float channels. The fragment
// shader shaders/scene.frag casts rays at the balls and shades each hit with the split sum
// (docs/theory/realtime.md). The renderer draws into the current GL context; headless.h and
// window.h create contexts. It uses libkiln's public headers only.
//
// The command, the window and the web page compile this one source, so all three show the same
// picture. Lengths are in the unit of the GAMES202 assignment's scene: balls of radius 36, 80
// apart.
#ifndef KILN_VIEWER_H
#define KILN_VIEWER_H

#include <kiln/brdf.h>

// ----------------------------------------------------------------------------------------- options

typedef enum view_scene {
    VIEW_SCENE_ASSIGNMENT, ///< two rows of five copper balls under one directional light
    VIEW_SCENE_IBL,        ///< two rows of five balls of one material, lit by the environment
    VIEW_SCENE_FURNACE, ///< two rows of five balls that reflect all light, in uniformly white light
    VIEW_SCENE_GRID,    ///< 7 x 5 balls: roughness grows to the right, metallic grows upwards
    /// VIEW_SCENE_IBL split by a vertical handle: the exact bake lights the left side, the
    /// importance-sampled bake lights the right side
    VIEW_SCENE_COMPARE,
    VIEW_SCENE_COUNT
} view_scene;

/// How the light that bounces more than once between microfacets is approximated.
typedef enum view_method {
    VIEW_METHOD_SINGLE, ///< leaves out the light of more than one bounce
    /// Kulla and Conty 2017; their Fresnel factor sums the bounces from the second one on
    VIEW_METHOD_KULLA_CONTY,
    /// Kulla and Conty 2017 with the Fresnel factor F E / (1 - F (1 - E)) of the GAMES202
    /// assignment
    VIEW_METHOD_KULLA_CONTY_HANDOUT,
    VIEW_METHOD_FDEZ_AGUERA, ///< the factors of Fdez-Aguera 2019 for image-based light
    VIEW_METHOD_TURQUIN,     ///< the factor of Turquin 2019 on the single-scattering lobe
    VIEW_METHOD_COUNT
} view_method;

typedef enum view_material {
    VIEW_MATERIAL_GOLD,
    VIEW_MATERIAL_COPPER,
    VIEW_MATERIAL_ALUMINIUM,
    VIEW_MATERIAL_SILVER,
    VIEW_MATERIAL_IRON,
    VIEW_MATERIAL_TITANIUM,
    VIEW_MATERIAL_WHITE,   ///< metal that reflects all light: F0 = 1
    VIEW_MATERIAL_HANDOUT, ///< copper with the constants of the GAMES202 assignment
    VIEW_MATERIAL_PLASTIC, ///< dielectric of index 1.5 over a red diffuse base
    VIEW_MATERIAL_CHALK,   ///< dielectric of index 1.5 over a white diffuse base
    VIEW_MATERIAL_COUNT,
    /// number of metals above, whose reflectance comes from measured indices of refraction
    VIEW_METAL_COUNT = VIEW_MATERIAL_WHITE
} view_material;

/// How the reflection of a rough surface is looked up in the prefiltered levels.
typedef enum view_reflections {
    VIEW_REFLECTIONS_STRAIGHT, ///< in the mirror direction, as the split sum of Karis 2013
    /// in a direction bent towards the normal (Lagarde and de Rousiers 2014)
    VIEW_REFLECTIONS_BENT,
    /// by one, two or three lookups and the harmonics (shaders/lobes.glsl)
    VIEW_REFLECTIONS_ONE,
    VIEW_REFLECTIONS_TWO,
    VIEW_REFLECTIONS_THREE,
    VIEW_REFLECTIONS_COUNT
} view_reflections;

/// The views that can be shown in place of the shaded balls, for debugging.
typedef enum view_debug {
    VIEW_DEBUG_NONE,
    VIEW_DEBUG_LEVEL,           ///< one mip level of the environment, unrolled as a panorama
    VIEW_DEBUG_TABLE_E,         ///< table of E: n.v grows to the right, roughness grows upwards
    VIEW_DEBUG_TABLE_E_AVERAGE, ///< table of E_avg: roughness grows upwards
    VIEW_DEBUG_TABLE_SPLIT, ///< split-sum table: A in red, B in green; axes as in the table of E
    VIEW_DEBUG_E,           ///< E(n.v, roughness) on the balls
    VIEW_DEBUG_F,           ///< Fresnel's reflectance at n.v on the balls
    VIEW_DEBUG_COUNT
} view_debug;

/// A camera that orbits `target`. Angles are in degrees; at azimuth 0 it looks along -Z.
typedef struct view_camera {
    double target[3];
    double azimuth, elevation, distance;
    double fov; ///< vertical field of view, degrees
} view_camera;

/// Everything that a picture depends on except its size, the environment and the tables. Start from
/// view_defaults.
typedef struct view_options {
    view_scene scene;
    /// compensation method of the upper row of balls, and of every ball in VIEW_SCENE_GRID; balls
    /// of the lower row always have VIEW_METHOD_SINGLE
    view_method method;
    /// material of the balls; VIEW_SCENE_ASSIGNMENT and VIEW_SCENE_FURNACE have their own
    view_material material;
    view_camera camera;
    double rotation; ///< turns the environment about +Y, in degrees, with kiln_map_convert's sign
    double exposure; ///< factor 2^exposure on the radiance before tone mapping
    view_debug debug;
    int debug_level; ///< mip level that VIEW_DEBUG_LEVEL shows, 0 to level_count - 1
    /// place of VIEW_SCENE_COMPARE's handle: 0 at the left border, 1 at the right border
    double split;
    /// blur of the environment seen behind the balls, as a roughness from 0 to 1
    double background;
    /// a pixel averages samples x samples rays on a regular grid before tone mapping; 1 to 8
    int samples;
    /// VIEW_SCENE_ASSIGNMENT: repeats the GAMES202 handout's figure 6, which uses the albedo as
    /// E_avg
    bool as_printed;
    bool one_row;   ///< leaves the upper row of balls out, as in the GAMES202 handout's figure 5
    bool occlusion; ///< true: balls block the environment's light from one another
    view_reflections reflections; ///< how the reflections of rough balls are looked up
    int lobes_size; ///< width and height in texels of the tables of lobes; 0 for 32, else 2 to 64
    /// diffuse light comes from the irradiance cube instead of the spherical harmonics
    bool cube_diffuse;
    /// true: a matte ground lies under the balls of scenes with an environment (view_ground)
    bool ground;
} view_options;

/// Returns the camera, method, material and settings that suit the scene.
view_options view_defaults(view_scene scene);

/// Return names for command lines and addresses, such as "assignment", "kulla-conty", "gold" and
/// "level", or NULL for an index beyond the last name.
const char *view_scene_name(int scene);
const char *view_method_name(int method);
const char *view_material_name(int material);
const char *view_debug_name(int debug);
const char *view_reflections_name(int reflections);

// ------------------------------------------------------------------------------------------- scene

enum { VIEW_MAX_BALLS = 64 };

typedef struct view_ball {
    double centre[3], radius;
    double roughness, metallic;
    double f0[3];        ///< reflectance at normal incidence
    double f82[3];       ///< reflectance at about 82 degrees (cosine 1/7), see kiln_fresnel_f82
    double f_average[3]; ///< cosine-weighted mean reflectance, 2 int F(mu) mu dmu
    double albedo[3];    ///< albedo of the diffuse base; 0 for metals
    view_method method;
    /// true: the share `metallic` of the Fresnel reflectance comes from the metal's measured
    /// indices of refraction
    bool measured;
} view_ball;

/// Fills `balls` with the balls of the view, and returns their number.
int view_balls(const view_options *options, view_ball balls[VIEW_MAX_BALLS]);

/// A horizontal, matte, infinite plane. Balls shade the plane; the plane neither lights the balls
/// nor hides light from them.
typedef struct view_plane {
    double height; ///< y of the plane, at which the lowest balls touch the plane
    double albedo;
} view_plane;

/// Sets the ground of the view. Returns whether the view shows the ground.
bool view_ground(const view_options *options, view_plane *ground);

/// A light as a disc: a spherical cap of uniform radiance.
typedef struct view_disc {
    double direction[3]; ///< unit vector to the centre, in the scene
    double sine, cosine; ///< of the angular radius
    double radiance[3];
} view_disc;

/// Turns lights by the view's rotation, and returns the number of discs, which is 0 for scenes
/// without an environment and where `lights` is NULL. Angular radii below 0.01 degrees and above 60
/// degrees are set to these values; the irradiance stays.
int view_discs(const view_options *options, const kiln_lights *lights,
               view_disc discs[KILN_MAX_LIGHTS]);

/// Sets the world position of the camera, `eye`, and the camera's axes right, up and backwards. The
/// axes are orthogonal unit vectors.
void view_camera_axes(const view_camera *camera, double eye[3], double right[3], double up[3],
                      double back[3]);

/// Maps exposed linear radiance to the screen's values, 0 to 1, with the curve of
/// shaders/tone.glsl. `radiance` and `shown` may be the same array.
void view_tone(view_scene scene, const double radiance[3], double shown[3]);

// ------------------------------------------------------------------------------------- environment

/// Bakes the textures that the shaders read: GGX levels in a cube (the smallest has at least 8
/// texels a side), an irradiance cube, and spherical harmonics. A cube `source` with more than one
/// level counts as baked, and its levels are copied. With `samples` above 0 the levels come from
/// kiln_textbook_prefilter with that many samples a texel (1024 is common). `size` is the edge of
/// level 0: 16 to 2048, or 0 for 256.
KILN_CHECKED kiln_result view_bake(kiln_context *context, const kiln_map *source, int size,
                                   int samples, kiln_environment *environment, kiln_error *error);

// ---------------------------------------------------------------------------------------- renderer

typedef struct view_renderer view_renderer;

/// A function that finds a GL function by its name, such as eglGetProcAddress or
/// glfwGetProcAddress.
typedef void (*view_function)(void);
typedef view_function view_lookup(const char *name);

/// Compiles the shaders in the current GL ES 3.0 context and computes exact tables. `lookup` is
/// ignored under emscripten. `context` must outlive the renderer.
KILN_CHECKED kiln_result view_create(kiln_context *context, view_lookup *lookup,
                                     view_renderer **renderer, kiln_error *error);
/// Destroys a renderer, whose GL context must be current. `renderer` may be NULL.
void view_destroy(view_renderer *renderer);
/// Returns the GL_RENDERER string of the driver, such as "llvmpipe (LLVM 15.0.6, 256 bits)".
const char *view_gl_name(const view_renderer *renderer);

typedef enum view_slot {
    VIEW_SLOT_EXACT,
    /// importance-sampled environment, shown right of VIEW_SCENE_COMPARE's handle
    VIEW_SLOT_TEXTBOOK,
    VIEW_SLOT_COUNT
} view_slot;

/// Uploads an environment into a slot. `levels`: a cube of GGX levels with roughness[] rising from
/// 0. `sh`: spherical harmonics of the radiance with 3 bands or more. `irradiance`: a cube of
/// irradiance / pi; NULL keeps the irradiance cube that the slot has.
KILN_CHECKED kiln_result view_set_environment(view_renderer *renderer, view_slot slot,
                                              const kiln_map *levels, const kiln_sh *sh,
                                              const kiln_map *irradiance, kiln_error *error);

/// Sets the lights that scenes with an environment show as discs, beside the environment in both
/// slots. The lights are in the environment's frame, as from kiln_lights_extract. NULL for none.
void view_set_lights(view_renderer *renderer, const kiln_lights *lights);

/// Replaces the renderer's own tables of one model. A model whose G is one of Schlick's replaces
/// the tables of VIEW_SCENE_ASSIGNMENT, any other model those of the environment scenes. E and
/// E_avg may store the complement. A table may have any size, axis and placement of texels. NULL
/// keeps the present table.
KILN_CHECKED kiln_result view_set_tables(view_renderer *renderer, const kiln_table *e,
                                         const kiln_table *e_average, const kiln_table *split,
                                         kiln_error *error);

/// Computes and uploads the tables that the view needs and that the renderer does not hold yet.
/// These are the tables of KILN_TABLE_LOBES for VIEW_REFLECTIONS_ONE to VIEW_REFLECTIONS_THREE,
/// which suit the levels of the environments that are set and take about a second. Call this before
/// view_draw; view_picture calls it by itself.
KILN_CHECKED kiln_result view_prepare(view_renderer *renderer, const view_options *options,
                                      kiln_error *error);
/// Draws into the framebuffer that is bound, tone-mapped for an 8-bit sRGB screen.
void view_draw(view_renderer *renderer, const view_options *options, int width, int height);

/// Draws into a new picture of three channels, row 0 at the top. `linear`: linear radiance; else
/// tone-mapped values from 0 to 1.
KILN_CHECKED kiln_result view_picture(view_renderer *renderer, const view_options *options,
                                      int width, int height, bool linear, kiln_image *image,
                                      kiln_error *error);

/// Renders VIEW_SCENE_FURNACE, where a lossless ball is invisible, and returns the
/// largest difference from 1 in the row of balls with compensation, silhouettes included, and the
/// RMS of the differences that are not 0.
KILN_CHECKED kiln_result view_furnace_residual(view_renderer *renderer, const view_options *options,
                                               int width, int height, double *largest, double *rms,
                                               kiln_error *error);

#endif
