// Loads the wheel's library by musl's loader and bakes with two threads: musl.c LIBRARY prints
// "0.2.0 1.0000".
#include <dlfcn.h>
#include <kiln/kiln.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    void *library = argc == 2 ? dlopen(argv[1], RTLD_NOW) : NULL;
    if (!library) {
        fprintf(stderr, "%s\n", argc == 2 ? dlerror() : "usage: musl LIBRARY");
        return 1;
    }
    const char *(*version)(void);
    kiln_result (*create)(const kiln_context_def *, kiln_context **, kiln_error *);
    kiln_result (*pixels)(kiln_context *, const kiln_pixels *, kiln_map *, kiln_error *);
    kiln_result (*bake)(kiln_context *, const kiln_map *, const kiln_bake_def *, kiln_environment *,
                        kiln_error *);
    *(void **)&version = dlsym(library, "kiln_version");
    *(void **)&create = dlsym(library, "kiln_context_create");
    *(void **)&pixels = dlsym(library, "kiln_map_from_pixels");
    *(void **)&bake = dlsym(library, "kiln_bake");
    static float white[16 * 32 * 3];
    for (size_t i = 0; i < sizeof white / sizeof *white; i++)
        white[i] = 1;
    kiln_context *context;
    kiln_error error = {0};
    kiln_map map;
    kiln_environment made;
    const kiln_pixels source = {.data = white, .width = 32, .height = 16, .channels = 3};
    if (create(&(kiln_context_def){.thread_count = 2}, &context, &error) ||
        pixels(context, &source, &map, &error) ||
        bake(context, &map, &(kiln_bake_def){.levels = {.size = 8}}, &made, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    printf("%s %.4f\n", version(), (double)made.levels.level[2][0]);
    return 0;
}
