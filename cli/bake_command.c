// The command kiln bake: reads the options, then bakes one environment or several.
#include "bake.h"

static int run(const cli_call *call)
{
    bake b = {0};
    int code = bake_read_options(&b, &cli_bake, call);
    if (code != CLI_GO)
        return code;
    return bake_is_for_several(&b) ? bake_run_several(&b) : bake_run(&b);
}

static const cli_example examples[] = {
    {"kiln bake city.exr -o city.ktx2",
     "one file with a cube of 256 and nine levels filtered by GGX"},
    {"kiln bake city.exr -o city.ktx2 --zstd --irradiance diffuse.ktx2 --sh sh.json",
     "the cube compressed, an irradiance cube, and spherical harmonics"},
    {"kiln bake 'face_%s.png' -o out.dds --format b10g11r11 --roughness 0,0.25,0.5,1",
     "reads six faces, and writes four levels of the given roughnesses"},
    {"kiln bake city.exr --for three -o city.ktx2", "the file that three.js loads"},
    {"kiln bake city.exr -o city.ktx2 --sun extract --lights-file sun.json",
     "the environment without its sun, and the sun for a directional light"},
    {"kiln bake *.hdr -o 'out/{name}.ktx2'",
     "bakes every environment of the folder to a file of its own"},
    {"kiln bake city.exr -o 'level_%d.hdr' --shape panorama --method textbook",
     "panoramas by importance sampling as courses teach, for comparison"},
    {NULL, NULL}};

const cli_command cli_bake = {
    .name = "bake",
    .arguments = "IN... -o OUT [OPTION...]",
    .summary = "Bakes a panorama into a prefiltered environment.",
    .about =
        "IN is a panorama, cross, strip, octahedron or cube (EXR, HDR, PNG, JPEG, KTX2, DDS, KTX), "
        "a "
        "folder "
        "or pattern of six faces, six files, or - for standard input. In a pattern, and in OUT, %s "
        "or {face} stands for the face; in OUT, %d or {level} stands for the level. If OUT holds "
        "{name}, each IN is an environment of its own, and {name} stands for its file name without "
        "the ending.",
    .more = "What a file says about its colours is honoured. Of KTX2, DDS and KTX files kiln reads "
            "level 0 of a cube or a "
            "2-D texture with 8 or 16 bits, 16-bit or 32-bit floats, or BC6H. "
            "Names of six faces are px nx py ny pz nz, posx negx ..., +x -x ..., right left top "
            "bottom front back, or rt lf up dn ft bk, which are oriented as Quake and Source draw "
            "a sky; see docs/conventions.md. Six files with such names may come in any order; "
            "other six files are taken as +X, -X, +Y, -Y, +Z, -Z.\n\nIf a bake takes longer than "
            "half a second and standard error is a terminal, a "
            "line on standard error shows the progress.",
    .examples = examples,
    .options = bake_options,
    .run = run,
};
