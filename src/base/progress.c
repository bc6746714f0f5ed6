// Reports progress to the caller of the library, and passes on the caller's wish to cancel.
#include "base/context.h"

bool ki_progress(kiln_context *context, const char *stage, double fraction)
{
    context->said = (ki_progress_range){stage, fraction, fraction};
    if (!context->def.progress)
        return true;
    // The callback may call the library with this context. Memory that it allocates must not come
    // from the scratch memory of the plan execution that reports progress.
    ki_scratch *scratch = context->scratch;
    context->scratch = NULL;
    bool go_on = context->def.progress(context->def.progress_user, stage, fraction);
    context->scratch = scratch;
    return go_on;
}

bool ki_go_on(kiln_context *context)
{
    const ki_progress_range *said = &context->said;
    return ki_progress(context, said->name ? said->name : "working", said->from);
}

void ki_asker_begin(ki_asker *asker, kiln_context *context)
{
    asker->context = context;
    asker->caller = ki_os_this_thread();
    atomic_init(&asker->stopped, false);
}

bool ki_was_stopped(const ki_asker *asker)
{
    return atomic_load_explicit(&asker->stopped, memory_order_relaxed);
}

bool ki_may_go_on(ki_asker *asker)
{
    if (!ki_was_stopped(asker) && ki_os_this_thread() == asker->caller && !ki_go_on(asker->context))
        atomic_store(&asker->stopped, true);
    return !ki_was_stopped(asker);
}

kiln_result ki_fail_cancelled(kiln_error *error, const char *stage)
{
    return ki_fail(error, KILN_ERROR_CANCELLED, "stopped while %s", stage);
}
