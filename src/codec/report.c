// The report about a picture that was read. In: counts, and notes by the readers of files. Out:
// sentences, the same for the command, for JSON, for the web page and for callers of the library.
#include "codec/report.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void add_note(kiln_load_report *report, const kiln_note *note)
{
    int stored = ki_min(report->note_count, KILN_MAX_NOTES);
    for (int i = 0; i < stored; i++)
        if (report->note[i].kind == note->kind && !strcmp(report->note[i].text, note->text))
            return;
    if (stored < KILN_MAX_NOTES)
        report->note[stored] = *note;
    report->note_count++;
}

void ki_note(kiln_load_report *report, kiln_note_kind kind, bool warning, const char *format, ...)
{
    kiln_note note = {.kind = kind, .warning = warning};
    va_list list;
    if (!report)
        return;
    va_start(list, format);
    ki_print_clean(note.text, sizeof note.text, format, list);
    va_end(list);
    add_note(report, &note);
}

void ki_note_pixel_aspect(kiln_load_report *report, const char *where, double aspect)
{
    if (aspect != 1)
        ki_note(report, KILN_NOTE_ASSUMPTION, false,
                "%s says that a pixel is %.4g times as wide as high, which was ignored: pixels "
                "cover equal steps of the sphere",
                where, aspect);
}

void ki_report_add(kiln_load_report *sum, const kiln_load_report *report)
{
    sum->missing_count += report->missing_count;
    for (int i = 0; i < ki_min(report->note_count, KILN_MAX_NOTES); i++)
        add_note(sum, &report->note[i]);
}

// --------------------------------------------------------------------------------------- sentences

// Makes a note such as "3 of 512 texels are WHAT". Returns false if `count` is 0.
static bool say_count(const kiln_load_report *report, size_t count, kiln_note_kind kind,
                      bool warning, const char *what, kiln_note *note)
{
    if (!count)
        return false;
    *note = (kiln_note){.kind = kind, .warning = warning};
    ki_print(note->text, sizeof note->text, "%zu of %zu texels %s %s", count, report->texel_count,
             count == 1 ? "is" : "are", what);
    return true;
}

// Makes the note about texels of one kind, such as infinite ones; returns false if no such texel
// was counted.
static bool say_kind(const kiln_load_report *report, int kind, kiln_note *note)
{
    char negative[128];
    switch (kind) {
    case KILN_NOTE_INFINITE:
        return say_count(report, report->infinite_count, KILN_NOTE_INFINITE, true,
                         "infinite and became 65504", note);
    case KILN_NOTE_NAN:
        return say_count(report, report->nan_count, KILN_NOTE_NAN, true,
                         "not a number and became the mean of the texels around", note);
    case KILN_NOTE_NEGATIVE:
        ki_print(negative, sizeof negative, "negative and %s, with %.3g %% of the light",
                 report->negative == KILN_NEGATIVE_KEEP ? "kept" : "became 0",
                 100 * report->negative_share);
        return say_count(report, report->negative_count, KILN_NOTE_NEGATIVE, false, negative, note);
    default:
        return say_count(report, report->missing_count, KILN_NOTE_MISSING, true,
                         "outside the file's data window and black", note);
    }
}

bool kiln_load_report_note(const kiln_load_report *report, int index, kiln_note *note)
{
    int stored = ki_min(report->note_count, KILN_MAX_NOTES);
    if (index < 0)
        return false;
    for (int kind = KILN_NOTE_INFINITE; kind <= KILN_NOTE_MISSING; kind++)
        if (say_kind(report, kind, note) && index-- == 0)
            return true;
    if (index < stored)
        *note = report->note[index];
    else if (index == stored && stored < report->note_count)
        *note = (kiln_note){.kind = KILN_NOTE_CHOICE};
    else
        return false;
    if (index == stored)
        ki_print(note->text, sizeof note->text, "%d more notes were left out",
                 report->note_count - stored);
    return true;
}

bool kiln_cut_note(const kiln_load_report *source, const kiln_cut *cut, kiln_note *note)
{
    if (!cut->cut_count || !source->negative_count || source->negative != KILN_NEGATIVE_KEEP)
        return false;
    *note = (kiln_note){.kind = KILN_NOTE_CUT, .warning = true};
    ki_print(note->text, sizeof note->text,
             "%zu of %zu values were negative, with %.3g %% of the light, and became 0",
             cut->cut_count, cut->value_count, 100 * cut->share);
    return true;
}
