#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const fuzz_target fuzz_targets[] = {{"exr", fuzz_decode, "\x76\x2f\x31\x01", 4},
                                    {"hdr", fuzz_decode, "#?", 2},
                                    {"png", fuzz_decode, "\x89PNG\r\n\x1a\n", 8},
                                    {"jpeg", fuzz_decode, "\xff\xd8\xff", 3},
                                    {"ktx1", fuzz_decode, "\xabKTX 11\xbb\r\n\x1a\n", 12},
                                    {"ktx2", fuzz_decode, "\xabKTX 20\xbb\r\n\x1a\n", 12},
                                    {"dds", fuzz_decode, "DDS ", 4},
                                    {"env", fuzz_decode, "\x86\x16\x87\x96\xf6\xd6\x96\x36", 8},
                                    {"glb", fuzz_decode, "glTF", 4},
                                    {"galacean", fuzz_galacean, NULL, 0},
                                    {"rows", fuzz_rows, NULL, 0},
                                    {"exr_chunk", fuzz_exr_chunk, NULL, 0},
                                    {"png_rows", fuzz_png_rows, NULL, 0},
                                    {"uastc", fuzz_uastc, NULL, 0},
                                    {"deflate", fuzz_deflate, NULL, 0},
                                    {"icc", fuzz_icc, NULL, 0},
                                    {"gain_map", fuzz_gain_map, NULL, 0},
                                    {"metadata", fuzz_metadata, NULL, 0},
                                    {"json", fuzz_json, NULL, 0},
                                    {"harmonics", fuzz_harmonics, NULL, 0},
                                    {"table", fuzz_table, NULL, 0},
                                    {"table_text", fuzz_table_text, NULL, 0},
                                    {"engine_text", fuzz_engine_text, NULL, 0},
                                    {"number", fuzz_number, NULL, 0},
                                    {"shown_text", fuzz_shown_text, NULL, 0},
                                    {"faces", fuzz_faces, NULL, 0},
                                    {"folder", fuzz_folder, NULL, 0},
                                    {"input", fuzz_input, NULL, 0},
                                    {"eval", fuzz_eval, NULL, 0},
                                    {"manifest", fuzz_manifest, NULL, 0},
                                    {NULL, NULL, NULL, 0}};

void fuzz_run(const fuzz_target *target, const uint8_t *bytes, size_t size)
{
    if (size < target->first_size)
        return;
    // The copy has exactly this size, so that the sanitizer sees a read past its end.
    uint8_t *copy = malloc(size ? size : 1);
    fuzz_must(copy != NULL);
    if (size)
        memcpy(copy, bytes, size);
    if (target->first)
        memcpy(copy, target->first, target->first_size);
    target->run(copy, size);
    free(copy);
}

const fuzz_target *fuzz_find(const char *name)
{
    for (const fuzz_target *target = fuzz_targets; target->name; target++)
        if (!strcmp(target->name, name))
            return target;
    fprintf(stderr, "%s: there is no such fuzz target\n", name);
    exit(2);
}
