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
    [ASSIGNMENT_MC] =
        "E(mu) by cosine-weighted Monte Carlo integration, with D clamped as in figure 1",
    [ASSIGNMENT_MC_UNCLAMPED] = "E(mu) by the samples of Emu_MC, with D not clamped",
    [ASSIGNMENT_IS] = "E(mu) by importance sampling of GGX: bonus 1, figure 2",
    [ASSIGNMENT_SPLIT_SUM] = "E(mu) = A + B by the split sum with F0 = 1: bonus 2",
    [ASSIGNMENT_EXACT] = "E(mu) by exact integration",
    [ASSIGNMENT_AVERAGE_MC] = "E_avg of the table Emu_MC",
    [ASSIGNMENT_AVERAGE] = "E_avg of the table Emu_IS: figure 4 without its mistake",
    [ASSIGNMENT_AVERAGE_BYTES] = "E_avg of the bytes of Emu_IS.png",
    [ASSIGNMENT_AVERAGE_EXACT] = "E_avg by exact integration",
};

bool assignment_is_exact(int table)
{
    return table == ASSIGNMENT_EXACT || table == ASSIGNMENT_AVERAGE_EXACT;
}
