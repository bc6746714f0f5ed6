// File names and descriptions of the GAMES202 assignment's tables.
#include "assignment.h"

const char *const assignment_names[ASSIGNMENT_TABLES] = {
    [ASSIGNMENT_MC] = "Emu_MC",
    [ASSIGNMENT_MC_UNCLAMPED] = "Emu_MC_unclamped",
    [ASSIGNMENT_IS] = "Emu_IS",
    [ASSIGNMENT_SPLIT_SUM] = "Emu_split_sum",
    [ASSIGNMENT_EXACT] = "Emu_exact",
    [ASSIGNMENT_AVERAGE_MC] = "Eavg_MC",
    [ASSIGNMENT_AVERAGE] = "Eavg",
    [ASSIGNMENT_AVERAGE_BYTES] = "Eavg_from_bytes",
    [ASSIGNMENT_AVERAGE_EXACT] = "Eavg_exact",
};

const char *const assignment_words[ASSIGNMENT_TABLES] = {
    [ASSIGNMENT_MC] = "E(mu), cosine-weighted Monte Carlo, D clamped as in figure 1",
    [ASSIGNMENT_MC_UNCLAMPED] = "the same samples, D as it is",
    [ASSIGNMENT_IS] = "E(mu), GGX importance sampling: bonus 1, figure 2",
    [ASSIGNMENT_SPLIT_SUM] = "E(mu) = A + B by split sum with F0 = 1: bonus 2",
    [ASSIGNMENT_EXACT] = "E(mu), the integral itself",
    [ASSIGNMENT_AVERAGE_MC] = "E_avg of Emu_MC",
    [ASSIGNMENT_AVERAGE] = "E_avg of Emu_IS: figure 4 as it should be",
    [ASSIGNMENT_AVERAGE_BYTES] = "E_avg of Emu_IS as its PNG holds it",
    [ASSIGNMENT_AVERAGE_EXACT] = "E_avg, the integral itself",
};

bool assignment_is_exact(int table)
{
    return table == ASSIGNMENT_EXACT || table == ASSIGNMENT_AVERAGE_EXACT;
}
