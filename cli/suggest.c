// Measures how similar two words are by the optimal string alignment distance: the smallest number
// of letters to insert, delete, replace or swap with a neighbour that turns one word into the
// other. Case is ignored. A known word is near if the distance is at most a third of the typed
// letters, or if one word begins with the other: both "thr" and "threejs" find "three".
#include "suggest.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 40, FAR = 1000 };

static int least(int a, int b)
{
    return a < b ? a : b;
}

static int distance(const char *a, const char *b)
{
    int row[LONGEST + 1][LONGEST + 1];
    int n = (int)strlen(a), m = (int)strlen(b);
    if (n > LONGEST || m > LONGEST)
        return FAR;
    for (int i = 0; i <= n; i++)
        for (int k = 0; k <= m; k++) {
            if (!i || !k) {
                row[i][k] = i + k;
                continue;
            }
            int same = tolower((unsigned char)a[i - 1]) == tolower((unsigned char)b[k - 1]);
            row[i][k] = least(row[i - 1][k - 1] + !same, 1 + least(row[i - 1][k], row[i][k - 1]));
            if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
                row[i][k] = least(row[i][k], row[i - 2][k - 2] + 1);
        }
    return row[n][m];
}

void cli_suggest(cli_suggestion *s, const char *word)
{
    size_t typed = strlen(s->typed), length = word ? strlen(word) : 0;
    if (!length || typed < 2)
        return;
    int d = distance(s->typed, word);
    size_t common = typed < length ? typed : length;
    bool begins = common >= 3 && !strncmp(s->typed, word, common);
    if ((begins || d <= (int)(typed + 2) / 3) && (!s->nearest || d < s->distance)) {
        s->nearest = word;
        s->distance = d;
    }
}

const char *cli_suggestion_text(const cli_suggestion *s, const char *between, const char *dashes,
                                char text[96])
{
    text[0] = 0;
    if (s->nearest)
        snprintf(text, 96, "%sdid you mean %s%s?", between, dashes, s->nearest);
    return text;
}
