// kiln/check.h: is this bake right? Prefiltered levels, spherical harmonics and tables of any tool
// are compared with exact values, and what is wrong with them is said in words.
//
// The conventions are those of <kiln/kiln.h>. A check never fails because the file is wrong: the
// report says what was found. docs/check.md explains the numbers and how each fault is recognised.
// SPDX-License-Identifier: MIT
#ifndef KILN_PUBLIC_CHECK_H
#define KILN_PUBLIC_CHECK_H

#include <kiln/brdf.h>

#ifdef __cplusplus
extern "C" {
#endif

// ---------------------------------------------------------------------------------------- findings

/// What a check recognised.
typedef enum kiln_finding_kind {
    KILN_FINDING_AXES = 0,   ///< the axes of the file: as expected, turned or mirrored
    KILN_FINDING_MAPPING,    ///< which roughness the levels have
    KILN_FINDING_BRIGHTNESS, ///< all values are multiplied by one factor
    KILN_FINDING_SHIFT,   ///< texels lie beside their places, or the environment is turned a little
    KILN_FINDING_CLAMPED, ///< bright light is missing
    KILN_FINDING_SEAM,    ///< errors jump at the edges of cube faces
    KILN_FINDING_FIREFLY, ///< single texels are far too bright
    KILN_FINDING_NEGATIVE, ///< texels are below zero
    KILN_FINDING_BASIS,    ///< signs or constants of spherical harmonics
    KILN_FINDING_WEIGHT,   ///< factors of the bands of spherical harmonics: radiance, irradiance
    KILN_FINDING_WINDOW,   ///< a window that reduces ringing
    KILN_FINDING_ORDER,    ///< rows and columns of a table: flipped or transposed
    KILN_FINDING_ENCODING, ///< numbers of a table are stored by a gamma curve
    KILN_FINDING_CONTENT   ///< which functions the channels of a table hold
} kiln_finding_kind;

enum { KILN_MAX_FINDINGS = 24 };

typedef struct kiln_finding {
    kiln_finding_kind kind;
    bool fault; ///< true: something is wrong; false: something to know
    /// A sentence without a capital and a full stop, for example "left and right are swapped".
    char text[KILN_NOTE_TEXT];
} kiln_finding;

typedef struct kiln_findings {
    int count;       ///< number of findings, at most KILN_MAX_FINDINGS
    int fault_count; ///< number of findings that are faults
    kiln_finding finding[KILN_MAX_FINDINGS];
} kiln_findings;

// ------------------------------------------------------------------------------------------ levels

/// Loads all levels of a prefiltered environment, whoever wrote it, in the axes of the file: a cube
/// in a KTX, KTX2 or DDS file; an .env file of Babylon.js or of Galacean Engine; the first light of
/// EXT_lights_image_based in a .glb file; an atlas of three.js (CubeUV) or of PlayCanvas, as a cube
/// of what the engine's shader reads; any file or set of faces that kiln_map_load reads, where
/// `{level}` or `%d` in the path stands for the level; or a folder with the faces that Filament's
/// cmgen writes, m0_px.exr, ... `engine` says whose atlas a flat picture is, and may be NULL for
/// other files and for atlases that kiln wrote. `report` may be NULL. The roughness of a level is
/// -1 where the file does not state the roughness.
KILN_API KILN_CHECKED kiln_result kiln_levels_load(kiln_context *context, const char *path,
                                                   const kiln_engine *engine,
                                                   kiln_load_report *report, kiln_map *map,
                                                   kiln_error *error);

/// How levels are checked. {0} finds out axes and roughness.
typedef struct kiln_check_levels_def {
    /// Engine that the levels are for, whose axes and roughness they should have. NULL: the axes
    /// are found, and the roughness is that of the levels or found.
    const kiln_engine *engine;
    /// True: `roughness` of the map is what each level should be filtered for, unless `engine` says
    /// so. False: the mapping that fits best is found.
    bool stated;
    kiln_lobe_kind lobe; ///< lobe of the levels; KILN_LOBE_GGX by default
} kiln_check_levels_def;

/// What is wrong with one level. Errors are relative, so that 0.01 is one per cent.
typedef struct kiln_check_level {
    int size;         ///< texels along the level's short side
    double roughness; ///< roughness with whose exact level this level was compared
    /// Roughness whose exact level is most like this level; -1 where the level is too small or too
    /// uniform to tell.
    double found;
    /// Root mean square over the sphere of the difference to the exact level, divided by the root
    /// mean square of the exact level.
    double rms;
    double largest; ///< largest difference, divided by the root mean square of the exact level
    double bias;    ///< mean difference, divided by the mean of the exact level
    double energy;  ///< root mean square of the level, divided by that of the exact level
    /// Root mean square of the jumps of the difference at edges of cube faces, as `rms`; 0 for maps
    /// without faces.
    double seam;
    double within;         ///< as `seam`, between neighbouring texels within faces
    size_t firefly_count;  ///< texels more than twice as bright as anything exact near them
    size_t negative_count; ///< texels with a channel below zero
    /// Root mean square difference of the exact level from brute force, at `proof_count` texels,
    /// divided by the root mean square of these. Level 0 of roughness 0 has means over texels and
    /// no proof.
    double proof;
    int proof_count;
} kiln_check_level;

typedef struct kiln_check_levels_report {
    int level_count;
    kiln_check_level level[KILN_MAX_LEVELS];
    double worst; ///< largest `rms` of the levels
    /// The engine of the definition; without one, the first engine that kiln tunes levels for and
    /// whose axes and roughness the levels have, or NULL if there is none.
    const kiln_engine *engine;
    /// The file shows in direction e the light from the panorama's direction d, where d[i] =
    /// sign[i] e[axis[i]].
    int axis[3], sign[3];
    /// The axes that the file should have: those of the engine. Without an engine, those that were
    /// found where an engine has them, and those of kiln elsewhere.
    int wanted_axis[3], wanted_sign[3];
    /// Factor by which all values of the file are too bright; errors are measured after a division
    /// by this factor, which is 1 if it is within 2 % of 1.
    double brightness;
    kiln_findings findings;
} kiln_check_levels_report;

/// Compares levels with exactly filtered levels of `source`, a map of any shape. `levels` has the
/// axes of the file, as kiln_levels_load returns them. If `difference` is not NULL, it receives the
/// levels minus the exact levels, in the panorama's directions. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_check_levels(kiln_context *context, const kiln_map *source,
                                                    const kiln_map *levels,
                                                    const kiln_check_levels_def *def,
                                                    kiln_check_levels_report *report,
                                                    kiln_map *difference, kiln_error *error);

/// Copies levels of a file to the panorama's directions, where `axis` and `sign` are axes as in
/// kiln_check_levels_report. With the axes that a file should have, `map` is what is shown of the
/// file. Only cubes are turned about other axes than y; other maps become what they are.
KILN_API KILN_CHECKED kiln_result kiln_levels_unturn(kiln_context *context, const kiln_map *levels,
                                                     const int axis[3], const int sign[3],
                                                     kiln_map *map, kiln_error *error);

/// Draws the differences that kiln_check_levels returns: for each level a panorama of 256 x 128
/// texels in sRGB from 0 to 1, one below the other. Grey is no difference, red is too bright, blue
/// is too dark, and the full colours stand for three times the root mean square difference of the
/// level.
KILN_API KILN_CHECKED kiln_result kiln_check_picture(kiln_context *context,
                                                     const kiln_map *difference,
                                                     kiln_image *picture, kiln_error *error);

enum { KILN_SHOWN = 19 };

/// How right what an engine shows of levels is: the levels are mixed and interpolated as the
/// engine's shader does. Entry i stands for the roughness 0.1 + 0.05 i.
typedef struct kiln_check_shown_report {
    /// Root mean square difference from brute force over `direction_count` directions, divided by
    /// the root mean square of the values of brute force.
    double rms[KILN_SHOWN];
    double all;   ///< root mean square of `rms`
    double worst; ///< largest of `rms`
    double worst_roughness;
    /// Root mean square difference of x / (x + mean) over all roughnesses, for values x and the
    /// mean of all values of the source. Such a curve shows any light between black, 0, and white,
    /// 1.
    double displayed;
    /// What `all` and `displayed` would be of exact levels of the same sizes and roughness.
    double exact_all, exact_displayed;
    int direction_count;
} kiln_check_shown_report;

/// Compares what an engine that reads levels shows of a cube with brute force, in directions that
/// are spread evenly over the sphere, 192 of them or fewer for panoramas of more than 1024 rows.
/// `levels` has the axes of the engine.
KILN_API KILN_CHECKED kiln_result kiln_check_shown(kiln_context *context, const kiln_map *source,
                                                   const kiln_map *levels,
                                                   const kiln_engine *engine,
                                                   kiln_check_shown_report *report,
                                                   kiln_error *error);

/// Returns whether levels are right: no fault was found, and either every level is within
/// `tolerance` of the exact level, or one of the errors `all` and `displayed` of what the engine
/// shows is more than 1 % smaller than with exact levels, as with levels that are tuned for
/// the engine. `shown` may be NULL or empty. Returns false for an empty report of levels.
KILN_API bool kiln_check_right(const kiln_check_levels_report *levels,
                               const kiln_check_shown_report *shown, double tolerance);

// --------------------------------------------------------------------------------------- harmonics

/// What is wrong with spherical harmonics.
typedef struct kiln_check_sh_report {
    int bands;
    /// Factor of each band between the file and the exact coefficients of what the file claims to
    /// hold, radiance or irradiance. All factors of a right file are 1.
    double band[KILN_MAX_BANDS];
    /// Norm of the difference from the exact coefficients, divided by the norm of these, in the
    /// axes that were found.
    double rms;
    int axis[3], sign[3]; ///< axes of the file, as in kiln_check_levels_report
    kiln_findings findings;
} kiln_check_sh_report;

/// Compares spherical harmonics, in the axes of their file, with those of `source`, a map of any
/// shape. `sh->irradiance` and `sh->window` say what the file claims to hold. `engine`, which may
/// be NULL, is the engine whose axes are expected.
KILN_API KILN_CHECKED kiln_result kiln_check_sh(kiln_context *context, const kiln_map *source,
                                                const kiln_sh *sh, const kiln_engine *engine,
                                                kiln_check_sh_report *report, kiln_error *error);

// ------------------------------------------------------------------------------------------ tables

/// The function that a channel of a table holds.
typedef enum kiln_table_content {
    KILN_HOLDS_UNKNOWN = 0,
    KILN_HOLDS_A,          ///< A of the split sum
    KILN_HOLDS_B,          ///< B of the split sum
    KILN_HOLDS_E,          ///< A + B, the albedo for F = 1
    KILN_HOLDS_COMPLEMENT, ///< 1 - (A + B)
    KILN_HOLDS_SHEEN,      ///< the albedo of Charlie sheen with KILN_SHEEN_ASHIKHMIN
    KILN_HOLDS_ZERO,       ///< 0 everywhere
    KILN_HOLDS_ONE         ///< 1 everywhere
} kiln_table_content;

/// What is wrong with a table.
typedef struct kiln_check_table_report {
    int channels;
    kiln_table_content content[4]; ///< what each channel holds
    kiln_model model;
    kiln_axis axis; ///< axis of n.v
    bool corners;   ///< true: texel i of n lies at i / (n - 1); false: at (i + 1/2) / n
    /// Root mean square and largest difference from the exact values, absolute, after rows and
    /// columns were put in order and a gamma curve was undone, but with texels where they are.
    /// The mean leaves channels out that hold a constant.
    double rms, largest;
    kiln_findings findings;
} kiln_check_table_report;

/// Compares a table of any tool with exact integrals, and finds out what the table holds and how it
/// is stored. The order that is expected is that of kiln_table: n.v grows along rows and roughness
/// along columns, or falls if `flip`. `image` has 1 to 4 channels, at least 12 x 12 texels, and
/// finite numbers.
KILN_API KILN_CHECKED kiln_result kiln_check_table(kiln_context *context, const kiln_image *image,
                                                   bool flip, kiln_check_table_report *report,
                                                   kiln_error *error);
/// Loads the numbers of a table as a file stores them: kiln_image_load, with the sRGB curve of a
/// PNG file left out. *flip says whether a file that kiln wrote states that row 0 holds roughness
/// 1.
KILN_API KILN_CHECKED kiln_result kiln_table_numbers_load(kiln_context *context, const char *path,
                                                          kiln_image *image, bool *flip,
                                                          kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
