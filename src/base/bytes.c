#include "base/bytes.h"
#include "base/os.h"

#include <stdio.h>
#include <string.h>

uint8_t *ki_write_room(ki_writer *w, size_t size)
{
    if (w->failed)
        return NULL;
    if (size > w->capacity - w->size) {
        size_t capacity = w->capacity ? w->capacity : 4096;
        while (capacity - w->size < size) {
            if (capacity > SIZE_MAX / 2) {
                w->failed = true;
                return NULL;
            }
            capacity *= 2;
        }
        uint8_t *bytes = ki_alloc_raw(w->context, capacity, 1);
        if (!bytes) {
            w->failed = true;
            return NULL;
        }
        if (w->size)
            memcpy(bytes, w->bytes, w->size);
        ki_free(w->bytes);
        w->bytes = bytes;
        w->capacity = capacity;
    }
    uint8_t *room = w->bytes + w->size;
    w->size += size;
    return room;
}

void ki_write(ki_writer *w, const void *bytes, size_t size)
{
    uint8_t *room = size ? ki_write_room(w, size) : NULL;
    if (room)
        memcpy(room, bytes, size);
}

static void put(uint8_t *room, uint64_t value, int count)
{
    for (int i = 0; room && i < count; i++)
        room[i] = (uint8_t)(value >> (8 * i));
}

void ki_write_u8(ki_writer *w, uint8_t value)
{
    put(ki_write_room(w, 1), value, 1);
}

void ki_write_u16(ki_writer *w, uint16_t value)
{
    put(ki_write_room(w, 2), value, 2);
}

void ki_write_u32(ki_writer *w, uint32_t value)
{
    put(ki_write_room(w, 4), value, 4);
}

void ki_write_u64(ki_writer *w, uint64_t value)
{
    put(ki_write_room(w, 8), value, 8);
}

void ki_write_text(ki_writer *w, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    int length = ki_os_print(text, sizeof text, format, list);
    va_end(list);
    if (length < 0 || (size_t)length >= sizeof text)
        w->failed = true;
    else
        ki_write(w, text, (size_t)length);
}

void ki_write_align(ki_writer *w, size_t alignment)
{
    size_t missing = (alignment - w->size % alignment) % alignment;
    uint8_t *room = missing ? ki_write_room(w, missing) : NULL;
    if (room)
        memset(room, 0, missing);
}

void ki_patch_u32(ki_writer *w, size_t at, uint32_t value)
{
    if (!w->failed && at + 4 <= w->size)
        put(w->bytes + at, value, 4);
}

void ki_patch_u64(ki_writer *w, size_t at, uint64_t value)
{
    if (!w->failed && at + 8 <= w->size)
        put(w->bytes + at, value, 8);
}

void ki_writer_free(ki_writer *w)
{
    ki_free(w->bytes);
    *w = (ki_writer){0};
}
