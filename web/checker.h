// Checks of files of other tools for the web page: C functions over numbers and pointers, which
// checker.mjs calls. They compare a file with the source of a baker (baker.h). A function that
// returns false leaves an error message in baker_message.
#ifndef CHECKER_H
#define CHECKER_H

#include "baker.h"

typedef struct checker checker;

/// Returns NULL if memory runs out.
BAKER checker *checker_create(baker *b);
/// Checks levels and harmonics of a file in emscripten's file system as `kiln check` does. `engine`
/// is the index of the engine that the file is for, or -1: the file states its engine, or axes and
/// roughness are found. The functions below return what was found, and nothing after a failure.
BAKER bool checker_run(checker *c, const char *path, int engine);
/// Returns the number of levels (0), of findings about levels and harmonics (1), and of bands of
/// harmonics (2).
BAKER int checker_count(const checker *c, int what);
/// Returns a number of a level: its size (0), its roughness (1), the roughness that the level is
/// most like (2), rms (3), largest (4), bias (5), energy (6) and seam (7) of kiln_check_level.
BAKER double checker_level(const checker *c, int level, int what);
/// Returns the sentence of a finding, without a full stop.
BAKER const char *checker_finding(const checker *c, int index);
/// Returns whether a finding is about the harmonics, and not about the levels.
BAKER bool checker_is_harmonic(const checker *c, int index);
BAKER bool checker_is_fault(const checker *c, int index);
/// Returns the largest rms of a level (0) and the error of the harmonics (1), both relative.
BAKER double checker_error(const checker *c, int what);
/// Returns the factor of a band of the harmonics, which is 1 where the band is right.
BAKER double checker_band(const checker *c, int band);
/// Returns the picture of kiln_check_picture: 256 x (128 x levels) RGB floats.
BAKER const float *checker_picture(const checker *c);
/// Replaces the levels of the baker's scenery (baker_scenery) by those of the file, in the
/// directions in which they are shown.
BAKER bool checker_scenery(checker *c);

#endif
