// The program bench_reference, for scripts that need brute-force values. In: a panorama, and on
// standard input lines "roughness x y z" with directions in kiln's axes, in which lines of equal
// roughness follow one another. Out: a line "r g b" for each line.
#include <kiln/kiln.h>

#include <stdio.h>
#include <string.h>

enum { MOST = 4096 };

static kiln_result filter(kiln_context *context, const kiln_map *source, double roughness,
                          const double (*directions)[3], int count, kiln_error *error)
{
    static double values[MOST][3];
    kiln_lobe lobe = kiln_lobe_ggx(roughness * roughness);
    kiln_result result =
        kiln_reference_filter(context, source, &lobe, 0, directions, count, values, error);
    for (int i = 0; i < count && !result; i++)
        printf("%.9g %.9g %.9g\n", values[i][0], values[i][1], values[i][2]);
    return result;
}

int main(int argc, char **argv)
{
    static double directions[MOST][3];
    kiln_context *context = NULL;
    kiln_error error = {0};
    kiln_map source = {0};
    kiln_result result;
    if (argc != 2) {
        fputs("usage: bench_reference PANORAMA <DIRECTIONS\n", stderr);
        return 2;
    }
    result = kiln_context_create(NULL, &context, &error);
    if (!result)
        result = kiln_map_load(context, argv[1], NULL, &source, &error);
    double roughness = 0, next, d[3];
    int count = 0;
    while (!result && scanf("%lf %lf %lf %lf", &next, &d[0], &d[1], &d[2]) == 4) {
        if (count == MOST || (count > 0 && (next < roughness || next > roughness))) {
            result =
                filter(context, &source, roughness, (const double(*)[3])directions, count, &error);
            count = 0;
        }
        roughness = next;
        memcpy(directions[count++], d, sizeof d);
    }
    if (!result && count > 0)
        result = filter(context, &source, roughness, (const double(*)[3])directions, count, &error);
    if (result)
        fprintf(stderr, "bench_reference: %s\n", error.message);
    kiln_map_free(&source);
    kiln_context_destroy(context);
    return result != KILN_OK;
}
