// Reads a KTX2 file as a cube (six faces), as a flat picture or as a table (one face).
#include "codec/ktx2.h"

// Returns whether a texture of one face is a table: kiln wrote the texture as one, or the texture
// has slices, or fewer than three channels.
static bool holds_table(const ki_ktx2_source *s, const kiln_file_info *info)
{
    static const uint32_t few_channels[] = {9, 16, 70, 76, 77, 83, 100, 103};
    bool few = false;
    for (size_t i = 0; i < sizeof few_channels / sizeof *few_channels; i++)
        few = few || s->vk == few_channels[i];
    return info->table[0] || s->depth || few;
}

kiln_result ki_ktx2_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, ki_decoded *decoded, kiln_file_info *info,
                           kiln_error *error)
{
    ki_ktx2_source s;
    kiln_result result = ki_ktx2_open(context, &s, bytes, size, name, info, error);
    if (result != KILN_OK)
        return result;
    kiln_load_report *report = decoded ? &decoded->report : &info->report;
    kiln_image *image = decoded ? &decoded->image : NULL;
    if (s.face_count == 6)
        return ki_ktx2_decode_cube(context, &s, decoded ? &decoded->map : NULL, info, report,
                                   error);
    if (holds_table(&s, info))
        return ki_ktx2_decode_table(context, &s, image, info, error);
    return ki_ktx2_decode_picture(context, &s, image, info, report, error);
}
