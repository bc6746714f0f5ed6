// What files say of themselves in texts: a PNG holds texts and stays the same picture, and the name
// of the writer ends before control characters.
#include "codec/ktx1.h"
#include "codec/png_text.h"

#include "kit/describe.h"

#include "kit/context.h"

// A text goes between the header and the pixels, which stay what they were, and any reader passes
// over it.
static void texts_stand_in_a_png(void **state)
{
    (void)state;
    kiln_map map = make_steps(context, KILN_SHAPE_CUBE, 8, 1);
    ki_writer plain = {.context = context}, texts = plain;
    CHECK_OK(ki_png_encode(map.level[0], 8, 8, 3, KI_PNG_PLAIN8, &plain, &error));
    ki_write(&texts, plain.bytes, plain.size);
    ki_png_add_text(&texts, 0, "kiln:engine", "engine=x layout=atlas roughness=0.25");
    ki_png_add_text(&texts, 0, "Software", "kiln 9.9.9");
    // Chunks are data and 12 bytes.
    assert_int_equal(texts.size, plain.size + 8 + 1 + 10 + 12 + 11 + 1 + 36 + 12);
    assert_memory_equal(texts.bytes, plain.bytes, 33);
    assert_memory_equal(texts.bytes + 33, "\0\0\0\x13tEXtSoftware\0kiln 9.9.9", 27);
    assert_memory_equal(texts.bytes + texts.size - (plain.size - 33), plain.bytes + 33,
                        plain.size - 33);
    kiln_file_info info;
    ki_decoded decoded[2];
    CHECK_OK(ki_decode(context, plain.bytes, plain.size, "p", &decoded[0], NULL, &error));
    CHECK_OK(ki_decode(context, texts.bytes, texts.size, "t", &decoded[1], &info, &error));
    assert_memory_equal(decoded[0].image.pixels, decoded[1].image.pixels, 64 * 3 * sizeof(float));
    assert_string_equal(info.engine, "x");
    assert_string_equal(info.layout, "atlas");
    assert_string_equal(info.writer, "kiln 9.9.9");
    assert_true(info.roughness[0] == 0.25F);
    ki_decoded_free(&decoded[0]);
    ki_decoded_free(&decoded[1]);
    ki_writer_free(&plain);
    ki_writer_free(&texts);
    kiln_map_free(&map);
}

// The writer that a file names is printed on terminals, which obey control characters: the name
// ends before the first of them, in every format that has such a name.
static void control_characters_end_a_writers_name(void **state)
{
    (void)state;
    const ki_exr_options options = {.half = true, .roughness = -1};
    const kiln_save_def def = {0};
    kiln_map map = make_steps(context, KILN_SHAPE_CUBE, 4, 1);
    for (int i = 0; i < 3; i++) {
        ki_writer w = {.context = context};
        kiln_file_info info;
        if (i == 0)
            CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
        else if (i == 1)
            CHECK_OK(ki_exr_encode(map.level[0], 4, 4, 3, &options, &w, &error));
        else
            CHECK_OK(ki_hdr_encode(map.level[0], 4, 4, &w, &error));
        char wanted[32];
        snprintf(wanted, sizeof wanted, "kiln %s", kiln_version());
        size_t at = 0, length = strlen(wanted);
        while (at + length < w.size && memcmp(w.bytes + at, wanted, length) != 0)
            at++;
        CHECK_OK(describe(w.bytes, w.size, "w", &info));
        assert_string_equal(info.writer, wanted);
        w.bytes[at + 6] = 0x1b;
        wanted[6] = 0;
        CHECK_OK(describe(w.bytes, w.size, "w", &info));
        assert_string_equal(info.writer, wanted);
        ki_writer_free(&w);
    }
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_stand_in_a_png),
        cmocka_unit_test(control_characters_end_a_writers_name),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
