// What costs many lobes and long sums: every lobe against brute force, the narrowest lobes and a
// single bright texel among them, and the white furnace of the lobes other than GGX.
#include "bake/reference.h"
#include "math/math.h"

#include "kit/context.h"

static void white_furnace_of_every_lobe_stays_white(void **state)
{
    (void)state;
    static const int sizes[] = {1, 33}; // where the rows differ most in number from the faces
    static const int faces[] = {1, 5, 100};
    for (int s = 0; s < 2; s++)
        for (int f = 0; f < 3; f++)
            for (int lobe = 1; lobe < 4; lobe++)
                CHECK_BELOW(
                    filtered_furnace_error(context, sizes[s], faces[f], (enum kiln_lobe_kind)lobe),
                    1e-6);
}

// A single bright texel gives the kernel itself: no ringing, nothing negative.
static void a_delta_sun_gives_the_kernel(void **state)
{
    (void)state;
    static const int places[][2] = {{0, 3}, {63, 100}, {20, 41}, {32, 0}, {31, 127}};
    for (int p = 0; p < 5; p++) {
        kiln_map in, out;
        CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 64, 1, &in, &error));
        for (int c = 0; c < 3; c++)
            in.level[0][3 * (128 * places[p][0] + places[p][1]) + c] = 1e6f;
        kiln_prefilter_def def = {.size = 64};
        CHECK_OK(kiln_prefilter(context, &in, &def, &out, &error));
        for (int l = 1; l < out.level_count; l++) {
            double alpha = (double)out.roughness[l] * (double)out.roughness[l], peak = 0, most = 0;
            size_t texels = kiln_map_texels(&out, l), count = texels < 200 ? texels : 200;
            kiln_lobe lobe = kiln_lobe_ggx(alpha);
            static double directions[200][3], values[200][3];
            for (size_t i = 0; i < count; i++)
                kiln_map_direction(&out, l, i * texels / count, directions[i]);
            // Brute force finer than usual: a texel is 3 degrees wide here.
            const ki_reference_rule fine = {.centre = 1e-4, .pairs = 0.01, .quads = 0.25};
            CHECK_OK(ki_reference_integrate(context, &in, &lobe, 0, (const double(*)[3])directions,
                                            (int)count, &fine, values, &error));
            for (size_t i = 0; i < 3 * texels; i++) {
                assert_true(out.level[l][i] >= 0);
                peak = fmax(peak, (double)out.level[l][i]);
            }
            for (size_t i = 0; i < count; i++)
                most =
                    fmax(most, fabs((double)out.level[l][3 * (i * texels / count)] - values[i][0]));
            CHECK_BELOW(most / peak, 1e-6);
        }
        kiln_map_free(&in);
        kiln_map_free(&out);
    }
}

// The spectrum alone, without the help of the list of suns: points too faint for it, on black.
static void faint_points_ring_below_the_tolerance(void **state)
{
    (void)state;
    kiln_map in, out;
    enum { SIZE = 128, POINTS = 3000 };
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, SIZE, 1, &in, &error));
    uint64_t seed = 77;
    for (int i = 0; i < POINTS; i++) {
        double z = 2 * random_number(&seed) - 1, u = random_number(&seed);
        int y = (int)(acos(z) / KI_PI * SIZE), x = (int)(u * 2 * SIZE);
        for (int c = 0; c < 3; c++)
            in.level[0][3 * (2 * SIZE * y + x) + c] = 100;
    }
    kiln_prefilter_def def = {.size = 64};
    CHECK_OK(kiln_prefilter(context, &in, &def, &out, &error));
    for (int l = 1; l < out.level_count; l++) {
        kiln_lobe lobe = kiln_lobe_ggx((double)out.roughness[l] * (double)out.roughness[l]);
        scene_errors e = scene_compare(context, &in, &out, l, &lobe, 0, 256);
        CHECK_BELOW(e.rms, 1e-4);
        CHECK_BELOW(e.most, 2e-3);
    }
    kiln_map_free(&in);
    kiln_map_free(&out);
}

static void other_lobes_and_shapes_match_brute_force(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 64, 21);
    for (int kind = 1; kind < 4; kind++)
        for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
            static const float roughness[] = {0.35f, 0.5f, 0.8f};
            kiln_map out;
            kiln_prefilter_def def = {.shape = (kiln_shape)shape,
                                      .size = 24,
                                      .level_count = 3,
                                      .roughness = roughness,
                                      .lobe = (enum kiln_lobe_kind)kind,
                                      .rotation = 33.3};
            CHECK_OK(kiln_prefilter(context, &in, &def, &out, &error));
            for (int l = 0; l < 3; l++) {
                double alpha = (double)roughness[l] * (double)roughness[l];
                kiln_lobe lobe = kind == 1   ? kiln_lobe_lambert()
                                 : kind == 2 ? kiln_lobe_charlie(alpha)
                                             : kiln_lobe_phong(2 / (alpha * alpha) - 2);
                if (kind == 3 && lobe.parameter < 1)
                    lobe.parameter = 1;
                scene_errors e = scene_compare(context, &in, &out, l, &lobe, 33.3, 40);
                CHECK_BELOW(e.rms, 1e-4);
                CHECK_BELOW(e.most, 2e-3);
            }
            kiln_map_free(&out);
        }
    kiln_map_free(&in);
}

static void tiny_alphas_match_brute_force(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 64, 4);
    static const float roughness[] = {0.001f, 0.02f, 0.05f};
    for (int i = 0; i < 3; i++) {
        kiln_map out;
        kiln_prefilter_def def = {.size = 12, .level_count = 1, .roughness = &roughness[i]};
        CHECK_OK(kiln_prefilter(context, &in, &def, &out, &error));
        kiln_lobe lobe = kiln_lobe_ggx((double)roughness[i] * (double)roughness[i]);
        scene_errors e = scene_compare(context, &in, &out, 0, &lobe, 0, 100);
        CHECK_BELOW(e.rms, 1e-4);
        CHECK_BELOW(e.most, 2e-3);
        kiln_map_free(&out);
    }
    kiln_map_free(&in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_of_every_lobe_stays_white),
        cmocka_unit_test(a_delta_sun_gives_the_kernel),
        cmocka_unit_test(faint_points_ring_below_the_tolerance),
        cmocka_unit_test(other_lobes_and_shapes_match_brute_force),
        cmocka_unit_test(tiny_alphas_match_brute_force),
    };
    return cmocka_run_group_tests_name("sphere lobes", tests, set_up, tear_down);
}
