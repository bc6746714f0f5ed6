// Bakes a panorama into the files that an engine loads, as `kiln bake IN --for ENGINE -o OUT` does.
// Usage: bake IN.exr OUT [ENGINE]
#include <kiln/kiln.h>

#include <stdio.h>

static kiln_result bake(kiln_context *context, const char *from, const char *to,
                        const kiln_engine *engine, kiln_error *error)
{
    kiln_map source = {0};
    kiln_environment made = {0};
    kiln_bake_def def = {.engine = engine, .irradiance_size = KILN_NO_IRRADIANCE};
    kiln_environment_save_def save = {.engine = engine};
    kiln_environment_report report = {0};
    kiln_result result = kiln_map_load(context, from, NULL, &source, error);
    if (result == KILN_OK)
        result = kiln_bake(context, &source, &def, &made, error);
    if (result == KILN_OK)
        result = kiln_environment_save(context, &made, to, &save, &report, error);
    if (result == KILN_OK)
        printf("%s: %d levels from %d texels on, %d file%s, %zu values cut off at %g\n", to,
               made.levels.level_count, made.levels.size, report.file_count,
               report.file_count > 1 ? "s" : "", report.levels.cut_count, report.levels.limit);
    kiln_environment_free(&made);
    kiln_map_free(&source);
    return result;
}

int main(int argc, char **argv)
{
    kiln_context *context = NULL;
    kiln_error error = {0};
    const kiln_engine *engine = argc > 3 ? kiln_engine_find(argv[3]) : NULL;
    if (argc < 3 || (argc > 3 && !engine)) {
        fprintf(stderr, "usage: bake IN.exr OUT [ENGINE]\n");
        return 2;
    }
    if (kiln_context_create(NULL, &context, &error) ||
        bake(context, argv[1], argv[2], engine, &error))
        fprintf(stderr, "bake: %s\n", error.message);
    kiln_context_destroy(context);
    return error.result ? 1 : 0;
}
