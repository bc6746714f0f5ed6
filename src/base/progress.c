// Reports progress to the caller of the library, and passes on the caller's wish to cancel.
#include "base/context.h"

bool ki_progress(kiln_context *context, const char *stage, double fraction)
{
    ki_progress_range said = {stage, fraction, fraction};
    context->said = said;
    if (!context->def.progress)
        return true;
    // The callback may call the library with this context. Memory that it allocates must not come
    // from the scratch memory of the plan execution that reports progress.
    ki_scratch *scratch = context->scratch;
    context->scratch = NULL;
    context->depth++;
    bool go_on = context->def.progress(context->def.progress_user, stage, fraction);
    context->depth--;
    context->scratch = scratch;
    context->said = said;
    if (!go_on)
        atomic_fetch_add(&context->stops[ki_depth(context)], 1);
    return go_on;
}

bool ki_go_on(kiln_context *context)
{
    const ki_progress_range *said = &context->said;
    return ki_progress(context, said->name ? said->name : "working", said->from);
}

ki_asker ki_asker_make(kiln_context *context)
{
    int depth = ki_depth(context);
    return (ki_asker){context, depth, atomic_load(&context->stops[depth])};
}

bool ki_was_stopped(const ki_asker *asker)
{
    const atomic_uint *stops = &asker->context->stops[asker->depth];
    return atomic_load_explicit(stops, memory_order_relaxed) != asker->stops;
}

bool ki_may_go_on(const ki_asker *asker)
{
    return !ki_was_stopped(asker) && (!ki_is_caller(asker->context) || ki_go_on(asker->context));
}

kiln_result ki_fail_cancelled(kiln_error *error, const char *stage)
{
    return ki_fail(error, KILN_ERROR_CANCELLED, "stopped while %s", stage);
}
