// Engines that no test runs here: what kiln writes for them, read again and looked up as their own
// sources say that they do. Level k in direction d holds the radiance (1 + k) (2 + d).
#include "engine/engine.h"

#include <unistd.h>

#include "kit/context.h"

enum { LEVELS_SHOWN = 40, WAYS = 60 };
// Writes the coded cube for an engine, then `name` is what to load of it.
static kiln_map written(const char *engine_name, kiln_format format, int size, const char *output,
                        const char *name)
{
    const kiln_engine *engine = kiln_engine_find(engine_name);
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    kiln_map map, loaded;
    kiln_sh sh = {.bands = 3};
    CHECK_OK(kiln_engine_levels(engine, size, 0, roughness, &def, &error));
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, size, def.level_count, &map, &error));
    for (int k = 0; k < map.level_count; k++)
        fill_gradient(&map, k, 1 + k);
    CHECK_OK(kiln_engine_save(context, engine, &map, &sh, format, in_folder(output), NULL, &error));
    CHECK_OK(kiln_map_load(context, in_folder(name), NULL, &loaded, &error));
    kiln_map_free(&map);
    return loaded;
}

static void spiral(int i, double d[3])
{
    double y = 1 - 2 * (i + 0.5) / WAYS, r = sqrt(1 - y * y);
    d[0] = r * cos(2.4 * i);
    d[1] = y;
    d[2] = r * sin(2.4 * i);
}

// As hardware reads a level that is no whole number.
static void sample(const kiln_map *map, const double way[3], double lod, double rgb[3])
{
    double high[3];
    int low = (int)floor(fmin(lod, map->level_count - 1));
    int next = low + 1 < map->level_count ? low + 1 : low;
    ki_cube_read(map, low, way, rgb);
    ki_cube_read(map, next, way, high);
    for (int c = 0; c < 3; c++)
        rgb[c] += (lod - low) * (high[c] - rgb[c]);
}

// A panorama's (u, v), v downwards, in kiln's directions: the centre is -Z, +X to its right.
static void direction_at(double u, double v, double d[3])
{
    double around = 2 * pi * (u - 0.5), down = pi * v;
    d[0] = sin(around) * sin(down);
    d[1] = cos(down);
    d[2] = -cos(around) * sin(down);
}

// Where a surface of this world direction and roughness looks a cube up.
typedef void (*looks)(const double world[3], double roughness, int level_count, double way[3],
                      double *lod);

// bevy_pbr/src/light_probe/environment_map.wgsl, compute_radiances: the direction's z is negated,
// the level is the roughness times that of the last level.
static void bevy_looks(const double world[3], double roughness, int level_count, double way[3],
                       double *lod)
{
    way[0] = world[0];
    way[1] = world[1];
    way[2] = -world[2];
    *lod = roughness * (level_count - 1);
}

// ImageBasedLighting.hlsl, PerceptualRoughnessToMipmapLevel with UNITY_SPECCUBE_LOD_STEPS 6.
static void unity_looks(const double world[3], double roughness, int level_count, double way[3],
                        double *lod)
{
    (void)level_count;
    memcpy(way, world, 3 * sizeof *way);
    *lod = 6 * roughness * (1.7 - 0.7 * roughness);
}

// Which of kiln's directions a world direction is: Bevy's world is kiln's.
static void bevy_shows(const double world[3], double d[3])
{
    memcpy(d, world, 3 * sizeof *d);
}

// Skybox-Panoramic.shader, ToRadialCoords: (0.5, 1) - (atan2(z, x) / 2 pi, acos(y) / pi), v
// upwards.
static void unity_shows(const double world[3], double d[3])
{
    direction_at(0.5 - atan2(world[2], world[0]) / (2 * pi), acos(world[1]) / pi, d);
}

static void check_shown(const char *name, const kiln_map *map, kiln_format format, looks look,
                        void (*shows)(const double[3], double[3]))
{
    const kiln_engine *engine = kiln_engine_find(name);
    // Texels of the coarsest level that is read are an eighth of a face wide. A block of BC6H is
    // then half a face, over which its few colours cannot follow three axes: finer levels are its
    // proof.
    const double finest = format == KILN_FORMAT_BC6H ? 2 : KILN_MAX_LEVELS;
    for (int j = 0; j <= LEVELS_SHOWN; j++)
        for (int i = 0; i < WAYS; i++) {
            double world[3], way[3], d[3], rgb[3], lod, r = (double)j / LEVELS_SHOWN;
            spiral(i, world);
            look(world, r, map->level_count, way, &lod);
            if (lod > finest)
                continue;
            shows(world, d);
            sample(map, way, lod, rgb);
            CHECK_NEAR(lod, kiln_engine_level(engine, r, map->size, map->level_count), 1e-12);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(rgb[c] / (1 + lod), 2 + d[c], format == KILN_FORMAT_BC6H ? 0.03 : 0.02);
        }
}

static void bevy_reads_each_level_where_it_lies(void **state)
{
    (void)state;
    const kiln_format *format = kiln_engine_find("bevy")->formats;
    kiln_map map;
    for (int i = 0; format[i] != KILN_FORMAT_AUTO; i++) {
        map = written("bevy", format[i], 256, "b", "b_specular.ktx2");
        assert_int_equal(map.level_count, 5);
        check_shown("bevy", &map, format[i], bevy_looks, bevy_shows);
        kiln_map_free(&map);
    }
    map = written("bevy", KILN_FORMAT_AUTO, 256, "b", "b_diffuse.ktx2");
    assert_int_equal(map.size, 16);
    assert_int_equal(map.level_count, 1);
    for (int i = 0; i < WAYS; i++) {
        double world[3], way[3], rgb[3], lod;
        spiral(i, world);
        bevy_looks(world, 0, 1, way, &lod);
        sample(&map, way, 0, rgb);
        for (int c = 0; c < 3;
             c++) // the last of five levels: 5 (2 + d) in steps of 1/32, edges wider
            CHECK_NEAR(rgb[c] / 5, 2 + world[c], 0.015);
    }
    kiln_map_free(&map);
    unlink(in_folder("b_specular.ktx2"));
    unlink(in_folder("b_diffuse.ktx2"));
}

static void unity_reads_each_level_where_it_lies(void **state)
{
    (void)state;
    const kiln_format *format = kiln_engine_find("unity")->formats;
    for (int i = 0; format[i] != KILN_FORMAT_AUTO; i++) {
        kiln_map map = written("unity", format[i], 512, "u.dds", "u.dds");
        assert_int_equal(map.level_count, 10);
        check_shown("unity", &map, format[i], unity_looks, unity_shows);
        kiln_map_free(&map);
    }
    unlink(in_folder("u.dds"));
}

// Godot's sky.glsl: SKY_COORDS = (atan2(x, -z) / 2 pi, wrapped to 0 to 1; acos(y) / pi). The
// picture that lies in these coordinates is the one that was baked: kiln's direction of the same
// (u, v). Unreal's file has the same pixels.
static void panoramas_lie_as_they_were_read(void **state)
{
    (void)state;
    static const char *const names[2][2] = {{"godot", "g.exr"}, {"unreal", "g.hdr"}};
    for (int n = 0; n < 2; n++) {
        kiln_map map = written(names[n][0], KILN_FORMAT_AUTO, 64, names[n][1], names[n][1]);
        assert_int_equal(map.shape, KILN_SHAPE_PANORAMA);
        assert_int_equal(map.size, 128);
        for (int i = 0; i < WAYS; i++) {
            double world[3], d[3];
            spiral(i, world);
            double u = atan2(world[0], -world[2]) / (2 * pi), v = acos(world[1]) / pi;
            u = u < 0 ? u + 1 : u;
            direction_at(u, v, d);
            size_t x = (size_t)(u * 256), y = (size_t)(v * 128);
            for (size_t c = 0; c < 3; c++)
                CHECK_NEAR((double)map.level[0][3 * (y * 256 + x) + c], 2 + d[c], 0.03);
        }
        kiln_map_free(&map);
        unlink(in_folder(names[n][1]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bevy_reads_each_level_where_it_lies),
        cmocka_unit_test(unity_reads_each_level_where_it_lies),
        cmocka_unit_test(panoramas_lie_as_they_were_read),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_empty_folder);
}
