// What a plan is made of.
#ifndef KI_PLAN_H
#define KI_PLAN_H

#include "image/resample.h"
#include "sphere/level.h"
#include "sphere/spectrum.h"
#include "tune/tune.h"

struct kiln_plan {
    kiln_context *context;
    kiln_prefilter_def def; // resolved
    int source_size;        // rows of the panorama
    float roughness[KILN_MAX_LEVELS];
    ki_analysis *analysis;
    ki_intake *intake;
    kiln_spectrum *spectrum; // of the last execution
    // One of the two a level. Mirrors may show the source itself, of another shape than a panorama.
    ki_resample_plan *mirrors[KILN_MAX_LEVELS];
    bool direct[KILN_MAX_LEVELS];
    ki_level *levels[KILN_MAX_LEVELS];
    ki_display *display; // of the others, or NULL
};

#endif
