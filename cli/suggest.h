// Finds the known word that is most similar to a mistyped word.
#ifndef KILN_CLI_SUGGEST_H
#define KILN_CLI_SUGGEST_H

#include <stddef.h>

/// The state of a search for the known word nearest to a typed word.
typedef struct cli_suggestion {
    const char *typed;
    const char *nearest; ///< nearest word up to now; NULL if no word is similar enough
    int distance;
} cli_suggestion;

/// Compares one more known word with the typed word; NULL is ignored.
void cli_suggest(cli_suggestion *suggestion, const char *word);
/// Writes a text for an error message: `between` and "did you mean --size?" with `dashes` before
/// the word, or "" if no word is similar enough. Returns `text`.
const char *cli_suggestion_text(const cli_suggestion *suggestion, const char *between,
                                const char *dashes, char text[96]);

#endif
