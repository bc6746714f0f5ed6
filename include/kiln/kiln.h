// kiln: exact image-based lighting. A panorama goes in, prefiltered radiance comes out.
//
// The sections of this header follow the light: context -> maps -> load -> sky -> lobe -> spectrum
// -> prefilter -> spherical harmonics -> lights -> environments, which one call bakes.
// After these come reference values by brute force, the writing of files, and the engines that read
// the files. <kiln/brdf.h> has what surfaces do to light: reflection models, and tables and closed
// forms of their integrals. <kiln/course.h> has the methods that courses teach, and <kiln/check.h>
// tells whether files of other tools are right.
//
// These conventions hold in every function and in every file that kiln writes
// (docs/conventions.md):
//   - Texels are linear radiance with Rec. 709 primaries in the input's own unit: three channels of
//     32-bit floats.
//   - Directions are right-handed with +Y up. The centre column of a panorama looks along -Z and
//     has +X to its right. Row 0 is at +Y.
//   - Cube faces come in the order +X -X +Y -Y +Z -Z, oriented as in OpenGL and KTX: a texel is the
//     radiance that arrives from the direction in which texture(cube, direction) reads the texel.
//   - Texel i of n has its centre at (i + 0.5) / n. Roughness is perceptual: alpha = roughness^2.
//
// Functions that can fail return a kiln_result, and write an error message to `error` if `error` is
// not NULL. On failure outputs are zeroed. No function keeps a pointer to its arguments after it
// has returned, except kiln_context_create (callbacks) and kiln_lobe_custom (function and user
// data).
//
// Only one thread at a time may use a context. Different contexts are independent of each other.
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
    KILN_ERROR_UNSUPPORTED, ///< valid, but of a kind that kiln does not read or write
    KILN_ERROR_CANCELLED,   ///< the progress callback returned false
} kiln_result;

/// Filled in by a function that fails. `message` is one sentence that says what happened, with the
/// numbers that matter.
typedef struct kiln_error {
    kiln_result result;
    char message[512];
} kiln_error;

/// Returns the version of the running library as text, for example "0.2.0".
KILN_API const char *kiln_version(void);

/// Steps over one character of UTF-8 text that ends in NUL. Returns the character's length in bytes
/// and sets *code to its code point; a byte that is not UTF-8 counts as one character U+FFFD.
/// *shown becomes false for such a byte and for characters that a terminal obeys instead of showing
/// them: controls, separators of lines, and marks that change the direction of text.
KILN_API int kiln_text_step(const char *text, unsigned *code, bool *shown);
/// Replaces every character that is not shown (see kiln_text_step) by '?', in place. Error
/// messages, notes and the strings of kiln_file_info are clean in this sense, whatever the file
/// holds.
KILN_API void kiln_text_clean(char *text);

// ---------------------------------------------------------------------------------------- context

typedef struct kiln_context kiln_context;

typedef enum kiln_cpu {
    KILN_CPU_BEST = 0,
    KILN_CPU_SCALAR,
    KILN_CPU_SSE2, ///< vectors of 128 bits: SSE2, on ARM NEON, in WebAssembly simd128
    KILN_CPU_AVX2,
    KILN_CPU_AVX512
} kiln_cpu;

/// Settings of a context. {0} selects memory from malloc and the operating system, no memory limit,
/// one thread per core, no progress reports and the best instruction set that the processor has.
typedef struct kiln_context_def {
    /// `allocate` returns `size` bytes aligned to 64, or NULL when there is no memory. `release`
    /// frees such a block of `size` bytes. Either both functions are set or both are NULL, which
    /// selects malloc and, for larger blocks, the operating system (docs/embedding.md, Allocators).
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory, size_t size);
    void *allocator_user;
    /// Number of bytes that the context's objects may hold at once; 0 for no limit. Memory that is
    /// free between the objects is not counted.
    size_t memory_limit;
    /// Number of threads, 1 to 256; 0 for one per core. If the system starts fewer threads, the
    /// context works with those; see kiln_context_threads.
    int thread_count;
    /// Runs task(data, i) for each i from 0 to count - 1, in any order on any threads, and returns
    /// when every call has returned. NULL: the context starts threads of its own. Work can be
    /// stopped between two calls of this function, and by those tasks that run on the thread that
    /// called the library.
    void (*parallel_for)(void *user, int count, void (*task)(void *data, int index), void *data);
    void *parallel_user;
    /// Called from time to time with 0 <= fraction <= 1, on the thread that called the library. The
    /// work in progress is cancelled when this function returns false. The function may call kiln
    /// with the same context and on its own thread, but not execute a plan that is being executed.
    /// May be NULL.
    bool (*progress)(void *user, const char *stage, double fraction);
    void *progress_user;
    /// Highest instruction set that may be used, for tests and benchmarks. Results are
    /// bit-identical for every instruction set.
    kiln_cpu cpu;
} kiln_context_def;

/// Creates a context. `def` may be NULL, which selects the defaults of kiln_context_def.
KILN_API KILN_CHECKED kiln_result kiln_context_create(const kiln_context_def *def,
                                                      kiln_context **context, kiln_error *error);
/// Destroys a context; `context` may be NULL. Objects made with the context may still be freed or
/// destroyed afterwards, which calls the context's `release`. Plans, spectra and streams must not
/// be used in any other way once their context is destroyed.
KILN_API void kiln_context_destroy(kiln_context *context);

/// Returns the name of the instruction set in use: "scalar", "sse2", "avx2", "avx512", "neon" or
/// "simd128".
KILN_API const char *kiln_context_cpu(const kiln_context *context);

/// Sets *running to the number of threads that work, with the calling thread, and *wanted to the
/// number that the definition asked for. `running` is less than `wanted` if the system refused to
/// start threads, for example because of a limit on processes. Either pointer may be NULL.
KILN_API void kiln_context_threads(const kiln_context *context, int *running, int *wanted);

/// Sets *current to the number of bytes that the context's objects hold now, and *peak to the
/// largest number held at once so far.
KILN_API void kiln_context_memory(const kiln_context *context, size_t *current, size_t *peak);

// ---------------------------------------------------------------------- pictures of all directions

enum { KILN_MAX_LEVELS = 16, KILN_MAX_SIZE = 32768, KILN_MAX_BANDS = 5 };

typedef enum kiln_shape {
    KILN_SHAPE_AUTO =
        0, ///< only for options, each of which documents its default; a map never has this shape
    KILN_SHAPE_PANORAMA,   ///< equirectangular, size rows of 2 * size texels
    KILN_SHAPE_CUBE,       ///< six faces of size * size texels, +X -X +Y -Y +Z -Z
    KILN_SHAPE_OCTAHEDRON, ///< size * size texels, +Y in the centre, -Y in the corners
} kiln_shape;

/// Radiance by direction, as RGB floats: rows from top to bottom, face after face, level after
/// level. Level k has the size max(1, smallest, size >> k). kiln_map_create and functions that
/// return a map allocate the texels, kiln_map_free releases them; the caller may read and write the
/// texels.
///
/// The levels may also lie in the caller's own memory. Set shape, size, level_count and level[],
/// and leave the other fields 0: every function then reads and writes such a map, and kiln_map_free
/// frees nothing. Texels must be finite, which kiln_map_from_pixels ensures. Negative texels are
/// data like all others: functions that filter a map are linear.
typedef struct kiln_map {
    kiln_shape shape;
    int size;                         ///< size of level 0 in texels, 1 to KILN_MAX_SIZE
    int level_count;                  ///< number of levels, 1 to KILN_MAX_LEVELS
    int smallest;                     ///< smallest size that a level may have; 0 or 1 for no bound
    float *level[KILN_MAX_LEVELS];    ///< texels of level k: kiln_map_texels(map, k) * 3 floats
    float roughness[KILN_MAX_LEVELS]; ///< roughness that each level was filtered for, 0 to 1
    void *owner;                      ///< for kiln's own use
} kiln_map;

/// A flat picture with 1 to 4 channels, rows from top to bottom: a table, or the content of a file
/// whose place on the sphere is not known yet.
typedef struct kiln_image {
    int width, height, channels;
    float *pixels;
    void *owner; ///< for kiln's own use
} kiln_image;

/// Creates a map whose texels are all 0. `level_count` 0 stands for all levels down to size 1.
KILN_API KILN_CHECKED kiln_result kiln_map_create(kiln_context *context, kiln_shape shape, int size,
                                                  int level_count, kiln_map *map,
                                                  kiln_error *error);
KILN_API void kiln_map_free(kiln_map *map);
KILN_API KILN_CHECKED kiln_result kiln_image_create(kiln_context *context, int width, int height,
                                                    int channels, kiln_image *image,
                                                    kiln_error *error);
KILN_API void kiln_image_free(kiln_image *image);

/// Returns the size of a level in texels along its short side: max(1, smallest, size >> level).
KILN_API int kiln_map_level_size(const kiln_map *map, int level);
/// Returns the number of texels of a level of size n: n * n * 6 for a cube, n * 2n for a panorama,
/// n * n for an octahedron.
KILN_API size_t kiln_map_texels(const kiln_map *map, int level);
/// Sets `direction` to the unit direction of the centre of a texel. `index` counts the texels of
/// the level row by row, face after face.
KILN_API void kiln_map_direction(const kiln_map *map, int level, size_t index, double direction[3]);

/// Swaps left and right (x becomes -x) of every level in place.
KILN_API void kiln_map_mirror(kiln_map *map);
/// Multiplies every texel by 2^stops, in place.
KILN_API void kiln_map_expose(kiln_map *map, double stops);

/// Values of a map that were below zero and became 0. Light is a value times the solid angle of its
/// texel, summed over channels and levels.
typedef struct kiln_cut {
    size_t value_count; ///< number of values in all levels: three per texel
    size_t cut_count;   ///< number of values that were below zero
    /// Light below zero that was cut off, relative to the light of the values above zero, where
    /// light is the absolute value times the solid angle of its texel.
    double share;
} kiln_cut;
/// Sets values below zero to 0 in every level, in place. `cut` receives what was cut off and may be
/// NULL. kiln_bake, kiln_plan_execute, kiln_prefilter and kiln_spectrum_filter end with this step;
/// kiln_map_convert and the methods in <kiln/course.h> keep negative values.
KILN_API void kiln_map_cut_negative(kiln_context *context, kiln_map *map, kiln_cut *cut);

/// Converts level 0 of a map to another shape or size. Each texel of the result is the mean of the
/// source over the texel's solid angle. The source is first turned by `rotation` degrees about +Y,
/// which moves the content of a panorama to the left. The result has one level.
KILN_API KILN_CHECKED kiln_result kiln_map_convert(kiln_context *context, const kiln_map *source,
                                                   kiln_shape shape, int size, double rotation,
                                                   kiln_map *map, kiln_error *error);

// ---------------------------------------------------------------------------------- files, reading

/// How a flat picture covers the sphere. KILN_LAYOUT_AUTO decides by the ratio of width to height:
/// 2:1 is a panorama, 4:3 and 3:4 are crosses of cube faces, 6:1 and 1:6 are strips of faces. An
/// EXR file written by kiln states that its picture is an octahedron.
typedef enum kiln_layout {
    KILN_LAYOUT_AUTO = 0,
    KILN_LAYOUT_PANORAMA, ///< a picture that is not 2:1 is stretched over the whole sphere
    KILN_LAYOUT_CROSS,
    KILN_LAYOUT_STRIP,
    KILN_LAYOUT_OCTAHEDRON,
    KILN_LAYOUT_PROBE, ///< a square angular map around -Z; the map becomes a panorama
    KILN_LAYOUT_BALL   ///< the square photograph of a mirror ball, by a camera that looks along -Z;
                       ///< the map becomes a panorama
} kiln_layout;

/// What becomes of negative texels. Lossy compression leaves such texels beside bright ones, and so
/// do colours outside the gamut of Rec. 709.
typedef enum kiln_negative {
    KILN_NEGATIVE_KEEP = 0, ///< negative values stay, so that sums and means are those of the file
    KILN_NEGATIVE_ZERO      ///< negative values become 0, which makes the environment brighter
} kiln_negative;

typedef enum kiln_note_kind {
    KILN_NOTE_INFINITE = 0, ///< infinite texels became 65504
    KILN_NOTE_NAN,          ///< texels that are not a number became the mean of their neighbours
    KILN_NOTE_NEGATIVE,     ///< negative texels were kept or became 0
    KILN_NOTE_MISSING,      ///< texels are not in the file and are black
    KILN_NOTE_CHOICE,       ///< which part, layer, channels or layout of the file are the picture
    KILN_NOTE_CONVERSION,   ///< the numbers were converted: colours, exposure, transfer function
    KILN_NOTE_ASSUMPTION,   ///< the file leaves open what kiln needs to know, and kiln assumed it
    KILN_NOTE_CUT           ///< filtered values below zero became 0
} kiln_note_kind;

enum { KILN_MAX_NOTES = 16, KILN_NOTE_TEXT = 256 };

/// One thing to know about a picture that was loaded.
typedef struct kiln_note {
    kiln_note_kind kind;
    bool warning; ///< true: the environment may not be what its author meant
    /// A sentence without the name of the file, a capital and a full stop, for example "12 of 512
    /// texels are infinite and became 65504".
    char text[KILN_NOTE_TEXT];
} kiln_note;

/// What a loader found in a picture, chose and changed. Counts are numbers of texels, in all faces
/// and levels that were loaded; a texel counts once, whatever number of its channels is concerned.
typedef struct kiln_load_report {
    size_t texel_count;    ///< number of all texels
    size_t infinite_count; ///< texels with an infinite channel, which became 65504
    /// Texels with a channel that is not a number or minus infinity. Such a channel became the mean
    /// of the neighbouring texels that have numbers.
    size_t nan_count;
    size_t negative_count; ///< texels with a channel below zero
    size_t missing_count;  ///< texels outside the data window of an EXR file, which are black
    /// Light of the values below zero relative to the light of the values above zero, where light
    /// is a value times the solid angle of its texel.
    double negative_share;
    kiln_negative negative; ///< what became of the values below zero: they were kept, or became 0
    int note_count;         ///< number of notes, of which `note` holds the first KILN_MAX_NOTES
    /// Choices, conversions and assumptions of the loader. The notes about the counts above are
    /// made by kiln_load_report_note.
    kiln_note note[KILN_MAX_NOTES];
} kiln_load_report;

/// Puts a report into sentences: sets *note to sentence number `index`, counted from 0, and returns
/// true. Returns false if the report has no such sentence.
KILN_API bool kiln_load_report_note(const kiln_load_report *report, int index, kiln_note *note);

/// Makes a sentence about the values below zero that a bake set to 0, `cut`, for a source that was
/// loaded with the report `source`: sets *note and returns true. Returns false if there were no
/// such values, or only values that rounding made, because the source had no negative texels or
/// these became 0.
KILN_API bool kiln_cut_note(const kiln_load_report *source, const kiln_cut *cut, kiln_note *note);

/// Options for loading a map. {0} selects the default of each option.
typedef struct kiln_load_def {
    kiln_layout layout;
    kiln_negative negative;
    kiln_load_report *report; ///< receives what was found in the file; may be NULL
    /// Layer of an EXR file that is the picture: the layer's name, its last components, the name of
    /// its part, PART.LAYER, or the name of a single channel, which is read as grey. NULL chooses
    /// R, G and B without a layer, else the layer that renderers name like a picture, else the only
    /// layer with colours; a file that has several such layers is refused.
    const char *layer;
} kiln_load_def;

/// Loads a map from an EXR, Radiance HDR, PNG or JPEG file (values are decoded to linear radiance
/// with Rec. 709 primaries, by what the file says about its colours; a gain map in a JPEG file is
/// applied), from a cube or 2-D texture in a KTX2, DDS or KTX 1 file, or from six face files. Six
/// faces are given by a folder or by a path with `%s` or `{face}` in place of the face, with any
/// of the names in docs/conventions.md: px nx py ny pz nz and the like. A folder that holds two
/// sets of faces is refused. The content of a file decides its format, never the ending of its
/// name. Texels that are infinite or not a number are replaced as kiln_load_report says. A picture
/// in which no texel is a number is refused. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_map_load(kiln_context *context, const char *path,
                                                const kiln_load_def *def, kiln_map *map,
                                                kiln_error *error);
/// Decodes a map from the bytes of a file in memory, as kiln_map_load does from a path. `name` is
/// the file name that error messages mention.
KILN_API KILN_CHECKED kiln_result kiln_map_decode(kiln_context *context, const void *bytes,
                                                  size_t size, const char *name,
                                                  const kiln_load_def *def, kiln_map *map,
                                                  kiln_error *error);
/// Loads a cube from six files, which may come in any order if their names tell the faces, as those
/// in a folder do; other files are taken as +X -X +Y -Y +Z -Z. `def->layout` is ignored. `def` may
/// be NULL.
KILN_API KILN_CHECKED kiln_result kiln_map_load_faces(kiln_context *context,
                                                      const char *const paths[6],
                                                      const kiln_load_def *def, kiln_map *map,
                                                      kiln_error *error);
/// Sets order[face] to the index of the file of each of the faces +X -X +Y -Y +Z -Z, by the names
/// of six files, or to 0 to 5 if the names do not tell the faces. Returns false if the names of
/// some files are those of a face, but do not make up a set.
KILN_API bool kiln_faces_order(const char *const paths[6], int order[6]);

typedef enum kiln_pixel_type {
    KILN_PIXEL_FLOAT = 0, ///< floats of 32 bits
    KILN_PIXEL_HALF       ///< half floats of 16 bits
} kiln_pixel_type;

/// Radiance in the caller's memory, for example rendered there or read back from a graphics
/// processor. Six cube faces stored one after the other are a strip of `size` texels width and 6 *
/// size texels height.
typedef struct kiln_pixels {
    const void *data; ///< the first pixel of the top row, at any address
    int width, height;
    int channels;         ///< number of channels: 3, or 4, of which the fourth is ignored
    kiln_pixel_type type; ///< type of each channel
    /// Distance in bytes from a row to the row below, may be negative; 0 for no gaps.
    ptrdiff_t row_stride;
    kiln_layout layout; ///< KILN_LAYOUT_AUTO decides by the ratio of the sides, as for files
    kiln_negative negative;
    kiln_load_report *report; ///< receives what was found in the pixels; may be NULL
} kiln_pixels;

/// Creates a map with a copy of the pixels. Values are treated as kiln_map_load treats those of
/// files.
KILN_API KILN_CHECKED kiln_result kiln_map_from_pixels(kiln_context *context,
                                                       const kiln_pixels *pixels, kiln_map *map,
                                                       kiln_error *error);
/// Loads a flat picture without placing it on the sphere. The result has three channels, or for a
/// KTX2 table the table's 1, 2 or 4 channels, with the slices of a 3-D table one below the other.
/// Infinite values and values that are not a number are replaced as in kiln_map_load.
KILN_API KILN_CHECKED kiln_result kiln_image_load(kiln_context *context, const char *path,
                                                  kiln_image *image, kiln_error *error);

enum { KILN_MAX_LAYERS = 32 };

/// One layer of an EXR file: the channels of a part whose names agree up to the last dot. Bytes of
/// the file that are control characters or no UTF-8 stand as \xNN in these texts, a backslash as
/// \\, and texts that are too long are cut.
typedef struct kiln_layer_info {
    char part[64];      ///< name of the part, or empty
    char name[128];     ///< name of the layer; empty for channels without a layer
    char channels[128]; ///< channels without the layer's name, for example "A, B, G, R"
    bool picture;       ///< true: kiln_map_load reads this layer unless the caller names another
} kiln_layer_info;

/// Description of a file, found without reading all of its texels. Strings end in NUL.
typedef struct kiln_file_info {
    char format[16]; ///< file format: "exr", "hdr", "png", "ktx2", "dds", "ktx1", "env", "glb", ...
    char encoding[48]; ///< type of the texels and their compression, for example "half rgb, piz"
    /// What the texels are: "panorama", "cross", "strip", "cube", "octahedron", "image", "table",
    /// "harmonics", or an atlas of levels side by side, "cubeuv" (three.js) or "atlas"
    /// (PlayCanvas). "openexr-panorama" and "openexr-cube" are the maps of OpenEXR's attribute
    /// "envmap", whose outer texels lie on the border of the panorama or of the face.
    char layout[24];
    /// Size of a cube face, of a picture, or of one slice of a table. For harmonics the width is
    /// the number of coefficients and the height 1.
    int width, height;
    int depth; ///< number of slices of a table, else 1
    int face_count, level_count;
    int channel_count;
    uint64_t byte_count;
    float roughness[KILN_MAX_LEVELS]; ///< roughness of each level; -1 where the file does not tell
    /// Name by which kiln_engine_find finds the engine that the file is for, or empty.
    char engine[24];
    char writer[64];      ///< program that wrote the file, for example "kiln 0.2.0", or empty
    char orientation[16]; ///< orientation of the texels in the file's own words, or empty
    char table[384];      ///< parameters of a table that kiln wrote, "kind=e d=ggx ...", or empty
    /// number of bands of spherical harmonics in the file, 0 if the file has no harmonics
    int sh_bands;
    bool sh_irradiance; ///< true: the harmonics are of irradiance; false: of radiance
    /// Coefficients of the spherical harmonics, converted to the normalisation and order of kiln_sh
    /// but in the axes of the file.
    float sh[KILN_MAX_BANDS * KILN_MAX_BANDS][3];
    /// Notes about what kiln chooses, converts and assumes when it reads the file. The counts are
    /// 0, because the texels were not read.
    kiln_load_report report;
    int part_count;  ///< number of parts of an EXR file, else 0
    int layer_count; ///< number of layers of an EXR file, of which `layer` holds the first
    kiln_layer_info layer[KILN_MAX_LAYERS];
} kiln_file_info;

/// Describes any file that kiln can read, and a folder or a pattern of six faces (see
/// kiln_map_load) as a cube with the bytes of all faces. Of the files that kiln only writes,
/// describes .env (Babylon.js), .glb with EXT_lights_image_based, atlases, and spherical harmonics
/// as text.
KILN_API KILN_CHECKED kiln_result kiln_file_describe(kiln_context *context, const char *path,
                                                     kiln_file_info *info, kiln_error *error);

// --------------------------------------------------------------------------------------------- sky

/// Stands for the value 0 in options for which 0 selects a default, as in kiln_sky_def. A computed
/// option x is passed as `x != 0 ? x : KILN_ZERO`.
#define KILN_ZERO 1e-300

/// Parameters of a daylight sky. {0} selects the default of each parameter.
typedef struct kiln_sky_def {
    int size; ///< number of rows of the panorama, 16 to 8192; 0 for 512
    /// Elevation of the sun in degrees above the horizon, -5 to 90; 0 for 30, KILN_ZERO for 0.
    double elevation;
    double azimuth;   ///< azimuth of the sun in degrees from -Z toward +X
    double turbidity; ///< haziness of the air, 1.7 (clear) to 10 (hazy); 0 for 3
    double albedo;    ///< albedo of the ground, 0 to 1; 0 for 0.2, KILN_ZERO for 0
} kiln_sky_def;

/// Creates a panorama of an analytic daylight sky, in kcd/m^2 per channel. The sun is a disc of
/// 0.533 degrees diameter, whose irradiance is exact at every texel size. Source:
/// docs/theory/sky.md.
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

/// A zonal kernel: the weight of light that arrives at a given angle to the output direction.
/// Filtered values are weighted means, so a constant factor of the weight has no effect. Use the
/// constructors below.
typedef struct kiln_lobe {
    kiln_lobe_kind kind;
    double parameter; ///< alpha (GGX, Charlie), exponent (Phong) or angular width (custom)
    double (*evaluate)(void *user, double cos_theta);
    void *user;
} kiln_lobe;

/// Returns the GGX lobe with N = V = R: D(theta/2; alpha) max(cos theta, 0). alpha is in [0, 1]; 0
/// is a perfect mirror, 1 equals Lambert.
KILN_API kiln_lobe kiln_lobe_ggx(double alpha);
/// Returns the Lambert lobe, max(cos theta, 0).
KILN_API kiln_lobe kiln_lobe_lambert(void);
/// Returns the lobe of Charlie sheen (Estevez and Kulla 2017) with N = V = R:
/// sin(theta/2)^(1/alpha) max(cos theta, 0), with alpha in [0.01, 1].
KILN_API kiln_lobe kiln_lobe_charlie(double alpha);
/// Returns the Phong lobe, max(cos theta, 0)^exponent, with an exponent in [1, 100000].
KILN_API kiln_lobe kiln_lobe_phong(double exponent);
/// Returns a lobe whose weight is the caller's own function of cos theta in [-1, 1]. The function
/// must be finite and not negative, and is called from any thread. `width` in (0, pi] is the angle
/// in radians over which the function changes most. The width decides where the quadrature nodes
/// lie and how high a degree the spectrum needs.
KILN_API kiln_lobe kiln_lobe_custom(double (*evaluate)(void *user, double cos_theta), void *user,
                                    double width);
/// Returns the weight of a lobe at an angle, up to a constant factor.
KILN_API double kiln_lobe_evaluate(const kiln_lobe *lobe, double cos_theta);

// ---------------------------------------------------------------------------------------- spectrum

/// The spherical harmonic coefficients of an environment: analysed once, they can be filtered with
/// any number of lobes.
typedef struct kiln_spectrum kiln_spectrum;

enum { KILN_MAX_DEGREE = 1600 };

/// Computes the spherical harmonics of level 0 of a map up to `degree`, 1 to KILN_MAX_DEGREE; 0
/// selects twice the size of the map. A panorama is transformed exactly, as constant over each
/// texel. Maps of other shapes are first converted to a panorama.
KILN_API KILN_CHECKED kiln_result kiln_spectrum_analyze(kiln_context *context, const kiln_map *map,
                                                        int degree, kiln_spectrum **spectrum,
                                                        kiln_error *error);
/// Computes a spectrum from the rows of a panorama, passed from north to south in any number of
/// calls, for panoramas that do not fit in memory. `rows` holds row_count * 2 * size RGB texels.
/// After `size` rows kiln_stream_finish returns the spectrum and frees the stream.
typedef struct kiln_stream kiln_stream;
KILN_API KILN_CHECKED kiln_result kiln_stream_begin(kiln_context *context, int size, int degree,
                                                    kiln_stream **stream, kiln_error *error);
KILN_API KILN_CHECKED kiln_result kiln_stream_rows(kiln_stream *stream, const float *rows,
                                                   int row_count, kiln_error *error);
KILN_API KILN_CHECKED kiln_result kiln_stream_finish(kiln_stream *stream, kiln_spectrum **spectrum,
                                                     kiln_error *error);
/// Frees a stream that was not finished. `stream` may be NULL.
KILN_API void kiln_stream_cancel(kiln_stream *stream);
KILN_API void kiln_spectrum_destroy(kiln_spectrum *spectrum);

KILN_API int kiln_spectrum_degree(const kiln_spectrum *spectrum);
/// Sets power[l][c] to the sum of the squared coefficients of degree l in channel c, over all
/// orders, for each degree l from 0 to the spectrum's degree.
KILN_API KILN_CHECKED kiln_result kiln_spectrum_power(const kiln_spectrum *spectrum,
                                                      double (*power)[3], kiln_error *error);

/// Filters the environment with one lobe, turned by `rotation` degrees about +Y, and writes the
/// result, with values below zero set to 0, to level `level` of `map`. Fails where the lobe is too
/// narrow for the degree of the spectrum; kiln_prefilter filters such levels from the panorama
/// itself.
KILN_API KILN_CHECKED kiln_result kiln_spectrum_filter(kiln_context *context,
                                                       const kiln_spectrum *spectrum,
                                                       const kiln_lobe *lobe, double rotation,
                                                       kiln_map *map, int level, kiln_error *error);

// --------------------------------------------------------------------------------------- prefilter

typedef struct kiln_engine kiln_engine; // defined in the section on engines below

/// The axis that points up in a source. kiln's own axes have y up.
typedef enum kiln_up {
    KILN_UP_Y = 0,
    KILN_UP_Z,      ///< z is up: kiln's direction (x, y, z) shows the source's (x, -z, y)
    KILN_UP_MINUS_Z ///< -z is up: kiln's direction (x, y, z) shows the source's (x, z, -y)
} kiln_up;

/// What kiln_prefilter computes. {0} selects a cube of size 256 with all levels, filtered by GGX
/// with roughness from 0 to 1 in equal steps.
typedef struct kiln_prefilter_def {
    kiln_shape shape; ///< shape of the levels; KILN_SHAPE_AUTO for a cube
    int size;         ///< size of level 0, 1 to KILN_MAX_SIZE; 0 for 256
    int level_count;  ///< number of levels, 1 to KILN_MAX_LEVELS; 0 for all levels down to size 1
    /// Smallest size of a level in texels, as in kiln_map. Needed where level_count is more than
    /// the number of levels down to size 1.
    int smallest;
    /// Lobe of every level: GGX (alpha = roughness^2), Lambert, Charlie (alpha = roughness^2, at
    /// least 0.01) or Phong (exponent 2 / alpha^2 - 2, at least 1).
    kiln_lobe_kind lobe;
    /// Roughness of each level, level_count numbers in [0, 1]. NULL for level / (level_count - 1),
    /// or for 1 with Lambert, whose lobe has no roughness.
    const float *roughness;
    double rotation; ///< rotation of the source about +Y in degrees
    /// Decides the degree at which the spectrum is cut off: the relative L2 error that a lone
    /// bright texel would have if kiln did not sum such texels exactly. 1e-6 to 0.01; 0 for 1.5e-4.
    /// With 1.5e-4, levels of real environments err by 4e-7 to 1e-5 as RMS (README.md).
    double tolerance;
    /// Engine for which the levels are tuned, or NULL for exact levels. An engine mixes two levels
    /// linearly and reads texels bilinearly. Tuned levels minimise the relative error of what the
    /// engine shows of this environment over roughness 0.05 to 1, near suns and away from them.
    /// Level 0 stays a mirror image, white stays white, and no texel is negative.
    /// kiln_engine_levels has the sizes. Source: docs/theory/tuning.md.
    const kiln_engine *tune_for;
    /// With tune_for: level 0 may be blurred where a blurred level 0 makes the engine's error
    /// smaller.
    bool tune_soft;
    /// Turns of the source about the other axes in degrees. The source is first turned to y up from
    /// the axis `up`, then by `roll` about the view axis -Z (what is above moves to the right), by
    /// `pitch` about +X (what is ahead moves up), and by `rotation` about +Y. Filtered levels,
    /// irradiance and harmonics are turned as exactly as they are filtered. A mirror image has
    /// means of 256 points or more in each texel, unless cubes are turned by quarter turns.
    double pitch, roll;
    kiln_up up;
} kiln_prefilter_def;

/// Filters level 0 of `source`, a map of any shape, with one lobe for each level of `map`, from one
/// spectrum. The GGX level of roughness 0 is the mirror image: each texel is the mean of the source
/// over the texel's area. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_prefilter(kiln_context *context, const kiln_map *source,
                                                 const kiln_prefilter_def *def, kiln_map *map,
                                                 kiln_error *error);

// ----------------------------------------------------------------------------- spherical harmonics

/// Coefficients of real, orthonormal spherical harmonics without the Condon-Shortley sign.
/// Coefficient l (l + 1) + m belongs to degree l and order m. As functions of the world's
/// directions (y up) the harmonics are proportional to 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2, ...
typedef struct kiln_sh {
    int bands; ///< number of bands, 1 to KILN_MAX_BANDS
    /// True: band l is multiplied by the cosine lobe's pi, 2 pi/3, pi/4, 0, -pi/24.
    bool irradiance;
    double window; ///< width of the deringing window in bands, 0 for none
    double c[KILN_MAX_BANDS * KILN_MAX_BANDS][3];
} kiln_sh;

/// Computes the spherical harmonics of a spectrum, turned by `rotation` degrees about +Y. `window`
/// > 0 multiplies band l by the Hanning window (1 + cos(pi l / window)) / 2 (Sloan 2008), which
/// reduces ringing.
KILN_API KILN_CHECKED kiln_result kiln_spectrum_sh(const kiln_spectrum *spectrum, int bands,
                                                   bool irradiance, double window, double rotation,
                                                   kiln_sh *sh, kiln_error *error);
/// Computes the spherical harmonics of the radiance of level 0 of a map, without a window. The map
/// is analysed only to the degree that five bands need, which takes a few milliseconds.
/// kiln_sh_filter turns the result into irradiance or applies a window.
KILN_API KILN_CHECKED kiln_result kiln_map_sh(kiln_context *context, const kiln_map *map, int bands,
                                              double rotation, kiln_sh *sh, kiln_error *error);
/// Sets `sh` to the first `bands` bands of `radiance`, converted to irradiance or windowed as in
/// kiln_spectrum_sh, with the same bits. `radiance` must have no window and at least as many bands.
/// `sh` may be the same object as `radiance`.
KILN_API KILN_CHECKED kiln_result kiln_sh_filter(const kiln_sh *radiance, int bands,
                                                 bool irradiance, double window, kiln_sh *sh,
                                                 kiln_error *error);
/// Sets `value` to the sum of all harmonics times their coefficients in a unit direction. The sum
/// may be negative.
KILN_API void kiln_sh_evaluate(const kiln_sh *sh, const double direction[3], double value[3]);

// ------------------------------------------------------------------------------------------ lights

enum { KILN_MAX_LIGHTS = 64 };

/// A compact source of light in an environment, such as the sun, a lamp or a window, as a disc of
/// uniform radiance irradiance / (pi sin^2 angular_radius).
typedef struct kiln_light {
    /// Unit vector to the radiometric centroid: the mean of the directions of the light, weighted
    /// by its radiance.
    double direction[3];
    /// Irradiance of a surface that faces the light: the sum over texels of the radiance above the
    /// surroundings, times solid angle, times the cosine of the angle to `direction`. The unit is
    /// that of the map's radiance times steradian.
    double irradiance[3];
    /// Angular radius in degrees of the disc with the same mean distance of light from the centre.
    /// A map widens a sun that is smaller than its texels.
    double angular_radius;
    double share;       ///< the part of the map's light that the light holds, 0 to 1
    size_t texel_count; ///< number of texels from which the light is taken
} kiln_light;

/// Lights, the one with the largest share first.
typedef struct kiln_lights {
    int count;
    kiln_light light[KILN_MAX_LIGHTS];
} kiln_lights;

/// Which lights are wanted. {0} selects the light with the largest share, if it holds a hundredth
/// of the map's light.
typedef struct kiln_lights_def {
    /// Largest number of lights, 1 to KILN_MAX_LIGHTS; 0 for 1, or for KILN_MAX_LIGHTS if `share`
    /// is not 0.
    int count;
    double share; ///< smallest share of a light, 0 to 1; 0 for 0.01, KILN_ZERO for 0
} kiln_lights_def;

/// Finds the compact lights in level 0 of a map of any shape: connected texels that are much
/// brighter than their surroundings. Lights are left out where discs in their place would change a
/// coefficient of the first five bands of harmonics by more than 8e-4 of the norm of all, or the
/// irradiance of a surface by 9.5e-4 of the greatest. `def` may be NULL. Source: docs/lights.md.
KILN_API KILN_CHECKED kiln_result kiln_lights_find(kiln_context *context, const kiln_map *map,
                                                   const kiln_lights_def *def, kiln_lights *lights,
                                                   kiln_error *error);
/// Finds lights as kiln_lights_find does and takes them out of level 0 of the map: their texels
/// receive what surrounds them, and are not negative. The map that remains and the lights together
/// are as bright as the map was.
KILN_API KILN_CHECKED kiln_result kiln_lights_extract(kiln_context *context, kiln_map *map,
                                                      const kiln_lights_def *def,
                                                      kiln_lights *lights, kiln_error *error);
/// Sets `sh` to the spherical harmonics of the lights' discs, as kiln_map_sh does for a map.
/// `bands` is 1 to KILN_MAX_BANDS.
KILN_API KILN_CHECKED kiln_result kiln_lights_sh(const kiln_lights *lights, int bands, kiln_sh *sh,
                                                 kiln_error *error);
/// Saves lights as a .json file: {"lights": [{"direction": [x, y, z], "irradiance": [r, g, b],
/// "angular_radius": degrees, "share": s, "texels": n}, ...]}.
KILN_API KILN_CHECKED kiln_result kiln_lights_save(kiln_context *context, const kiln_lights *lights,
                                                   const char *path, kiln_error *error);

/// What a limit took from a map.
typedef struct kiln_clamp {
    double limit;       ///< largest value that a texel may have; 0 if the map was not clamped
    size_t texel_count; ///< number of texels that were brighter
    /// Light that the limit removed, relative to all light of the map, where light is a value times
    /// the solid angle of its texel.
    double light_share;
} kiln_clamp;
/// Multiplies every texel of level 0 whose largest channel exceeds `limit` by limit / channel, so
/// that its colour stays. `limit` 0 selects 32 times the mean of the map without its lights.
/// `clamp` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_map_clamp(kiln_context *context, kiln_map *map, double limit,
                                                 kiln_clamp *clamp, kiln_error *error);

// ----------------------------------------------------------------------------------- environments

/// The maps and harmonics that light a scene, all computed from one source. kiln_bake and
/// kiln_plan_environment create an environment, kiln_environment_free releases it.
/// kiln_environment_save also accepts an environment that the caller filled with other maps.
typedef struct kiln_environment {
    kiln_map levels; ///< prefiltered radiance; level k is filtered for levels.roughness[k]
    /// Irradiance / pi, one level; empty ({0}) where no irradiance was asked for.
    kiln_map irradiance;
    /// spherical harmonics of the radiance; kiln_sh_filter makes irradiance of them or applies a
    /// window
    kiln_sh sh;
    kiln_lobe_kind lobe; ///< lobe that the levels were filtered with
    /// degree of the spectrum that the levels are computed from; 0 if there is no such spectrum
    int degree;
    /// Values of `levels` and of `irradiance` that were below zero after filtering and became 0. A
    /// source without negative texels has such values by rounding only.
    kiln_cut levels_cut, irradiance_cut;
    /// Lights that were taken out of the source, in the directions of the levels, and what a limit
    /// took from the source: see kiln_bake_def.sun.
    kiln_lights lights;
    kiln_clamp clamped;
} kiln_environment;

/// What becomes of the sun, lamps and other compact lights of a source.
typedef enum kiln_sun {
    KILN_SUN_KEEP = 0, ///< lights stay in the maps
    KILN_SUN_EXTRACT,  ///< lights are taken out, as by kiln_lights_extract
    KILN_SUN_CLAMP     ///< bright texels are made darker, as by kiln_map_clamp
} kiln_sun;

enum { KILN_NO_IRRADIANCE = -1 };

/// Whether levels are tuned for the engine that reads them: see kiln_prefilter_def.tune_for.
typedef enum kiln_tune {
    KILN_TUNE_AUTO =
        0, ///< KILN_TUNE_SHARP for engines where tuning was measured to help, else KILN_TUNE_NONE
    KILN_TUNE_NONE,  ///< exact levels
    KILN_TUNE_SHARP, ///< tuned levels; level 0 stays the mirror image
    KILN_TUNE_SOFT   ///< tuned levels; level 0 may be blurred
} kiln_tune;

/// What kiln_bake computes. {0} selects the defaults of kiln_prefilter_def, an irradiance map of
/// size 64 and three bands of harmonics.
typedef struct kiln_bake_def {
    /// The definition of the levels. `levels.rotation`, `pitch`, `roll` and `up` turn irradiance
    /// and harmonics too, after `mirror` is applied.
    kiln_prefilter_def levels;
    /// Engine that the levels are for, or NULL. The engine decides lobe, roughness, smallest and
    /// tuning of `levels`, whose own fields of these names must be 0; also size and level_count if
    /// these are 0.
    const kiln_engine *engine;
    kiln_tune tune;  ///< tuning of the levels; applies only with `engine`
    bool mirror;     ///< true: swaps left and right of the source
    double exposure; ///< multiplies the source by 2^exposure, -600 to 600
    /// Size of the irradiance map, 1 to KILN_MAX_SIZE; 0 for 64, KILN_NO_IRRADIANCE for none.
    int irradiance_size;
    int sh_bands;           ///< number of bands of harmonics, 1 to KILN_MAX_BANDS; 0 for 3
    kiln_sun sun;           ///< what becomes of lights, after mirror and exposure
    kiln_lights_def lights; ///< which lights are taken out; applies with KILN_SUN_EXTRACT
    /// Limit of kiln_map_clamp, 0 for its own choice; applies with KILN_SUN_CLAMP.
    double clamp;
} kiln_bake_def;

/// Computes an environment from level 0 of a map of any shape. The source is mirrored, exposed and
/// turned, then its spectrum is computed and filtered. The irradiance map has the shape of the
/// levels. Levels and irradiance hold nothing negative: see levels_cut. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_bake(kiln_context *context, const kiln_map *source,
                                            const kiln_bake_def *def, kiln_environment *environment,
                                            kiln_error *error);

/// A panorama whose rows are decoded or made while it is baked, so that only a few of them are in
/// memory at a time.
typedef struct kiln_rows {
    int size; ///< number of rows, each of 2 * size texels; 1 to KILN_MAX_SIZE / 2
    /// Writes the rows first .. first + count - 1, counted from the north, to `rgb`: count * 2 *
    /// size RGB texels, whose values must be finite. Another result than KILN_OK ends the bake with
    /// this result and the message that the function has written to `error`. The function is called
    /// on several threads at the same time, for rows in an order that suits the bake, and for some
    /// rows more than once.
    kiln_result (*read)(void *user, int first, int count, float *rgb, kiln_error *error);
    void *user;
    /// Rows are read in whole blocks of `block` rows where this is possible: each block begins at
    /// row `phase` plus a multiple of `block`. 0 stands for blocks of one row.
    int block, phase;
} kiln_rows;

/// Computes an environment as kiln_bake does, with the same bits, from rows that are read when the
/// bake needs them, from both poles to the equator. Rows around a sun, a single texel with a
/// thousandth of all light, are read twice. All rows are in memory at the same time only if lights
/// are taken out or clamped, if a mirror level is turned by pitch, roll or up, or if a level has a
/// lobe that is too narrow for the spectrum (roughness above 0 and below about 0.07).
KILN_API KILN_CHECKED kiln_result kiln_bake_rows(kiln_context *context, const kiln_rows *rows,
                                                 const kiln_bake_def *def,
                                                 kiln_environment *environment, kiln_error *error);
/// The shape and the size of a source: rows of a panorama, or texels along a side of a cube face or
/// an octahedron.
typedef struct kiln_extent {
    kiln_shape shape;
    int size;
} kiln_extent;

/// Computes an environment from a file, with the same bits as kiln_map_load and kiln_bake. A
/// panorama in an EXR or HDR file is baked while it is read, as by kiln_bake_rows, so that neither
/// the file nor the picture is in memory as a whole. The whole picture is loaded from other files,
/// for the bakes that need all rows (see kiln_bake_rows), and if values are not a number or chroma
/// is subsampled. `load` and `def` may be NULL. `source`, which may be NULL, receives the shape and
/// size of what was loaded.
KILN_API KILN_CHECKED kiln_result kiln_bake_file(kiln_context *context, const char *path,
                                                 const kiln_load_def *load,
                                                 const kiln_bake_def *def, kiln_extent *source,
                                                 kiln_environment *environment, kiln_error *error);
/// Frees the maps of an environment. `environment` may be NULL.
KILN_API void kiln_environment_free(kiln_environment *environment);

/// A prepared bake for many sources of one size. A plan computes once everything that depends only
/// on the sizes, and allocates once the memory that executions need.
typedef struct kiln_plan kiln_plan;

/// Creates a plan for sources of one shape and size. `source_size` is the number of rows of a
/// panorama, or the number of texels along a side of a cube face or an octahedron. `def` may be
/// NULL. The plan uses the context. For tuned levels the creation takes as long as one execution
/// more, which measures the memory that is needed.
KILN_API KILN_CHECKED kiln_result kiln_plan_create(kiln_context *context, kiln_shape source_shape,
                                                   int source_size, const kiln_bake_def *def,
                                                   kiln_plan **plan, kiln_error *error);
/// Creates an environment with the shapes, sizes, levels and roughness of the plan and with texels
/// 0.
KILN_API KILN_CHECKED kiln_result kiln_plan_environment(const kiln_plan *plan,
                                                        kiln_environment *environment,
                                                        kiln_error *error);
/// Bakes into an environment made by kiln_plan_environment, or into maps of the same shape, size
/// and levels. The result is bit-identical to that of kiln_bake. On failure the content of the maps
/// is undefined. An execution allocates nothing, unless lights are taken out, or the source has
/// more than 64 suns and more suns than any source before. A sun is a single texel with a
/// thousandth of all light.
KILN_API KILN_CHECKED kiln_result kiln_plan_execute(kiln_plan *plan, const kiln_map *source,
                                                    kiln_environment *environment,
                                                    kiln_error *error);
/// Returns the spectrum behind the levels of the last execution. The plan owns the spectrum, which
/// stays valid until the plan's next execution.
KILN_API const kiln_spectrum *kiln_plan_spectrum(const kiln_plan *plan);
/// Destroys a plan. `plan` may be NULL.
KILN_API void kiln_plan_destroy(kiln_plan *plan);

// --------------------------------------------------------------------------------------- reference

/// Computes reference values by brute force, for tests, benchmarks and error maps: the sum over
/// every texel of a panorama in double precision. The lobe is integrated over each texel with as
/// many quadrature nodes as a relative error of 1e-6 of the result needs. `directions` holds
/// `count` unit vectors (to 0.001), `values` receives count * 3 numbers.
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
    /// RGBM, RGBD and RGBP: four bytes a texel, PNG only; see docs/conventions.md.
    KILN_FORMAT_RGBM,
    KILN_FORMAT_RGBD,
    KILN_FORMAT_RGBP,
    /// UASTC HDR 4x4: 4 x 4 texels in 16 bytes, as a subset of ASTC HDR that loaders can convert to
    /// BC6H quickly; KTX2 only
    KILN_FORMAT_UASTC
} kiln_format;
/// Returns the names of the formats, "auto", "rgba16f", ..., in the order of the enum, with NULL
/// after the last name.
KILN_API const char *const *kiln_format_names(void);
/// Returns the largest radiance that a format holds; greater values are saved as this limit.
/// Returns 0 for formats of floats that hold every radiance.
KILN_API double kiln_format_limit(kiln_format format);

/// Options for saving a map. {0} selects the default of each option.
typedef struct kiln_save_def {
    kiln_format format;
    int zstd; ///< zstd compression level of a KTX2 file, 1 to 22; 0 for no compression
    /// Spherical harmonics to store in the metadata of formats that have metadata; may be NULL.
    const kiln_sh *sh;
    const char *lobe; ///< name of the lobe of the levels, stored in the metadata; may be NULL
} kiln_save_def;

/// Returns the ending of a path if a format of kiln has that ending: in lower case and with its
/// dot, for example ".ktx2". Returns "/" for a path that ends in a slash, and "" for an ending that
/// kiln does not know.
KILN_API const char *kiln_path_ending(const char *path);
/// Fails, with the error of kiln_map_save, if a map of this shape cannot be saved to this path with
/// the options `def`, which may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_map_save_check(const char *path, kiln_shape shape,
                                                      const kiln_save_def *def, kiln_error *error);
/// Returns the largest radiance that a file of this path and format holds; greater values are saved
/// as this limit. Returns 0 for files of floats that hold every radiance.
KILN_API double kiln_map_save_limit(const char *path, kiln_format format);

/// Returns the number of bytes of a level in a format, with its faces one after the other and no
/// gaps between rows. Returns 0 where kiln_map_pack fails.
KILN_API size_t kiln_map_packed_size(const kiln_map *map, int level, kiln_format format);
/// Packs a level in the layout that a graphics processor reads: rgba16f (also for
/// KILN_FORMAT_AUTO), rgba32f, rgb9e5, b10g11r11, or bc6h or uastc blocks. Faces are stored one
/// after the other. A row of texels or blocks begins `row_stride` bytes after the row before it; 0
/// for no gaps. Values above kiln_format_limit are stored as the limit. Fails if `destination_size`
/// is too small.
KILN_API KILN_CHECKED kiln_result kiln_map_pack(kiln_context *context, const kiln_map *map,
                                                int level, kiln_format format, void *destination,
                                                size_t row_stride, size_t destination_size,
                                                kiln_error *error);

/// What kiln_map_save wrote, and how many values were too large for the format.
typedef struct kiln_save_report {
    int file_count;
    /// largest radiance that the files' format can hold; 0 if floats hold every radiance
    double limit;
    size_t value_count; ///< number of values in all levels: three per texel
    size_t cut_count;   ///< number of values above `limit`, which the files hold as `limit`
    double share;       ///< cut_count / value_count
    /// Light above the limit relative to all light of the map, where light is a value times the
    /// solid angle of its texel.
    double light_share;
    double largest; ///< largest value of the map
} kiln_save_report;

/// Writes a map to one or more files, each of which appears complete or not at all: a temporary
/// file in the same folder is written, synchronised to disk (fsync) and renamed. The ending of
/// `path` decides the format:
///   .ktx2 .dds   a cube with all levels in one file
///   .exr .hdr .png, or a folder (a path that ends in /)   one file for each face and level:
///       `%s` or `{face}` in the name stands for the face, `%d` or `{level}` for the level; a cube
///       whose path has no place for the face becomes six files NAME_px.exr, ... for each level
/// `def` may be NULL. `report` may be NULL, else it receives the number of files and of values
/// above the limit.
KILN_API KILN_CHECKED kiln_result kiln_map_save(kiln_context *context, const kiln_map *map,
                                                const char *path, const kiln_save_def *def,
                                                kiln_save_report *report, kiln_error *error);

/// A file in memory, with the name under which kiln would have saved the file.
typedef struct kiln_file {
    const char *name;
    const unsigned char *bytes;
    size_t size;
    void *owner; ///< for kiln's own use
} kiln_file;

typedef struct kiln_files {
    int count;
    kiln_file *file;
} kiln_files;

/// Encodes in memory the files that kiln_map_save would write. `name` is a path that need not
/// exist. Release the files with kiln_files_free.
KILN_API KILN_CHECKED kiln_result kiln_map_encode(kiln_context *context, const kiln_map *map,
                                                  const char *name, const kiln_save_def *def,
                                                  kiln_files *files, kiln_save_report *report,
                                                  kiln_error *error);
/// Frees files in memory. `files` may be NULL.
KILN_API void kiln_files_free(kiln_files *files);

/// Saves a flat picture as .exr, .hdr (three channels) or .png (8 bits; values in 0 to 1 are stored
/// without an sRGB curve).
KILN_API KILN_CHECKED kiln_result kiln_image_save(kiln_context *context, const kiln_image *image,
                                                  const char *path, kiln_error *error);

/// Saves coefficients of spherical harmonics as .json, as .txt (one line for each coefficient) or
/// as .h (a C array).
KILN_API KILN_CHECKED kiln_result kiln_sh_save(kiln_context *context, const kiln_sh *sh,
                                               const char *path, kiln_error *error);

// ----------------------------------------------------------------------------------------- engines

/// The form in which a rendering engine reads an environment. docs/engines/NAME.md says how the
/// engine loads the files, and which of its pixels were compared with the expected values.
struct kiln_engine {
    const char *name;  ///< short name, for example "three"
    const char *title; ///< full name and version, for example "three.js from r187 on"
    const char *files; ///< names of the written files, for example "NAME.ktx2"
    /// Ending of the path for kiln_engine_save with the default format, for example "ktx2"; ""
    /// where the path is the beginning of several file names. kiln_engine_ending knows the other
    /// formats.
    const char *ending;
    /// Formula for the roughness r of level k of n, w being the size of level 0.
    const char *mapping;
    int size;        ///< default size of a cube face in texels
    int level_count; ///< default number of levels of the cube
    double limit;    ///< largest radiance that the engine's files hold in the default format
    /// Formats that the engine's files may have, the default first and KILN_FORMAT_AUTO after the
    /// last.
    kiln_format formats[4];
    /// What the support is proved by: "pixels of VERSION" where rendered pixels were compared, else
    /// "source of" or "manual of" the version.
    const char *proof;
    /// True if tuned levels (kiln_prefilter_def.tune_for) were measured to show less error in this
    /// engine than exact levels do. `kiln bake --for` then tunes by default.
    bool tune;
    /// Why the first of `formats` is the default: the sizes and errors of the others beside its
    /// own, as docs/engines/README.md lists them. NULL for engines without a choice.
    const char *format_reason;
};

/// Returns the engine at an index of kiln's list of engines, or NULL for an index outside the list.
KILN_API const kiln_engine *kiln_engine_at(int index);
/// Returns the engine with this name, or NULL if kiln knows no such engine.
KILN_API const kiln_engine *kiln_engine_find(const char *name);
/// Fills `roughness` and `def` so that kiln_prefilter computes the levels that an engine reads.
/// `def` keeps a pointer to `roughness`. `size` and `level_count` 0 stand for the engine's
/// defaults. Sizes are powers of two within a range that the error message names.
KILN_API KILN_CHECKED kiln_result kiln_engine_levels(const kiln_engine *engine, int size,
                                                     int level_count,
                                                     float roughness[KILN_MAX_LEVELS],
                                                     kiln_prefilter_def *def, kiln_error *error);
/// Replaces KILN_FORMAT_AUTO by the engine's default format, if the engine has formats to choose
/// from. Fails if *format is not a format of the engine.
KILN_API KILN_CHECKED kiln_result kiln_engine_format(const kiln_engine *engine, kiln_format *format,
                                                     kiln_error *error);
/// Returns the ending of the path for kiln_engine_save with a format of the engine, as in
/// kiln_engine.ending. Returns NULL if `engine` is not from kiln's list.
KILN_API const char *kiln_engine_ending(const kiln_engine *engine, kiln_format format);
/// Returns the level, with its fraction, that the engine's shader reads for a roughness of 0 to 1.
/// Returns -1 if `engine` is not from kiln's list or reads no levels, and for a roughness, size or
/// level_count out of range.
KILN_API double kiln_engine_level(const kiln_engine *engine, double roughness, int size,
                                  int level_count);
/// Computes what an engine shows of a cube in finite directions other than 0: two neighbouring
/// levels, each read bilinearly across cube faces, are mixed by the fraction of the level. `values`
/// receives count * 3 numbers; `count` is not negative.
KILN_API KILN_CHECKED kiln_result kiln_engine_show(kiln_context *context, const kiln_engine *engine,
                                                   const kiln_map *map, double roughness,
                                                   const double (*directions)[3], int count,
                                                   double (*values)[3], kiln_error *error);
/// Writes a cube, given in kiln's directions, as the files that an engine reads, turned so that the
/// engine shows a panorama where its own loader would. `sh` holds the environment's radiance in at
/// least three bands, from which some engines take their diffuse light. `format` is a format of the
/// engine or KILN_FORMAT_AUTO. Either all files appear or none.
KILN_API KILN_CHECKED kiln_result kiln_engine_save(kiln_context *context, const kiln_engine *engine,
                                                   const kiln_map *map, const kiln_sh *sh,
                                                   kiln_format format, const char *path,
                                                   kiln_save_report *report, kiln_error *error);
/// Encodes in memory the files that kiln_engine_save would write. Release the files with
/// kiln_files_free.
KILN_API KILN_CHECKED kiln_result kiln_engine_encode(kiln_context *context,
                                                     const kiln_engine *engine, const kiln_map *map,
                                                     const kiln_sh *sh, kiln_format format,
                                                     const char *name, kiln_files *files,
                                                     kiln_save_report *report, kiln_error *error);

// --------------------------------------------------------------------------- environments, writing

/// Options for saving an environment. {0} saves only the levels, with the harmonics and the name of
/// the lobe in the metadata of formats that have metadata.
typedef struct kiln_environment_save_def {
    /// Engine whose files hold the levels; NULL for the files of kiln_map_save.
    const kiln_engine *engine;
    kiln_format format; ///< format of levels and irradiance
    /// Zstd level of KTX2 files that are not for an engine, 1 to 22; 0 for no compression.
    int zstd;
    const char *irradiance_path; ///< path of the irradiance map; NULL to leave the irradiance out
    /// Path of the harmonics (.json, .txt or .h); NULL for no file of harmonics.
    const char *sh_path;
    /// harmonics to write to sh_path; NULL for the field `sh` of the environment
    const kiln_sh *sh;
    /// Path of the lights (.json), as for kiln_lights_save; NULL for no file of lights.
    const char *lights_path;
    /// Called with the path and the bytes of each file before the file is written, for example to
    /// keep a checksum. May be NULL.
    void (*watch)(void *user, const char *path, const void *bytes, size_t size);
    void *watch_user;
} kiln_environment_save_def;

typedef struct kiln_environment_report {
    int file_count; ///< number of files written in all
    kiln_save_report levels, irradiance;
} kiln_environment_report;

/// Writes an environment: the levels to `path`, irradiance and harmonics to the paths in `def`.
/// Either all files appear or none. `def` and `report` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_environment_save(
    kiln_context *context, const kiln_environment *environment, const char *path,
    const kiln_environment_save_def *def, kiln_environment_report *report, kiln_error *error);
/// Encodes in memory the files that kiln_environment_save would write, the files of the levels
/// first. Release the files with kiln_files_free.
KILN_API KILN_CHECKED kiln_result
kiln_environment_encode(kiln_context *context, const kiln_environment *environment,
                        const char *name, const kiln_environment_save_def *def, kiln_files *files,
                        kiln_environment_report *report, kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
