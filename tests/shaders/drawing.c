#include "drawing.h"

view_headless *headless;
view_renderer *renderer;

int start_drawing(void **state)
{
    if (set_up(state) || view_headless_create(&headless, &error) ||
        view_create(context, view_headless_lookup, &renderer, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return -1;
    }
    return 0;
}

int stop_drawing(void **state)
{
    view_destroy(renderer);
    view_headless_destroy(headless);
    return tear_down(state);
}

light_means draw_light(const view_light *light, int count, uint64_t seed)
{
    light_means means = {0};
    view_random random;
    view_random_start(&random, seed);
    for (int i = 0; i < count; i++) {
        double xi[2] = {view_random_next(&random), view_random_next(&random)}, d[3], radiance[3];
        view_light_sample(light, xi, d);
        view_light_radiance(light, d, radiance);
        double pdf = view_light_pdf(light, d);
        CHECK_NEAR(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 1, 1e-12);
        means.sphere += 1 / pdf / count;
        for (int c = 0; c < 3; c++) {
            means.total[c] += radiance[c] / pdf / count;
            for (int k = 0; k < 3; k++)
                means.moment[k][c] += d[k] * radiance[c] / pdf / count;
        }
    }
    return means;
}
