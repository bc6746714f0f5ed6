// Resampling by area: laws, and an independent slow sum.
#include "kit/kit.h"

#include "image/image.h"
#include "image/resample.h"

static kiln_error error;

static kiln_map convert(kiln_context *context, const kiln_map *source, kiln_shape shape, int size,
                        double rotation)
{
    kiln_map map;
    CHECK_OK(kiln_map_convert(context, source, shape, size, rotation, &map, &error));
    return map;
}

// Texels without any likeness to their neighbours, some of them ten times brighter.
static void fill_spiky(kiln_map *map, uint64_t seed)
{
    for (size_t i = 0; i < value_count(map, 0); i++) {
        float value = (float)random_number(&seed);
        map->level[0][i] = random_bits(&seed) % 50 ? value : 10 * value;
    }
}

// A triangle's solid angle, Van Oosterom and Strackee 1983.
static double triangle(const double a[3], const double b[3], const double c[3])
{
    double det = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                 a[2] * (b[0] * c[1] - b[1] * c[0]);
    double la = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    double lb = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    double lc = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    double ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    double bc = b[0] * c[0] + b[1] * c[1] + b[2] * c[2];
    double ca = c[0] * a[0] + c[1] * a[1] + c[2] * a[2];
    return 2 * fabs(atan2(det, la * lb * lc + ab * lc + bc * la + ca * lb));
}

// Solid angle of a texel by formulas that share nothing with the library.
static double solid_angle(const kiln_map *map, size_t index)
{
    int n = map->size, width = map->shape == KILN_SHAPE_PANORAMA ? 2 * n : n;
    int x = (int)(index % (size_t)width), row = (int)(index / (size_t)width);
    int y = row % n, face = row / n;
    if (map->shape == KILN_SHAPE_PANORAMA)
        return 2 * pi / width * (cos(pi * y / n) - cos(pi * (y + 1) / n));
    double corner[4][3], area;
    for (int k = 0; k < 4; k++) {
        double u = (double)(x + (k & 1)) / n, v = (double)(y + (k >> 1)) / n;
        if (map->shape == KILN_SHAPE_CUBE)
            ki_face_direction(face, 2 * u - 1, 2 * v - 1, corner[k]);
        else
            ki_octahedron_direction(u, v, corner[k]);
    }
    if (map->shape == KILN_SHAPE_CUBE || (x < n / 2) == (y < n / 2))
        area =
            triangle(corner[0], corner[1], corner[2]) + // cut along v = const - u: no fold inside
            triangle(corner[1], corner[2], corner[3]);
    else
        area =
            triangle(corner[0], corner[1], corner[3]) + triangle(corner[0], corner[2], corner[3]);
    return area;
}

static void energy(const kiln_map *map, double sum[3])
{
    sum[0] = sum[1] = sum[2] = 0;
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++)
        for (size_t c = 0; c < 3; c++)
            sum[c] += solid_angle(map, i) * (double)map->level[0][3 * i + c];
}

static void solid_angles_fill_the_sphere(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
        for (int size = 2; size < 40; size += 2) {
            kiln_map map = make_map(context, (kiln_shape)shape, size, 1);
            fill_constant(&map, 1);
            double sum[3];
            energy(&map, sum);
            CHECK_NEAR(sum[0], 4 * pi, 1e-12);
            kiln_map_free(&map);
        }
    kiln_context_destroy(context);
}

static void constants_stay_constant(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    static const int sources[] = {1, 2, 3, 5, 8, 31, 64}, targets[] = {1, 2, 3, 7, 16, 33, 50, 64};
    static const double rotations[] = {0, 90, -17.3, 360.0 / 64};
    for (int shapes = 0; shapes < 9; shapes++)
        for (size_t i = 0; i < sizeof sources / sizeof *sources; i++)
            for (size_t j = 0; j < sizeof targets / sizeof *targets; j++)
                for (size_t k = 0; k < 4; k++) {
                    if (shapes / 3 && shapes % 3 && sources[i] * targets[j] > 30)
                        continue; // slow, and no different
                    kiln_map source = make_map(
                        context, (kiln_shape)(KILN_SHAPE_PANORAMA + shapes / 3), sources[i], 1);
                    fill_constant(&source, 0.7f);
                    kiln_map map =
                        convert(context, &source, (kiln_shape)(KILN_SHAPE_PANORAMA + shapes % 3),
                                targets[j], rotations[k]);
                    for (size_t t = 0; t < 3 * kiln_map_texels(&map, 0); t++)
                        CHECK_NEAR((double)map.level[0][t], (double)0.7f, 0.7e-6);
                    kiln_map_free(&map);
                    kiln_map_free(&source);
                }
    kiln_context_destroy(context);
}

static void energy_is_kept(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    static const struct {
        kiln_shape from, to;
        int source, target;
        double rotation;
    } cases[] = {
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_CUBE, 64, 32, 0},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_CUBE, 64, 48, 33.3},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_CUBE, 37, 21, 0},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_CUBE, 20, 128, 9},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_CUBE, 96, 2, 0},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_OCTAHEDRON, 64, 40, 0},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_OCTAHEDRON, 33, 80, 71},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_OCTAHEDRON, 256, 32, 0},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_PANORAMA, 64, 31, 12.5},
        {KILN_SHAPE_PANORAMA, KILN_SHAPE_PANORAMA, 30, 64, 0},
        {KILN_SHAPE_CUBE, KILN_SHAPE_PANORAMA, 32, 64, 0},
        {KILN_SHAPE_CUBE, KILN_SHAPE_PANORAMA, 27, 50, 100.7},
        {KILN_SHAPE_CUBE, KILN_SHAPE_CUBE, 32, 12, 90},
        {KILN_SHAPE_CUBE, KILN_SHAPE_CUBE, 31, 64, 0},
        {KILN_SHAPE_OCTAHEDRON, KILN_SHAPE_PANORAMA, 40, 64, -20},
        {KILN_SHAPE_OCTAHEDRON, KILN_SHAPE_PANORAMA, 32, 256, 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        kiln_map source = make_map(context, cases[k].from, cases[k].source, 1);
        size_t count = kiln_map_texels(&source, 0);
        // Noise, then a sun somewhere, the poles and seams among the places.
        for (uint32_t sun = 0; sun < 12; sun++) {
            fill_constant(&source, 0);
            uint64_t seed = sun * 77 + 1;
            size_t at = sun == 1   ? 0
                        : sun == 2 ? count - 1
                        : sun == 3 ? count / 2
                                   : random_bits(&seed) % count;
            if (sun == 0)
                fill_spiky(&source, k);
            else
                source.level[0][3 * at] = 1e5f;
            kiln_map map =
                convert(context, &source, cases[k].to, cases[k].target, cases[k].rotation);
            double before[3], after[3];
            energy(&source, before);
            energy(&map, after);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(after[c], before[c], 1e-6 * before[c]);
            kiln_map_free(&map);
        }
        kiln_map_free(&source);
    }
    kiln_context_destroy(context);
}

// The mean over a texel by count x count sub-samples.
static void slow_mean(const kiln_map *source, const kiln_map *map, size_t index, double rotation,
                      int count, double mean[3])
{
    int n = map->size, width = map->shape == KILN_SHAPE_PANORAMA ? 2 * n : n, m = source->size;
    int x = (int)(index % (size_t)width), row = (int)(index / (size_t)width);
    int y = row % n, face = row / n;
    double total = 0, sum[3] = {0, 0, 0};
    for (int j = 0; j < count; j++)
        for (int i = 0; i < count; i++) {
            double u = (x + (i + 0.5) / count) / width, v = (y + (j + 0.5) / count) / n, area;
            double d[3], p, q;
            if (map->shape == KILN_SHAPE_CUBE) {
                ki_face_direction(face, 2 * u - 1, 2 * v - 1, d);
                area = pow(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], -1.5);
            } else if (map->shape == KILN_SHAPE_OCTAHEDRON) {
                ki_octahedron_direction(u, v, d);
                area = pow(fabs(d[0]) + fabs(d[1]) + fabs(d[2]), 3);
            } else {
                ki_panorama_direction(u, v, d);
                area = sin(pi * v);
            }
            ki_turn(d, rotation, d);
            int source_face = 0, source_width = m;
            if (source->shape == KILN_SHAPE_CUBE) {
                source_face = ki_direction_face(d, &p, &q);
                p = (p + 1) / 2;
                q = (q + 1) / 2;
            } else if (source->shape == KILN_SHAPE_OCTAHEDRON) {
                ki_direction_octahedron(d, &p, &q);
            } else {
                ki_direction_panorama(d, &p, &q);
                source_width = 2 * m;
            }
            int column = (int)fmin(p * source_width, source_width - 1);
            int line = (int)fmin(q * m, m - 1) + source_face * m;
            for (int c = 0; c < 3; c++)
                sum[c] += area * (double)source->level[0][3 * (line * source_width + column) + c];
            total += area;
        }
    for (int c = 0; c < 3; c++)
        mean[c] = sum[c] / total;
}

static void compare(kiln_shape from, int source_size, kiln_shape to, int size, double rotation,
                    int texels, int count, double rms_bound, double bound)
{
    kiln_context *context = make_context(1);
    kiln_map source = make_map(context, from, source_size, 1);
    fill_spiky(&source, 5);
    kiln_map map = convert(context, &source, to, size, rotation);
    double squares = 0, worst = 0, level = 0;
    uint64_t seed = 3;
    size_t all = kiln_map_texels(&map, 0);
    for (int k = 0; k < texels; k++) {
        // The first and last, whole middle rows' ends, then anywhere.
        size_t at = k == 0   ? 0
                    : k == 1 ? all - 1
                    : k == 2 ? all / 2 + (size_t)size / 2
                             : random_bits(&seed) % all;
        double mean[3];
        slow_mean(&source, &map, at, rotation, count, mean);
        for (size_t c = 0; c < 3; c++) {
            double off = fabs((double)map.level[0][3 * at + c] - mean[c]);
            squares += off * off;
            level += mean[c];
            worst = fmax(worst, off);
        }
    }
    double rms = sqrt(squares / (3 * texels)) / (level / (3 * texels));
    if (getenv("KILN_TEST_VERBOSE"))
        printf("%d %d -> %d %d turned %g: rms %.3g worst %.3g\n", (int)from, source_size, (int)to,
               size, rotation, rms, worst);
    CHECK_BELOW(rms, rms_bound);
    CHECK_BELOW(worst, bound);
    kiln_map_free(&map);
    kiln_map_free(&source);
    kiln_context_destroy(context);
}

// The bounds allow for the slow sum's own error, which falls as its count of sub-samples grows:
// tried up to 4009 a side.
static void texels_are_means_of_what_lies_under_them(void **state)
{
    (void)state;
    compare(KILN_SHAPE_PANORAMA, 64, KILN_SHAPE_CUBE, 32, 0, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 64, KILN_SHAPE_CUBE, 32, 13.7, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 35, KILN_SHAPE_CUBE, 17, 40, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 8, KILN_SHAPE_CUBE, 64, 200, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 1, KILN_SHAPE_CUBE, 33, 50, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 2, KILN_SHAPE_OCTAHEDRON, 6, -35, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 3, KILN_SHAPE_CUBE, 2, 0, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 90, KILN_SHAPE_CUBE, 3, 2, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 64, KILN_SHAPE_OCTAHEDRON, 32, 0, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 35, KILN_SHAPE_OCTAHEDRON, 19, 25, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_PANORAMA, 50, KILN_SHAPE_PANORAMA, 21, 25, 8, 1009, 2e-3, 1e-2);
    compare(KILN_SHAPE_CUBE, 32, KILN_SHAPE_PANORAMA, 50, 65, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_CUBE, 32, KILN_SHAPE_CUBE, 20, 90, 8, 509, 2e-3, 1e-2);
    compare(KILN_SHAPE_OCTAHEDRON, 32, KILN_SHAPE_PANORAMA, 40, -3, 8, 509, 2e-3, 1e-2);
}

// What is not exact, as resample.c states it.
static void sub_samples_keep_their_bound(void **state)
{
    (void)state;
    compare(KILN_SHAPE_CUBE, 32, KILN_SHAPE_CUBE, 32, 30, 100, 256, 4e-2, 0.4);
    compare(KILN_SHAPE_CUBE, 64, KILN_SHAPE_OCTAHEDRON, 32, 0, 100, 256, 4e-2, 0.4);
    compare(KILN_SHAPE_OCTAHEDRON, 32, KILN_SHAPE_CUBE, 32, 0, 100, 256, 4e-2, 0.4);
}

// Exact areas nest: a texel is the mean of the finer map's texels in it, by their solid angles.
static void coarse_texels_are_means_of_fine_ones(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    for (int to = KILN_SHAPE_CUBE; to <= KILN_SHAPE_OCTAHEDRON; to++)
        for (int factor = 2; factor < 6; factor++)
            for (int k = 0; k < 4; k++) {
                kiln_map source = make_map(context, KILN_SHAPE_PANORAMA, 61 + k, 1);
                fill_spiky(&source, (uint32_t)(factor + k));
                source.level[0][7320] = 1e5f;
                double rotation = k & 2 ? 21.3 : 0;
                int n = 34;
                kiln_map coarse = convert(context, &source, (kiln_shape)to, n, rotation);
                kiln_map fine = convert(context, &source, (kiln_shape)to, n * factor, rotation);
                for (size_t i = 0; i < kiln_map_texels(&coarse, 0); i++) {
                    double sum = 0, total = 0;
                    for (int j = 0; j < factor * factor; j++) {
                        size_t x = i % (size_t)n * (size_t)factor + (size_t)(j % factor);
                        size_t y = i / (size_t)n * (size_t)factor + (size_t)(j / factor);
                        size_t at = y * (size_t)(n * factor) + x;
                        double area = solid_angle(&fine, at);
                        sum += area * (double)fine.level[0][3 * at];
                        total += area;
                    }
                    CHECK_NEAR((double)coarse.level[0][3 * i], sum / total, 1e-6 * sum / total);
                }
                kiln_map_free(&fine);
                kiln_map_free(&coarse);
                kiln_map_free(&source);
            }
    kiln_context_destroy(context);
}

static void turned_columns_are_turned_maps(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
        for (int size = 31; size < 33; size++) {
            int width = 2 * size;
            kiln_map source = make_map(context, KILN_SHAPE_PANORAMA, size, 1);
            kiln_map moved = make_map(context, KILN_SHAPE_PANORAMA, size, 1);
            fill_spiky(&source, 9);
            for (int columns = -5; columns < 70; columns += 15) {
                for (int i = 0; i < width * size; i++) {
                    int from = i / width * width + ((i % width + columns) % width + width) % width;
                    for (int c = 0; c < 3; c++)
                        moved.level[0][3 * i + c] = source.level[0][3 * from + c];
                }
                kiln_map a =
                    convert(context, &source, (kiln_shape)shape, 24, columns * 360.0 / width);
                kiln_map b = convert(context, &moved, (kiln_shape)shape, 24, 0);
                assert_memory_equal(a.level[0], b.level[0],
                                    kiln_map_texels(&a, 0) * 3 * sizeof(float));
                kiln_map_free(&a);
                kiln_map_free(&b);
            }
            kiln_map_free(&source);
            kiln_map_free(&moved);
        }
    kiln_context_destroy(context);
}

// Quarter turns and equal sizes move texels and change none.
static void quarter_turns_permute(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
        for (int size = 1; size < 9; size++)
            for (int turn = -1; turn < 4; turn++) {
                if (shape == KILN_SHAPE_PANORAMA && size % 2)
                    continue;
                kiln_map source = make_map(context, (kiln_shape)shape, size, 1);
                for (size_t i = 0; i < 3 * kiln_map_texels(&source, 0); i++)
                    source.level[0][i] = (float)i;
                kiln_map map = convert(context, &source, (kiln_shape)shape, size, 90.0 * turn);
                for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
                    double d[3], turned[3], e[3];
                    kiln_map_direction(&map, 0, i, d);
                    ki_turn(d, 90.0 * turn, turned);
                    size_t from = (size_t)map.level[0][3 * i] / 3;
                    kiln_map_direction(&source, 0, from, e);
                    for (size_t c = 0; c < 3; c++) {
                        CHECK_NEAR(e[c], turned[c], 1e-14);
                        assert_true(map.level[0][3 * i + c] == (float)(3 * from + c));
                    }
                }
                kiln_map_free(&map);
                kiln_map_free(&source);
            }
    kiln_context_destroy(context);
}

static void threads_do_not_change_bits(void **state)
{
    (void)state;
    kiln_context *contexts[3] = {make_context(1), make_context(2), make_context(5)};
    for (int shapes = 0; shapes < 9; shapes++) {
        kiln_map source =
            make_map(contexts[0], (kiln_shape)(KILN_SHAPE_PANORAMA + shapes / 3), 50, 1);
        fill_spiky(&source, 1);
        kiln_map map[3];
        for (int k = 0; k < 3; k++)
            map[k] = convert(contexts[k], &source, (kiln_shape)(KILN_SHAPE_PANORAMA + shapes % 3),
                             37, 11);
        for (int k = 1; k < 3; k++)
            assert_memory_equal(map[0].level[0], map[k].level[0],
                                kiln_map_texels(&map[0], 0) * 3 * sizeof(float));
        for (int k = 0; k < 3; k++)
            kiln_map_free(&map[k]);
        kiln_map_free(&source);
    }
    for (int k = 0; k < 3; k++)
        kiln_context_destroy(contexts[k]);
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    for (int shapes = 0; shapes < 9; shapes++) {
        kiln_context *steady = make_context(1);
        kiln_map source = make_map(steady, (kiln_shape)(KILN_SHAPE_PANORAMA + shapes / 3), 19, 1);
        fill_spiky(&source, 2);
        for (int n = 1;; n++) {
            assert_true(n < 1000);
            failing f;
            kiln_context *context = failing_context(&f);
            f.calls = 0;
            f.fail_at = n;
            kiln_map map;
            kiln_result result =
                kiln_map_convert(context, &source, (kiln_shape)(KILN_SHAPE_PANORAMA + shapes % 3),
                                 21, 7, &map, &error);
            assert_true(result == KILN_OK || result == KILN_ERROR_MEMORY);
            assert_true(result == KILN_OK || !map.owner);
            kiln_map_free(&map);
            size_t held;
            kiln_context_memory(context, &held, NULL);
            assert_int_equal(held, 0);
            assert_int_equal(f.held, f.idle);
            kiln_context_destroy(context);
            assert_true((result == KILN_OK) == (f.calls < n));
            if (result == KILN_OK)
                break;
        }
        kiln_map_free(&source);
        kiln_context_destroy(steady);
    }
}

// A plan executed again gives the same; it fits in a few MiB.
static void plans_are_small_and_repeat(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    kiln_map source = make_map(context, KILN_SHAPE_PANORAMA, 1024, 1);
    kiln_map map[2] = {make_map(context, KILN_SHAPE_CUBE, 256, 1),
                       make_map(context, KILN_SHAPE_CUBE, 256, 1)};
    fill_spiky(&source, 4);
    size_t before, after;
    kiln_context_memory(context, &before, NULL);
    ki_resample_plan *plan;
    ki_buffer buffer = {0};
    CHECK_OK(ki_resample_plan_create(context, KILN_SHAPE_PANORAMA, 1024, KILN_SHAPE_CUBE, 256, NULL,
                                     0, &plan, &error));
    CHECK_OK(ki_resample_reserve(context, plan, &buffer, &error));
    kiln_context_memory(context, &after, NULL);
    CHECK_BELOW((double)(after - before), 4e6);
    for (int k = 0; k < 2; k++)
        assert_true(
            ki_resample_execute(context, plan, &buffer, source.level[0], map[k].level[0], NULL));
    assert_memory_equal(map[0].level[0], map[1].level[0],
                        kiln_map_texels(&map[0], 0) * 3 * sizeof(float));
    ki_resample_plan_destroy(plan);
    ki_buffer_free(&buffer);
    for (int k = 0; k < 2; k++)
        kiln_map_free(&map[k]);
    kiln_map_free(&source);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_angles_fill_the_sphere),
        cmocka_unit_test(constants_stay_constant),
        cmocka_unit_test(energy_is_kept),
        cmocka_unit_test(texels_are_means_of_what_lies_under_them),
        cmocka_unit_test(sub_samples_keep_their_bound),
        cmocka_unit_test(coarse_texels_are_means_of_fine_ones),
        cmocka_unit_test(turned_columns_are_turned_maps),
        cmocka_unit_test(quarter_turns_permute),
        cmocka_unit_test(threads_do_not_change_bits),
        cmocka_unit_test(any_allocation_may_fail),
        cmocka_unit_test(plans_are_small_and_repeat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
