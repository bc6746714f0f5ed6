#include "sweep.h"

#include "kit/clock.h"

long sweep_count;

static double end;

void sweep_begin(void)
{
    end = seconds_now() + 0.02;
}

void sweep_prepare(void)
{
    end = seconds_now() + 60;
}

static bool go_on(void *user, const char *stage, double fraction)
{
    (void)user;
    assert_non_null(stage);
    assert_true(fraction >= 0 && fraction <= 1);
    return seconds_now() < end;
}

kiln_context *sweep_context(void)
{
    kiln_context *c = NULL;
    kiln_context_def def = {.thread_count = 1, .memory_limit = (size_t)48 << 20, .progress = go_on};
    assert_int_equal(kiln_context_create(&def, &c, NULL), KILN_OK);
    return c;
}

void sweep_check(const char *call, kiln_result result, const kiln_error *e, bool outputs_empty)
{
    sweep_count++;
    if (result == KILN_OK)
        return;
    if (result < KILN_ERROR_ARGUMENT || result > KILN_ERROR_CANCELLED || e->result != result)
        fail_msg("%s: returned %d, the error says %d", call, (int)result, (int)e->result);
    if (!e->message[0] || !memchr(e->message, 0, sizeof e->message))
        fail_msg("%s: failed without a message", call);
    if (!outputs_empty)
        fail_msg("%s: failed (%s), but an output is not zeroed", call, e->message);
}
