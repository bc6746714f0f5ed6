// A context for a whole test program. The tear-down fails if memory is still allocated:
//     cmocka_run_group_tests(tests, set_up, tear_down)
// Include this header last, because its names are common words.
#ifndef KILN_TEST_CONTEXT_H
#define KILN_TEST_CONTEXT_H

#include "check.h"

static kiln_context *context;

static int set_up(void **state)
{
    (void)state;
    return kiln_context_create(&(kiln_context_def){.thread_count = 2}, &context, NULL) != KILN_OK;
}

static int tear_down(void **state)
{
    (void)state;
    size_t held = 0;
    kiln_context_memory(context, &held, NULL);
    kiln_context_destroy(context);
    return held != 0;
}

#endif
