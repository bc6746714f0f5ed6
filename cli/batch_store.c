// Memory that is freed all at once: pieces of at least 64 kB, which are filled from the beginning.
#include "batch.h"

#include <stdlib.h>
#include <string.h>

enum { PIECE = 1 << 16, ALIGNMENT = sizeof(void *) };

struct batch_piece {
    struct batch_piece *below;
    size_t used, size;
    char *bytes;
};

void *batch_keep(batch_store *store, size_t size)
{
    struct batch_piece *piece = store->piece;
    if (size > SIZE_MAX / 2)
        return NULL;
    size = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (!piece || piece->size - piece->used < size) {
        size_t room = size > PIECE ? size : PIECE;
        piece = malloc(sizeof *piece + room);
        if (!piece)
            return NULL;
        *piece = (struct batch_piece){store->piece, 0, room, (char *)(piece + 1)};
        store->piece = piece;
    }
    void *kept = piece->bytes + piece->used;
    piece->used += size;
    return kept;
}

char *batch_keep_text(batch_store *store, const char *text, size_t length)
{
    char *kept = batch_keep(store, length + 1);
    if (kept) {
        memcpy(kept, text, length);
        kept[length] = 0;
    }
    return kept;
}

void batch_store_free(batch_store *store)
{
    for (struct batch_piece *piece = store->piece, *below; piece; piece = below) {
        below = piece->below;
        free(piece);
    }
    store->piece = NULL;
}
