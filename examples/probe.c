// Bakes a cube that a renderer draws anew in each frame, such as a reflection probe. A plan bakes
// each frame into the same maps without allocation. The scene is a lamp that moves around the cube.
#include <kiln/kiln.h>

#include <math.h>
#include <stdio.h>

enum { SIZE = 32, FRAMES = 4 };

// Fills six faces of RGB floats, as a renderer would: bright within 20 degrees of the lamp, dark
// elsewhere.
static void render(const kiln_map *cube, double azimuth)
{
    const double lamp[3] = {sin(azimuth), 0.5, -cos(azimuth)}, length = sqrt(1.25);
    for (size_t i = 0; i < kiln_map_texels(cube, 0); i++) {
        double d[3];
        kiln_map_direction(cube, 0, i, d);
        double cosine = (d[0] * lamp[0] + d[1] * lamp[1] + d[2] * lamp[2]) / length;
        for (int c = 0; c < 3; c++)
            cube->level[0][3 * i + (size_t)c] = cosine > 0.94 ? 20 : 0.1f;
    }
}

int main(void)
{
    static float texels[6 * SIZE * SIZE * 3];
    // The cube's texels are in an array of the program's own.
    kiln_map cube = {.shape = KILN_SHAPE_CUBE, .size = SIZE, .level_count = 1, .level = {texels}};
    kiln_bake_def def = {.levels = {.size = SIZE, .level_count = 5, .tolerance = 0.01},
                         .irradiance_size = KILN_NO_IRRADIANCE};
    kiln_context *context = NULL;
    kiln_plan *plan = NULL;
    kiln_environment probe = {0};
    kiln_error error = {0};
    kiln_result result = kiln_context_create(NULL, &context, &error);
    if (result == KILN_OK)
        result = kiln_plan_create(context, KILN_SHAPE_CUBE, SIZE, &def, &plan, &error);
    if (result == KILN_OK)
        result = kiln_plan_environment(plan, &probe, &error);
    for (int i = 0; i < FRAMES && result == KILN_OK; i++) {
        kiln_sh diffuse;
        render(&cube, i * 1.5707963267948966);
        result = kiln_plan_execute(plan, &cube, &probe, &error);
        if (result == KILN_OK)
            result = kiln_sh_filter(&probe.sh, 3, true, 0, &diffuse, &error);
        if (result == KILN_OK)
            printf("frame %d: light leans to x %+.2f, z %+.2f\n", i,
                   diffuse.c[3][1] / diffuse.c[0][1], diffuse.c[2][1] / diffuse.c[0][1]);
    }
    if (result != KILN_OK)
        fprintf(stderr, "probe: %s\n", error.message);
    kiln_environment_free(&probe);
    kiln_plan_destroy(plan);
    kiln_context_destroy(context);
    return result == KILN_OK ? 0 : 1;
}
