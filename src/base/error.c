// Writes error messages.
#include "base/base.h"

void ki_describe(kiln_error *error, kiln_result result, const char *format, ...)
{
    if (error) {
        error->result = result;
        va_list list;
        va_start(list, format);
        ki_print_clean(error->message, sizeof error->message, format, list);
        va_end(list);
    }
}
