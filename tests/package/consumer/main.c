// Bakes a white furnace: every texel must stay white.
#include <kiln/kiln.h>

#include <math.h>
#include <stdio.h>

int main(void)
{
    int result = 1;
    kiln_context *context = NULL;
    kiln_map panorama = {0}, cube = {0};
    kiln_error error = {0};
    kiln_prefilter_def def = {.size = 16};
    float worst = 0;

    if (kiln_context_create(NULL, &context, &error) ||
        kiln_map_create(context, KILN_SHAPE_PANORAMA, 32, 1, &panorama, &error))
        goto done;
    for (size_t i = 0; i < kiln_map_texels(&panorama, 0) * 3; i++)
        panorama.level[0][i] = 1;
    if (kiln_prefilter(context, &panorama, &def, &cube, &error))
        goto done;
    for (int k = 0; k < cube.level_count; k++)
        for (size_t i = 0; i < kiln_map_texels(&cube, k) * 3; i++)
            if (!(fabsf(cube.level[k][i] - 1) <= worst))
                worst = fabsf(cube.level[k][i] - 1);
    printf("kiln %s: %d levels, off white by %g\n", kiln_version(), cube.level_count,
           (double)worst);
    result = !(worst <= 1e-6f && cube.level_count == 5);
done:
    if (error.result)
        fprintf(stderr, "%s\n", error.message);
    kiln_map_free(&cube);
    kiln_map_free(&panorama);
    kiln_context_destroy(context);
    return result;
}
