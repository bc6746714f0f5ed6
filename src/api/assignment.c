// The assignment's tables as the caller sees them.
#include "course/assignment.h"

#include <math.h>

enum { MAX_SAMPLES = 1 << 20, MAX_SIZE = 1024 };

static kiln_result complete(kiln_assignment_method method, const kiln_assignment_def *given,
                            kiln_assignment_def *def, kiln_error *error)
{
    *def = given ? *given : (kiln_assignment_def){0};
    def->size = def->size ? def->size : 128;
    def->sample_count = def->sample_count ? def->sample_count : 1024;
    if ((unsigned)method > KILN_ASSIGNMENT_SPLIT_SUM)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the method is %d, there are 0 to %d",
                       (int)method, KILN_ASSIGNMENT_SPLIT_SUM);
    if (def->size < 2 || def->size > MAX_SIZE)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "size of the table is %d, it must be 2 to %d, or 0", def->size, MAX_SIZE);
    if (def->sample_count < 1 || def->sample_count > MAX_SAMPLES)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "sample_count is %d, it must be 1 to %d, or 0",
                       def->sample_count, MAX_SAMPLES);
    if ((unsigned)def->g > KILN_ASSIGNMENT_G_UNCORRELATED)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "g is %d, there are 0 to %d", (int)def->g,
                       KILN_ASSIGNMENT_G_UNCORRELATED);
    return KILN_OK;
}

kiln_g kiln_assignment_masking(kiln_assignment_g g)
{
    static const kiln_g masking[] = {KILN_G_SCHLICK_K2, KILN_G_SCHLICK_TEXT, KILN_G_SMITH,
                                     KILN_G_SMITH_UNCORRELATED};
    return masking[(unsigned)g <= KILN_ASSIGNMENT_G_UNCORRELATED ? g : 0];
}

kiln_result kiln_assignment_energy(kiln_context *context, kiln_assignment_method method,
                                   const kiln_assignment_def *def, kiln_image *table,
                                   kiln_error *error)
{
    kiln_assignment_def d;
    *table = (kiln_image){0};
    kiln_result result = complete(method, def, &d, error);
    if (!result)
        result = kiln_image_create(context, d.size, d.size, 1, table, error);
    if (!result)
        result = ki_assignment_energy(context, method, &d, table, error);
    if (result)
        kiln_image_free(table);
    return result;
}

static kiln_result check_table(const char *name, const kiln_image *table, kiln_error *error)
{
    if (!table->pixels || table->channels != 1 || table->width < 1 || table->height < 1)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s is %d x %d with %d channels%s, it must have one", name, table->width,
                       table->height, table->channels, table->pixels ? "" : " and no pixels");
    return KILN_OK;
}

kiln_result kiln_assignment_average(kiln_context *context, const kiln_image *energy,
                                    kiln_image *average, kiln_error *error)
{
    *average = (kiln_image){0};
    kiln_result result = check_table("the table of E", energy, error);
    if (!result)
        result = kiln_image_create(context, energy->width, energy->height, 1, average, error);
    if (!result)
        ki_assignment_average(energy, average);
    return result;
}

kiln_result kiln_assignment_compare(kiln_context *context, const kiln_image *table,
                                    const kiln_image *exact, kiln_difference *difference,
                                    kiln_image *map, kiln_error *error)
{
    *difference = (kiln_difference){0};
    if (map)
        *map = (kiln_image){0};
    kiln_result result = check_table("the table", table, error);
    if (!result)
        result = check_table("the exact table", exact, error);
    if (!result && (table->width != exact->width || table->height != exact->height))
        result = ki_fail(error, KILN_ERROR_ARGUMENT,
                         "the table is %d x %d, the exact one %d x %d: they must be alike",
                         table->width, table->height, exact->width, exact->height);
    if (!result && map)
        result = kiln_image_create(context, table->width, table->height, 3, map, error);
    if (!result)
        *difference = ki_assignment_compare(table, exact, map);
    return result;
}

void kiln_assignment_truncate(kiln_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) {
        double x = (double)image->pixels[i];
        x = x > 0 ? x < 1 ? x : 1 : 0;
        image->pixels[i] = (float)(floor(x * 255) / 255);
    }
}
