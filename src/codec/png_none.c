// A build without libpng.
#include "codec/codec.h"

kiln_result ki_png_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error)
{
    (void)context, (void)bytes, (void)size, (void)info;
    if (image)
        *image = (kiln_image){0};
    return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: this build of kiln leaves PNG out", name);
}

kiln_result ki_png_encode(const float *pixels, int width, int height, int channels,
                          ki_png_coding coding, ki_writer *writer, kiln_error *error)
{
    (void)pixels, (void)width, (void)height, (void)channels, (void)coding, (void)writer;
    return ki_fail(error, KILN_ERROR_UNSUPPORTED, "this build of kiln leaves PNG out");
}
