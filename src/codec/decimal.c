#include "codec/decimal.h"
#include "base/os.h"

#include <float.h>
#include <string.h>

// Returns value * 10^exponent, which is infinite or 0 where a double ends.
static double scale(double value, int exponent)
{
    for (; exponent > 0 && value > 0 && value <= DBL_MAX; exponent--)
        value *= 10;
    while (exponent < 0 && value > 0) {
        double divisor = 1;
        for (; exponent < 0 && divisor < 1e300; exponent++)
            divisor *= 10;
        value /= divisor;
    }
    return value;
}

const char *ki_parse_number(const char *text, double *value)
{
    while (*text == ' ' || *text == '\t')
        text++;
    bool negative = *text == '-';
    text += *text == '-' || *text == '+';
    double mantissa = 0;
    int digits = 0, exponent = 0;
    for (; *text >= '0' && *text <= '9'; text++, digits++)
        mantissa = mantissa * 10 + (*text - '0');
    if (*text == '.')
        for (text++; *text >= '0' && *text <= '9'; text++, digits++, exponent--)
            mantissa = mantissa * 10 + (*text - '0');
    if (!digits || digits > 300)
        return NULL;
    if (*text == 'e' || *text == 'E') {
        const char *at = text + 1;
        bool down = *at == '-';
        at += *at == '-' || *at == '+';
        int power = 0;
        const char *first = at;
        for (; *at >= '0' && *at <= '9'; at++) // from 1000 on, exponents need no more digits
            power = power < 1000 ? power * 10 + (*at - '0') : power;
        if (at > first) {
            exponent += down ? -power : power;
            text = at;
        }
    }
    mantissa = scale(mantissa, exponent);
    *value = negative ? -mantissa : mantissa;
    return text;
}

void ki_write_number(ki_writer *writer, double value)
{
    ki_write_text(writer, "%.9g", value);
}

void ki_write_float(ki_writer *writer, float value)
{
    char text[40];
    for (int digits = 6; digits <= 9; digits++) {
        ki_print(text, sizeof text, "%.*g", digits, (double)value);
        if (ki_os_read_float(text) == value)
            break;
    }
    ki_write_text(writer, strpbrk(text, ".e") ? "%s" : "%s.0", text);
}
