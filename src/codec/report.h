// Notes about a picture that is being read.
#ifndef KI_REPORT_H
#define KI_REPORT_H

#include "base/base.h"

/// Adds a note to a report, unless the report has a note of the same kind and text. `report` may be
/// NULL.
void ki_note(kiln_load_report *report, kiln_note_kind kind, bool warning, const char *format, ...)
    KI_PRINTF(4, 5);
/// Notes that a file states pixels which are not square, and that kiln ignores this. `where` names
/// the place in the file; `aspect` is a pixel's width divided by its height, 1 for no note.
void ki_note_pixel_aspect(kiln_load_report *report, const char *where, double aspect);
/// Adds the counts of one file's report that its reader fills in (missing_count), and its notes, to
/// the report of a set of files.
void ki_report_add(kiln_load_report *sum, const kiln_load_report *report);

#endif
