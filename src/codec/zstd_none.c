// The functions of zstd.h for a build without the zstd library.
#include "codec/zstd.h"

kiln_result ki_zstd_known(const char *name, kiln_error *error)
{
    return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                   "%s: this build of kiln has no zstd, which the CMake option KILN_ZSTD adds",
                   name);
}

size_t ki_zstd_bound(size_t size)
{
    return size;
}

kiln_result ki_zstd_pack(kiln_context *context, const uint8_t *plain, size_t size, int level,
                         uint8_t *room, size_t bound, size_t *packed_size)
{
    (void)context, (void)plain, (void)size, (void)level, (void)room, (void)bound;
    *packed_size = 0;
    return KILN_ERROR_MEMORY;
}

bool ki_zstd_stated_size(const uint8_t *packed, size_t packed_size, uint64_t *size)
{
    (void)packed, (void)packed_size;
    *size = 0;
    return false;
}

kiln_result ki_zstd_unpack(kiln_context *context, const uint8_t *packed, size_t packed_size,
                           uint8_t *plain, size_t size, const char **fault)
{
    (void)context, (void)packed, (void)packed_size, (void)plain, (void)size;
    *fault = "this build of kiln has no zstd";
    return KILN_ERROR_FORMAT;
}
