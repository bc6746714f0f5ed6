// Memory that the threads that decode rows take and give back.
#include "codec/row_file.h"

void ki_row_pool_begin(kiln_context *context, ki_row_pool *pool)
{
    *pool = (ki_row_pool){.context = context};
    ki_os_mutex_begin(&pool->mutex);
}

ki_buffer ki_row_pool_take(ki_row_pool *pool, size_t size)
{
    ki_buffer buffer = {0};
    ki_os_lock(&pool->mutex);
    if (pool->count)
        buffer = pool->buffer[--pool->count];
    ki_os_unlock(&pool->mutex);
    (void)ki_buffer_reserve(pool->context, &buffer, size, 1);
    return buffer;
}

void ki_row_pool_give(ki_row_pool *pool, ki_buffer buffer)
{
    ki_os_lock(&pool->mutex);
    bool room = pool->count < KI_ROW_BUFFERS;
    if (room)
        pool->buffer[pool->count++] = buffer;
    ki_os_unlock(&pool->mutex);
    if (!room)
        ki_buffer_free(&buffer);
}

void ki_row_pool_end(ki_row_pool *pool)
{
    for (int i = 0; i < pool->count; i++)
        ki_buffer_free(&pool->buffer[i]);
    ki_os_mutex_end(&pool->mutex);
}
