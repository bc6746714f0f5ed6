// kiln: exact image-based lighting. A panorama goes in, prefiltered radiance comes out.
//
// Read from top to bottom this header follows the light,
//   context -> maps -> load -> sky -> lobe -> spectrum -> prefilter -> spherical harmonics,
// then brute force that results are compared with, files written, and what engines read of them.
// What a surface does to the light is in <kiln/brdf.h>: reflection models, tables and closed forms
// of them. The methods that courses teach are in <kiln/course.h>.
//
// Conventions, the same in every function and every file written (docs/conventions.md):
//   - linear Rec. 709 radiance in the input's own unit, 32-bit float, three channels;
//   - right-handed, +Y up; a panorama's centre column looks along -Z, +X to its right, row 0 is +Y;
//   - cube faces +X -X +Y -Y +Z -Z as OpenGL and KTX order and orient them: texel (x, y) of face f
//     is the radiance that arrives from the direction that texture(cube, direction) reads there;
//   - texel centres at (i + 0.5) / n; roughness is perceptual, alpha = roughness^2.
//
// Functions that can fail return a kiln_result and, where `error` is not NULL, a sentence with the
// numbers in it. Outputs are zeroed on failure. No function keeps a pointer to its arguments after
// it returns, except kiln_context_create (callbacks) and kiln_lobe_custom (function and user data).
//
// One context may be used by one thread at a time; different contexts are independent.
// SPDX-License-Identifier: MIT
#ifndef KILN_H
#define KILN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define KILN_VERSION_MAJOR 0
#define KILN_VERSION_MINOR 2
#define KILN_VERSION_PATCH 0

#if defined(_WIN32) && defined(KILN_SHARED)
#if defined(KILN_BUILD)
#define KILN_API __declspec(dllexport)
#else
#define KILN_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define KILN_API __attribute__((visibility("default")))
#else
#define KILN_API
#endif

#if defined(__GNUC__)
#define KILN_CHECKED __attribute__((warn_unused_result))
#else
#define KILN_CHECKED
#endif

#ifdef __cplusplus
extern "C" {
#endif

// ---------------------------------------------------------------------------------------- results

typedef enum kiln_result {
    KILN_OK = 0,
    KILN_ERROR_ARGUMENT,    ///< a value passed in is outside its range
    KILN_ERROR_MEMORY,      ///< the allocator refused, or the context's limit is reached
    KILN_ERROR_IO,          ///< a file cannot be opened, read, written or renamed
    KILN_ERROR_FORMAT,      ///< a file's content is damaged or not what its name says
    KILN_ERROR_UNSUPPORTED, ///< valid, but not something kiln reads or writes
    KILN_ERROR_CANCELLED,   ///< the progress callback returned false
} kiln_result;

/// Filled by a function that fails: what happened, in one sentence with the numbers in it.
typedef struct kiln_error {
    kiln_result result;
    char message[512];
} kiln_error;

/// The version of the library that is running, "0.2.0".
KILN_API const char *kiln_version(void);

// ---------------------------------------------------------------------------------------- context

typedef struct kiln_context kiln_context;

typedef enum kiln_cpu {
    KILN_CPU_BEST = 0,
    KILN_CPU_SCALAR,
    KILN_CPU_SSE2, ///< vectors of 128 bits: SSE2, on ARM NEON, in WebAssembly simd128
    KILN_CPU_AVX2,
    KILN_CPU_AVX512
} kiln_cpu;

/// {0} is a good default: malloc, no limit, one thread a core, no progress, every instruction set.
typedef struct kiln_context_def {
    /// Returns `size` bytes aligned to 64, or NULL. May be NULL; then `release` must be too.
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory, size_t size);
    void *allocator_user;
    size_t memory_limit; ///< bytes held at once; 0 for none
    int thread_count;    ///< 1 to 256; 0 for one a core
    /// Runs task(data, 0 .. count-1) in any order on any threads and returns when all are done.
    /// May be NULL: then the context has threads of its own.
    void (*parallel_for)(void *user, int count, void (*task)(void *data, int index), void *data);
    void *parallel_user;
    /// Called now and then from the calling thread with 0 <= fraction <= 1. Returning false cancels.
    bool (*progress)(void *user, const char *stage, double fraction);
    void *progress_user;
    /// Highest instruction set to use. Results are the same bits for each; for tests and benches.
    kiln_cpu cpu;
} kiln_context_def;

/// `def` may be NULL for the defaults.
KILN_API KILN_CHECKED kiln_result kiln_context_create(const kiln_context_def *def,
                                                      kiln_context **context, kiln_error *error);
/// `context` may be NULL. What was made with it may be freed or destroyed later, which calls `release`
/// then; nothing else may be done with plans, spectra and streams of a context that is gone.
KILN_API void kiln_context_destroy(kiln_context *context);

/// The instruction set in use: "scalar", "sse2", "avx2", "avx512", "neon" or "simd128".
KILN_API const char *kiln_context_cpu(const kiln_context *context);

/// Bytes held by the context's objects now, and the most that were held at once.
KILN_API void kiln_context_memory(const kiln_context *context, size_t *current, size_t *peak);

// ------------------------------------------------------------------------- pictures of all directions

enum { KILN_MAX_LEVELS = 16, KILN_MAX_SIZE = 32768, KILN_MAX_BANDS = 5 };

typedef enum kiln_shape {
    KILN_SHAPE_AUTO = 0,   ///< in options only, which say what it stands for; no map has it
    KILN_SHAPE_PANORAMA,   ///< equirectangular, size rows of 2 * size texels
    KILN_SHAPE_CUBE,       ///< six faces of size * size texels, +X -X +Y -Y +Z -Z
    KILN_SHAPE_OCTAHEDRON, ///< size * size texels, +Y in the centre, -Y in the corners
} kiln_shape;

/// Radiance by direction: RGB floats, row-major, face after face, level after level. Level k has
/// the size max(1, smallest, size >> k). Made by kiln_map_create or a function that says so, released by
/// kiln_map_free; the numbers may be read and written freely.
///
/// The levels may also lie in the caller's own memory: set shape, size, level_count and level[], leave
/// the rest 0, and every function takes such a map, to read from and to write to. kiln_map_free then
/// frees nothing. Values must be radiance, finite and not negative: kiln_map_from_pixels sees to it.
typedef struct kiln_map {
    kiln_shape shape;
    int size;                         ///< of level 0: 1 to KILN_MAX_SIZE
    int level_count;                  ///< 1 to KILN_MAX_LEVELS
    int smallest;                     ///< size below which no level goes; 0 or 1 for none
    float *level[KILN_MAX_LEVELS];    ///< kiln_map_texels(map, k) * 3 floats each
    float roughness[KILN_MAX_LEVELS]; ///< what each level was filtered for, 0 to 1
    void *owner;                      ///< kiln's own
} kiln_map;

/// A flat picture: tables, and files before their shape is known. 1 to 4 channels, row-major.
typedef struct kiln_image {
    int width, height, channels;
    float *pixels;
    void *owner; ///< kiln's own
} kiln_image;

/// All texels 0. `level_count` 0 means a full chain down to 1.
KILN_API KILN_CHECKED kiln_result kiln_map_create(kiln_context *context, kiln_shape shape, int size,
                                                  int level_count, kiln_map *map,
                                                  kiln_error *error);
KILN_API void kiln_map_free(kiln_map *map);
KILN_API KILN_CHECKED kiln_result kiln_image_create(kiln_context *context, int width, int height,
                                                    int channels, kiln_image *image,
                                                    kiln_error *error);
KILN_API void kiln_image_free(kiln_image *image);

/// Size of a level, in texels along its short side: max(1, smallest, size >> level).
KILN_API int kiln_map_level_size(const kiln_map *map, int level);
/// Number of texels of a level, all faces: n * n * 6, n * 2n or n * n.
KILN_API size_t kiln_map_texels(const kiln_map *map, int level);
/// Unit direction of the centre of texel `index` (row-major, face after face) of a level.
KILN_API void kiln_map_direction(const kiln_map *map, int level, size_t index, double direction[3]);

/// Swaps left and right (x becomes -x) in place, on every level.
KILN_API void kiln_map_mirror(kiln_map *map);
/// Multiplies every texel by 2^stops.
KILN_API void kiln_map_expose(kiln_map *map, double stops);

/// The map in another shape or size, each texel the mean over its solid angle of the source's
/// level 0, turned by `rotation` degrees about +Y (a panorama's content moves to the left).
/// One level.
KILN_API KILN_CHECKED kiln_result kiln_map_convert(kiln_context *context, const kiln_map *source,
                                                   kiln_shape shape, int size, double rotation,
                                                   kiln_map *map, kiln_error *error);

// ---------------------------------------------------------------------------------- files, reading

/// How a flat picture lies on the sphere. Auto: 2:1 is a panorama, 4:3 and 3:4 are crosses,
/// 6:1 and 1:6 are strips; an EXR that kiln wrote says that it is an octahedron.
typedef enum kiln_layout {
    KILN_LAYOUT_AUTO = 0,
    KILN_LAYOUT_PANORAMA,
    KILN_LAYOUT_CROSS,
    KILN_LAYOUT_STRIP,
    KILN_LAYOUT_OCTAHEDRON
} kiln_layout;

/// {0} is a good default.
typedef struct kiln_load_def {
    kiln_layout layout;
} kiln_load_def;

/// Loads EXR, Radiance HDR or PNG (sRGB, decoded to linear), KTX2 or DDS cubes that kiln wrote, or
/// six faces: a folder or a pattern with `%s` or `{face}` for px nx py ny pz nz. Not-a-number and
/// negative texels become 0, infinities the largest finite value of their file's format; `def` may
/// be NULL. Source: the content decides, never the name's ending.
KILN_API KILN_CHECKED kiln_result kiln_map_load(kiln_context *context, const char *path,
                                                const kiln_load_def *def, kiln_map *map,
                                                kiln_error *error);
/// The same from memory; `name` stands in messages.
KILN_API KILN_CHECKED kiln_result kiln_map_decode(kiln_context *context, const void *bytes,
                                                  size_t size, const char *name,
                                                  const kiln_load_def *def, kiln_map *map,
                                                  kiln_error *error);
typedef enum kiln_pixel_type {
    KILN_PIXEL_FLOAT = 0, ///< 32 bits
    KILN_PIXEL_HALF       ///< 16 bits
} kiln_pixel_type;

/// Radiance in the caller's memory: of a renderer, or read back from a graphics processor. Six faces one
/// behind the other are a strip `size` wide and 6 * size high.
typedef struct kiln_pixels {
    const void *data; ///< the first pixel of the top row, at any address
    int width, height;
    int channels;         ///< 3, or 4 of which the last is not read
    kiln_pixel_type type; ///< of a channel
    ptrdiff_t row_stride; ///< bytes from a row to the next below, negative too; 0 without gaps
    kiln_layout layout;   ///< KILN_LAYOUT_AUTO tells it by the sides' ratio, as for files
} kiln_pixels;

/// A map of pixels that are copied. Values that are no radiance become what they become when files are
/// loaded: see kiln_map_load.
KILN_API KILN_CHECKED kiln_result kiln_map_from_pixels(kiln_context *context,
                                                       const kiln_pixels *pixels, kiln_map *map,
                                                       kiln_error *error);
/// A flat picture as it is, without a shape, of three channels; a table (KTX2) of 1, 2 or 4, its
/// slices one below the other.
KILN_API KILN_CHECKED kiln_result kiln_image_load(kiln_context *context, const char *path,
                                                  kiln_image *image, kiln_error *error);

/// What a file is, without reading all of its texels. Strings end in NUL.
typedef struct kiln_file_info {
    char format[16];   ///< "exr", "hdr", "png", "ktx2", "dds", "ktx1", "env", "glb", ...
    char encoding[48]; ///< texel type and compression, "half rgb, piz"
    /// "panorama", "cross", "strip", "cube", "octahedron", "image", "table", "harmonics", or an atlas
    /// whose levels lie side by side: "cubeuv" (three.js) or "atlas" (PlayCanvas)
    char layout[24];
    int width, height; ///< of one face, of the picture or of a table's slice
    int depth;         ///< slices of a table, else 1
    int face_count, level_count;
    int channel_count;
    uint64_t byte_count;
    float roughness[KILN_MAX_LEVELS]; ///< of each level, where the file says; else -1
    char engine[24];                  ///< kiln_engine_find's name of whom the file is for, or empty
    char writer[64];                  ///< "kiln 0.2.0", or empty
    char orientation[16];             ///< as the file states it, or empty
    char table[160];                  ///< what a table that kiln wrote is: "kind=e d=ggx ..."
    int sh_bands;                     ///< 0 where the file holds no spherical harmonics
    bool sh_irradiance;               ///< what they are of: irradiance, or radiance
    /// As kiln_sh, in the file's own axes, whatever factors and signs the file keeps them with.
    float sh[KILN_MAX_BANDS * KILN_MAX_BANDS][3];
} kiln_file_info;

/// Describes every file that kiln reads, and those that it only writes: KTX 1 (Filament), .env
/// (Babylon.js), .glb with EXT_lights_image_based, atlases, spherical harmonics, and tables as code.

KILN_API KILN_CHECKED kiln_result kiln_file_describe(kiln_context *context, const char *path,
                                                     kiln_file_info *info, kiln_error *error);

// --------------------------------------------------------------------------------------------- sky

/// Says zero where an option's 0 stands for a default, as in kiln_sky_def. A computed value x is passed
/// as `x != 0 ? x : KILN_ZERO`.
#define KILN_ZERO 1e-300

/// {0} is a good default.
typedef struct kiln_sky_def {
    int size; ///< rows of the panorama, 16 to 8192; 0 for 512
    double
        elevation;  ///< of the sun, degrees above the horizon, -5 to 90; 0 for 30, KILN_ZERO for 0
    double azimuth; ///< of the sun, degrees from -Z toward +X
    double turbidity; ///< 1.7 (clear) to 10 (hazy); 0 for 3
    double albedo;    ///< of the ground, 0 to 1; 0 for 0.2, KILN_ZERO for 0
} kiln_sky_def;

/// An analytic daylight sky with a sun disc of 0.533 degrees whose irradiance is right whatever
/// the texel size, as a panorama, in kcd/m^2 by channel. Source: docs/theory/sky.md.
KILN_API KILN_CHECKED kiln_result kiln_sky(kiln_context *context, const kiln_sky_def *def,
                                           kiln_map *map, kiln_error *error);

// ------------------------------------------------------------------------------------------- lobes

typedef enum kiln_lobe_kind {
    KILN_LOBE_GGX,
    KILN_LOBE_LAMBERT,
    KILN_LOBE_CHARLIE,
    KILN_LOBE_PHONG,
    KILN_LOBE_CUSTOM
} kiln_lobe_kind;

/// A zonal kernel: the weight of light that arrives at an angle to the output direction. Its
/// scale does not matter, results are weighted means. Use the constructors below.
typedef struct kiln_lobe {
    kiln_lobe_kind kind;
    double parameter; ///< alpha, exponent, or angular width
    double (*evaluate)(void *user, double cos_theta);
    void *user;
} kiln_lobe;

/// GGX with N = V = R: D(theta/2; alpha) max(cos theta, 0). alpha in [0, 1]; 0 is a perfect mirror,
/// 1 is Lambert.
KILN_API kiln_lobe kiln_lobe_ggx(double alpha);
/// max(cos theta, 0).
KILN_API kiln_lobe kiln_lobe_lambert(void);
/// Charlie sheen (Estevez and Kulla 2017) with N = V = R: sin(theta/2)^(1/alpha) max(cos theta, 0),
/// alpha in [0.01, 1].
KILN_API kiln_lobe kiln_lobe_charlie(double alpha);
/// max(cos theta, 0)^exponent, exponent in [1, 100000].
KILN_API kiln_lobe kiln_lobe_phong(double exponent);
/// The caller's own function of cos theta in [-1, 1], finite and not negative, called from any
/// thread. `width` in (0, pi] is the angle in radians over which it changes most: it places the
/// quadrature nodes and decides how fine the spectrum must be.
KILN_API kiln_lobe kiln_lobe_custom(double (*evaluate)(void *user, double cos_theta), void *user,
                                    double width);
/// The lobe's weight at an angle, up to its scale.
KILN_API double kiln_lobe_evaluate(const kiln_lobe *lobe, double cos_theta);

// ---------------------------------------------------------------------------------------- spectrum

/// The spherical harmonics of an environment: analyse once, filter as often as wanted.
typedef struct kiln_spectrum kiln_spectrum;

enum { KILN_MAX_DEGREE = 1600 };

/// Analyses level 0 of a map. `degree` 1 to KILN_MAX_DEGREE; 0 chooses the size's own (size * 2).
/// A panorama is transformed as it is, piecewise constant; other shapes are converted to one first.
KILN_API KILN_CHECKED kiln_result kiln_spectrum_analyze(kiln_context *context, const kiln_map *map,
                                                        int degree, kiln_spectrum **spectrum,
                                                        kiln_error *error);
/// The same row by row, north to south, for panoramas that do not fit in memory. `rows` holds
/// row_count * 2 * size RGB texels. After `size` rows call finish, which takes the stream.
typedef struct kiln_stream kiln_stream;
KILN_API KILN_CHECKED kiln_result kiln_stream_begin(kiln_context *context, int size, int degree,
                                                    kiln_stream **stream, kiln_error *error);
KILN_API KILN_CHECKED kiln_result kiln_stream_rows(kiln_stream *stream, const float *rows,
                                                   int row_count, kiln_error *error);
KILN_API KILN_CHECKED kiln_result kiln_stream_finish(kiln_stream *stream, kiln_spectrum **spectrum,
                                                     kiln_error *error);
/// Gives a stream up unfinished. May be NULL.
KILN_API void kiln_stream_cancel(kiln_stream *stream);
KILN_API void kiln_spectrum_destroy(kiln_spectrum *spectrum);

KILN_API int kiln_spectrum_degree(const kiln_spectrum *spectrum);
/// Sum over m of |a_lm|^2 of the three channels, for degrees 0 to degree: degree + 1 numbers each.
KILN_API KILN_CHECKED kiln_result kiln_spectrum_power(const kiln_spectrum *spectrum,
                                                      double (*power)[3], kiln_error *error);

/// One level: the environment seen through a lobe, turned by `rotation` degrees about +Y. Writes
/// level `level` of `map`. Fails where the lobe is narrower than the spectrum can tell
/// (kiln_prefilter handles those too, from the panorama itself).
KILN_API KILN_CHECKED kiln_result kiln_spectrum_filter(kiln_context *context,
                                                       const kiln_spectrum *spectrum,
                                                       const kiln_lobe *lobe, double rotation,
                                                       kiln_map *map, int level, kiln_error *error);

// --------------------------------------------------------------------------------------- prefilter

typedef struct kiln_engine kiln_engine; // below, among the files

/// {0} is a good default: a cube of 256, full chain, GGX, roughness from 0 to 1 in equal steps.
typedef struct kiln_prefilter_def {
    kiln_shape shape;       ///< KILN_SHAPE_AUTO for a cube
    int size;               ///< 1 to KILN_MAX_SIZE; 0 for 256
    int level_count;        ///< 1 to KILN_MAX_LEVELS; 0 for all down to 1
    int smallest;           ///< of the map: only with it may there be more levels than down to 1
    kiln_lobe_kind lobe;    ///< GGX (alpha = roughness^2), Lambert, Charlie (the same alpha,
                            ///< 0.01 at least) or Phong (exponent 2 / alpha^2 - 2, 1 at least)
    const float *roughness; ///< level_count numbers in [0, 1]; NULL for level / (level_count - 1),
                            ///< or 1 for Lambert, which has none
    double rotation;        ///< degrees about +Y
    /// Where the spectrum is cut: the relative L2 error that a lone bright point would have, were it
    /// not summed exactly. 1e-6 to 0.01; 0 for 1.5e-4. Real environments err by a hundredth of it.
    double tolerance;
    /// Tunes levels for what this engine shows of them (kiln_engine_levels has its sizes). An engine mixes
    /// two levels linearly and reads texels bilinearly; tuned levels show the least relative error over
    /// roughness .05 to 1 in this environment, near suns and away from them. Level 0 stays the mirror,
    /// white stays white, nothing is negative. NULL: exact levels. Source:
    /// docs/theory/tuning.md.
    const kiln_engine *tune_for;
    /// With tune_for: level 0 may be softer than the mirror, where that shows less error.
    bool tune_soft;
} kiln_prefilter_def;

/// Every level from one analysis. Roughness 0 with GGX is the mirror: true area weights. `def` may
/// be NULL. `source` is any map; its level 0 is used.
KILN_API KILN_CHECKED kiln_result kiln_prefilter(kiln_context *context, const kiln_map *source,
                                                 const kiln_prefilter_def *def, kiln_map *map,
                                                 kiln_error *error);

// ------------------------------------------------------------------------------ spherical harmonics

/// Real, orthonormal, no Condon-Shortley sign, z the polar axis of the formulas but the directions
/// are the world's (y up): 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2, ... in order l(l+1)+m.
typedef struct kiln_sh {
    int bands;       ///< 1 to KILN_MAX_BANDS
    bool irradiance; ///< times the cosine lobe's pi, 2 pi/3, pi/4, 0, -pi/24 by band
    double window;   ///< width of the deringing window, 0 for none
    double c[KILN_MAX_BANDS * KILN_MAX_BANDS][3];
} kiln_sh;

/// `window` > 0 multiplies band l by the Hanning window (1 + cos(pi l / window)) / 2 (Sloan 2008).
/// `rotation` in degrees about +Y.
KILN_API KILN_CHECKED kiln_result kiln_spectrum_sh(const kiln_spectrum *spectrum, int bands,
                                                   bool irradiance, double window, double rotation,
                                                   kiln_sh *sh, kiln_error *error);
/// The same of a map: its level 0 is analysed just as far as five bands need, which takes a few
/// milliseconds. Harmonics of radiance, without a window: kiln_sh_filter makes others of them.
KILN_API KILN_CHECKED kiln_result kiln_map_sh(kiln_context *context, const kiln_map *map, int bands,
                                              double rotation, kiln_sh *sh, kiln_error *error);
/// The first `bands` bands of harmonics of radiance, as irradiance or with a window as
/// kiln_spectrum_sh makes them, to the same bits. `radiance` has no window and at least as many bands;
/// the two may be the same.
KILN_API KILN_CHECKED kiln_result kiln_sh_filter(const kiln_sh *radiance, int bands,
                                                 bool irradiance, double window, kiln_sh *sh,
                                                 kiln_error *error);
/// The value of the series in a unit direction; may be negative.
KILN_API void kiln_sh_evaluate(const kiln_sh *sh, const double direction[3], double value[3]);

// ----------------------------------------------------------------------------------- environments

/// What a scene is lit by, all made from one source. Made by kiln_bake or kiln_plan_environment,
/// released by kiln_environment_free. Who fills one in with maps of their own may save it all the same.
typedef struct kiln_environment {
    kiln_map levels;     ///< radiance through the lobe, each level for its roughness[]
    kiln_map irradiance; ///< irradiance / pi, one level; empty ({0}) where none was asked for
    kiln_sh sh;          ///< of the radiance, without a window; kiln_sh_filter makes others
    kiln_lobe_kind lobe; ///< of the levels
    int degree;          ///< of the spectrum that the levels were made from; 0 where they were not
} kiln_environment;

enum { KILN_NO_IRRADIANCE = -1 };

/// Whether levels are tuned for the engine that reads them: see kiln_prefilter_def.
typedef enum kiln_tune {
    KILN_TUNE_AUTO = 0, ///< sharp where the engine was measured to show less error so, else none
    KILN_TUNE_NONE,     ///< exact levels
    KILN_TUNE_SHARP,    ///< level 0 stays the mirror
    KILN_TUNE_SOFT      ///< level 0 may be softer
} kiln_tune;

/// {0} is a good default: what kiln_prefilter makes by default, irradiance of 64 and three bands.
typedef struct kiln_bake_def {
    kiln_prefilter_def levels; ///< `rotation` turns irradiance and harmonics too, after the mirror
    /// Whose levels to make; may be NULL. The engine decides lobe, roughness, smallest and tuning of
    /// `levels`, which stay 0 there, and size and level_count where these are 0.
    const kiln_engine *engine;
    kiln_tune tune;      ///< with an engine only
    bool mirror;         ///< swaps left and right of the source
    double exposure;     ///< multiplies the source by 2^exposure: -600 to 600
    int irradiance_size; ///< 1 to KILN_MAX_SIZE; 0 for 64, KILN_NO_IRRADIANCE for none
    int sh_bands;        ///< 1 to KILN_MAX_BANDS; 0 for 3
} kiln_bake_def;

/// Bakes a source of any shape, of which level 0 is used: mirrored, exposed, turned, then analysed and
/// filtered. `def` may be NULL. The irradiance has the shape of the levels.
KILN_API KILN_CHECKED kiln_result kiln_bake(kiln_context *context, const kiln_map *source,
                                            const kiln_bake_def *def, kiln_environment *environment,
                                            kiln_error *error);
/// May be NULL.
KILN_API void kiln_environment_free(kiln_environment *environment);

/// The same sizes many times: what depends on them only is computed once, and the memory that a bake
/// needs is allocated once.
typedef struct kiln_plan kiln_plan;

/// For panoramas of `source_size` rows or cubes of `source_size` texels along a face (octahedra too).
/// `def` may be NULL. The plan keeps the context: destroy the plan first.
KILN_API KILN_CHECKED kiln_result kiln_plan_create(kiln_context *context, kiln_shape source_shape,
                                                   int source_size, const kiln_bake_def *def,
                                                   kiln_plan **plan, kiln_error *error);
/// An empty environment of the plan's shapes, sizes, levels and roughness.
KILN_API KILN_CHECKED kiln_result kiln_plan_environment(const kiln_plan *plan,
                                                        kiln_environment *environment,
                                                        kiln_error *error);
/// Bakes into maps that are there: made by kiln_plan_environment, or of the same shape, size and
/// levels. The result is kiln_bake's, to the same bits. Where it fails the maps hold anything.
KILN_API KILN_CHECKED kiln_result kiln_plan_execute(kiln_plan *plan, const kiln_map *source,
                                                    kiln_environment *environment,
                                                    kiln_error *error);
/// The spectrum that the last execution's levels were made from; the plan's own, valid until the next.
KILN_API const kiln_spectrum *kiln_plan_spectrum(const kiln_plan *plan);
/// May be NULL.
KILN_API void kiln_plan_destroy(kiln_plan *plan);

// --------------------------------------------------------------------------------------- reference

/// Brute force: the sum over every texel of a panorama in double precision, the lobe integrated over
/// each texel by as many nodes as it needs there, to 1e-6 of the result. Slow; for tests, benches
/// and error maps. Directions are unit (to 0.001); `values` receives count * 3.
KILN_API KILN_CHECKED kiln_result kiln_reference_filter(kiln_context *context,
                                                        const kiln_map *panorama,
                                                        const kiln_lobe *lobe, double rotation,
                                                        const double (*directions)[3], int count,
                                                        double (*values)[3], kiln_error *error);

// ---------------------------------------------------------------------------------- files, writing

typedef enum kiln_format {
    KILN_FORMAT_AUTO = 0, ///< rgba16f for KTX2 and DDS, half for EXR, 8 bits for PNG
    KILN_FORMAT_RGBA16F,
    KILN_FORMAT_RGBA32F,
    KILN_FORMAT_RGB9E5,
    KILN_FORMAT_B10G11R11,
    KILN_FORMAT_BC6H, ///< unsigned, 4 x 4 texels in 16 bytes, KTX2 and DDS only
    KILN_FORMAT_RGBM, ///< these three for PNG: four bytes, docs/conventions.md has their formulas
    KILN_FORMAT_RGBD,
    KILN_FORMAT_RGBP
} kiln_format;
/// "auto", "rgba16f", ...: in the order of the enum, NULL behind the last.
KILN_API const char *const *kiln_format_names(void);
/// The largest radiance that a format holds; more is cut off. 0 where floats hold all.
KILN_API double kiln_format_limit(kiln_format format);

/// {0} is a good default.
typedef struct kiln_save_def {
    kiln_format format;
    int zstd;          ///< KTX2: compression level 1 to 22, 0 for none
    const kiln_sh *sh; ///< stored in the file's metadata where it has any; may be NULL
    const char *lobe;  ///< name stored in the metadata; may be NULL
} kiln_save_def;

/// A path's ending as kiln's formats have it, in small letters whatever the path has, with its dot:
/// ".ktx2". "/" where the path ends in a slash, "" where kiln has no such ending.
KILN_API const char *kiln_path_ending(const char *path);
/// Fails, as kiln_map_save would, where a map of this shape cannot be saved to such a path so. `def` may
/// be NULL.
KILN_API KILN_CHECKED kiln_result kiln_map_save_check(const char *path, kiln_shape shape,
                                                      const kiln_save_def *def, kiln_error *error);
/// The largest radiance that such a file holds in a format; more is cut off. 0 where floats hold all.
KILN_API double kiln_map_save_limit(const char *path, kiln_format format);

/// Bytes of a level in a format without gaps, faces one behind the other; 0 where kiln_map_pack fails.
KILN_API size_t kiln_map_packed_size(const kiln_map *map, int level, kiln_format format);
/// Packs a level as a graphics processor reads it: rgba16f (also for KILN_FORMAT_AUTO), rgba32f, rgb9e5,
/// b10g11r11, or blocks of bc6h; faces one behind the other, every row (of blocks) `row_stride` bytes
/// behind the last, 0 for no gaps. What is above kiln_format_limit is cut off to it. Fails where
/// `destination_size` does not suffice.
KILN_API KILN_CHECKED kiln_result kiln_map_pack(kiln_context *context, const kiln_map *map,
                                                int level, kiln_format format, void *destination,
                                                size_t row_stride, size_t destination_size,
                                                kiln_error *error);

/// What saving a map did.
typedef struct kiln_save_report {
    int file_count;
    double limit;       ///< the largest radiance that these files hold; 0 where floats hold all
    size_t value_count; ///< three a texel, of all levels
    size_t cut_count;   ///< how many of them were above the limit and are the limit in the files
    double share;       ///< cut_count / value_count
    double largest;     ///< of the map's values
} kiln_save_report;

/// Writes a map whole or not at all: a temporary file beside `path`, fsync, rename. By ending:
///   .ktx2 .dds   a cube with all levels in one file
///   .exr .hdr .png, or a folder (ends in /)   with %s or {face} for the face and %d or {level} for
///       the level in the name; a cube without them becomes six files NAME_px.exr ... a level
/// `def` may be NULL. `report`, which may be NULL, tells of files and of values that were cut off.
KILN_API KILN_CHECKED kiln_result kiln_map_save(kiln_context *context, const kiln_map *map,
                                                const char *path, const kiln_save_def *def,
                                                kiln_save_report *report, kiln_error *error);

/// A file in memory, under the name that it would have been saved as.
typedef struct kiln_file {
    const char *name;
    const unsigned char *bytes;
    size_t size;
    void *owner; ///< kiln's own
} kiln_file;

typedef struct kiln_files {
    int count;
    kiln_file *file;
} kiln_files;

/// The files that kiln_map_save would write, in memory; kiln_files_free releases them. `name` is a path
/// that need not exist.
KILN_API KILN_CHECKED kiln_result kiln_map_encode(kiln_context *context, const kiln_map *map,
                                                  const char *name, const kiln_save_def *def,
                                                  kiln_files *files, kiln_save_report *report,
                                                  kiln_error *error);
/// May be NULL.
KILN_API void kiln_files_free(kiln_files *files);

/// A flat picture: .exr, .hdr (three channels) or .png (8 bits, values as they are, 0 to 1).
KILN_API KILN_CHECKED kiln_result kiln_image_save(kiln_context *context, const kiln_image *image,
                                                  const char *path, kiln_error *error);

/// Coefficients as .json, .txt (one line each) or .h (a C array).
KILN_API KILN_CHECKED kiln_result kiln_sh_save(kiln_context *context, const kiln_sh *sh,
                                               const char *path, kiln_error *error);

// ----------------------------------------------------------------------------------------- engines

/// What an engine wants of an environment. docs/engines/NAME.md says how it is loaded there, and
/// what was shown by its pixels.
struct kiln_engine {
    const char *name;    ///< "three"
    const char *title;   ///< "three.js from r187 on"
    const char *files;   ///< what is written: "NAME.ktx2"
    const char *ending;  ///< of the path to kiln_engine_save, "ktx2"; "" where names begin with it
    const char *mapping; ///< of level k of n, of a size of w texels, to roughness r
    int size;            ///< of a face, where nothing else is asked for
    int level_count;     ///< then
    double limit;        ///< the largest radiance that the files hold
    /// To choose from, the first by default; KILN_FORMAT_AUTO behind the last.
    kiln_format formats[4];
    const char *proof; ///< "pixels of VERSION", where seen; else "source of" or "manual of"
    /// Tuned levels (kiln_prefilter_def.tune_for) show less error than exact ones in this engine, as
    /// measured: `kiln bake --for` tunes by default.
    bool tune;
};

/// The engines in the order of their table; NULL where the index is none.
KILN_API const kiln_engine *kiln_engine_at(int index);
/// By name; NULL where there is none.
KILN_API const kiln_engine *kiln_engine_find(const char *name);
/// The levels that an engine wants, for kiln_prefilter: `def` points to `roughness`. `size` and
/// `level_count` 0 for the engine's own; powers of two within the range that the error names.
KILN_API KILN_CHECKED kiln_result kiln_engine_levels(const kiln_engine *engine, int size,
                                                     int level_count,
                                                     float roughness[KILN_MAX_LEVELS],
                                                     kiln_prefilter_def *def, kiln_error *error);
/// Fails where `format` is none of the engine's; KILN_FORMAT_AUTO becomes its first, if it has any.
KILN_API KILN_CHECKED kiln_result kiln_engine_format(const kiln_engine *engine, kiln_format *format,
                                                     kiln_error *error);
/// The level, a fraction, that the engine's shader reads for a roughness; -1 where the engine is none
/// of kiln's or reads no levels.
KILN_API double kiln_engine_level(const kiln_engine *engine, double roughness, int size,
                                  int level_count);
/// What the engine shows of such a cube in directions that are not 0: two levels mixed by the fraction,
/// each read bilinearly across faces. `values` receives count * 3.
KILN_API KILN_CHECKED kiln_result kiln_engine_show(kiln_context *context, const kiln_engine *engine,
                                                   const kiln_map *map, double roughness,
                                                   const double (*directions)[3], int count,
                                                   double (*values)[3], kiln_error *error);
/// Writes such a cube, given in kiln's directions, as the engine reads it: turned so that it shows a
/// panorama where its own loader would. `sh`, of three bands or more, is the environment's radiance,
/// which some engines take their diffuse light from. `format` is one of the engine's, or
/// KILN_FORMAT_AUTO. Files appear together or not at all.
KILN_API KILN_CHECKED kiln_result kiln_engine_save(kiln_context *context, const kiln_engine *engine,
                                                   const kiln_map *map, const kiln_sh *sh,
                                                   kiln_format format, const char *path,
                                                   kiln_save_report *report, kiln_error *error);
/// The files that kiln_engine_save would write, in memory; kiln_files_free releases them.
KILN_API KILN_CHECKED kiln_result kiln_engine_encode(kiln_context *context,
                                                     const kiln_engine *engine, const kiln_map *map,
                                                     const kiln_sh *sh, kiln_format format,
                                                     const char *name, kiln_files *files,
                                                     kiln_save_report *report, kiln_error *error);

// ------------------------------------------------------------------------------ environments, writing

/// {0} is a good default: the levels alone, with harmonics and lobe in the file's metadata where the
/// file has any.
typedef struct kiln_environment_save_def {
    const kiln_engine *engine;   ///< whose files the levels become; NULL: those of kiln_map_save
    kiln_format format;          ///< of levels and irradiance
    int zstd;                    ///< of KTX2 files, not of an engine's
    const char *irradiance_path; ///< NULL: the irradiance is not written
    const char *sh_path;         ///< .json, .txt or .h; NULL: harmonics have no file of their own
    const kiln_sh *sh;           ///< what goes to sh_path; NULL: the environment's
} kiln_environment_save_def;

typedef struct kiln_environment_report {
    int file_count; ///< of all
    kiln_save_report levels, irradiance;
} kiln_environment_report;

/// Writes an environment, the levels to `path`: all files together or none. `def` and `report` may be
/// NULL.
KILN_API KILN_CHECKED kiln_result kiln_environment_save(
    kiln_context *context, const kiln_environment *environment, const char *path,
    const kiln_environment_save_def *def, kiln_environment_report *report, kiln_error *error);
/// The files that kiln_environment_save would write, in memory, the levels' first; kiln_files_free
/// releases them.
KILN_API KILN_CHECKED kiln_result
kiln_environment_encode(kiln_context *context, const kiln_environment *environment,
                        const char *name, const kiln_environment_save_def *def, kiln_files *files,
                        kiln_environment_report *report, kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
