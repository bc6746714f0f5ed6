// Files of panoramas whose rows are decoded when a bake asks for them, so that neither the file nor
// the picture is in memory as a whole.
#ifndef KI_ROW_FILE_H
#define KI_ROW_FILE_H

#include "base/base.h"
#include "base/file.h"
#include "base/os.h"
#include "image/color.h"

enum { KI_ROW_BUFFERS = 256 }; ///< greatest number of buffers that are kept
/// Memory that threads take for the time of one call and give back, which costs less than to
/// allocate the memory anew for each call.
typedef struct ki_row_pool {
    kiln_context *context;
    ki_os_mutex mutex;
    ki_buffer buffer[KI_ROW_BUFFERS];
    int count;
} ki_row_pool;

void ki_row_pool_begin(kiln_context *context, ki_row_pool *pool);
/// Frees the buffers that were given back. No thread has a buffer any more.
void ki_row_pool_end(ki_row_pool *pool);
/// Takes a buffer of at least `size` bytes. Its memory is NULL when memory runs out.
ki_buffer ki_row_pool_take(ki_row_pool *pool, size_t size);
void ki_row_pool_give(ki_row_pool *pool, ki_buffer buffer);

/// A file that is open, and what a decoder of rows gets to know about its use. The fields stay as
/// they are while the decoder is in use.
typedef struct ki_row_input {
    kiln_context *context;
    const char *name;  ///< name of the file in error messages
    const char *layer; ///< layer of an EXR file; NULL for the usual choice
    bool any_layout;   ///< true: the file decides what its picture is; false: it is a panorama
    ki_open_file file;
    ki_row_pool pool;
} ki_row_input;

/// Decodes rows of one panorama. {0} is no decoder.
typedef struct ki_row_decoder {
    void *state; ///< the decoder's own data
    /// Writes rows as they are in the file, before the colours are converted and values that are no
    /// radiance are replaced. Called on several threads at the same time.
    kiln_result (*decode)(const void *state, int first, int count, float *rgb, kiln_error *error);
    void (*close)(void *state);
    int size;         ///< number of rows
    int block, phase; ///< blocks of rows as in kiln_rows
    bool converts;    ///< true: colours are multiplied by `matrix`
    ki_matrix3 matrix;
} ki_row_decoder;

/// Open a file of the format of the function's name for decoding by rows. *decoder stays empty if
/// the file cannot be decoded so, for example because it is damaged or holds no panorama; the file
/// is then loaded as a whole, which explains what is wrong. Notes are added to *report. The
/// function fails only if memory runs out or the caller asks to stop.
kiln_result ki_exr_rows_open(ki_row_input *input, ki_row_decoder *decoder, kiln_load_report *report,
                             kiln_error *error);
kiln_result ki_hdr_rows_open(ki_row_input *input, ki_row_decoder *decoder, kiln_load_report *report,
                             kiln_error *error);

/// A file whose rows pass by.
typedef struct ki_row_file ki_row_file;

/// Opens a file for a bake of its rows. *file is NULL if the file cannot be decoded by rows, which
/// is no failure. Otherwise `rows` reads from *file.
kiln_result ki_row_file_open(kiln_context *context, const char *path, const kiln_load_def *def,
                             ki_row_file **file, kiln_rows *rows, kiln_error *error);
/// Returns whether the rows that were read hold values that only the whole picture can replace:
/// values that are not a number.
bool ki_row_file_needs_whole(const ki_row_file *file);
/// Completes the report after all rows were read, and copies it to the load definition's. Rows are
/// read again if the light of all rows must be known. Fails if no texel has finite values.
kiln_result ki_row_file_finish(ki_row_file *file, kiln_error *error);
/// Closes a file. `file` may be NULL.
void ki_row_file_close(ki_row_file *file);

#endif
