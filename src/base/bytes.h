// Reading and writing of little-endian bytes, with checked bounds.
#ifndef KI_BYTES_H
#define KI_BYTES_H

#include "base/base.h"

/// Bytes that are read from `at` to `end`. Reading past the end gives zeros and sets `failed`,
/// which stays set: a parser can read a whole header and check once.
typedef struct ki_reader {
    const uint8_t *at, *end;
    bool failed;
} ki_reader;

static inline ki_reader ki_reader_make(const void *bytes, size_t size)
{
    return (ki_reader){bytes, (const uint8_t *)bytes + size, false};
}

static inline size_t ki_reader_left(const ki_reader *r)
{
    return (size_t)(r->end - r->at);
}

/// Returns a pointer to the next `size` bytes and advances past them, or returns NULL if fewer
/// bytes are left.
static inline const uint8_t *ki_read_bytes(ki_reader *r, size_t size)
{
    if (r->failed || ki_reader_left(r) < size) {
        r->failed = true;
        return NULL;
    }
    const uint8_t *bytes = r->at;
    r->at += size;
    return bytes;
}

static inline uint8_t ki_read_u8(ki_reader *r)
{
    const uint8_t *b = ki_read_bytes(r, 1);
    return b ? b[0] : 0;
}

static inline uint32_t ki_read_u32(ki_reader *r)
{
    const uint8_t *b = ki_read_bytes(r, 4);
    return b ? (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24
             : 0;
}

static inline uint64_t ki_read_u64(ki_reader *r)
{
    uint64_t low = ki_read_u32(r);
    return low | (uint64_t)ki_read_u32(r) << 32;
}

/// An array of bytes that grows by writing. A failed allocation sets `failed`, and later writes do
/// nothing.
typedef struct ki_writer {
    kiln_context *context;
    uint8_t *bytes;
    size_t size, capacity;
    bool failed;
} ki_writer;

/// Appends `size` bytes that are not initialised, and returns a pointer to them. Returns NULL on
/// failure.
uint8_t *ki_write_room(ki_writer *w, size_t size);
void ki_write(ki_writer *w, const void *bytes, size_t size);
void ki_write_u8(ki_writer *w, uint8_t value);
void ki_write_u16(ki_writer *w, uint16_t value);
void ki_write_u32(ki_writer *w, uint32_t value);
void ki_write_u64(ki_writer *w, uint64_t value);
/// Appends text made by printf's format, without its terminating NUL.
void ki_write_text(ki_writer *w, const char *format, ...) KI_PRINTF(2, 3);
/// Appends zeros until the size is a multiple of `alignment`.
void ki_write_align(ki_writer *w, size_t alignment);
/// Overwrites bytes that were already written, at the position `at`.
void ki_patch_u32(ki_writer *w, size_t at, uint32_t value);
void ki_patch_u64(ki_writer *w, size_t at, uint64_t value);
void ki_writer_free(ki_writer *w);

#endif
