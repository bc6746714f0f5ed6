// The word that was probably meant.
#ifndef KILN_CLI_SUGGEST_H
#define KILN_CLI_SUGGEST_H

#include <stddef.h>

/// The search for the word that is nearest to one that was typed.
typedef struct cli_suggestion {
    const char *typed;
    const char *nearest; ///< NULL while no word is near enough
    int distance;
} cli_suggestion;

/// Considers one more word; NULL is none.
void cli_suggest(cli_suggestion *suggestion, const char *word);
/// `between` and "did you mean --size?", or "" where no word is near; `dashes` stand before the word.
const char *cli_suggestion_text(const cli_suggestion *suggestion, const char *between,
                                const char *dashes, char text[96]);

#endif
