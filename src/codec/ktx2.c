// Reads a KTX2 file as a cube (six faces) or as a table (one face).
#include "codec/ktx2.h"

kiln_result ki_ktx2_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, ki_decoded *decoded, kiln_file_info *info,
                           kiln_error *error)
{
    ki_ktx2_source s;
    kiln_result result = ki_ktx2_open(&s, bytes, size, name, info, error);
    if (result != KILN_OK)
        return result;
    return s.face_count == 6
               ? ki_ktx2_decode_cube(context, &s, decoded ? &decoded->map : NULL, info, error)
               : ki_ktx2_decode_table(context, &s, decoded ? &decoded->image : NULL, info, error);
}
