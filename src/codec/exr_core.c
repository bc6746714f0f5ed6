// PIZ, PXR24 and B44: OpenEXRCore's pipeline between our buffers.
#include "codec/exr.h"

static exr_result_t already_read(exr_decode_pipeline_t *pipeline)
{
    (void)pipeline;
    return EXR_ERR_SUCCESS;
}

bool ki_exr_undo_other(kiln_context *context, exr_const_context_t core, int part,
                       const exr_chunk_info_t *info, const ki_exr_box *box, int compression,
                       const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size)
{
    (void)context, (void)box, (void)compression;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    if (exr_decoding_initialize(core, part, info, &pipeline) != EXR_ERR_SUCCESS)
        return false;
    bool good = exr_decoding_choose_default_routines(core, part, &pipeline) == EXR_ERR_SUCCESS;
    if (good) {
        union {
            const uint8_t *input;
            void *buffer;
        } bytes = {packed};
        pipeline.read_fn = already_read;
        pipeline.unpack_and_convert_fn = NULL;
        pipeline.packed_buffer = bytes.buffer; // only read
        pipeline.packed_alloc_size = packed_size;
        pipeline.unpacked_buffer = raw;
        pipeline.unpacked_alloc_size = size;
        good = exr_decoding_run(core, part, &pipeline) == EXR_ERR_SUCCESS &&
               pipeline.unpacked_buffer == raw;
        pipeline.packed_buffer = NULL;
        pipeline.packed_alloc_size = 0;
        pipeline.unpacked_buffer = NULL;
        pipeline.unpacked_alloc_size = 0;
    }
    exr_decoding_destroy(core, &pipeline);
    return good;
}
