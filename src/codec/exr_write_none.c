// A build without libdeflate reads EXR and does not write it.
#include "codec/codec.h"

kiln_result ki_exr_encode(const float *pixels, int width, int height, int channels,
                          const ki_exr_options *options, ki_writer *writer, kiln_error *error)
{
    (void)pixels, (void)width, (void)height, (void)channels, (void)options, (void)writer;
    return ki_fail(error, KILN_ERROR_UNSUPPORTED, "this build of kiln does not write EXR");
}
