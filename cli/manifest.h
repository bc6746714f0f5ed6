// Reads JSON objects whose members are texts, numbers, truth values, null, or arrays of these.
#ifndef KILN_CLI_MANIFEST_H
#define KILN_CLI_MANIFEST_H

#include <stdbool.h>
#include <stddef.h>

typedef enum manifest_kind {
    MANIFEST_TEXT,
    MANIFEST_NUMBER,
    MANIFEST_TRUE,
    MANIFEST_FALSE,
    MANIFEST_NULL,
    MANIFEST_LIST
} manifest_kind;

enum { MANIFEST_ITEMS = 64, MANIFEST_MEMBERS = 64 };

/// A value with its text: of a text without escape sequences, of a number as it stands in the file.
typedef struct manifest_value {
    manifest_kind kind;
    char *text; ///< NULL for true, false, null and lists
} manifest_value;

/// A member of an object. The texts lie in the reader's bytes.
typedef struct manifest_member {
    const char *key;
    manifest_value value;
    int item_count; ///< number of items of a list
    manifest_value item[MANIFEST_ITEMS];
} manifest_member;

typedef struct manifest_reader {
    char *at, *end;      ///< the bytes to read, which are overwritten by the texts
    int line;            ///< number of the line of `at`, from 1
    const char *problem; ///< what is wrong with the bytes, or NULL
    int problem_line;    ///< the line in which something is wrong
    int object_line;     ///< line in which the last object begins
} manifest_reader;

/// Reads the next object into `members`, an array of MANIFEST_MEMBERS, and returns the number of
/// its members. Returns -1 at the end, or with `problem` set if the bytes are not such an object.
int manifest_read(manifest_reader *reader, manifest_member *members);

#endif
