#include "context.h"

kiln_context *context;
kiln_error error;

int set_up(void **state)
{
    (void)state;
    return kiln_context_create(&(kiln_context_def){.thread_count = 2}, &context, &error) != KILN_OK;
}

int tear_down(void **state)
{
    (void)state;
    size_t held = 0;
    kiln_context_memory(context, &held, NULL);
    kiln_context_destroy(context);
    return held != 0;
}

int set_up_folder(void **state)
{
    folder_make();
    return set_up(state);
}

int tear_down_folder(void **state)
{
    folder_remove();
    return tear_down(state);
}

int tear_down_empty_folder(void **state)
{
    bool left = file_count(folder_path()) != 0;
    return tear_down_folder(state) || left;
}
