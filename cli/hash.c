// The checksum XXH64. In: bytes. Out: 64 bits. Method: four sums take 8 bytes each of every 32
// bytes. At the end the four sums, and then the last bytes, which are fewer than 32, are mixed into
// one number. Source: "xxHash fast digest algorithm", version 0.1.1, section XXH64.
#include "hash.h"
#include "os.h"

#include <errno.h>
#include <string.h>

enum { STRIPE = 32, BUFFER = 1 << 16 };

static const uint64_t prime[5] = {0x9e3779b185ebca87, 0xc2b2ae3d27d4eb4f, 0x165667b19e3779f9,
                                  0x85ebca77c2b2ae63, 0x27d4eb2f165667c5};

static uint64_t rotate(uint64_t x, int bits)
{
    return x << bits | x >> (64 - bits);
}

// Reads `count` bytes as a number whose first byte is the least.
static uint64_t read_number(const uint8_t *at, int count)
{
    uint64_t value = 0;
    for (int i = 0; i < count; i++)
        value |= (uint64_t)at[i] << (8 * i);
    return value;
}

static uint64_t add_lane(uint64_t sum, uint64_t lane)
{
    return rotate(sum + lane * prime[1], 31) * prime[0];
}

typedef struct state {
    uint64_t sum[4], length;
} state;

static state begin(void)
{
    return (state){.sum = {prime[0] + prime[1], prime[1], 0, 0 - prime[0]}};
}

// Adds `size` bytes, a multiple of 32.
static void add(state *s, const uint8_t *at, size_t size)
{
    s->length += size;
    for (const uint8_t *end = at + size; at < end; at += STRIPE)
        for (size_t k = 0; k < 4; k++)
            s->sum[k] = add_lane(s->sum[k], read_number(at + 8 * k, 8));
}

static uint64_t merge(const state *s)
{
    uint64_t h =
        rotate(s->sum[0], 1) + rotate(s->sum[1], 7) + rotate(s->sum[2], 12) + rotate(s->sum[3], 18);
    for (int k = 0; k < 4; k++)
        h = (h ^ add_lane(0, s->sum[k])) * prime[0] + prime[3];
    return h;
}

// Ends with `size` bytes, fewer than 32.
static uint64_t finish(const state *s, const uint8_t *at, size_t size)
{
    uint64_t h = (s->length ? merge(s) : prime[4]) + s->length + size;
    for (; size >= 8; at += 8, size -= 8)
        h = rotate(h ^ add_lane(0, read_number(at, 8)), 27) * prime[0] + prime[3];
    if (size >= 4) {
        h = rotate(h ^ (read_number(at, 4) * prime[0]), 23) * prime[1] + prime[2];
        at += 4;
        size -= 4;
    }
    for (; size; at++, size--)
        h = rotate(h ^ (*at * prime[4]), 11) * prime[0];
    h = (h ^ h >> 33) * prime[1];
    h = (h ^ h >> 29) * prime[2];
    return h ^ h >> 32;
}

uint64_t hash_bytes(const void *bytes, size_t size)
{
    state s = begin();
    size_t whole = size - size % STRIPE;
    add(&s, bytes, whole);
    return finish(&s, (const uint8_t *)bytes + whole, size - whole);
}

bool hash_file(const char *path, uint64_t *hash)
{
    uint8_t buffer[BUFFER];
    state s = begin();
    size_t filled = 0;
    FILE *file = os_open_file(path);
    *hash = 0;
    if (!file)
        return false;
    setvbuf(file, NULL, _IONBF, 0);
    for (size_t got; (got = fread(buffer + filled, 1, BUFFER - filled, file)) > 0;) {
        size_t whole = (filled + got) / STRIPE * STRIPE;
        add(&s, buffer, whole);
        filled += got - whole;
        memmove(buffer, buffer + whole, filled);
    }
    bool failed = ferror(file) != 0;
    int reason = errno;
    fclose(file);
    *hash = finish(&s, buffer, filled);
    errno = reason;
    return !failed;
}
