// kiln: exact image-based lighting. A panorama goes in, prefiltered radiance comes out.
//
// Read from top to bottom this header follows the light,
//   context -> load -> lobe -> spectrum -> prefilter -> spherical harmonics,
// then what the surface does to it,
//   microfacet models -> compensation of energy -> tables -> closed forms,
// then what both are compared with, the textbook, the assignment, brute force, and last the files.
// Each of the two can be read without the other.
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
    KILN_CPU_SSE2, ///< vectors of 128 bits; in WebAssembly simd128
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
/// `context` may be NULL.
KILN_API void kiln_context_destroy(kiln_context *context);

/// The instruction set in use: "scalar", "sse2", "avx2", "avx512" or "simd128".
KILN_API const char *kiln_context_cpu(const kiln_context *context);

/// Bytes held by the context's objects now, and the most that were held at once.
KILN_API void kiln_context_memory(const kiln_context *context, size_t *current, size_t *peak);

// ------------------------------------------------------------------------- pictures of all directions

enum { KILN_MAX_LEVELS = 16, KILN_MAX_SIZE = 32768, KILN_MAX_BANDS = 5 };

typedef enum kiln_shape {
    KILN_SHAPE_PANORAMA,   ///< equirectangular, size rows of 2 * size texels
    KILN_SHAPE_CUBE,       ///< six faces of size * size texels, +X -X +Y -Y +Z -Z
    KILN_SHAPE_OCTAHEDRON, ///< size * size texels, +Y in the centre, -Y in the corners
} kiln_shape;

/// Radiance by direction: RGB floats, row-major, face after face, level after level. Level k has
/// the size max(1, smallest, size >> k). Made by kiln_map_create or a function that says so, released by
/// kiln_map_free; the numbers may be read and written freely.
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
/// A flat picture as it is, without a shape, of three channels; a table (KTX2) of 1, 2 or 4, its
/// slices one below the other.
KILN_API KILN_CHECKED kiln_result kiln_image_load(kiln_context *context, const char *path,
                                                  kiln_image *image, kiln_error *error);

/// What a file is, without reading all of its texels. Strings end in NUL.
typedef struct kiln_file_info {
    char format[16];   ///< "exr", "hdr", "png", "ktx2", "dds"
    char encoding[48]; ///< texel type and compression, "half rgb, piz"
    char layout[24];   ///< "panorama", "cross", "strip", "cube", "octahedron", "image", "table"
    int width, height; ///< of one face, of the picture or of a table's slice
    int depth;         ///< slices of a table, else 1
    int face_count, level_count;
    int channel_count;
    uint64_t byte_count;
    float roughness[KILN_MAX_LEVELS]; ///< of each level, where the file says; else -1
    char writer[64];                  ///< "kiln 0.2.0", or empty
    char orientation[16];             ///< as the file states it, or empty
    char table[160];                  ///< what a table that kiln wrote is: "kind=e d=ggx ..."
    int sh_bands;                     ///< 0 where the file holds no spherical harmonics
    float sh[KILN_MAX_BANDS * KILN_MAX_BANDS][3];
} kiln_file_info;

KILN_API KILN_CHECKED kiln_result kiln_file_describe(kiln_context *context, const char *path,
                                                     kiln_file_info *info, kiln_error *error);

// --------------------------------------------------------------------------------------------- sky

/// {0} stands for each default.
typedef struct kiln_sky_def {
    int size;           ///< rows of the panorama, 16 to 8192; 0 for 512
    double elevation;   ///< of the sun above the horizon in degrees, -5 to 90; see has_elevation
    bool has_elevation; ///< false: 30 degrees
    double azimuth;     ///< degrees from -Z toward +X
    double turbidity;   ///< 1.7 (clear) to 10 (hazy); 0 for 3
    double albedo;      ///< of the ground below, 0 to 1; see has_albedo
    bool has_albedo;    ///< false: 0.2
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
    kiln_shape shape;       ///< KILN_SHAPE_PANORAMA is 0; see has_shape
    bool has_shape;         ///< false: a cube
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
    /// Levels for what this engine shows, instead of the exact ones: see kiln_engine_levels. It mixes two
    /// levels linearly and reads texels bilinearly; these show the least error over roughness .05 to 1 in
    /// this environment, relative to what is right at each, near suns and away from them. Level 0 is the
    /// mirror all the same, white stays white, nothing is negative. NULL: exact levels. Source:
    /// docs/theory/display.md.
    const kiln_engine *shown_by;
    /// With shown_by: level 0 may be softer than the mirror, where that shows less error.
    bool soft;
} kiln_prefilter_def;

/// Every level from one analysis. Roughness 0 with GGX is the mirror: true area weights. `def` may
/// be NULL. `source` is any map; its level 0 is used.
KILN_API KILN_CHECKED kiln_result kiln_prefilter(kiln_context *context, const kiln_map *source,
                                                 const kiln_prefilter_def *def, kiln_map *map,
                                                 kiln_error *error);

/// The same sizes many times: everything that depends on them only is computed once.
typedef struct kiln_plan kiln_plan;

/// For panoramas of `source_size` rows. The plan keeps the context: destroy it first.
KILN_API KILN_CHECKED kiln_result kiln_plan_create(kiln_context *context, int source_size,
                                                   const kiln_prefilter_def *def, kiln_plan **plan,
                                                   kiln_error *error);
/// `map` is made by kiln_plan_map or has the same shape, size and levels.
KILN_API KILN_CHECKED kiln_result kiln_plan_execute(kiln_plan *plan, const kiln_map *panorama,
                                                    kiln_map *map, kiln_error *error);
/// An empty map of the plan's shape, size, levels and roughness.
KILN_API KILN_CHECKED kiln_result kiln_plan_map(const kiln_plan *plan, kiln_map *map,
                                                kiln_error *error);
/// The spectrum of the panorama executed last; the plan's own, valid until the next execution.
KILN_API const kiln_spectrum *kiln_plan_spectrum(const kiln_plan *plan);
KILN_API void kiln_plan_destroy(kiln_plan *plan);

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
/// The value of the series in a unit direction; may be negative.
KILN_API void kiln_sh_evaluate(const kiln_sh *sh, const double direction[3], double value[3]);

// ------------------------------------------------------------------------------ microfacet models

/// The distribution of normals.
typedef enum kiln_d {
    KILN_D_GGX,     ///< Trowbridge and Reitz 1975, Walter et al. 2007
    KILN_D_BECKMANN ///< Gaussian slopes, with Smith's masking of its own
} kiln_d;

/// Masking and shadowing, Smith's or Schlick's approximation with one of the two k in use.
typedef enum kiln_g {
    KILN_G_SMITH,              ///< height-correlated Smith (Heitz 2014, eq. 99); the default
    KILN_G_SMITH_UNCORRELATED, ///< G1(v) G1(l)
    KILN_G_SCHLICK_K2,         ///< k = roughness^2 / 2 (Karis 2013, image-based light)
    KILN_G_SCHLICK_TEXT        ///< k = (roughness + 1)^2 / 8 (Karis 2013, point lights)
} kiln_g;

/// {0} is a good default: GGX with height-correlated Smith shadowing.
typedef struct kiln_model {
    kiln_d d;
    kiln_g g;
} kiln_model;

// Functions of numbers, which cannot fail: arguments outside their range are clamped into it.
// nov, nol and noh are the cosines n.v, n.l and n.h, voh is v.h = l.h, all in [0, 1]; alpha =
// roughness^2. Roughness 0 is the limit from above at fixed cosines, a cosine of 0 the limit after
// that.

/// D, per steradian: int D(h) (n.h) dh = 1. Infinite at roughness 0 and noh 1.
KILN_API double kiln_brdf_d(kiln_d d, double roughness, double noh);
/// G in [0, 1], symmetric. Schlick's two do not depend on the distribution.
KILN_API double kiln_brdf_g(const kiln_model *model, double roughness, double nov, double nol);
/// The specular lobe with F = 1, D G / (4 nov nol), per steradian. Finite at nov = 0 or nol = 0,
/// where G / (nov nol) has a limit; infinite where both are 0 and the model's limit is.
KILN_API double kiln_brdf_specular(const kiln_model *model, double roughness, double nov,
                                   double nol, double noh);

/// Schlick 1994: f0 + (1 - f0) (1 - voh)^5.
KILN_API double kiln_fresnel_schlick(double f0, double voh);
/// A metal's: Schlick's less a dip towards the edge, a voh (1 - voh)^6 (Lazanyi and Szirmay-Kalos
/// 2005), with a such that F is `f82` at voh = 1 / 7, 82 degrees (Kutz et al. 2021). Cut to [0, 1].
KILN_API double kiln_fresnel_f82(double f0, double f82, double voh);
/// Unpolarised light on a dielectric of ior = n_transmitted / n_incident, 0 to 1e8. Total
/// reflection is 1.
KILN_API double kiln_fresnel_dielectric(double ior, double voh);
/// On a conductor of complex index n + i k relative to the medium outside, each 0 to 1e8.
KILN_API double kiln_fresnel_conductor(double n, double k, double voh);
/// The index of the metal with a reflectivity at normal incidence (0 to 0.9999) and an edge tint (0
/// to 1). Gulbrandsen 2014, factored so that k loses no digits; the reflectivity comes out again.
KILN_API void kiln_gulbrandsen(double reflectivity, double edge_tint, double *n, double *k);

/// F_avg = 2 int F(mu) mu dmu from 0 to 1. Schlick's is exactly (1 + 20 f0) / 21.
KILN_API double kiln_fresnel_schlick_average(double f0);
/// (1 + 20 f0) / 21 - a / 126, exact where nothing is cut: f0 of 0.2 or more, f82 from
/// f0 to Schlick's F.
KILN_API double kiln_fresnel_f82_average(double f0, double f82);
/// Exact (Walsh 1926, and reciprocity for ior < 1), to 1e-14.
KILN_API double kiln_fresnel_dielectric_average(double ior);
/// By adaptive quadrature, to 1e-12.
KILN_API double kiln_fresnel_conductor_average(double n, double k);
/// Kulla and Conty's fit (Imageworks 2017) to the dielectric's for ior 0 to 400: off by up to 0.0065
/// above 1, by 0.0029 below.
KILN_API double kiln_fresnel_dielectric_average_fit(double ior);
/// Their polynomial to the conductor's in Gulbrandsen's parameters: off by up to 0.10, by 0.014 RMS.
KILN_API double kiln_fresnel_conductor_average_fit(double reflectivity, double edge_tint);

// Samplers: xi in [0, 1)^2 uniform; n = (0, 0, 1); pdfs are per steradian. Light from a half
// vector: l = 2 (v.h) h - v, which may be below the surface (its share is lost, the weight 0).

/// l with the density (n.l) / pi.
KILN_API void kiln_sample_cosine(const double xi[2], double l[3]);
KILN_API double kiln_pdf_cosine(double nol);
/// h with the density D(h) (n.h). Walter et al. 2007, eqs. 28 and 35.
KILN_API void kiln_sample_half_vector(kiln_d d, double roughness, const double xi[2], double h[3]);
KILN_API double kiln_pdf_half_vector(kiln_d d, double roughness, double noh);
/// h among GGX's normals visible from the unit vector v (v[2] >= 0), with the density G1(v) D(h)
/// (v.h) / (n.v). Heitz 2018, by the spherical caps of Dupuy and Benyoub 2023.
KILN_API void kiln_sample_visible(double roughness, const double v[3], const double xi[2],
                                  double h[3]);
KILN_API double kiln_pdf_visible(double roughness, double nov, double noh, double voh);
/// The density of l = 2 (v.h) h - v where h has the density `pdf`: pdf / (4 voh).
KILN_API double kiln_pdf_reflection(double pdf, double voh);

// What a rough surface reflects in all, with every bounce after the first lost: the furnace test's
// missing light is 1 - E. Exact, by one-dimensional integrals; errors below 1e-11, with Beckmann's D
// 1e-8. Arguments outside [0, 1] are clamped; roughness 0 and nov 0 are limits, roughness first.
// Source: docs/theory/energy.md.

/// E(n.v) = int f (n.l) dl with F = 1: the directional albedo.
KILN_API double kiln_energy(const kiln_model *model, double roughness, double nov);
/// E_avg = 2 int_0^1 E(mu) mu dmu.
KILN_API double kiln_energy_average(const kiln_model *model, double roughness);
/// A and B of the split sum: with Schlick's F the directional albedo is f0 A + B.
KILN_API void kiln_energy_split(const kiln_model *model, double roughness, double nov,
                                double ab[2]);

/// Masking of Charlie sheen.
typedef enum kiln_sheen {
    KILN_SHEEN_ASHIKHMIN, ///< 1 / (4 (n.l + n.v - n.l n.v)), Filament's and most viewers'; the default
    KILN_SHEEN_ESTEVEZ    ///< Estevez and Kulla's fit of Lambda, as KHR_materials_sheen gives it
} kiln_sheen;

/// The directional albedo of Charlie sheen of colour 1, alpha = roughness^2, roughness at least 0.01.
/// It exceeds 1 at grazing angles: neither masking conserves energy. Source: docs/theory/sheen.md.
KILN_API double kiln_sheen_albedo(kiln_sheen sheen, double roughness, double nov);

/// Rough glass, exact Fresnel: rt[0] of the light from n.v is reflected and rt[1] transmitted by one
/// microfacet; the rest is lost to further bounces. ior = n beyond / n on the side of v: below 1 from
/// the inside; clamped to [1/16, 16]. Error below 2e-6, from the inside with ior next to 1 and n.v below
/// 1e-3 6e-6. KILN_G_SMITH hides transmitted light by Heitz's beta function, the others by the
/// product. Source: docs/theory/glass.md.
KILN_API void kiln_glass(const kiln_model *model, double roughness, double ior, double nov,
                         double rt[2]);
/// 2 int R mu dmu and 2 int T mu dmu. Reciprocity: T_avg(ior) = ior^2 T_avg(1 / ior).
KILN_API void kiln_glass_average(const kiln_model *model, double roughness, double ior,
                                 double rt[2]);

// ------------------------------------------------------------------------- compensation of energy

// The specular lobe leaves out light that bounces more than once between the microfacets. With E(mu)
// its albedo for F = 1 and E_avg = 2 int E mu dmu, these put it back. See docs/theory/compensation.md.

/// Which factor colours the added lobe; f = F_avg.
typedef enum kiln_f_add {
    KILN_F_ADD_SECOND,    ///< f^2 E_avg / (1 - f (1 - E_avg)): all bounces from the second one on
    KILN_F_ADD_ASSIGNMENT ///< f E_avg / (1 - f (1 - E_avg)), as taught: the first one too
} kiln_f_add;

/// Kulla and Conty 2017, F = 1: (1 - e_o) (1 - e_i) / (pi (1 - e_average)), reciprocal; its cosine
/// integral over i is 1 - e_o. Where e_average is 1 nothing is missing, and it is 0.
KILN_API double kiln_kulla_conty(double e_o, double e_i, double e_average);
/// The factor to that lobe for other Fresnel terms.
KILN_API double kiln_kulla_conty_fresnel(kiln_f_add form, double f_average, double e_average);
/// Turquin 2019: the factor 1 + f0 (1 - e) / e to the specular lobe, e = E(n.v).
KILN_API double kiln_turquin(double f0, double e);
/// Fdez-Aguera 2019 for image-based light: prefiltered radiance is multiplied by `single`,
/// irradiance / pi by `multiple`, where f0 a + b is the split sum's albedo and e = a + b.
KILN_API void kiln_fdez_aguera(double f0, double a, double b, double *single, double *multiple);
/// The factor to the specular lobe that brings its albedo to the random walk's: 1 + added / e_single,
/// where e_single = f0 a + b and `added` is what KILN_TABLE_E_WALK shows, or kiln_walk_albedo's
/// albedo - bounce[0].
KILN_API double kiln_compensate_walk(double e_single, double added);

/// The F of a walk's microfacets.
typedef enum kiln_walk_fresnel {
    KILN_WALK_SCHLICK,  ///< of f0
    KILN_WALK_CONSTANT, ///< f0 itself; 1 is the white furnace
    KILN_WALK_CONDUCTOR ///< exact, of n and k
} kiln_walk_fresnel;

/// {0} is a good default: Schlick's F of f0 = 0, 65536 paths.
typedef struct kiln_walk_def {
    kiln_walk_fresnel fresnel;
    double f0;      ///< 0 to 1
    double n, k;    ///< as for kiln_fresnel_conductor
    int path_count; ///< rounded up to a power of 2, 32 to 2^24; 0 for 65536
    uint32_t seed;  ///< other paths; their difference is as the standard error says
} kiln_walk_def;

enum { KILN_WALK_BOUNCES = 16 };

/// The share of the light that comes back, with all bounces.
typedef struct kiln_walk {
    double albedo;
    double standard_error;            ///< of the albedo, from 16 independent parts
    double bounce[KILN_WALK_BOUNCES]; ///< the albedo by the number of bounces: 1, 2, ..., the rest
    int path_count;                   ///< walked
} kiln_walk;

/// Ground truth for all of these: a random walk between the microfacets of GGX (Heitz, Hanika, d'Eon
/// and Dachsbacher 2016), whose single bounce is the height-correlated Smith model. The same bits
/// everywhere. Source, cost and error: docs/theory/walk.md.
KILN_API void kiln_walk_albedo(const kiln_walk_def *def, double roughness, double nov,
                               kiln_walk *walk);

// ------------------------------------------------------------------------------------------ tables

enum { KILN_MAX_TABLE = 4096 };

/// What a table holds. u runs along n.v, v along roughness, w (slices) along the third argument: F0
/// itself, or for an ior from 1 to 3 w = 2 (ior - 1) / (ior + 1), which is 2 sqrt(F0), so
/// ior = (2 + w) / (2 - w).
typedef enum kiln_table_kind {
    KILN_TABLE_E,                ///< E, one channel: the directional albedo of F = 1
    KILN_TABLE_E_AVERAGE,        ///< E_avg, one channel, one texel wide: 2 int E(mu) mu dmu
    KILN_TABLE_DFG,              ///< A, B: specular albedo = F0 A + B
    KILN_TABLE_DFG_MULTISCATTER, ///< B, A + B and the cloth's albedo, as Filament orders them
    KILN_TABLE_SHEEN,            ///< directional albedo of Charlie sheen, one channel
    KILN_TABLE_E_DIELECTRIC,     ///< E of a rough dielectric's reflection, w along the ior
    KILN_TABLE_GLASS,            ///< reflected, transmitted from outside, the same from inside
    KILN_TABLE_E_WALK ///< what later bounces add by random walk, w along F0: the albedo with all
                      ///< bounces E(n.v, roughness, F0) is F0 A + B + this, to 2e-3
} kiln_table_kind;

/// How n.v runs along u: the warped axes resolve the grazing layer, where E changes fast.
typedef enum kiln_axis {
    KILN_AXIS_LINEAR, ///< u = n.v
    KILN_AXIS_SQRT,   ///< u = (n.v)^(1/2)
    KILN_AXIS_CBRT,   ///< u = (n.v)^(1/3)
    KILN_AXIS_GRAZING ///< u = sqrt(n.v (1 + c) / (n.v + c)), for E: errs least by far. c is alpha,
                      ///< for Schlick's text k / (1 - k), so that every row has its layer alike
} kiln_axis;

/// What files and the command call these choices: names in the order of the enum, NULL behind the last.
KILN_API const char *const *kiln_d_names(void);
KILN_API const char *const *kiln_g_names(void);
KILN_API const char *const *kiln_sheen_names(void);
KILN_API const char *const *kiln_table_kind_names(void);
KILN_API const char *const *kiln_axis_names(void);

/// {0} is a good default: E of the default model, 128 x 128, u = n.v, texel centres.
typedef struct kiln_table_def {
    kiln_table_kind kind;
    kiln_model model;
    kiln_sheen sheen; ///< KILN_TABLE_SHEEN only
    /// 1 to KILN_MAX_TABLE; 0 for 128 x 128, 32 x 32 x 32 where there is w,
    /// 40 x 32 x 20 of the walk. E_avg is one texel wide.
    int width, height, depth;
    kiln_axis axis;  ///< KILN_TABLE_E_WALK has the grazing one and corners, without being asked
    bool corners;    ///< texel i stands at i / (n - 1), else at (i + 1/2) / n, of each axis
    bool complement; ///< 1 - value: 1 - E keeps its precision where E is near 1
    bool flip;       ///< row 0 holds roughness 1, for loaders that turn pictures over
    int path_count; ///< random walks a texel, KILN_TABLE_E_WALK only, as in kiln_walk_def; 0 for 8192
} kiln_table_def;

/// A table, its slices one below the other in `image`: width x (height * depth).
typedef struct kiln_table {
    kiln_table_def def; ///< as made: nothing is left 0 for a default
    kiln_image image;
} kiln_table;

/// Fills a table; `def` may be NULL. Texels are the integrals rounded to floats; large tables of E come
/// from a series that is within 7e-8 of it.
KILN_API KILN_CHECKED kiln_result kiln_table_create(kiln_context *context,
                                                    const kiln_table_def *def, kiln_table *table,
                                                    kiln_error *error);
KILN_API void kiln_table_free(kiln_table *table);
/// E_avg of what looking up a table of E shows, rather than of E: with it Kulla and Conty's lobe gives
/// back exactly what the table says is missing, and the furnace errs by no more than the lookup.
/// `height` texels, 0 for 1024.
KILN_API KILN_CHECKED kiln_result kiln_table_average(kiln_context *context, const kiln_table *table,
                                                     int height, kiln_table *average,
                                                     kiln_error *error);
/// What a texel stands for.
KILN_API void kiln_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                               double *roughness, double *third);
/// The value between texels, interpolated as graphics hardware does, with the complement undone.
/// `third` counts where the kind has one. `values` receives the table's channels.
KILN_API void kiln_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                                double *values);

// ------------------------------------------------------------------------------------ closed forms

/// What a closed form stands for, in n.v and roughness.
typedef enum kiln_fit_kind {
    KILN_FIT_E,         ///< E
    KILN_FIT_E_AVERAGE, ///< E_avg, of roughness alone
    KILN_FIT_DFG,       ///< A and B of the split sum
    KILN_FIT_SHEEN      ///< albedo of Charlie sheen, KILN_SHEEN_ASHIKHMIN
} kiln_fit_kind;

typedef enum kiln_fit_form {
    KILN_FIT_AUTO, ///< whichever has fewer coefficients
    KILN_FIT_POLYNOMIAL,
    KILN_FIT_RATIONAL
} kiln_fit_form;

/// {0} is a good default: E of the default model to 1e-3.
typedef struct kiln_fit_def {
    kiln_fit_kind kind;
    kiln_model model;
    kiln_fit_form form;
    double error;         ///< largest wanted anywhere, 1e-6 to 0.5; 0 for 1e-3
    double roughness_min; ///< 0 to 0.9, below which the form is not asked for and its argument
                          ///< clamped; sheen at least 0.1
    int max_coefficients; ///< of a part, 1 to KILN_MAX_FIT; 0 for KILN_MAX_FIT
} kiln_fit_def;

enum { KILN_MAX_FIT = 160, KILN_MAX_FIT_TERMS = 12 };

/// x of a part, scaled to [-1, 1]: t = n.v (1 + c) / (n.v + c), with c as on KILN_AXIS_GRAZING.
typedef enum kiln_fit_axis {
    KILN_FIT_AXIS_NONE,
    KILN_FIT_AXIS_T,
    KILN_FIT_AXIS_SQRT_T,
    KILN_FIT_AXIS_NOV,
    KILN_FIT_AXIS_SQRT_NOV
} kiln_fit_axis;

/// P(x, y) / Q(x, y), y the roughness scaled to [-1, 1]; the coefficient of x^i y^j is
/// p[j * x_count + i]. Q has the same powers, q[0] = 1 and no zero on the square, which is proven;
/// a polynomial has no q.
typedef struct kiln_fit_part {
    kiln_fit_axis axis;
    bool rational;
    int x_count, y_count;
    float p[KILN_MAX_FIT], q[KILN_MAX_FIT];
} kiln_fit_part;

/// A closed form: its one part; or for KILN_FIT_DFG, with F5 = (1 - n.v)^5, B = F5 part[0] + part[1]
/// and A = part[0] - B, so that part[0] is E.
typedef struct kiln_fit {
    kiln_fit_def def; ///< as made: nothing is left 0 for a default
    int part_count;
    kiln_fit_part part[2];
    int coefficient_count;
    double max_error, rms_error; ///< measured in floats against the integrals
} kiln_fit;

/// Finds the form with the fewest coefficients that errs by def->error at most at some 40000 points,
/// evaluated in floats as the code that kiln_fit_save writes does. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_fit_create(kiln_context *context, const kiln_fit_def *def,
                                                  kiln_fit *fit, kiln_error *error);
/// `values` receives two numbers, A and B, for KILN_FIT_DFG, else one.
KILN_API void kiln_fit_evaluate(const kiln_fit *fit, float nov, float roughness, float *values);
/// Writes a function of that name, as C (.h) or GLSL ES 3.00 (.glsl). `name` is an identifier; NULL
/// for kiln_e, kiln_e_average, kiln_dfg or kiln_sheen.
KILN_API KILN_CHECKED kiln_result kiln_fit_save(kiln_context *context, const kiln_fit *fit,
                                                const char *name, const char *path,
                                                kiln_error *error);

// ------------------------------------------------------------------------- the textbook, by its name

/// The methods that courses teach, with their defaults and their errors, to learn from and to
/// compare with. See docs/theory/textbook.md.
typedef struct kiln_textbook_def {
    kiln_shape shape; ///< of the result; KILN_SHAPE_PANORAMA as in the textbook
    int size;         ///< rows or edge; 0 for 64
    int level_count;  ///< prefilter only; 0 for all
    int phi_count;    ///< irradiance: steps of phi, to 65536; 0 for 100
    int theta_count;  ///< irradiance: steps of theta, to 65536; 0 for 100
    int sample_count; ///< prefilter: Hammersley points, to 1048576; 0 for 1024
} kiln_textbook_def;

/// Irradiance / pi as the textbook's uniform sum over (phi, theta) gives it: white stays near 1
/// (0.99992 with 100 x 100). A panorama's texels look where the textbook's do, at i / (width - 1) and
/// j / (height - 1), which is up to half a texel from their centres.
KILN_API KILN_CHECKED kiln_result kiln_textbook_irradiance(kiln_context *context,
                                                           const kiln_map *panorama,
                                                           const kiln_textbook_def *def,
                                                           kiln_map *map, kiln_error *error);
/// GGX importance sampling on Hammersley points with N = V = R, weighted by n.l, nearest texels;
/// roughness level / (level_count - 1). A panorama's texels as for kiln_textbook_irradiance.
KILN_API KILN_CHECKED kiln_result kiln_textbook_prefilter(kiln_context *context,
                                                          const kiln_map *panorama,
                                                          const kiln_textbook_def *def,
                                                          kiln_map *map, kiln_error *error);
/// The 1024-sample split-sum table: x is n.v = i/(size-1), y is roughness = j/(size-1), row 0 at
/// the top holds roughness 1; two channels (A, B). Where n.v is 0 the textbook divides 0 by 0; here
/// the estimator's limit n.v -> 0 is evaluated, at n.v = 1e-4. `size` 2 to 4096; `sample_count` to
/// 1048576, 0 for 1024.
KILN_API KILN_CHECKED kiln_result kiln_textbook_brdf(kiln_context *context, int size,
                                                     int sample_count, kiln_image *table,
                                                     kiln_error *error);

// ----------------------------------------------------------------------- the assignment, by its name

/// How GAMES202's fourth assignment (2021) computes E(mu), with its sizes, its samples and its
/// errors. See docs/theory/assignment.md.
typedef enum kiln_assignment_method {
    KILN_ASSIGNMENT_MONTE_CARLO, ///< light drawn by its cosine, in jittered strata (SplitMix64)
    KILN_ASSIGNMENT_IMPORTANCE,  ///< GGX's half vectors on Hammersley points: its bonus 1
    KILN_ASSIGNMENT_SPLIT_SUM    ///< the sums A and B on the same points, added: its bonus 2
} kiln_assignment_method;

/// {0} is the assignment's own: 128 x 128 texels, 1024 samples each, k = roughness^2 / 2.
typedef struct kiln_assignment_def {
    int size;         ///< 2 to 1024; 0 for 128
    int sample_count; ///< to 1048576; 0 for 1024. Monte Carlo takes the largest square up to it
    kiln_g g;         ///< see has_g. D is GGX
    bool has_g;     ///< false: KILN_G_SCHLICK_K2, which its figures have; its text has the other k
    bool unclamped; ///< Monte Carlo: D's denominator as it is; false: at least 1e-4
    bool unflipped; ///< row 0 holds roughness 0, as in figure 3; else the top row is roughness 1
    uint64_t seed;  ///< of Monte Carlo's numbers
} kiln_assignment_def;

/// E with F = 1, size x size, one channel, before it is cut to bytes: mu = (x + 1/2) / size from left
/// to right, roughness = (y + 1/2) / size upwards. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_assignment_energy(kiln_context *context,
                                                         kiln_assignment_method method,
                                                         const kiln_assignment_def *def,
                                                         kiln_image *table, kiln_error *error);
/// E_avg of such a table: each row is 2 mean(E mu) of that row, in every texel.
KILN_API KILN_CHECKED kiln_result kiln_assignment_average(kiln_context *context,
                                                          const kiln_image *energy,
                                                          kiln_image *average, kiln_error *error);
/// Cuts every value to what (uint8)(255 x) keeps of it: saved as PNG, it is that byte.
KILN_API void kiln_assignment_truncate(kiln_image *image);

/// Of the texels of two tables, the one minus the other.
typedef struct kiln_difference {
    double max, rms; ///< of its size
    double mean;     ///< with its sign
} kiln_difference;

/// Tables of one channel, alike in size. `map`, which may be NULL, receives a picture (sRGB) of the
/// error by decades from 1e-4, white, to 1, dark: blue where `table` is too dark, red where too
/// bright.
KILN_API KILN_CHECKED kiln_result kiln_assignment_compare(kiln_context *context,
                                                          const kiln_image *table,
                                                          const kiln_image *exact,
                                                          kiln_difference *difference,
                                                          kiln_image *map, kiln_error *error);

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

/// Writes a map whole or not at all: a temporary file beside `path`, fsync, rename. By ending:
///   .ktx2 .dds   a cube with all levels in one file
///   .exr .hdr .png, or a folder (ends in /)   with %s or {face} for the face and %d or {level} for
///       the level in the name; a cube without them becomes six files NAME_px.exr ... a level
/// `def` may be NULL. The number of files written goes to `file_count`, which may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_map_save(kiln_context *context, const kiln_map *map,
                                                const char *path, const kiln_save_def *def,
                                                int *file_count, kiln_error *error);
/// A flat picture: .exr, .hdr (three channels) or .png (8 bits, values as they are, 0 to 1).
KILN_API KILN_CHECKED kiln_result kiln_image_save(kiln_context *context, const kiln_image *image,
                                                  const char *path, kiln_error *error);

/// How a table's numbers are stored.
typedef enum kiln_table_format {
    KILN_TABLE_FORMAT_AUTO = 0, ///< halves in KTX2 and .inc, 16 bits in PNG, else floats
    KILN_TABLE_FORMAT_F32,
    KILN_TABLE_FORMAT_F16,
    KILN_TABLE_FORMAT_U16, ///< 0 to 1 in 65535 steps, clamped
    KILN_TABLE_FORMAT_U8,  ///< 0 to 1 in 255 steps, clamped
    KILN_TABLE_FORMAT_RGBD ///< PNG of three channels, each (c D)^(1 / 2.2), and D: to 255, Babylon.js'
} kiln_table_format;

/// {0} is a good default.
typedef struct kiln_table_save_def {
    kiln_table_format format;
    int zstd;         ///< KTX2: compression level 1 to 22, 0 for none
    const char *name; ///< what names in .h and .glsl begin with; NULL for the file's own name
} kiln_table_save_def;

/// Fails, as kiln_table_save would, where a file of that ending cannot be saved so. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_table_save_check(const char *path,
                                                        const kiln_table_save_def *def,
                                                        kiln_error *error);

/// Writes a table whole or not at all. By ending (docs/tables.md says what is in each):
///   .ktx2          a 2-D texture, or a 3-D one where there are slices
///   .exr .hdr .png slices one below the other; two channels are red and green
///   .raw .bin      the numbers alone, little-endian
///   .h             a C array of floats, at most 4194304 of them
///   .inc           halves as hexadecimal numbers with commas, as Filament's cmgen writes its table
///   .glsl          a constant array and its lookup, at most 65536 bytes
/// `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_table_save(kiln_context *context, const kiln_table *table,
                                                  const char *path, const kiln_table_save_def *def,
                                                  kiln_error *error);
/// Reads a KTX2 table that kiln wrote.
KILN_API KILN_CHECKED kiln_result kiln_table_load(kiln_context *context, const char *path,
                                                  kiln_table *table, kiln_error *error);
/// Writes source code that looks up tables made with this def (of a kiln_table): .h, a C99 and C++
/// function on an array of floats; .glsl, a GLSL ES 3.00 function on a texture, which the sampler
/// must filter linearly and clamp at the edge. Names begin with `name`; NULL for the file's own name
/// without "_lookup".
KILN_API KILN_CHECKED kiln_result kiln_table_lookup_save(kiln_context *context,
                                                         const kiln_table_def *def,
                                                         const char *path, const char *name,
                                                         kiln_error *error);
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
    /// kiln_prefilter_def.shown_by shows less error, as measured: `kiln bake --for` uses it.
    bool fit;
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
                                                   int *file_count, kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
