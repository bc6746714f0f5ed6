// A folder for the files of a test program, and files as a whole.
#ifndef KILN_KIT_FOLDER_H
#define KILN_KIT_FOLDER_H

#include <kiln/kiln.h>

#include <stddef.h>
#include <stdint.h>

/// Makes a new folder for this program in /tmp. Only one such folder exists at a time.
void folder_make(void);

/// The folder's path, without a slash at the end.
const char *folder_path(void);

/// The path of a name in the folder. Eight paths are kept at a time.
const char *in_folder(const char *name);

/// Removes what is in the folder, folders included.
void folder_empty(void);

/// Removes the folder with all that is in it.
void folder_remove(void);

/// The number of files and folders in a folder, hidden files included.
int file_count(const char *path);

/// The bytes of a file and a 0 behind them, to be released by free(). Fails if the file cannot be
/// read.
uint8_t *read_file(const char *path, size_t *size);

/// The bytes of a panorama of npm's @pmndrs/assets under `folder`, to be released by free(). The
/// panorama is a data URL inside of a module of JavaScript.
uint8_t *read_asset(const char *folder, const char *name, size_t *size);

typedef struct folder_file {
    char name[64];
    uint8_t *bytes; // to be released by free()
    size_t size;
} folder_file;

/// Reads all files of a folder that are not hidden, in any order, at most `most`. Returns their
/// number.
int read_folder(const char *path, folder_file *files, int most);

/// Writes a file of these bytes, or replaces it.
void write_file(const char *path, const void *bytes, size_t size);

/// Checks that every file of a list is on the disk with the same bytes, and removes these files.
void check_saved_files(const kiln_files *files);

/// Checks that two files have the same bytes, at least one.
void check_same_files(const char *a, const char *b);

#endif
