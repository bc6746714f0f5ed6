// Reports progress to the caller of the library, and passes on the caller's wish to cancel.
#include "base/context.h"

bool ki_progress(kiln_context *context, const char *stage, double fraction)
{
    ki_progress_range said = {stage, fraction, fraction};
    context->said = said;
    if (!context->def.progress)
        return true;
    // The callback may call the library with this context. Memory that it allocates must not come
    // from the scratch memory of the plan execution that reports progress, and a call that it stops
    // must not stop the one that reports.
    ki_scratch *scratch = context->scratch;
    unsigned nested_stops = context->nested_stops;
    context->scratch = NULL;
    context->depth++;
    bool go_on = context->def.progress(context->def.progress_user, stage, fraction);
    context->depth--;
    context->scratch = scratch;
    context->said = said;
    context->nested_stops = nested_stops;
    if (!go_on && context->depth)
        context->nested_stops++;
    else if (!go_on)
        atomic_fetch_add(&context->stops, 1);
    return go_on;
}

bool ki_go_on(kiln_context *context)
{
    const ki_progress_range *said = &context->said;
    return ki_progress(context, said->name ? said->name : "working", said->from);
}

ki_asker ki_asker_make(kiln_context *context)
{
    bool is_nested = ki_is_caller(context) && context->depth;
    return (ki_asker){context, is_nested ? context->nested_stops : atomic_load(&context->stops),
                      is_nested};
}

bool ki_was_stopped(const ki_asker *asker)
{
    kiln_context *context = asker->context;
    unsigned stops = asker->is_nested ? context->nested_stops
                                      : atomic_load_explicit(&context->stops, memory_order_relaxed);
    return stops != asker->stops;
}

bool ki_may_go_on(const ki_asker *asker)
{
    return !ki_was_stopped(asker) && (!ki_is_caller(asker->context) || ki_go_on(asker->context));
}

kiln_result ki_fail_cancelled(kiln_error *error, const char *stage)
{
    return ki_fail(error, KILN_ERROR_CANCELLED, "stopped while %s", stage);
}
