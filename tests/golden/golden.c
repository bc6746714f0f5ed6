// The bits that kiln makes on every machine, by every compiler, with every instruction set: one
// hash a line of hashes.txt, which this program computes and compares.
//
//   golden HASHES           computes every hash with each instruction set of this processor, compares
//   golden HASHES --quick   leaves the long ones out, for processors that are emulated
//   golden HASHES --update  writes the file anew; then CHANGELOG.md says under Output what changed
//
// It sees the public headers only and needs no test framework, so that it is built wherever kiln
// is. Files are written to the current folder and removed.
#include "kit/scene.h"

#include <kiln/brdf.h>

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static kiln_error error;

static void check(kiln_result result, const char *what)
{
    if (result == KILN_OK)
        return;
    fprintf(stderr, "golden: %s: %s\n", what, error.message);
    exit(1);
}

#define CHECK(call) check((call), #call)

// ------------------------------------------------------------------------------------------ hashes

static const uint64_t fnv_begin = 14695981039346656037u, fnv_prime = 1099511628211u; // FNV-1a

static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * fnv_prime;
    return hash;
}

static uint64_t hash_map(uint64_t hash, const kiln_map *map)
{
    for (int level = 0; level < map->level_count; level++)
        hash = hash_bytes(hash, map->level[level], kiln_map_texels(map, level) * 3 * sizeof(float));
    return hash;
}

static uint64_t hash_sh(uint64_t hash, const kiln_sh *sh)
{
    for (int k = 0; k < 25; k++) {
        uint64_t bits;
        memcpy(&bits, &sh->c[k][0], sizeof bits);
        hash = hash * fnv_prime + bits;
    }
    return hash;
}

// The hash of a file that is here, which is removed.
static uint64_t hash_file(const char *name)
{
    unsigned char bytes[4096];
    uint64_t hash = fnv_begin;
    FILE *file = fopen(name, "rb");
    if (!file) {
        perror(name);
        exit(1);
    }
    for (size_t size; (size = fread(bytes, 1, sizeof bytes, file)) > 0;)
        hash = hash_bytes(hash, bytes, size);
    fclose(file);
    remove(name);
    return hash;
}

// ---------------------------------------------------------------------------------- what is hashed

static kiln_map make_panorama(kiln_context *context, int size, uint32_t seed)
{
    kiln_map map;
    CHECK(kiln_map_create(context, KILN_SHAPE_PANORAMA, size, 1, &map, &error));
    scene_fill(&map, seed);
    return map;
}

// A tall spectrum, a width that is no power of two, a lobe too narrow for the spectrum: every
// kernel.
static const int sizes[] = {40, 128, 98};

static uint64_t levels(kiln_context *context)
{
    static const float roughness[] = {0.02f, 0.3f, 0.9f};
    uint64_t hash = 0;
    for (int i = 0; i < 3; i++) {
        kiln_map in = make_panorama(context, sizes[i], 17u + (uint32_t)i), out;
        kiln_prefilter_def def = {.size = i == 2 ? 8 : 64, .rotation = i * 20.0};
        if (i == 2) {
            def.level_count = 3;
            def.roughness = roughness;
        }
        CHECK(kiln_prefilter(context, &in, &def, &out, &error));
        hash = hash * 31 + hash_map(fnv_begin, &out);
        kiln_map_free(&out);
        kiln_map_free(&in);
    }
    return hash;
}

static uint64_t levels_small(kiln_context *context)
{
    static const float roughness[] = {0, 0.2f, 0.5f, 1};
    kiln_map in = make_panorama(context, 22, 9), out;
    kiln_prefilter_def def = {.size = 16, .level_count = 4, .roughness = roughness, .rotation = 70};
    CHECK(kiln_prefilter(context, &in, &def, &out, &error));
    uint64_t hash = hash_map(fnv_begin, &out);
    kiln_map_free(&out);
    kiln_map_free(&in);
    return hash;
}

static uint64_t harmonics(kiln_context *context)
{
    uint64_t hash = 0;
    for (int i = 0; i < 3; i++) {
        kiln_map in = make_panorama(context, sizes[i], 17u + (uint32_t)i);
        kiln_spectrum *spectrum;
        kiln_sh sh;
        CHECK(kiln_spectrum_analyze(context, &in, 0, &spectrum, &error));
        CHECK(kiln_spectrum_sh(spectrum, 5, false, 0, 10, &sh, &error));
        hash = hash_sh(hash, &sh);
        kiln_spectrum_destroy(spectrum);
        kiln_map_free(&in);
    }
    return hash;
}

static uint64_t irradiance(kiln_context *context)
{
    kiln_map in = make_panorama(context, 40, 5), out;
    kiln_prefilter_def def = {.size = 16, .level_count = 1, .lobe = KILN_LOBE_LAMBERT};
    CHECK(kiln_prefilter(context, &in, &def, &out, &error));
    uint64_t hash = hash_map(fnv_begin, &out);
    kiln_map_free(&out);
    kiln_map_free(&in);
    return hash;
}

static kiln_map make_checks(kiln_context *context, int size)
{
    kiln_map map;
    CHECK(kiln_map_create(context, KILN_SHAPE_PANORAMA, size, 1, &map, &error));
    scene_checks(&map);
    return map;
}

// Levels of `size` texels tuned for what an engine shows.
static uint64_t tune(kiln_context *context, uint64_t hash, const char *name, int size, bool soft)
{
    kiln_map in = make_checks(context, 4 * size), out;
    const kiln_engine *engine = kiln_engine_find(name);
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    CHECK(kiln_engine_levels(engine, size, 0, roughness, &def, &error));
    def.tune_for = engine;
    def.tune_soft = soft;
    CHECK(kiln_prefilter(context, &in, &def, &out, &error));
    hash = hash_map(hash, &out);
    kiln_map_free(&out);
    kiln_map_free(&in);
    return hash;
}

static uint64_t tuned(kiln_context *context)
{
    uint64_t hash = tune(context, fnv_begin, "three", 32, false);
    hash = tune(context, hash, "babylon", 32, true);
    return tune(context, hash, "filament", 32, false);
}

static uint64_t tuned_small(kiln_context *context)
{
    return tune(context, fnv_begin, "three", 16, false);
}

static uint64_t one_table(kiln_context *context, const kiln_table_def *def)
{
    kiln_table table;
    CHECK(kiln_table_create(context, def, &table, &error));
    const kiln_image *image = &table.image;
    size_t value_count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    uint64_t hash = hash_bytes(fnv_begin, image->pixels, value_count * sizeof(float));
    kiln_table_free(&table);
    return hash;
}

// Small enough for each texel's own integral, and large enough for the series.
static uint64_t table_dfg(kiln_context *context)
{
    return one_table(context, &(kiln_table_def){.kind = KILN_TABLE_DFG, .width = 16, .height = 8});
}

static uint64_t table_e(kiln_context *context)
{
    return one_table(context, &(kiln_table_def){.axis = KILN_AXIS_GRAZING});
}

static uint64_t table_walk(kiln_context *context)
{
    return one_table(
        context,
        &(kiln_table_def){
            .kind = KILN_TABLE_E_WALK, .width = 6, .height = 4, .depth = 2, .path_count = 256});
}

static uint64_t table_lobes(kiln_context *context)
{
    uint64_t hash = 0;
    for (int taps = 1; taps <= KILN_MAX_TAPS; taps++)
        hash = hash * 31 + one_table(context, &(kiln_table_def){.kind = KILN_TABLE_LOBES,
                                                                .width = 6,
                                                                .height = 7,
                                                                .tap_count = taps,
                                                                .level_count = 4});
    return hash;
}

static uint64_t sky(kiln_context *context)
{
    kiln_map map;
    CHECK(kiln_sky(context, &(kiln_sky_def){.size = 32}, &map, &error));
    uint64_t hash = hash_map(fnv_begin, &map);
    kiln_map_free(&map);
    return hash;
}

// A map of sides that are no multiple of a block's, written as a file of one kind.
static uint64_t file_of(kiln_context *context, kiln_shape shape, const char *name,
                        kiln_format format)
{
    kiln_map in = make_panorama(context, 20, 3), map;
    kiln_save_def def = {.format = format};
    CHECK(kiln_map_convert(context, &in, shape, 18, 0, &map, &error));
    CHECK(kiln_map_save(context, &map, name, &def, NULL, &error));
    kiln_map_free(&map);
    kiln_map_free(&in);
    return hash_file(name);
}

static uint64_t file_hdr(kiln_context *context)
{
    return file_of(context, KILN_SHAPE_PANORAMA, "golden.hdr", KILN_FORMAT_AUTO);
}

static uint64_t file_exr(kiln_context *context)
{
    return file_of(context, KILN_SHAPE_PANORAMA, "golden.exr", KILN_FORMAT_AUTO);
}

static uint64_t file_png(kiln_context *context)
{
    return file_of(context, KILN_SHAPE_PANORAMA, "golden.png", KILN_FORMAT_RGBM);
}

static uint64_t file_ktx2(kiln_context *context)
{
    return file_of(context, KILN_SHAPE_CUBE, "golden.ktx2", KILN_FORMAT_RGB9E5);
}

static uint64_t file_dds(kiln_context *context)
{
    return file_of(context, KILN_SHAPE_CUBE, "golden.dds", KILN_FORMAT_BC6H);
}

static uint64_t uastc(kiln_context *context)
{
    return file_of(context, KILN_SHAPE_CUBE, "golden.ktx2", KILN_FORMAT_UASTC);
}

// Numbers as text.
static uint64_t file_sh_json(kiln_context *context)
{
    kiln_map in = make_panorama(context, 40, 7);
    kiln_spectrum *spectrum;
    kiln_sh sh;
    CHECK(kiln_spectrum_analyze(context, &in, 8, &spectrum, &error));
    CHECK(kiln_spectrum_sh(spectrum, 3, true, 0, 0, &sh, &error));
    CHECK(kiln_sh_save(context, &sh, "golden.json", &error));
    kiln_spectrum_destroy(spectrum);
    kiln_map_free(&in);
    return hash_file("golden.json");
}

typedef struct entry {
    const char *name;
    uint64_t (*compute)(kiln_context *context);
    bool slow;       // takes a second or more
    uint64_t wanted; // as hashes.txt has it; 0 where it has none
} entry;

static entry entries[] = {
    {"levels", levels, true, 0},
    {"levels-small", levels_small, false, 0},
    {"harmonics", harmonics, false, 0},
    {"irradiance", irradiance, false, 0},
    {"tuned", tuned, true, 0},
    {"tuned-small", tuned_small, false, 0},
    {"table-dfg", table_dfg, false, 0},
    {"table-e", table_e, false, 0},
    {"table-walk", table_walk, false, 0},
    {"table-lobes", table_lobes, false, 0},
    {"sky", sky, false, 0},
    {"file-hdr", file_hdr, false, 0},
    {"file-exr", file_exr, false, 0},
    {"file-png-rgbm", file_png, false, 0},
    {"file-ktx2", file_ktx2, false, 0},
    {"file-dds-bc6h", file_dds, false, 0},
    {"uastc", uastc, false, 0},
    {"file-json", file_sh_json, false, 0},
};
enum { ENTRIES = sizeof entries / sizeof *entries };

// ---------------------------------------------------------------------------------------- the file

static void read_hashes(const char *path)
{
    char line[256], name[64];
    FILE *file = fopen(path, "r");
    for (unsigned long long hash; file && fgets(line, sizeof line, file);)
        if (line[0] != '#' && sscanf(line, "%63s %llx", name, &hash) == 2)
            for (int i = 0; i < ENTRIES; i++)
                if (!strcmp(name, entries[i].name))
                    entries[i].wanted = hash;
    if (file)
        fclose(file);
}

static void write_hashes(const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file) {
        perror(path);
        exit(1);
    }
    fputs("# FNV-1a of what tests/golden/golden.c computes, on every machine. Written by golden "
          "--update.\n",
          file);
    for (int i = 0; i < ENTRIES; i++)
        fprintf(file, "%-14s %016llx\n", entries[i].name, (unsigned long long)entries[i].wanted);
    fclose(file);
}

// Number of threads for an instruction set: a different number for each, because the bits must not
// depend on it. The two sets that every processor has run with three threads and with one.
static int threads_for(int cpu)
{
#if defined(__EMSCRIPTEN__) // built without threads
    (void)cpu;
    return 1;
#else
    static const int threads[] = {3, 1, 2, 4};
    return threads[cpu - KILN_CPU_SCALAR];
#endif
}

typedef enum golden_mode { COMPARE, QUICK, UPDATE } golden_mode;

// Computes hashes with one instruction set; returns how many are wrong. With UPDATE the first set,
// scalar, says what is right.
static int compare(kiln_context *context, golden_mode mode)
{
    const char *set = kiln_context_cpu(context);
    int wrong = 0, computed = 0;
    for (int i = 0; i < ENTRIES; i++) {
        entry *e = &entries[i];
        if (mode == QUICK && e->slow)
            continue;
        uint64_t hash = e->compute(context);
        computed++;
        if (mode == UPDATE && !strcmp(set, "scalar"))
            e->wanted = hash;
        if (hash == e->wanted)
            continue;
        printf("%s: %s is %016llx, wanted %016llx\n", set, e->name, (unsigned long long)hash,
               (unsigned long long)e->wanted);
        wrong++;
    }
    printf("%s: %d of %d hashes are right\n", set, computed - wrong, computed);
    fflush(stdout);
    return wrong;
}

int main(int argc, char **argv)
{
    golden_mode mode = argc < 3 ? COMPARE : !strcmp(argv[2], "--quick") ? QUICK : UPDATE;
    if (argc < 2 || argc > 3 || (mode == UPDATE && strcmp(argv[2], "--update") != 0)) {
        fputs("golden HASHES [--quick | --update]\n", stderr);
        return 2;
    }
    if (mode != UPDATE)
        read_hashes(argv[1]);
    int wrong = 0;
    char last[16] = "";
    for (int cpu = KILN_CPU_SCALAR; cpu <= KILN_CPU_AVX512; cpu++) {
        kiln_context_def def = {.thread_count = threads_for(cpu), .cpu = (kiln_cpu)cpu};
        kiln_context *context;
        CHECK(kiln_context_create(&def, &context, &error));
        if (strcmp(last, kiln_context_cpu(context)) != 0) // else more than this processor has
            wrong += compare(context, mode);
        snprintf(last, sizeof last, "%s", kiln_context_cpu(context));
        kiln_context_destroy(context);
    }
    if (mode == UPDATE && !wrong)
        write_hashes(argv[1]);
    return wrong ? 1 : 0;
}
