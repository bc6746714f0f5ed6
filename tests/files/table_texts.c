// The texts in files of tables: names of arrays, made from the names of files, and the line that
// says which table a file holds, which is parsed strictly.
#include "codec/codec.h"
#include "lookup/tables.h"
#include "table/table_text.h"

#include "kit/context.h"

// Names of arrays and functions, from those of files.
static void names_are_made_from_files(void **state)
{
    (void)state;
    static const char *const names[][3] = {
        {"brdf.h", NULL, "static const float brdf_texels[35]"},
        {"my brdf-2.h", NULL, "static const float my_brdf_2_texels[35]"},
        {"2--lut.h", NULL, "static const float table_2_lut_texels[35]"},
        {"gl_x.h", NULL, "static const float table_gl_x_texels[35]"},
        {".h.h", NULL, "static const float table_h_texels[35]"},
        {"a.b.h", "mine", "static const float mine_texels[35]"},
        {"b.glsl", NULL, "const float b_texels[35]"},
    };
    kiln_table table;
    CHECK_OK(lookup_table(context, 0, &table, &error));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t size;
        kiln_table_save_def def = {.name = names[i][1]};
        CHECK_OK(kiln_table_save(context, &table, in_folder(names[i][0]), &def, &error));
        char *text = (char *)read_file(in_folder(names[i][0]), &size);
        if (!strstr(text, names[i][2]))
            fail_msg("%s does not hold \"%s\":\n%s", names[i][0], names[i][2], text);
        free(text);
    }
    size_t size;
    CHECK_OK(kiln_table_lookup_save(context, &table.def, in_folder("brdf_lookup.h"), NULL, &error));
    char *text = (char *)read_file(in_folder("brdf_lookup.h"), &size);
    assert_non_null(strstr(text, "double brdf_lookup(const float *texels"));
    free(text);
    assert_int_equal(kiln_table_lookup_save(context, &table.def, in_folder("a.txt"), NULL, &error),
                     KILN_ERROR_ARGUMENT);
    kiln_table_free(&table);
}

static void texts_are_parsed_strictly(void **state)
{
    (void)state;
    char text[KI_TABLE_TEXT], again[KI_TABLE_TEXT];
    kiln_table_def def, back;
    for (int i = 0; i < LOOKUP_TABLES; i++) {
        kiln_table table;
        CHECK_OK(lookup_table(context, i, &table, &error));
        ki_table_describe(&table.def, text);
        assert_true(ki_table_parse(text, &back));
        ki_table_describe(&back, again);
        assert_string_equal(again, text);
        for (size_t cut = 0; text[0] && cut < strlen(text); cut++) {
            char shorter[KI_TABLE_TEXT];
            snprintf(shorter, sizeof shorter, "%.*s", (int)cut, text);
            // A number that was cut is still a number.
            if (!strstr(shorter, "paths="))
                assert_false(ki_table_parse(shorter, &back));
        }
        kiln_table_free(&table);
    }
    def = (kiln_table_def){.kind = KILN_TABLE_E_WALK,
                           .model = {KILN_D_BECKMANN, KILN_G_SMITH_UNCORRELATED},
                           .width = 4096,
                           .height = 4096,
                           .depth = 4096,
                           .axis = KILN_AXIS_GRAZING,
                           .sheen = KILN_SHEEN_ASHIKHMIN,
                           .path_count = 2147483647};
    ki_table_describe(&def, text);
    assert_true(ki_table_parse(text, &back));
    ki_table_describe(&back, again);
    assert_string_equal(again, text);
    static const char *const wrong[] = {
        "kind=x d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=1x1x1 "
        "paths=0",
        "kind=e d=ggx g=smith sheen=estevez axis=sqrt corners=2 complement=0 flip=0 size=1x1x1 "
        "paths=0",
        "kind=e d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=0x1x1 "
        "paths=0",
        "kind=e d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=1x4097x1 "
        "paths=0",
        "kind=e d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=1x1x1 "
        "paths=2147483648",
        "kind=e d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=1x1x1 "
        "paths=-1",
        "kind=e d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=1x1x1 "
        "paths=1 ",
        "kind=e g=smith d=ggx sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=1x1x1 "
        "paths=1",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_false(ki_table_parse(wrong[i], &back));
        assert_int_equal(back.width, 0);
    }
}

static void wrong_texts_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *sentence;
    } wrong[] = {
        {"kind=e d=ggx", "describes its table as \"kind=e d=ggx\""},
        {"kind=e d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=6x5x1 "
         "paths=0",
         "has 7 x 5 x 1 texels, but describes its table as 6 x 5 x 1"},
        {"kind=dfg d=ggx g=smith sheen=estevez axis=sqrt corners=0 complement=0 flip=0 size=7x5x1 "
         "paths=0",
         "has 1 channels, but its kind of table has 2"},
        {"\033[31m", "describes its table as \"\""},
    };
    kiln_table table, back;
    CHECK_OK(lookup_table(context, 0, &table, &error));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        ki_writer w = {.context = context};
        CHECK_OK(ki_ktx2_encode_table(&table.image, 1, wrong[i].text, KILN_TABLE_FORMAT_F32, 0, &w,
                                      &error));
        write_file(in_folder("w.ktx2"), w.bytes, w.size);
        ki_writer_free(&w);
        assert_int_equal(kiln_table_load(context, in_folder("w.ktx2"), &back, &error),
                         KILN_ERROR_FORMAT);
        CHECK_SAYS(error.message, wrong[i].sentence);
        assert_null(back.image.pixels);
    }
    kiln_table_free(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_made_from_files),
        cmocka_unit_test(texts_are_parsed_strictly),
        cmocka_unit_test(wrong_texts_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_folder);
}
