// An EXR file that is being read: what exr.c, which reads whole pictures, and exr_rows.c, which
// reads rows of a picture, share.
#ifndef KI_EXR_FILE_H
#define KI_EXR_FILE_H

#include "codec/exr.h"

/// Greatest number of tasks that decode chunks of a file at the same time.
enum { KI_EXR_TASKS = 1024 };

typedef struct ki_exr_file {
    kiln_context *context;
    const char *name;
    ki_exr_header header;
    ki_exr_layers layers;
    ki_exr_layer layer;      // the layer that is read
    bool chosen;             // false: no layer is the picture, and `layer` is only described
    const ki_exr_part *part; // the part of the layer
    int sampling;            // 2 if chroma has a sample in every second column and line, else 1
    ki_exr_color color;
    ki_exr_picture picture;
    ki_exr_chunk *chunks;
    int chunk_count;
    uint16_t *dwa_table;
    ki_asker asker; // of the decoding of chunks
    int task_count;
    uint8_t results[KI_EXR_TASKS]; // the kiln_result of each task that decodes chunks
    int failed_at[KI_EXR_TASKS];   // index of the chunk at which each task failed
} ki_exr_file;

/// Parses the headers in `bytes`, chooses the layer and checks the windows of its part. Called on
/// the thread on which the library was called. `f` has its context and name; ki_exr_close frees
/// `f`, whatever the result is.
kiln_result ki_exr_open(ki_exr_file *f, const uint8_t *bytes, size_t size, const char *wanted,
                        bool describe_only, kiln_error *error);
void ki_exr_close(ki_exr_file *f);
void ki_exr_describe(const ki_exr_file *f, kiln_file_info *info);
/// Notes what is read and how.
void ki_exr_note_all(const ki_exr_file *f, kiln_load_report *report);
/// Returns the number of pixels that lie in both the data window and the display window.
size_t ki_exr_common(const ki_exr_file *f);
/// Fails if the display window is nearly empty. `common` is what ki_exr_common returned.
kiln_result ki_exr_check_common(const ki_exr_file *f, size_t common, kiln_error *error);
/// Makes the table that the file's compression method needs.
kiln_result ki_exr_prepare(ki_exr_file *f, kiln_error *error);
/// Returns whether the colours of the layer are multiplied by color.matrix.
bool ki_exr_converts(const ki_exr_file *f);
/// Fails with the message that chunk `index` is damaged, that memory for it ran out, or that
/// reading was stopped.
kiln_result ki_exr_fail_chunk(const ki_exr_file *f, int index, kiln_result result,
                              kiln_error *error);

#endif
