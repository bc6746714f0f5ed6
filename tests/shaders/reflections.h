// Tests of the ways to look reflections up, which the program of scenes.c runs.
#ifndef KILN_SHADERS_REFLECTIONS_H
#define KILN_SHADERS_REFLECTIONS_H

void more_lookups_have_smaller_errors(void **unused);
void the_furnace_stays_white(void **unused);
void the_noise_is_that_of_the_reference(void **unused);

#endif
