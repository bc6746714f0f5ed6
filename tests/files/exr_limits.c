// EXR files that ask for much work or memory by few bytes: what is refused, and that every loop
// over the content of a file asks the caller whether to go on. The number of these questions is
// counted, since the time that the work takes says nothing on a busy machine.
#include "codec/codec.h"
#include "exr_plain.h"

#include "kit/context.h"
#include "kit/stopping.h"

enum { W = 32, H = 16 };

typedef struct header {
    int attributes, channels; // numbers of additional ones
    int parts;                // 0 for a file of one part
    uint32_t sampling;        // of channel R
    int32_t right, bottom;    // of the display window
    const char *name;         // of one more attribute; NULL for none
} header;

static void write_channel(ki_writer *w, const char *name, uint32_t sampling)
{
    ki_write(w, name, strlen(name) + 1);
    ki_write_u32(w, 1); // 16-bit floats
    ki_write_u32(w, 0);
    ki_write_u32(w, sampling);
    ki_write_u32(w, sampling);
}

static void write_part(const header *h, int part, ki_writer *w)
{
    ki_writer list = {.context = w->context};
    const int32_t data[4] = {0, 0, W - 1, H - 1}, display[4] = {0, 0, h->right, h->bottom};
    const float one = 1;
    char name[16];
    write_channel(&list, "B", 1);
    write_channel(&list, "G", 1);
    write_channel(&list, "R", h->sampling);
    for (int i = 0; i < h->channels; i++) {
        snprintf(name, sizeof name, "c%06d", i);
        write_channel(&list, name, 1);
    }
    ki_write_u8(&list, 0);
    plain_attribute(w, "channels", "chlist", list.bytes, list.size);
    ki_writer_free(&list);
    plain_attribute(w, "compression", "compression", "", 1);
    plain_attribute(w, "dataWindow", "box2i", data, sizeof data);
    plain_attribute(w, "displayWindow", "box2i", display, sizeof display);
    plain_attribute(w, "lineOrder", "lineOrder", "", 1);
    for (int i = 0; i < h->attributes; i++) {
        snprintf(name, sizeof name, "a%06d", i);
        plain_attribute(w, name, "float", &one, sizeof one);
    }
    if (h->name)
        plain_attribute(w, h->name, "float", &one, sizeof one);
    if (h->parts) {
        const int32_t chunks = H;
        snprintf(name, sizeof name, "p%06d", part);
        plain_attribute(w, "name", "string", name, strlen(name));
        plain_attribute(w, "type", "string", "scanlineimage", 13);
        plain_attribute(w, "chunkCount", "int", &chunks, sizeof chunks);
    }
    ki_write_u8(w, 0);
}

// Writes a header and, for a file of one part, the lines of zeros.
static void make_exr(const header *h, ki_writer *w)
{
    ki_write_u32(w, 20000630);
    ki_write_u32(w, 2 | (h->parts ? 0x1000 : 0));
    for (int part = 0; part < (h->parts ? h->parts : 1); part++)
        write_part(h, part, w);
    if (h->parts) {
        ki_write_u8(w, 0);
        return;
    }
    size_t table = w->size, bytes = (size_t)(3 + h->channels) * W * 2;
    memset(ki_write_room(w, 8 * H), 0, 8 * H);
    for (uint32_t y = 0; y < H; y++) {
        ki_patch_u64(w, table + 8 * y, w->size);
        ki_write_u32(w, y);
        ki_write_u32(w, (uint32_t)bytes);
        memset(ki_write_room(w, bytes), 0, bytes);
    }
}

static header plain_header(void)
{
    return (header){.sampling = 1, .right = W - 1, .bottom = H - 1};
}

static void check_refused(const header *h, const char *sentence)
{
    ki_writer w = {.context = context};
    kiln_image image;
    make_exr(h, &w);
    assert_true(ki_exr_decode(context, w.bytes, w.size, "a.exr", NULL, &image, NULL, NULL,
                              &error) != KILN_OK);
    assert_string_equal(error.message, sentence);
    ki_writer_free(&w);
}

static void what_is_too_much_is_said(void **state)
{
    (void)state;
    header h = plain_header();
    h.channels = 100000;
    check_refused(&h, "a.exr: has 100003 channels, the limit is 1024");
    h = plain_header();
    h.parts = 1025;
    check_refused(&h, "a.exr: the EXR header is damaged: it has more than 1024 parts");
    h = plain_header();
    h.sampling = 17;
    check_refused(&h, "a.exr: the EXR header is damaged: its list of channels is damaged, or has a "
                      "name of more than 255 bytes or samples more than 16 pixels apart");
    char name[300];
    memset(name, 'n', sizeof name);
    name[256] = 0;
    h = plain_header();
    h.name = name;
    check_refused(&h, "a.exr: the EXR header is damaged: it ends within an attribute, or an "
                      "attribute has a name of more than 255 bytes");
}

static void attributes_are_limited(void **state)
{
    (void)state;
    header h = plain_header();
    h.attributes = 1 << 20;
    check_refused(&h, "a.exr: the EXR header is damaged: it has more than 1048576 attributes");
}

static void what_is_just_allowed_is_read(void **state)
{
    (void)state;
    char name[256];
    memset(name, 'n', sizeof name);
    name[255] = 0;
    header h = plain_header();
    h.channels = 1021;
    h.attributes = 5000;
    h.name = name;
    ki_writer w = {.context = context};
    kiln_map map;
    make_exr(&h, &w);
    CHECK_OK(kiln_map_decode(context, w.bytes, w.size, "a.exr", NULL, &map, &error));
    assert_int_equal(map.size, H);
    kiln_map_free(&map);
    ki_writer_free(&w);
}

// A file of 3.7 kB whose display window would take 6.4 GB.
static void a_nearly_empty_display_window_takes_no_memory(void **state)
{
    (void)state;
    header h = plain_header();
    h.right = 32767;
    h.bottom = 16383;
    ki_writer w = {.context = context};
    kiln_image image;
    make_exr(&h, &w);
    kiln_context *own = make_context(1);
    assert_int_equal(ki_exr_decode(own, w.bytes, w.size, "a.exr", NULL, &image, NULL, NULL, &error),
                     KILN_ERROR_UNSUPPORTED);
    assert_string_equal(error.message,
                        "a.exr: only 512 of the 536870912 pixels of its display window lie in its "
                        "data window, it must be at least 1 of 64; write the file with a display "
                        "window that fits the data");
    size_t peak;
    kiln_context_memory(own, NULL, &peak);
    CHECK_BELOW((double)peak, 1e6);
    kiln_context_destroy(own);
    // A small display window may be as empty as its author likes.
    h.right = 1023;
    h.bottom = 511;
    w.size = 0;
    make_exr(&h, &w);
    kiln_load_report report;
    CHECK_OK(ki_exr_decode(context, w.bytes, w.size, "a.exr", NULL, &image, NULL, &report, &error));
    assert_int_equal(report.missing_count, 1024 * 512 - W * H);
    kiln_image_free(&image);
    ki_writer_free(&w);
}

static void the_part_outside_the_display_window_is_told(void **state)
{
    (void)state;
    header h = plain_header();
    h.right = 7;
    h.bottom = 3;
    ki_writer w = {.context = context};
    kiln_map map;
    kiln_note note;
    kiln_load_report report;
    const kiln_load_def def = {.report = &report};
    make_exr(&h, &w);
    CHECK_OK(kiln_map_decode(context, w.bytes, w.size, "a.exr", &def, &map, &error));
    assert_true(kiln_load_report_note(&report, 0, &note));
    assert_int_equal(note.kind, KILN_NOTE_CHOICE);
    assert_string_equal(note.text, "480 pixels of the data window lie outside the display window "
                                   "and were left out");
    kiln_map_free(&map);
    ki_writer_free(&w);
}

// Decodes with a progress callback that stops at one of its calls. Returns the number of calls
// until the end.
static int count_calls(const ki_writer *w, int left, kiln_result wanted)
{
    countdown count = {.left = left};
    kiln_context_def def = {.thread_count = 1, .progress = count_down, .progress_user = &count};
    kiln_context *own;
    kiln_image image;
    CHECK_OK(kiln_context_create(&def, &own, &error));
    assert_int_equal(
        ki_exr_decode(own, w->bytes, w->size, "a.exr", NULL, &image, NULL, NULL, &error), wanted);
    kiln_image_free(&image);
    kiln_context_destroy(own);
    return count.calls;
}

// Whether to go on is asked after each 1024 attributes, channels or parts, and the work stops at
// any of these.
static void check_stops(const header *h, int questions, kiln_result result)
{
    ki_writer w = {.context = context};
    make_exr(h, &w);
    int calls = count_calls(&w, 1 << 30, result);
    assert_true(calls >= questions);
    assert_true(calls <= 2 * questions + 80);
    for (int i = 0; i < questions; i += questions / 5 + 1) {
        assert_int_equal(count_calls(&w, i, KILN_ERROR_CANCELLED), i + 1);
        assert_string_equal(error.message, "stopped while reading");
    }
    ki_writer_free(&w);
}

static void long_headers_can_be_stopped(void **state)
{
    (void)state;
    header h = plain_header();
    h.attributes = 200000;
    check_stops(&h, 195, KILN_OK);
    h = plain_header();
    h.channels = 100000;
    check_stops(&h, 97, KILN_ERROR_UNSUPPORTED);
    h = plain_header();
    h.parts = 1000;
    check_stops(&h, 1000, KILN_ERROR_UNSUPPORTED);
}

// 32768 chunks of one pixel each.
static void many_chunks_can_be_stopped(void **state)
{
    (void)state;
    plain_file file = {
        .width = 1, .height = 32768, .part_count = 1, .parts = {{.channels = {"B", "G", "R"}}}};
    ki_writer w = {.context = context};
    plain_write(&file, &w);
    int calls = count_calls(&w, 1 << 30, KILN_OK);
    assert_true(calls > 64); // 7 for the places of the chunks, 64 for their decoding
    for (int i = 0; i < calls; i += 9)
        assert_int_equal(count_calls(&w, i, KILN_ERROR_CANCELLED), i + 1);
    ki_writer_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_is_too_much_is_said, set_up, tear_down),
        cmocka_unit_test_setup_teardown(attributes_are_limited, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_just_allowed_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_nearly_empty_display_window_takes_no_memory, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(the_part_outside_the_display_window_is_told, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(long_headers_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(many_chunks_can_be_stopped, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
