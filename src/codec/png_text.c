#include "codec/png_text.h"

#include "codec/deflate.h"
#include "codec/engine_text.h"
#include "codec/file_info.h"

#include <string.h>

// Numbers of bytes. SIGNATURE: PNG's signature. HEADER: the signature and the chunk IHDR, with
// which every file begins. AROUND: what surrounds a chunk's data, its size, type and CRC.
enum { SIGNATURE = 8, HEADER = SIGNATURE + 25, AROUND = 12 };

static void put_high_first(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static uint32_t get_high_first(const uint8_t *from)
{
    return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

void ki_png_add_text(ki_writer *w, size_t start, const char *key, const char *text)
{
    ki_crc32_table table;
    ki_crc32_fill(&table);
    size_t key_size = strlen(key) + 1, data = key_size + strlen(text);
    if (w->failed || !ki_write_room(w, data + AROUND))
        return;
    uint8_t *chunk = w->bytes + start + HEADER;
    memmove(chunk + data + AROUND, chunk, w->size - start - HEADER - data - AROUND);
    put_high_first(chunk, (uint32_t)data);
    memcpy(chunk + 4, "tEXt", 4);
    memcpy(chunk + 8, key, key_size);
    memcpy(chunk + 8 + key_size, text, data - key_size);
    put_high_first(chunk + 8 + data, ki_crc32(&table, 0, chunk + 4, data + 4));
}

// Copies the text of a tEXt chunk's data to `text`, with a NUL at its end, if the chunk's key is
// `key`. Otherwise returns false.
static bool is_text(const uint8_t *data, size_t size, const char *key, char *text, size_t room)
{
    size_t key_size = strlen(key) + 1;
    if (size < key_size || memcmp(data, key, key_size) != 0 || size - key_size >= room)
        return false;
    memcpy(text, data + key_size, size - key_size);
    text[size - key_size] = 0;
    return true;
}

void ki_png_read_texts(const uint8_t *bytes, size_t size, kiln_file_info *info)
{
    char text[512];
    ki_reader r = ki_reader_make(bytes, size);
    ki_read_bytes(&r, SIGNATURE);
    for (;;) {
        const uint8_t *head = ki_read_bytes(&r, 8);
        size_t data_size = head ? get_high_first(head) : 0;
        const uint8_t *data = ki_read_bytes(&r, data_size);
        ki_read_bytes(&r, 4);
        if (!head || r.failed || !memcmp(head + 4, "IDAT", 4))
            return;
        if (memcmp(head + 4, "tEXt", 4) != 0)
            continue;
        if (is_text(data, data_size, "kiln:engine", text, sizeof text))
            ki_engine_text_read(text, info);
        if (is_text(data, data_size, "Software", text, sizeof text) && !strncmp(text, "kiln ", 5))
            ki_copy_printable(info->writer, sizeof info->writer, text);
    }
}
