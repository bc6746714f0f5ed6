// Work that is stopped by its progress callback.
#ifndef KILN_KIT_STOPPING_H
#define KILN_KIT_STOPPING_H

#include <kiln/kiln.h>

#include <stdbool.h>

typedef struct countdown {
    int left;  // number of reports after which the next report stops the work
    int calls; // number of reports until now
} countdown;

/// A progress callback of a context whose user pointer is a countdown. Checks that there is a stage
/// and that the fraction is in [0, 1].
bool count_down(void *user, const char *stage, double fraction);

/// Work that is told once to stop, and again to go on if it asks further.
typedef struct single_stop {
    int stop_at; // the report that stops the work, counted from 1; 0 for none
    int calls;   // number of reports until now
} single_stop;

/// A progress callback of a context whose user pointer is a `single_stop`.
bool stop_once(void *user, const char *stage, double fraction);

/// The question to stop at after a run that was stopped at question `stop`: the next one. Under
/// AddressSanitizer, which makes the work about ten times as long, it is the next of the first ten,
/// and then every seventh.
int after_stop(int stop);

/// Does `work`, which must succeed with a context of the countdown `c`, again and again, and stops
/// it at its first question, at its second, and so on, by after_stop. Returns the number of its
/// questions. Work in steps asks once more after each twentieth of a second, so that on a busy
/// machine it may ask more often one time than the next: the least number counts.
int count_questions(countdown *c, kiln_result (*work)(const void *data), const void *data);

#endif
