// The list of findings of a check.
#include "check/check.h"

void ki_find(kiln_findings *findings, kiln_finding_kind kind, bool fault, const char *format, ...)
{
    if (findings->count >= KILN_MAX_FINDINGS)
        return;
    kiln_finding *finding = &findings->finding[findings->count++];
    *finding = (kiln_finding){.kind = kind, .fault = fault};
    findings->fault_count += fault;
    va_list list;
    va_start(list, format);
    ki_print_clean(finding->text, sizeof finding->text, format, list);
    va_end(list);
}
