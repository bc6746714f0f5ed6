// Decimal numbers in files: their value to 15 digits from the smallest to the largest double, and
// the text at which a number ends.
#include "codec/decimal.h"

#include "kit/kit.h"

static void numbers_have_their_value_and_end(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
        const char *rest;
    } rows[] = {{"0", 0, ""},
                {" \t-12.5e-3 7", -0.0125, " 7"},
                {"+.5,", 0.5, ","},
                {"1.e2x", 100, "x"},
                {"1e", 1, "e"},
                {"1e+ 2", 1, "e+ 2"},
                {"2e05", 200000, ""},
                {"1e00000000000000000003,4", 1000, ",4"},
                // more digits of the exponent than an int holds belong to the number all the same
                {"1e10000000000000000000 2", HUGE_VAL, " 2"},
                {"-1e10001 2", -HUGE_VAL, " 2"},
                {"1e-99999999999 2", 0, " 2"},
                {"0e99999999999 2", 0, " 2"},
                {"1e305", 1e305, ""},
                {"1.7976931348623157e308", 1.7976931348623157e308, ""},
                {"1e309", HUGE_VAL, ""},
                {"1e-305", 1e-305, ""},
                {"2.2250738585072014e-308", 2.2250738585072014e-308, ""},
                {"12345678901234567890e-320", 1.2345678901234567890e-301, ""}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double value = -1, wanted = rows[i].value;
        const char *rest = ki_parse_number(rows[i].text, &value);
        if (!rest || strcmp(rest, rows[i].rest) != 0)
            fail_msg("\"%s\" ends before \"%s\", wanted \"%s\"", rows[i].text, rest ? rest : "NULL",
                     rows[i].rest);
        if (value != wanted && !(fabs(value - wanted) <= 1e-13 * fabs(wanted)))
            fail_msg("\"%s\" is %.17g, wanted %.17g", rows[i].text, value, wanted);
    }
}

static void what_is_no_number_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"", " ", "-", ".", "e5", "+-1", "x1", "inf", "nan", "\n1"};
    double value;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_null(ki_parse_number(texts[i], &value));
    char digits[302];
    memset(digits, '1', 301);
    digits[301] = 0;
    assert_null(ki_parse_number(digits, &value));
    assert_true(ki_parse_number(digits + 1, &value) == digits + 301);
    CHECK_NEAR(value / 1e299, 1.1111111111111111, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_have_their_value_and_end),
        cmocka_unit_test(what_is_no_number_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
