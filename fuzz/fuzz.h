// Fuzz targets: functions that take any bytes and must return, within their memory, without a leak, with
// results that keep the laws which the target states. libFuzzer calls them (entry.c) with bytes that it
// changes to reach more code; the test `corpus` calls them (replay.c) with files that it found earlier.
#ifndef KILN_FUZZ_H
#define KILN_FUZZ_H

#include "base/base.h"

typedef struct fuzz_target {
    const char *name;
    void (*run)(const uint8_t *bytes, size_t size);
} fuzz_target;

/// All targets; the last has no name.
extern const fuzz_target fuzz_targets[];
/// Returns the target with this name, or ends the program.
const fuzz_target *fuzz_find(const char *name);

// The targets, each in the file that is named here.

// decode.c: a file of one format, whose first bytes are put in place, so that every input is of the format.
void fuzz_exr(const uint8_t *bytes, size_t size);
void fuzz_hdr(const uint8_t *bytes, size_t size);
void fuzz_png(const uint8_t *bytes, size_t size);
void fuzz_jpeg(const uint8_t *bytes, size_t size);
void fuzz_ktx1(const uint8_t *bytes, size_t size);
void fuzz_ktx2(const uint8_t *bytes, size_t size);
void fuzz_dds(const uint8_t *bytes, size_t size);
void fuzz_env(const uint8_t *bytes, size_t size);
void fuzz_glb(const uint8_t *bytes, size_t size);
/// What the targets above do with a file's bytes, whatever its format.
void fuzz_decode(const uint8_t *bytes, size_t size);
/// Harmonics as JSON, lines of text, Filament's text and C arrays.
void fuzz_harmonics(const uint8_t *bytes, size_t size);
// parts.c: what lies inside of files, put into a file that is otherwise whole.
void fuzz_exr_chunk(const uint8_t *bytes, size_t size);
void fuzz_png_rows(const uint8_t *bytes, size_t size);
void fuzz_icc(const uint8_t *bytes, size_t size);
void fuzz_gain_map(const uint8_t *bytes, size_t size);
void fuzz_metadata(const uint8_t *bytes, size_t size);
// deflate.c
void fuzz_deflate(const uint8_t *bytes, size_t size);
// text.c: lines of text, numbers, JSON and names of files.
void fuzz_engine_text(const uint8_t *bytes, size_t size);
void fuzz_table_text(const uint8_t *bytes, size_t size);
void fuzz_number(const uint8_t *bytes, size_t size);
void fuzz_json(const uint8_t *bytes, size_t size);
void fuzz_shown_text(const uint8_t *bytes, size_t size);
// paths.c: what is read from a path: a table, standard input, and the names of six faces.
void fuzz_table(const uint8_t *bytes, size_t size);
void fuzz_input(const uint8_t *bytes, size_t size);
void fuzz_faces(const uint8_t *bytes, size_t size);

// check.c: what the targets share.

/// Ends the program by abort() unless a law holds.
void fuzz_must(bool holds);
/// A context of one thread with this memory limit.
kiln_context *fuzz_context(size_t memory_limit);
/// Destroys a context, which must hold no memory any more.
void fuzz_end(kiln_context *context);
/// A copy with a NUL behind its last byte, to be released by free(). Its memory ends there, so that a read
/// past the end is seen.
char *fuzz_text(const uint8_t *bytes, size_t size);
void fuzz_must_be_finite(const float *values, size_t count);
/// Checks that a text ends within its room.
void fuzz_must_end(const char *text, size_t room);
/// Checks what kiln says of a file: texts end, and numbers are in range.
void fuzz_check_info(const kiln_file_info *info);

#endif
