// Texels and directions: each is found by the other, faces and seams join, and turning and
// mirroring a map moves each texel to its place.
#include "kit/kit.h"

#include "image/image.h"

static size_t texel_towards(const kiln_map *map, const double d[3])
{
    int n = map->size, face = 0, width = map->shape == KILN_SHAPE_PANORAMA ? 2 * n : n;
    double u, v;
    if (map->shape == KILN_SHAPE_CUBE) {
        face = ki_direction_face(d, &u, &v);
        u = (u + 1) / 2;
        v = (v + 1) / 2;
    } else if (map->shape == KILN_SHAPE_PANORAMA) {
        ki_direction_panorama(d, &u, &v);
    } else {
        ki_direction_octahedron(d, &u, &v);
    }
    return ((size_t)face * (size_t)n + (size_t)(v * n)) * (size_t)width + (size_t)(u * width);
}

static void directions_and_texels_invert(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    static const int sizes[] = {1, 2, 3, 7, 16, 33};
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
            kiln_map map = make_map(context, (kiln_shape)shape, sizes[k], 1);
            for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
                double d[3];
                kiln_map_direction(&map, 0, i, d);
                CHECK_NEAR(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 1, 4e-16);
                // Centres of 1 x 1 octahedra and of the middle of cubes' edges are unambiguous too.
                assert_int_equal(texel_towards(&map, d), i);
            }
            kiln_map_free(&map);
        }
    kiln_context_destroy(context);
}

static void conventions_are_those_of_the_header(void **state)
{
    (void)state;
    double d[3], s, t, u, v;
    ki_panorama_direction(0.5, 0.5, d);
    CHECK_NEAR(d[2], -1, 1e-15);
    ki_panorama_direction(0.75, 0.5, d);
    CHECK_NEAR(d[0], 1, 1e-15);
    ki_panorama_direction(0.3, 0, d);
    CHECK_NEAR(d[1], 1, 0);
    // OpenGL 4.6 core, table 8.19: major axis, sc and tc of each face.
    static const double faces[6][3][3] = {
        {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
        {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
    };
    for (int face = 0; face < 6; face++) {
        ki_face_direction(face, 0.25, -0.5, d);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(d[c], faces[face][0][c] + 0.25 * faces[face][1][c] - 0.5 * faces[face][2][c],
                       0);
        assert_int_equal(ki_direction_face(d, &s, &t), face);
        CHECK_NEAR(s, 0.25, 0);
        CHECK_NEAR(t, -0.5, 0);
    }
    static const double up[3] = {0, 1, 0}, right[3] = {1, 0, 0}, back[3] = {0, 0, 1};
    ki_direction_octahedron(up, &u, &v);
    CHECK_NEAR(u, 0.5, 0);
    CHECK_NEAR(v, 0.5, 0);
    ki_direction_octahedron(right, &u, &v);
    CHECK_NEAR(u, 1, 0);
    CHECK_NEAR(v, 0.5, 0);
    ki_direction_octahedron(back, &u, &v);
    CHECK_NEAR(u, 0.5, 0);
    CHECK_NEAR(v, 1, 0);
    for (int corner = 0; corner < 4; corner++) {
        ki_octahedron_direction(corner & 1, corner >> 1, d);
        CHECK_NEAR(d[1], -1, 1e-15);
    }
}

// Both faces at an edge give the same directions there, and every edge has exactly two faces.
static void faces_agree_on_shared_edges(void **state)
{
    (void)state;
    for (int face = 0; face < 6; face++)
        for (int edge = 0; edge < 4; edge++)
            for (int quarter = -3; quarter < 4; quarter++) {
                double along = 0.25 * quarter;
                double fixed = edge & 1 ? 1 : -1, d[3];
                ki_face_direction(face, edge < 2 ? fixed : along, edge < 2 ? along : fixed, d);
                int found = 0;
                for (int other = 0; other < 6; other++)
                    for (int side = 0; side < 4; side++) {
                        double f = side & 1 ? 1 : -1, e[3], distance = 9;
                        for (int sign = -1; sign < 2; sign += 2) {
                            ki_face_direction(other, side < 2 ? f : sign * along,
                                              side < 2 ? sign * along : f, e);
                            double far = fabs(d[0] - e[0]) + fabs(d[1] - e[1]) + fabs(d[2] - e[2]);
                            distance = fmin(distance, far);
                        }
                        found += other != face && distance == 0;
                    }
                assert_int_equal(found, 1);
            }
}

static void panoramas_and_octahedra_close_at_their_seams(void **state)
{
    (void)state;
    double a[3], b[3];
    for (int k = 0; k < 10; k++) {
        double x = 0.1 * k + 0.05;
        ki_panorama_direction(0, x, a);
        ki_panorama_direction(1, x, b);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(a[c], b[c], 1e-15);
        for (int side = 0; side < 4; side++) {
            double end = side & 1;
            ki_octahedron_direction(side < 2 ? x : end, side < 2 ? end : x, a);
            ki_octahedron_direction(side < 2 ? 1 - x : end, side < 2 ? end : 1 - x, b);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(a[c], b[c], 1e-15);
        }
    }
}

static void turning_moves_a_panorama_to_the_left(void **state)
{
    (void)state;
    for (int k = -9; k <= 9; k++) {
        double d[3], turned[3], u, v;
        ki_panorama_direction(0.31, 0.4, d);
        ki_turn(d, k * 37.5, turned);
        ki_direction_panorama(turned, &u, &v);
        double wanted = 0.31 + k * 37.5 / 360;
        CHECK_NEAR(u, wanted - floor(wanted), 1e-15);
        CHECK_NEAR(v, 0.4, 1e-15);
        // Quarter turns are exact.
        ki_turn(d, k * 90, turned);
        static const int swaps[4][2] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}};
        const int *m = swaps[k & 3];
        assert_true(turned[0] == m[0] * d[0] + m[1] * d[2]);
        assert_true(turned[1] == d[1]);
        assert_true(turned[2] == m[0] * d[2] - m[1] * d[0]);
    }
}

static void mirroring_swaps_left_and_right(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
        for (int size = 1; size < 6; size++) {
            kiln_map map = make_map(context, (kiln_shape)shape, size, 1);
            size_t count = kiln_map_texels(&map, 0);
            for (size_t i = 0; i < 3 * count; i++)
                map.level[0][i] = (float)i;
            kiln_map_mirror(&map);
            for (size_t i = 0; i < count; i++) {
                double d[3];
                kiln_map_direction(&map, 0, i, d);
                d[0] = -d[0];
                size_t from = texel_towards(&map, d);
                for (size_t c = 0; c < 3; c++)
                    assert_true(map.level[0][3 * i + c] == (float)(3 * from + c));
            }
            kiln_map_free(&map);
        }
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_and_texels_invert),
        cmocka_unit_test(conventions_are_those_of_the_header),
        cmocka_unit_test(faces_agree_on_shared_edges),
        cmocka_unit_test(panoramas_and_octahedra_close_at_their_seams),
        cmocka_unit_test(turning_moves_a_panorama_to_the_left),
        cmocka_unit_test(mirroring_swaps_left_and_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
