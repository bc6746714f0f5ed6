// The notes that a file's reader leaves in its report.
#ifndef KILN_KIT_NOTES_H
#define KILN_KIT_NOTES_H

#include "check.h"

/// Checks that note `index` of a report has this kind and text, and whether it is a warning.
static inline void check_note(const kiln_load_report *report, int index, kiln_note_kind kind,
                              bool warning, const char *text)
{
    kiln_note note;
    assert_true(kiln_load_report_note(report, index, &note));
    assert_string_equal(note.text, text);
    assert_int_equal(note.kind, kind);
    assert_int_equal(note.warning, warning);
}

#endif
