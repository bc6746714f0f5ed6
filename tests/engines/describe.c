// What is written for each engine is described as what it is: format, layout, levels, roughness,
// harmonics.
#include "codec/formats.h"
#include "engine/engine.h"

#include "kit/context.h"

// Harmonics no two of which are alike, up to a fourth band, which no engine's file keeps.
static kiln_sh harmonics(void)
{
    kiln_sh sh = {.bands = 4};
    for (int i = 0; i < 48; i++)
        sh.c[i / 3][i % 3] = 3 - i * 0.171 + (i % 5) * 0.33;
    return sh;
}

static void save(const char *name, int size, kiln_format format, const char *output,
                 float roughness[KILN_MAX_LEVELS], int *level_count)
{
    const kiln_engine *engine = kiln_engine_find(name);
    kiln_prefilter_def def;
    const kiln_sh sh = harmonics();
    CHECK_OK(kiln_engine_levels(engine, size, 0, roughness, &def, &error));
    kiln_map map = {.shape = KILN_SHAPE_CUBE,
                    .size = def.size,
                    .level_count = def.level_count,
                    .smallest = def.smallest};
    CHECK_OK(ki_map_allocate(context, &map, &error));
    for (int k = 0; k < map.level_count; k++) {
        map.roughness[k] = roughness[k];
        for (size_t i = 0; i < 3 * kiln_map_texels(&map, k); i++)
            map.level[k][i] = (float)(1 + i % 7);
    }
    CHECK_OK(kiln_engine_save(context, engine, &map, &sh, format, in_folder(output), NULL, &error));
    *level_count = map.level_count;
    kiln_map_free(&map);
}

static void check_harmonics(const char *name, const kiln_file_info *info)
{
    kiln_sh sh = harmonics(), turned;
    sh.bands = 3;
    ki_turn_sh(&sh, &ki_recipe_of(kiln_engine_find(name))->axes, &turned);
    assert_int_equal(info->sh_bands, 3);
    assert_false(info->sh_irradiance);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)info->sh[i][c], turned.c[i][c], 2e-6);
}

typedef struct expected {
    const char *engine;
    int size;
    kiln_format format;
    const char *output, *name; // what is saved, and the file of it that is described
    const char *file_format, *encoding, *layout, *said; // said: the engine that the file names
    int width, height, faces, levels, channels;
    enum { NO_LEVELS, ALL_LEVELS, FIRST_LEVEL, LAST_LEVEL } roughness;
    bool writer, harmonics;
} expected;

#if KILN_TEST_ZSTD
#define UASTC_FILE "uastc, zstd"
#else
#define UASTC_FILE "uastc"
#endif

static const expected table[] = {
    {"three", 64, 0, "a.ktx2", "a.ktx2", "ktx2", "rgb9e5", "cube", "", 64, 64, 6, 4, 3, ALL_LEVELS,
     true, true},
    {"three", 64, KILN_FORMAT_RGBA16F, "a.ktx2", "a.ktx2", "ktx2", "rgba16f", "cube", "", 64, 64, 6,
     4, 4, ALL_LEVELS, true, true},
    {"three-cubeuv", 128, 0, "a.exr", "a.exr", "exr", "half rgb, zip", "cubeuv", "three-cubeuv",
     336, 256, 1, 9, 3, ALL_LEVELS, true, false},
    {"three-cubeuv", 128, KILN_FORMAT_UASTC, "a3.ktx2", "a3.ktx2", "ktx2", UASTC_FILE, "cubeuv",
     "three-cubeuv", 336, 256, 1, 9, 3, ALL_LEVELS, true, false},
    {"babylon", 32, 0, "a.env", "a.env", "env", "rgbd, png", "cube", "babylon", 32, 32, 6, 6, 3,
     ALL_LEVELS, false, true},
    {"babylon-dds", 32, 0, "b.dds", "b.dds", "dds", "rgba16f", "cube", "", 32, 32, 6, 6, 4,
     NO_LEVELS, false, false},
    {"filament", 64, 0, "f", "f_ibl.ktx", "ktx1", "b10g11r11", "cube", "filament", 64, 64, 6, 3, 3,
     ALL_LEVELS, true, true},
    {"filament", 64, KILN_FORMAT_RGBA16F, "g", "g_ibl.ktx", "ktx1", "rgba16f", "cube", "filament",
     64, 64, 6, 3, 4, ALL_LEVELS, true, true},
    {"filament", 64, 0, "f", "f_skybox.ktx", "ktx1", "b10g11r11", "cube", "filament", 64, 64, 6, 1,
     3, FIRST_LEVEL, true, false},
    {"playcanvas", 512, 0, "p.png", "p.png", "png", "8 bits rgbp", "atlas", "playcanvas", 512, 512,
     1, 6, 3, ALL_LEVELS, true, false},
    {"playcanvas-dds", 512, 0, "p.dds", "p.dds", "dds", "rgba16f", "atlas", "playcanvas-dds", 512,
     512, 1, 1, 4, NO_LEVELS, true, false},
    {"cesium", 64, 0, "c", "c.ktx2", "ktx2", "rgba16f", "cube", "", 64, 64, 6, 5, 4, ALL_LEVELS,
     true, true},
    {"cesium", 64, 0, "c", "c_sh.json", "json", "text", "harmonics", "cesium", 9, 1, 1, 1, 3,
     NO_LEVELS, false, true},
    {"galacean", 32, 0, "n.env", "n.env", "galacean env", "8 bits rgbm", "cube", "galacean", 32, 32,
     6, 6, 3, ALL_LEVELS, false, true},
    {"gltf", 64, 0, "g.glb", "g.glb", "glb", "rgbd, png", "cube", "gltf", 64, 64, 6, 3, 3,
     ALL_LEVELS, true, true},
    {"bevy", 64, 0, "v", "v_specular.ktx2", "ktx2", "rgb9e5", "cube", "", 64, 64, 6, 3, 3,
     ALL_LEVELS, true, false},
    {"bevy", 64, KILN_FORMAT_BC6H, "v", "v_diffuse.ktx2", "ktx2", "bc6h", "cube", "", 16, 16, 6, 1,
     3, LAST_LEVEL, true, false},
    {"unity", 64, 0, "u.dds", "u.dds", "dds", "rgba16f", "cube", "", 64, 64, 6, 7, 4, NO_LEVELS,
     false, false},
    {"model-viewer", 32, 0, "m.jpg", "m.jpg", "jpeg", "8 bits rgb, srgb, gain map", "panorama", "",
     128, 64, 1, 1, 3, NO_LEVELS, false, false},
    {"godot", 32, 0, "d.exr", "d.exr", "exr", "half rgb, zip", "panorama", "", 128, 64, 1, 1, 3,
     NO_LEVELS, true, false},
    {"unreal", 32, 0, "r.hdr", "r.hdr", "hdr", "rgbe, rle", "panorama", "", 128, 64, 1, 1, 3,
     NO_LEVELS, true, false},
};

static void check(const expected *e)
{
    float roughness[KILN_MAX_LEVELS];
    char writer[32];
    int count;
    kiln_file_info info;
    save(e->engine, e->size, e->format, e->output, roughness, &count);
    CHECK_OK(kiln_file_describe(context, in_folder(e->name), &info, &error));
    assert_string_equal(info.format, e->file_format);
    assert_string_equal(info.encoding, e->encoding);
    assert_string_equal(info.layout, e->layout);
    assert_string_equal(info.engine, e->said);
    snprintf(writer, sizeof writer, "kiln %s", kiln_version());
    assert_string_equal(info.writer, e->writer ? writer : "");
    assert_int_equal(info.width, e->width);
    assert_int_equal(info.height, e->height);
    assert_int_equal(info.face_count, e->faces);
    assert_int_equal(info.level_count, e->levels);
    assert_int_equal(info.channel_count, e->channels);
    for (int k = 0; k < e->levels; k++) {
        double wanted = e->roughness == NO_LEVELS    ? -1
                        : e->roughness == LAST_LEVEL ? (double)roughness[count - 1]
                                                     : (double)roughness[k];
        CHECK_NEAR((double)info.roughness[k], wanted, 1e-7);
    }
    if (e->harmonics)
        check_harmonics(e->engine, &info);
    else
        assert_int_equal(info.sh_bands, 0);
}

static void every_engines_files_are_described(void **state)
{
    (void)state;
    enum { ROWS = sizeof table / sizeof *table };
    for (int i = 0; i < ROWS; i++)
        if (engine_is_written(kiln_engine_find(table[i].engine)))
            check(&table[i]);
    for (int i = 0; kiln_engine_at(i); i++) {
        bool found = false;
        for (int k = 0; k < ROWS; k++)
            found = found || !strcmp(table[k].engine, kiln_engine_at(i)->name);
        if (!found)
            fail_msg("%s is in no row", kiln_engine_at(i)->name);
    }
}

// Filament's harmonics stand beside its cube as text too.
static void filaments_text_is_described(void **state)
{
    (void)state;
    kiln_file_info info;
    CHECK_OK(kiln_file_describe(context, in_folder("sh.txt"), &info, &error));
    assert_string_equal(info.format, "text");
    assert_string_equal(info.layout, "harmonics");
    assert_string_equal(info.engine, "filament");
    check_harmonics("filament", &info);
}

// Files that are described alone, and atlases, whose sides look like a cross, are no environments.
static void what_is_not_read_says_what_it_is(void **state)
{
    (void)state;
    static const char *const names[][2] = {
        {"a.env", "is a .env file, which kiln writes and describes but does not read"},
        {"n.env", "is a .env file, which kiln writes and describes but does not read"},
        {"c_sh.json", "is a .json file, which kiln writes and describes but does not read"},
        {"g.glb", "is a .glb file, which kiln writes and describes but does not read"},
        {"a.exr", "is the atlas of three-cubeuv, which kiln describes but does not read"},
        {"a3.ktx2", "is the atlas of three-cubeuv, which kiln describes but does not read"},
        {"p.png", "is the atlas of playcanvas, which kiln describes but does not read"},
        {"p.dds", "is the atlas of playcanvas-dds, which kiln describes but does not read"}};
    kiln_map map;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(kiln_map_load(context, in_folder(names[i][0]), NULL, &map, &error),
                         KILN_ERROR_UNSUPPORTED);
        if (!strstr(error.message, names[i][1]) || !strstr(error.message, names[i][0]))
            fail_msg("%s", error.message);
    }
}

// Returns the sum of all texels of a block of 4 x 4.
static double light_of_block(const kiln_image *image, int x, int y)
{
    double sum = 0;
    for (int row = y; row < y + 4; row++)
        for (int i = 3 * x; i < 3 * (x + 4); i++)
            sum += (double)image->pixels[(ptrdiff_t)3 * image->width * row + i];
    return sum;
}

// The rows of the KTX2 picture stand from below in the file, and are read from the top like those
// of the EXR picture: both have the same black blocks, and block compression loses a few percent of
// the light at most.
static void the_atlas_is_the_same_in_blocks(void **state)
{
    (void)state;
    kiln_image halfs, blocks;
    double sums[2] = {0};
    CHECK_OK(kiln_image_load(context, in_folder("a.exr"), &halfs, &error));
    CHECK_OK(kiln_image_load(context, in_folder("a3.ktx2"), &blocks, &error));
    assert_int_equal(blocks.width, halfs.width);
    assert_int_equal(blocks.height, halfs.height);
    for (int y = 0; y < halfs.height; y += 4)
        for (int x = 0; x < halfs.width; x += 4) {
            double a = light_of_block(&halfs, x, y), b = light_of_block(&blocks, x, y);
            assert_int_equal(a > 0, b > 0);
            sums[0] += a;
            sums[1] += b;
        }
    CHECK_NEAR(sums[1], sums[0], 0.05 * sums[0]);
    kiln_image_free(&halfs);
    kiln_image_free(&blocks);
}

// Filament's KTX 1 file is read as what it is, a cube, by its first level.
static void filaments_cube_is_read(void **state)
{
    (void)state;
    kiln_file_info info;
    kiln_map map;
    CHECK_OK(kiln_file_describe(context, in_folder("f_ibl.ktx"), &info, &error));
    CHECK_OK(kiln_map_load(context, in_folder("f_ibl.ktx"), NULL, &map, &error));
    assert_int_equal(map.shape, KILN_SHAPE_CUBE);
    assert_int_equal(map.size, info.width);
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_engines_files_are_described),
        cmocka_unit_test(filaments_text_is_described),
        cmocka_unit_test(the_atlas_is_the_same_in_blocks),
        cmocka_unit_test(filaments_cube_is_read),
        cmocka_unit_test(what_is_not_read_says_what_it_is),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_folder);
}
