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

kiln_result ki_fail_cancelled(kiln_error *error, const char *stage)
{
    return ki_fail(error, KILN_ERROR_CANCELLED, "stopped while %s", stage);
}
