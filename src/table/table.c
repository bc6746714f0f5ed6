// Computes tables of the reflection model's integrals. In: a kiln_table_def (kind, model, size,
// axis and flags). Out: an image of floats, a texel for each cosine n.v (columns), roughness (rows)
// and F0 or ior (slices). Each kind has a function that fills part of a row; rows run in parallel.
// The integrals are those of src/brdf/, and docs/tables.md describes the tables.
#include "table/table.h"

#include "brdf/dielectric.h"
#include "brdf/energy.h"
#include "brdf/sheen.h"
#include "brdf/surface.h"
#include "brdf/walk.h"
#include "table/lobes.h"
#include "table/table_axis.h"

int ki_table_channels(kiln_table_kind kind)
{
    switch (kind) {
    case KILN_TABLE_DFG:
        return 2;
    case KILN_TABLE_DFG_MULTISCATTER:
        return 3;
    case KILN_TABLE_GLASS:
    case KILN_TABLE_LOBES:
        return 4;
    default:
        return 1;
    }
}

// ------------------------------------------------------------------------------------------- kinds

enum { CHUNK = 256, MAX_CHANNELS = 4 };

typedef struct fill_job fill_job;

// Computes the values of one kind of table in one row and slice, at `count` cosines nov, at most
// CHUNK, to out[count][channels]. `third` is the third argument of the kind: F0 or ior of the
// slice.
typedef void fill_chunk(const fill_job *job, double roughness, double third, const double *nov,
                        int count, double *out);

struct fill_job {
    kiln_context *context;
    kiln_table *table;
    const kiln_table_def *def;
    fill_chunk *fill;
    // Chebyshev series of the albedo E, which replaces the integral of each texel of a large table;
    // otherwise NULL
    const ki_surface *surface;
    int channels;
};

static void fill_e(const fill_job *job, double roughness, double third, const double *nov,
                   int count, double *out)
{
    (void)third;
    if (job->surface && roughness > 1e-5)
        ki_surface_values(job->context, job->surface, roughness, nov, count, out);
    else
        ki_energy_values(job->context, &job->def->model, roughness, nov, count, false, out);
}

static void fill_average(const fill_job *job, double roughness, double third, const double *nov,
                         int count, double *out)
{
    (void)third, (void)nov;
    for (int i = 0; i < count; i++)
        out[i] = ki_energy_average(&job->def->model, roughness);
}

static void fill_dfg(const fill_job *job, double roughness, double third, const double *nov,
                     int count, double *out)
{
    (void)third;
    ki_energy_values(job->context, &job->def->model, roughness, nov, count, true, out);
}

// Computes the channels in Filament's order: B and A + B of the split sum, and the albedo of
// Charlie sheen with Ashikhmin's masking.
static void fill_multiscatter(const fill_job *job, double roughness, double third,
                              const double *nov, int count, double *out)
{
    double ab[2 * CHUNK];
    (void)third;
    ki_energy_values(job->context, &job->def->model, roughness, nov, count, true, ab);
    for (int i = 0; i < count; i++) {
        const double *a = ab + 2 * (size_t)i;
        *out++ = a[1];
        *out++ = a[0] + a[1];
        *out++ = kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, roughness, nov[i]);
    }
}

static void fill_sheen(const fill_job *job, double roughness, double third, const double *nov,
                       int count, double *out)
{
    (void)third;
    for (int i = 0; i < count; i++)
        out[i] = kiln_sheen_albedo(job->def->sheen, roughness, nov[i]);
}

static void fill_dielectric(const fill_job *job, double roughness, double third, const double *nov,
                            int count, double *out)
{
    for (int i = 0; i < count; i++)
        out[i] = ki_dielectric_reflection(&job->def->model, roughness, third, nov[i]);
}

static void fill_glass(const fill_job *job, double roughness, double third, const double *nov,
                       int count, double *out)
{
    for (int i = 0; i < count; i++, out += 4) {
        kiln_glass(&job->def->model, roughness, third, nov[i], out);
        kiln_glass(&job->def->model, roughness, 1 / third, nov[i], out + 2);
    }
}

static fill_chunk *const fill_of[KILN_TABLE_E_WALK + 1] = {
    [KILN_TABLE_E] = fill_e,         [KILN_TABLE_E_AVERAGE] = fill_average,
    [KILN_TABLE_DFG] = fill_dfg,     [KILN_TABLE_DFG_MULTISCATTER] = fill_multiscatter,
    [KILN_TABLE_SHEEN] = fill_sheen, [KILN_TABLE_E_DIELECTRIC] = fill_dielectric,
    [KILN_TABLE_GLASS] = fill_glass,
};

// ------------------------------------------------------------------------------------------ checks

static kiln_result check_size(const char *name, int size, int limit, kiln_error *error)
{
    if (size < 1 || size > limit)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s of the table is %d, it must be 1 to %d",
                       name, size, limit);
    return KILN_OK;
}

static kiln_result check_depth(const kiln_table_def *def, bool has_depth, kiln_error *error)
{
    enum { LIMIT = 1 << 26 };
    if (!has_depth && def->depth != 1)
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "depth of the table is %d, it must be 1 because this kind of table has no third axis",
            def->depth);
    if ((int64_t)def->width * def->height * def->depth > LIMIT)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%d x %d x %d texels are %lld, the limit is %d",
                       def->width, def->height, def->depth,
                       (long long)def->width * def->height * def->depth, LIMIT);
    return KILN_OK;
}

static kiln_result check_choices(const kiln_table_def *def, kiln_error *error)
{
    if ((unsigned)def->kind > KILN_TABLE_LOBES)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "kind of the table is %d, it must be 0 to %d",
                       (int)def->kind, KILN_TABLE_LOBES);
    if ((unsigned)def->model.d > KILN_D_BECKMANN || (unsigned)def->model.g > KILN_G_SCHLICK_TEXT)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the model has d %d and g %d, which must be 0 to %d and 0 to %d",
                       (int)def->model.d, (int)def->model.g, KILN_D_BECKMANN, KILN_G_SCHLICK_TEXT);
    if ((unsigned)def->sheen > KILN_SHEEN_ESTEVEZ)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "sheen is %d, it must be 0 to %d",
                       (int)def->sheen, KILN_SHEEN_ESTEVEZ);
    if ((unsigned)def->axis > KILN_AXIS_GRAZING)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "axis of the table is %d, it must be 0 to %d",
                       (int)def->axis, KILN_AXIS_GRAZING);
    if (def->kind == KILN_TABLE_E_WALK && def->axis != KILN_AXIS_LINEAR &&
        def->axis != KILN_AXIS_GRAZING)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "axis of the table is %d, it must be %d, or 0, for a table of random walks",
                       (int)def->axis, KILN_AXIS_GRAZING);
    if (def->kind == KILN_TABLE_E_WALK &&
        (def->model.d != KILN_D_GGX || def->model.g != KILN_G_SMITH))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "random walks need the model of GGX and height-correlated Smith, but d is "
                       "%d and g is %d",
                       (int)def->model.d, (int)def->model.g);
    if (def->path_count && (def->path_count < 16 || def->path_count > 1 << 24))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "path_count is %d, it must be 16 to %d, or 0",
                       def->path_count, 1 << 24);
    if (def->complement && ki_table_channels(def->kind) != 1)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "complement needs a table of one channel, but this kind of table has %d",
                       ki_table_channels(def->kind));
    return KILN_OK;
}

kiln_result ki_table_complete(kiln_table_def *def, kiln_error *error)
{
    kiln_result result = check_choices(def, error);
    if (result)
        return result;
    if (def->kind == KILN_TABLE_LOBES)
        return ki_lobes_complete(def, error);
    bool has_depth = ki_table_third(def->kind) != KI_THIRD_NONE;
    bool walks = def->kind == KILN_TABLE_E_WALK;
    if (def->kind == KILN_TABLE_E_AVERAGE)
        def->width = 1;
    def->width = def->width ? def->width : walks ? 40 : has_depth ? 32 : 128;
    def->height = def->height ? def->height : has_depth ? 32 : 128;
    def->depth = def->depth ? def->depth : walks ? 20 : has_depth ? 32 : 1;
    if (walks) {
        // With these default sizes, axis and number of paths the interpolated albedo errs by at
        // most 2e-3: docs/theory/walk.md.
        def->axis = KILN_AXIS_GRAZING;
        def->corners = true;
        def->path_count = def->path_count ? def->path_count : 8192;
    } else
        def->path_count = 0;
    result = check_size("width", def->width, KILN_MAX_TABLE, error);
    if (!result)
        result = check_size("height", def->height, KILN_MAX_TABLE, error);
    if (!result)
        result = check_size("depth", def->depth, KILN_MAX_TABLE, error);
    if (!result)
        result = check_depth(def, has_depth, error);
    return result;
}

// -------------------------------------------------------------------------------------------- rows

// Task of one thread: fills row index % height of slice index / height of a table.
static void fill_row(void *data, int index)
{
    const fill_job *job = data;
    const kiln_table_def *def = job->def;
    int slice = index / def->height, row = index % def->height;
    double nov, roughness, third;
    kiln_table_texel(job->table, 0, row, slice, &nov, &roughness, &third);
    float *texel =
        job->table->image.pixels + (size_t)index * (size_t)def->width * (size_t)job->channels;
    for (int x = 0; x < def->width; x += CHUNK) {
        double chunk[CHUNK], values[CHUNK * MAX_CHANNELS];
        int count = ki_min(CHUNK, def->width - x);
        ki_axis_columns(def, roughness, x, count, chunk);
        job->fill(job, roughness, third, chunk, count, values);
        for (int i = 0; i < count * job->channels; i++)
            *texel++ = (float)(def->complement ? 1 - values[i] : values[i]);
    }
}

// Task of one thread: fills one row of a table of KILN_TABLE_E_WALK in all slices, because one set
// of random walks serves every F0.
static void fill_walk_row(void *data, int row)
{
    const fill_job *job = data;
    const kiln_table_def *def = job->def;
    size_t slice = (size_t)def->width * (size_t)def->height;
    float *pixels = job->table->image.pixels + (size_t)row * (size_t)def->width;
    for (int z = 0; z < def->depth; z += KI_WALK_COLUMN) {
        double f0[KI_WALK_COLUMN], added[KI_WALK_COLUMN];
        int count = ki_min(KI_WALK_COLUMN, def->depth - z);
        for (int x = 0; x < def->width; x++) {
            double nov = 0, roughness = 0;
            for (int i = 0; i < count; i++)
                kiln_table_texel(job->table, x, row, z + i, &nov, &roughness, &f0[i]);
            ki_walk_column(roughness, nov, f0, count, def->path_count, 0, added);
            for (int i = 0; i < count; i++) {
                double value = def->complement ? 1 - added[i] : added[i];
                pixels[(size_t)(z + i) * slice + (size_t)x] = (float)value;
            }
        }
    }
}

// Returns true for tables of the albedo E that have more than four times as many texels as the
// Chebyshev series of E (surface.h) needs integrals at most.
static bool wants_surface(const kiln_table_def *def)
{
    return def->kind == KILN_TABLE_E && def->model.d == KILN_D_GGX &&
           def->width * def->height > 4 * KI_SURFACE_NOV * KI_SURFACE_ROUGHNESS;
}

static kiln_result fill_table(kiln_context *context, kiln_table *table, kiln_error *error)
{
    const kiln_table_def *def = &table->def;
    fill_job job = {.context = context,
                    .table = table,
                    .def = def,
                    .fill = fill_of[def->kind],
                    .channels = ki_table_channels(def->kind)};
    ki_surface *surface = NULL;
    if (wants_surface(def)) {
        surface = ki_alloc_raw(context, 1, sizeof *surface);
        if (!surface)
            return ki_fail_memory(context, error, "a table's series", sizeof *surface);
        ki_surface_build(context, &def->model, surface);
    }
    job.surface = surface;
    ki_progress_range range = {"table", 0, 1};
    bool walks = def->kind == KILN_TABLE_E_WALK;
    bool whole = ki_parallel_steps(context, &range, walks ? def->height : def->height * def->depth,
                                   walks ? fill_walk_row : fill_row, &job);
    ki_free(surface);
    return whole ? KILN_OK : ki_fail_cancelled(error, "table");
}

kiln_result kiln_table_create(kiln_context *context, const kiln_table_def *def, kiln_table *table,
                              kiln_error *error)
{
    *table = (kiln_table){.def = def ? *def : (kiln_table_def){0}};
    kiln_result result = ki_table_complete(&table->def, error);
    if (!result)
        result = kiln_image_create(context, table->def.width, table->def.height * table->def.depth,
                                   ki_table_channels(table->def.kind), &table->image, error);
    if (!result)
        result = table->def.kind == KILN_TABLE_LOBES ? ki_lobes_fill(context, table, error)
                                                     : fill_table(context, table, error);
    if (result)
        kiln_table_free(table);
    return result;
}

void kiln_table_free(kiln_table *table)
{
    if (!table)
        return;
    kiln_image_free(&table->image);
    *table = (kiln_table){0};
}
