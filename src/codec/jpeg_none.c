// The functions of jpeg_pixels.h for a build without libjpeg-turbo.
#include "codec/jpeg_pixels.h"

kiln_result ki_jpeg_samples(kiln_context *context, ki_span picture, const ki_jpeg_head *head,
                            const char *name, uint8_t **samples, kiln_error *error)
{
    (void)context, (void)picture, (void)head;
    *samples = NULL;
    return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                   "%s: this build of kiln has no JPEG, which the CMake option KILN_JPEG adds; or "
                   "convert the picture by: oiiotool IN --colorconvert sRGB linear -o OUT.exr",
                   name);
}

kiln_result ki_jpeg_write(const uint8_t *samples, int width, int height, int channels, int quality,
                          const char *name, ki_writer *writer, kiln_error *error)
{
    (void)samples, (void)width, (void)height, (void)channels, (void)quality, (void)writer;
    return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                   "%s: this build of kiln has no JPEG, which the CMake option KILN_JPEG adds; or "
                   "write an .hdr panorama by: kiln bake IN --shape panorama --roughness 0 -o "
                   "NAME.hdr",
                   name);
}
