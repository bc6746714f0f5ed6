// Reads the KTX2 cubes that foreign.mjs wrote and compares every texel with the formula there:
// ktx_read FILES...
#include <kiln/kiln.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct cube {
    char format[16], scheme[8], orientation[4];
    int size, levels;
} cube;

static double value_of(const cube *c, int n, int level)
{
    if (!strcmp(c->format, "rgba16f"))
        return ldexp(1 + 4 * n % 1024 / 1024.0, 12 - 15 + 4 * n / 1024);
    if (!strcmp(c->format, "rgba32f"))
        return n / 1024.0;
    if (!strcmp(c->format, "rgb9e5"))
        return ldexp(n, level - 9);
    double x = n / 255.0;
    bool srgb = strstr(c->format, "srgb") != NULL;
    return !srgb ? x : x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

// Floats are stored exactly; others are a quotient or a power, rounded to float.
static bool is_near(const cube *c, double value, double wanted)
{
    bool exact = !strcmp(c->format, "rgba16f") || !strcmp(c->format, "rgba32f") ||
                 !strcmp(c->format, "rgb9e5");
    return fabs(value - wanted) <= (exact ? 0 : 4e-7 * wanted);
}

static bool check_level(const cube *c, const kiln_map *map, int k)
{
    int edge = c->size >> k;
    const float *value = map->level[k];
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < edge; y++)
            for (int x = 0; x < edge; x++)
                for (int i = 0; i < 3; i++) {
                    int n = (11 * k + 31 * face + 7 * y + 3 * x + 50 * i) % 256;
                    double got = (double)*value++, wanted = value_of(c, n, k);
                    if (!is_near(c, got, wanted)) {
                        fprintf(stderr,
                                "level %d, face %d, x %d, y %d, channel %d: %.9g, not %.9g\n", k,
                                face, x, y, i, got, wanted);
                        return false;
                    }
                }
    return true;
}

static bool check(kiln_context *context, const char *path)
{
    cube c;
    kiln_map map;
    kiln_error error;
    const char *name = strrchr(path, '/');
    if (!name || sscanf(name, "/%15[^-]-%7[^-]-%2s-%d-%d.ktx2", c.format, c.scheme, c.orientation,
                        &c.size, &c.levels) != 5) {
        fprintf(stderr, "the name has another form\n");
        return false;
    }
    if (kiln_map_load(context, path, NULL, &map, &error) != KILN_OK) {
        fprintf(stderr, "%s\n", error.message);
        return false;
    }
    bool good = map.shape == KILN_SHAPE_CUBE && map.size == c.size && map.level_count == c.levels;
    for (int k = 0; good && k < c.levels; k++)
        good = check_level(&c, &map, k);
    kiln_map_free(&map);
    return good;
}

int main(int argc, char **argv)
{
    kiln_context *context;
    kiln_error error;
    bool good = argc > 1 && kiln_context_create(NULL, &context, &error) == KILN_OK;
    for (int i = 1; good && i < argc; i++) {
        good = check(context, argv[i]);
        if (!good)
            fprintf(stderr, "%s: not read as written\n", argv[i]);
    }
    if (argc > 1)
        kiln_context_destroy(context);
    return good ? 0 : 1;
}
