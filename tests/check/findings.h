// What the tests of reports share.
#ifndef KILN_TEST_FINDINGS_H
#define KILN_TEST_FINDINGS_H

#include <kiln/check.h>

#include "kit/kit.h"

/// Checks that findings have one fault and no other, of the kind `kind`, whose text says `words`.
static inline void expect_one_fault(const kiln_findings *findings, kiln_finding_kind kind,
                                    const char *words)
{
    for (int i = 0; i < findings->count; i++)
        if (findings->finding[i].fault) {
            CHECK_SAYS(findings->finding[i].text, words);
            assert_int_equal(findings->finding[i].kind, kind);
        }
    assert_int_equal(findings->fault_count, 1);
}

#endif
