// Writes JSON (RFC 8259) to standard output while the values arrive. In: keys and values, in order.
// Out: indented text; json.h describes the numbers and the UTF-8 check.
#include "json.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void break_line(const json *j)
{
    if (j->line)
        return;
    putchar('\n');
    for (int i = 0; i < j->depth; i++)
        putchar('\t');
}

static void print_text(const char *text);

// Prints what precedes a JSON value: a comma if a value stands before it, a line break inside an
// object, and the key.
static void begin(json *j, const char *key)
{
    bool array = j->array[j->depth];
    if (j->filled[j->depth])
        fputs(array || j->line ? ", " : ",", stdout);
    j->filled[j->depth] = true;
    if (!key || !j->depth || array)
        return;
    break_line(j);
    print_text(key);
    fputs(j->line ? ": " : ":\t", stdout);
}

static void open_container(json *j, const char *key, bool array)
{
    begin(j, key);
    putchar(array ? '[' : '{');
    j->depth += j->depth < JSON_DEPTH;
    j->array[j->depth] = array;
    j->filled[j->depth] = false;
}

void json_object(json *j, const char *key)
{
    open_container(j, key, false);
}

void json_array(json *j, const char *key)
{
    open_container(j, key, true);
}

void json_end(json *j)
{
    bool array = j->array[j->depth];
    j->depth--;
    if (!array)
        break_line(j);
    putchar(array ? ']' : '}');
    if (!j->depth)
        putchar('\n');
}

// ----------------------------------------------------------------------------------------- numbers

// printf uses the locale's decimal separator; JSON requires a point.
static void print_digits(double value, int digits)
{
    char text[32];
    snprintf(text, sizeof text, "%.*g", digits, value);
    for (char *at = text; *at; at++)
        putchar(strchr("0123456789+-e", *at) ? *at : '.');
}

void json_number(json *j, const char *key, double value)
{
    char text[32];
    begin(j, key);
    if (!isfinite(value)) {
        fputs("null", stdout);
        return;
    }
    snprintf(text, sizeof text, "%.15g", value);
    double off = fabs(strtod(text, NULL) - value);
    print_digits(value, off <= fabs(value) * DBL_EPSILON ? 15 : 17);
}

void json_rounded(json *j, const char *key, double value, int digits)
{
    char text[32];
    snprintf(text, sizeof text, "%.*g", digits, value);
    json_number(j, key, strtod(text, NULL));
}

void json_float(json *j, const char *key, float value)
{
    char text[32];
    int digits = 6;
    for (; digits < 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value)
            break;
    }
    json_rounded(j, key, (double)value, digits);
}

void json_bool(json *j, const char *key, bool value)
{
    begin(j, key);
    fputs(value ? "true" : "false", stdout);
}

// -------------------------------------------------------------------------------------------- text

static void print_escaped(unsigned code)
{
    static const char from[] = "\"\\\b\f\n\r\t", to[] = "\"\\bfnrt";
    const char *known = code < 128 ? strchr(from, (int)code) : NULL;
    if (known)
        printf("\\%c", to[known - from]);
    else
        printf("\\u%04x", code);
}

// Characters that a terminal would obey are escaped too; the longest of their codes has four
// digits.
static void print_text(const char *text)
{
    putchar('"');
    while (*text) {
        unsigned code;
        bool shown;
        int length = kiln_text_step(text, &code, &shown);
        if (code == 0xfffd)
            fputs("\xef\xbf\xbd", stdout); // the replacement character, also for invalid bytes
        else if (!shown || code == '"' || code == '\\')
            print_escaped(code);
        else
            fwrite(text, 1, (size_t)length, stdout);
        text += length;
    }
    putchar('"');
}

void json_text(json *j, const char *key, const char *text)
{
    begin(j, key);
    print_text(text);
}

void json_notes(json *j, const kiln_load_report *report)
{
    kiln_note note;
    json_array(j, "notes");
    for (int i = 0; kiln_load_report_note(report, i, &note); i++)
        json_text(j, NULL, note.text);
    json_end(j);
}

static void number_vector(json *j, const char *key, const double v[3])
{
    json_array(j, key);
    for (int k = 0; k < 3; k++)
        json_number(j, NULL, v[k]);
    json_end(j);
}

void json_lights(json *j, const kiln_lights *lights)
{
    json_array(j, "lights");
    for (int i = 0; i < lights->count; i++) {
        const kiln_light *light = &lights->light[i];
        json_object(j, NULL);
        number_vector(j, "direction", light->direction);
        number_vector(j, "irradiance", light->irradiance);
        json_number(j, "angular_radius", light->angular_radius);
        json_number(j, "share", light->share);
        json_number(j, "texels", (double)light->texel_count);
        json_end(j);
    }
    json_end(j);
}
