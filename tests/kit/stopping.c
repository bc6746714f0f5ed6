#include "stopping.h"

#include "base/os.h"
#include "check.h"

bool count_down(void *user, const char *stage, double fraction)
{
    countdown *c = user;
    assert_non_null(stage);
    assert_true(fraction >= 0 && fraction <= 1);
    c->calls++;
    return c->left-- > 0;
}

bool stop_once(void *user, const char *stage, double fraction)
{
    single_stop *o = user;
    assert_non_null(stage);
    assert_true(fraction >= 0 && fraction <= 1);
    return ++o->calls != o->stop_at;
}

int after_stop(int stop)
{
#if defined(KI_OS_CHECKS_BLOCKS)
    enum { EACH = 10, STEP = 7 };
    return stop < EACH ? stop + 1 : stop + STEP;
#else
    return stop + 1;
#endif
}

int count_questions(countdown *c, kiln_result (*work)(const void *data), const void *data)
{
    *c = (countdown){.left = 1 << 30};
    assert_int_equal(work(data), KILN_OK);
    int asked = c->calls;
    for (int stop = 0; stop < asked; stop = after_stop(stop)) {
        *c = (countdown){.left = stop};
        kiln_result result = work(data);
        if (result == KILN_OK) {
            assert_true(c->calls <= stop);
            asked = c->calls;
        } else {
            assert_int_equal(result, KILN_ERROR_CANCELLED);
            assert_int_equal(c->calls, stop + 1);
        }
    }
    return asked;
}
