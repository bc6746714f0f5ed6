// Fuzz targets: functions that take any bytes. A target must return, must not use memory that is
// not its own, must release what it allocates, and aborts if a result breaks a law that its comment
// states. libFuzzer calls a target (entry.c) with bytes that libFuzzer changes to reach more code.
// The test `corpus` calls the targets (replay.c) with the files that libFuzzer found earlier.
#ifndef KILN_FUZZ_H
#define KILN_FUZZ_H

#include "base/base.h"

typedef struct fuzz_target {
    const char *name;
    void (*run)(const uint8_t *bytes, size_t size);
    // For a target that reads files of one format: the bytes by which kiln recognises the format.
    // NULL for others.
    const char *first;
    size_t first_size;
} fuzz_target;

/// All targets; the last has no name.
extern const fuzz_target fuzz_targets[];
/// Runs a target with a copy of the bytes that begins with the target's first bytes, so that every
/// input is a file of the target's format. Inputs shorter than the first bytes are left out.
void fuzz_run(const fuzz_target *target, const uint8_t *bytes, size_t size);
/// Returns the target with this name, or ends the program.
const fuzz_target *fuzz_find(const char *name);

// The targets, each in the file that is named here.

// decode.c: files.

/// Describes and reads a file of any format.
void fuzz_decode(const uint8_t *bytes, size_t size);
/// A file of Galacean Engine whose length fits its size.
void fuzz_galacean(const uint8_t *bytes, size_t size);
/// Reads a file by rows, and as a whole. The function is in rows.c.
void fuzz_rows(const uint8_t *bytes, size_t size);
/// Harmonics as JSON, lines of text, Filament's text and C arrays.
void fuzz_harmonics(const uint8_t *bytes, size_t size);
// parts.c: what lies inside of files, put into a file that is otherwise whole.
void fuzz_exr_chunk(const uint8_t *bytes, size_t size);
void fuzz_png_rows(const uint8_t *bytes, size_t size);
void fuzz_uastc(const uint8_t *bytes, size_t size);
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
// paths.c: what is read from a path: a table, standard input, the names of six faces, and a folder
// of faces.
void fuzz_table(const uint8_t *bytes, size_t size);
void fuzz_input(const uint8_t *bytes, size_t size);
void fuzz_faces(const uint8_t *bytes, size_t size);
void fuzz_folder(const uint8_t *bytes, size_t size);
// manifest.c: manifests of `kiln batch`.
void fuzz_manifest(const uint8_t *bytes, size_t size);
// eval.c: the command `kiln eval`.
void fuzz_eval(const uint8_t *bytes, size_t size);

// check.c: what the targets share.

/// Ends the program by abort() unless a law holds.
void fuzz_must(bool holds);
/// A context of one thread with this memory limit.
kiln_context *fuzz_context(size_t memory_limit);
/// Destroys a context, which must hold no memory any more.
void fuzz_end(kiln_context *context);
/// A copy with a NUL behind its last byte, to be released by free(). Its memory ends there, so that
/// a read past the end is seen.
char *fuzz_text(const uint8_t *bytes, size_t size);
void fuzz_must_be_finite(const float *values, size_t count);
/// Checks that a text ends within its room.
void fuzz_must_end(const char *text, size_t room);
/// Checks what kiln says of a file: texts end, and numbers are in range.
void fuzz_check_info(const kiln_file_info *info);

#endif
