#include "maps.h"

#include "check.h"
#include "random.h"

kiln_context *make_context(int threads)
{
    return make_context_for(threads, KILN_CPU_BEST);
}

kiln_context *make_context_for(int threads, enum kiln_cpu cpu)
{
    kiln_error error = {0};
    kiln_context *context = NULL;
    kiln_context_def def = {.thread_count = threads, .cpu = cpu};
    CHECK_OK(kiln_context_create(&def, &context, &error));
    return context;
}

kiln_map make_map(kiln_context *context, kiln_shape shape, int size, int level_count)
{
    kiln_error error = {0};
    kiln_map map;
    CHECK_OK(kiln_map_create(context, shape, size, level_count, &map, &error));
    return map;
}

kiln_map make_panorama(kiln_context *context, int size)
{
    return make_map(context, KILN_SHAPE_PANORAMA, size, 1);
}

kiln_map make_noise(kiln_context *context, kiln_shape shape, int size, uint64_t seed)
{
    kiln_map map = make_map(context, shape, size, 1);
    fill_noise(&map, seed, 0, 1);
    return map;
}

kiln_map make_steps(kiln_context *context, kiln_shape shape, int size, int level_count)
{
    kiln_map map = make_map(context, shape, size, level_count);
    int last = map.level_count > 1 ? map.level_count - 1 : 1;
    for (int k = 0; k < map.level_count; k++) {
        map.roughness[k] = (float)k / (float)last;
        for (size_t i = 0; i < value_count(&map, k); i++)
            map.level[k][i] = (float)((i * 7919 + (size_t)k) % 2048) / 8;
    }
    return map;
}

kiln_environment make_sky_bake(kiln_context *context)
{
    kiln_error error = {0};
    kiln_map sky;
    kiln_environment made;
    kiln_bake_def def = {.levels = {.size = 16}, .irradiance_size = 4};
    CHECK_OK(kiln_sky(context, &(kiln_sky_def){.size = 32}, &sky, &error));
    CHECK_OK(kiln_bake(context, &sky, &def, &made, &error));
    kiln_map_free(&sky);
    return made;
}

size_t value_count(const kiln_map *map, int level)
{
    return 3 * kiln_map_texels(map, level);
}

void fill_constant(kiln_map *map, float value)
{
    for (size_t i = 0; i < value_count(map, 0); i++)
        map->level[0][i] = value;
}

void fill_noise(kiln_map *map, uint64_t seed, double low, double high)
{
    for (size_t i = 0; i < value_count(map, 0); i++)
        map->level[0][i] = (float)random_between(&seed, low, high);
}

void fill_gradient(kiln_map *map, int level, double factor)
{
    for (size_t i = 0; i < kiln_map_texels(map, level); i++) {
        double d[3];
        kiln_map_direction(map, level, i, d);
        for (size_t c = 0; c < 3; c++)
            map->level[level][3 * i + c] = (float)(factor * (2 + d[c]));
    }
}

float *texel_at(const kiln_map *map, int x, int y)
{
    return map->level[0] + 3 * ((size_t)y * 2 * (size_t)map->size + (size_t)x);
}

void panorama_direction(int size, double x, double y, double d[3])
{
    double theta = pi * y / size, phi = pi * x / size - pi;
    d[0] = sin(theta) * sin(phi);
    d[1] = cos(theta);
    d[2] = -sin(theta) * cos(phi);
}

bool same_map(const kiln_map *a, const kiln_map *b)
{
    bool same = a->shape == b->shape && a->size == b->size && a->level_count == b->level_count &&
                a->smallest == b->smallest &&
                !memcmp(a->roughness, b->roughness, (size_t)a->level_count * sizeof(float));
    for (int k = 0; same && k < a->level_count; k++)
        same = !memcmp(a->level[k], b->level[k], value_count(a, k) * sizeof(float));
    return same;
}

void check_same_levels(const kiln_map *a, const kiln_map *b)
{
    assert_int_equal(a->shape, b->shape);
    assert_int_equal(a->size, b->size);
    assert_true(a->level_count <= b->level_count);
    for (int k = 0; k < a->level_count; k++)
        assert_memory_equal(a->level[k], b->level[k], value_count(a, k) * sizeof(float));
}

uint64_t hash_map(const kiln_map *map)
{
    uint64_t hash = 14695981039346656037u;
    for (int k = 0; k < map->level_count; k++) {
        const unsigned char *bytes = (const unsigned char *)map->level[k];
        for (size_t i = 0; i < value_count(map, k) * sizeof(float); i++)
            hash = (hash ^ bytes[i]) * 1099511628211u;
    }
    return hash;
}

double largest_difference(const kiln_map *a, const kiln_map *b, int level, double base)
{
    double worst = 0;
    for (size_t i = 0; i < value_count(a, level); i++) {
        double x = (double)a->level[level][i], y = (double)b->level[level][i];
        worst = fmax(worst, fabs(x - y) / (fabs(y) + base));
    }
    return worst;
}
