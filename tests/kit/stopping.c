#include "stopping.h"

#include "check.h"

bool count_down(void *user, const char *stage, double fraction)
{
    countdown *c = user;
    assert_non_null(stage);
    assert_true(fraction >= 0 && fraction <= 1);
    c->calls++;
    return c->left-- > 0;
}
