// A view as an array of numbers. The page's JavaScript hands views to the baker and the stage in
// this form.
#ifndef VIEW_NUMBERS_H
#define VIEW_NUMBERS_H

#include "viewer.h"

// Index of each number in the array. Flags are 0 or 1.
typedef enum stage_number {
    STAGE_SCENE,
    STAGE_METHOD,
    STAGE_MATERIAL,
    STAGE_TARGET_X,
    STAGE_TARGET_Y,
    STAGE_TARGET_Z,
    STAGE_AZIMUTH,
    STAGE_ELEVATION,
    STAGE_DISTANCE,
    STAGE_FOV,
    STAGE_ROTATION,
    STAGE_EXPOSURE,
    STAGE_DEBUG,
    STAGE_LEVEL,
    STAGE_SPLIT,
    STAGE_BACKGROUND,
    STAGE_SAMPLES,
    STAGE_AS_PRINTED,
    STAGE_OCCLUSION,
    STAGE_CUBE_DIFFUSE,
    STAGE_REFLECTIONS,
    STAGE_GROUND,
    STAGE_NUMBERS
} stage_number;

void view_to_numbers(const view_options *options, double numbers[STAGE_NUMBERS]);
view_options view_from_numbers(const double numbers[STAGE_NUMBERS]);

#endif
