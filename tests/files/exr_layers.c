// EXR files of several layers and parts: which of these is the picture, what is said about the
// choice, and what is refused. A sample's value tells its part and channel.
#include "codec/codec.h"
#include "codec/file_info.h"
#include "exr_plain.h"

#include "kit/context.h"

enum { W = 4, H = 2 };

// Loads a file, of which def->layer may name the layer. A panorama of 4 x 2 texels.
static kiln_result load(plain_file *file, kiln_load_def *def, kiln_map *map)
{
    ki_writer w = {.context = context};
    file->width = file->width ? file->width : W;
    file->height = file->height ? file->height : H;
    file->part_count = file->part_count ? file->part_count : 1;
    plain_write(file, &w);
    kiln_result result = kiln_map_decode(context, w.bytes, w.size, "a.exr", def, map, &error);
    ki_writer_free(&w);
    return result;
}

static void check_texel(const kiln_map *map, int part, const char *const channels[3])
{
    for (int c = 0; c < 3; c++) {
        float wanted = channels[c] ? plain_number(part, channels[c], 0, 0) : 0;
        CHECK_NEAR((double)map->level[0][c], (double)wanted, 0);
        CHECK_NEAR((double)map->level[0][3 * (W * H - 1) + c], (double)wanted, 0);
    }
}

// Loads a file of one or two parts and compares the texels with the wanted channels.
static void check_choice(plain_file file, const char *layer, int part, const char *red,
                         const char *green, const char *blue)
{
    kiln_map map;
    kiln_load_report report;
    kiln_load_def def = {.layer = layer, .report = &report};
    CHECK_OK(load(&file, &def, &map));
    check_texel(&map, part, (const char *const[3]){red, green, blue});
    kiln_map_free(&map);
}

static void check_refused(plain_file file, const char *layer, const char *sentence)
{
    kiln_map map;
    kiln_load_def def = {.layer = layer};
    assert_int_equal(load(&file, &def, &map), KILN_ERROR_UNSUPPORTED);
    assert_string_equal(error.message, sentence);
    assert_null(map.level[0]);
}

#define ONE(...) ((plain_file){.parts = {{.channels = {__VA_ARGS__}}}})
#define RGB(layer) layer ".B", layer ".G", layer ".R"

static void the_picture_is_the_plain_one_or_the_one_named_like_a_picture(void **state)
{
    (void)state;
    check_choice(ONE(RGB("AO"), RGB("Beauty"), "B", "G", "R", "Z"), NULL, 0, "R", "G", "B");
    check_choice(ONE(RGB("A.AO"), RGB("A.Combined"), "A.Depth.Z"), NULL, 0, "A.Combined.R",
                 "A.Combined.G", "A.Combined.B");
    static const char *const names[] = {"Combined", "combined",  "rgba", "RGBA",  "beauty",
                                        "Beauty",   "RGB_color", "Ci",   "C",     "default",
                                        "Image",    "x.y.Ci",    "main", "Color", "FinalImage"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char b[32], g[32], r[32];
        snprintf(b, sizeof b, "%s.B", names[i]);
        snprintf(g, sizeof g, "%s.G", names[i]);
        snprintf(r, sizeof r, "%s.R", names[i]);
        check_choice(ONE(RGB("AO"), b, g, r, RGB("normals")), NULL, 0, r, g, b);
    }
    // Without such a layer, the channel Y before the only layer with colours, whatever its name.
    check_choice(ONE("A", "N.X", "N.Y", "N.Z", RGB("lights"), "Z"), NULL, 0, "lights.R", "lights.G",
                 "lights.B");
    check_choice(ONE("Y", "AO.B", "AO.G", "AO.R"), NULL, 0, "Y", "Y", "Y");
}

static void names_of_channels_may_be_spelled_out_or_in_lower_case(void **state)
{
    (void)state;
    check_choice(ONE("b", "g", "r"), NULL, 0, "r", "g", "b");
    check_choice(ONE("blue", "green", "red"), NULL, 0, "red", "green", "blue");
    check_choice(ONE("Blue", "Green", "Red"), NULL, 0, "Red", "Green", "Blue");
    check_choice(ONE("beauty.blue", "beauty.green", "beauty.red", "id.red"), NULL, 0, "beauty.red",
                 "beauty.green", "beauty.blue");
    check_choice(ONE("y"), NULL, 0, "y", "y", "y");
    check_choice(ONE("B", "G", "R", "b", "g", "r"), NULL, 0, "R", "G", "B");
    check_choice(ONE("G", "R"), NULL, 0, "R", "G", NULL);
}

static void parts_are_searched_for_the_picture(void **state)
{
    (void)state;
    plain_file file = {.multipart = true,
                       .part_count = 3,
                       .parts = {{.name = "one", .channels = {RGB("Combined"), "Z"}},
                                 {.name = "two", .channels = {"X", "Y", "Z"}},
                                 {.name = "three", .channels = {"A", "B", "G", "R"}}}};
    check_choice(file, NULL, 2, "R", "G", "B");
    check_choice(file, "Combined", 0, "Combined.R", "Combined.G", "Combined.B");
    check_choice(file, "one.Combined", 0, "Combined.R", "Combined.G", "Combined.B");
    check_choice(file, "X", 1, "X", "X", "X");
    // Of several parts with R, G and B, the one that is named like a picture.
    plain_file passes = {.multipart = true,
                         .part_count = 3,
                         .parts = {{.name = "AO", .channels = {"B", "G", "R"}},
                                   {.name = "rgba", .channels = {"A", "B", "G", "R"}},
                                   {.name = "N", .channels = {"B", "G", "R"}}}};
    check_choice(passes, NULL, 1, "R", "G", "B");
    check_choice(passes, "AO", 0, "R", "G", "B");
    passes.parts[1].name = "beauty.left";
    check_refused(passes, NULL,
                  "a.exr: 3 of its layers may be the picture; choose one by --layer NAME: AO, "
                  "beauty.left, N");
    passes.parts[0].deep = true; // deep parts are no choice, so that flat ones may be
    passes.parts[2].channels[0] = "X";
    passes.parts[2].channels[1] = "Y";
    passes.parts[2].channels[2] = "Z";
    check_choice(passes, NULL, 1, "R", "G", "B");
}

static void a_layer_may_be_named(void **state)
{
    (void)state;
    plain_file file = ONE(RGB("V.AO"), RGB("V.Combined"), "V.Depth.Z", RGB("W.AO"));
    check_choice(file, "V.AO", 0, "V.AO.R", "V.AO.G", "V.AO.B");
    check_choice(file, "Combined", 0, "V.Combined.R", "V.Combined.G", "V.Combined.B");
    check_choice(file, "V.Depth.Z", 0, "V.Depth.Z", "V.Depth.Z", "V.Depth.Z");
    check_choice(file, "W.AO.G", 0, "W.AO.G", "W.AO.G", "W.AO.G");
    check_choice(file, "", 0, "V.Combined.R", "V.Combined.G", "V.Combined.B");
    check_refused(file, "AO",
                  "a.exr: 2 of its layers are named AO; name the part too, as PART.LAYER: V.AO, "
                  "V.Combined, W.AO");
    check_refused(file, "beauty",
                  "a.exr: has no picture or channel named beauty; its layers with a picture are: "
                  "V.AO, V.Combined, W.AO");
    check_refused(file, "ombined",
                  "a.exr: has no picture or channel named ombined; its layers with a picture are: "
                  "V.AO, V.Combined, W.AO");
}

static void what_is_no_picture_is_never_taken_for_one(void **state)
{
    (void)state;
    check_refused(ONE("X", "Y", "Z"), NULL,
                  "a.exr: has no channel R, G, B or Y; its channels are X, Y, Z; --layer CHANNEL "
                  "reads one of them as grey");
    check_refused(ONE("N.X", "N.Y", "N.Z", "Z"), NULL,
                  "a.exr: has no channel R, G, B or Y; its channels are N.X, N.Y, N.Z, Z; --layer "
                  "CHANNEL reads one of them as grey");
    check_refused(
        ONE("Y", "Z"), NULL,
        "a.exr: has no channel R, G, B or Y; its channels are Y, Z; --layer CHANNEL reads "
        "one of them as grey");
    check_choice(ONE("Y", "Z"), "Y", 0, "Y", "Y", "Y");
    check_refused(ONE(RGB("AO"), RGB("Normal")), NULL,
                  "a.exr: 2 of its layers may be the picture; choose one by --layer NAME: AO, "
                  "Normal");
    // Blender's compositor writes its result beside the layers that it was made of.
    check_choice(ONE(RGB("Composite.Combined"), RGB("RenderLayer.Combined")), NULL, 0,
                 "Composite.Combined.R", "Composite.Combined.G", "Composite.Combined.B");
    check_refused(ONE(RGB("One.Combined"), RGB("Two.Combined")), NULL,
                  "a.exr: 2 of its layers may be the picture; choose one by --layer NAME: "
                  "One.Combined, Two.Combined");
    plain_file deep = ONE("A", "B", "G", "R");
    deep.parts[0].deep = true;
    check_refused(deep, NULL, "a.exr: holds deep samples, kiln reads flat pictures only");
}

static void check_notes(plain_file file, const char *layer, const char *first, const char *second)
{
    kiln_map map;
    kiln_note note;
    kiln_load_report report;
    kiln_load_def def = {.layer = layer, .report = &report};
    CHECK_OK(load(&file, &def, &map));
    kiln_map_free(&map);
    int count = 0;
    for (; kiln_load_report_note(&report, count, &note); count++)
        assert_string_equal(note.text, count ? second : first);
    assert_int_equal(count, (first != NULL) + (second != NULL));
}

static void the_choice_is_told(void **state)
{
    (void)state;
    check_notes(ONE("A", "B", "G", "R", "Z"), NULL, NULL, NULL);
    check_notes(ONE(RGB("AO"), RGB("Combined"), "Depth.Z"), NULL,
                "layer Combined (channels R, G, B), one of 3 layers, is the picture", NULL);
    check_notes(ONE(RGB("AO"), "B", "G", "R"), NULL,
                "channels R, G, B, which have no layer's name, are the picture; the file has 2 "
                "layers",
                NULL);
    check_notes(ONE(RGB("AO"), "Depth.Z"), "Depth.Z",
                "channel Depth.Z alone is the picture, as grey", NULL);
    check_notes(ONE("R"), NULL, "the file has no green channel, which is taken as 0",
                "the file has no blue channel, which is taken as 0");
}

// Describes a file from memory, whose choice may be impossible.
static void describe(plain_file file, kiln_file_info *info)
{
    ki_writer w = {.context = context};
    file.width = W;
    file.height = H;
    file.part_count = file.part_count ? file.part_count : 1;
    plain_write(&file, &w);
    CHECK_OK(ki_decode(context, w.bytes, w.size, "a.exr", NULL, info, &error));
    ki_writer_free(&w);
}

static void layers_are_described_in_printable_words(void **state)
{
    (void)state;
    kiln_file_info info;
    describe(ONE(RGB("AO"), RGB("Normal"), "Z"), &info);
    assert_int_equal(info.part_count, 1);
    assert_int_equal(info.layer_count, 3);
    assert_string_equal(info.layer[0].name, "AO");
    assert_string_equal(info.layer[1].channels, "B, G, R");
    assert_string_equal(info.layer[2].name, "");
    assert_string_equal(info.layer[2].channels, "Z");
    for (int i = 0; i < 3; i++)
        assert_false(info.layer[i].picture);

    plain_file file = {
        .multipart = true,
        .part_count = 2,
        .parts = {{.name = "a\x1b[31m", .channels = {"B", "G", "R"}},
                  {.name = "N", .channels = {"\xffodd\n.X", "gr\xc3\xbcn.\xc2\x9b"}}}};
    describe(file, &info);
    assert_int_equal(info.part_count, 2);
    assert_int_equal(info.layer_count, 3);
    assert_string_equal(info.layer[0].part, "a\\x1b[31m");
    assert_true(info.layer[0].picture);
    assert_string_equal(info.layer[1].name, "\\xffodd\\x0a");
    assert_string_equal(info.layer[2].name, "gr\xc3\xbcn");
    assert_string_equal(info.layer[2].channels, "\\xc2\\x9b");
    assert_false(info.layer[1].picture);
}

static void texts_are_escaped_and_cut(void **state)
{
    (void)state;
    static const struct {
        const char *from;
        size_t room;
        const char *to;
    } cases[] = {
        {"plain", 32, "plain"},
        {"back\\slash", 32, "back\\\\slash"},
        {"\x1b]0;title\x07", 32, "\\x1b]0;title\\x07"},
        {"\xe2\x82\xac \xf0\x9f\x8c\x9e", 32, "\xe2\x82\xac \xf0\x9f\x8c\x9e"},
        {"\xc0\xaf \xed\xa0\x80 \xf4\x90\x80\x80", 64,
         "\\xc0\\xaf \\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80"},
        {"\xe2\x80\xaetxt", 32, "\\xe2\\x80\\xaetxt"}, // writes from right to left
        {"\xe2\x82", 32, "\\xe2\\x82"},
        {"12345678", 9, "12345678"},
        {"12345678", 8, "1234..."},
        {"123\xe2\x82\xac"
         "78",
         8, "123..."},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[64];
        ki_escape_text(text, cases[i].room, cases[i].from, strlen(cases[i].from));
        assert_string_equal(text, cases[i].to);
    }
}

static void other_formats_have_no_layers(void **state)
{
    (void)state;
    static const char hdr[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\1\1\1\200\1\1\1\200";
    kiln_map map;
    const kiln_load_def def = {.layer = "beauty"};
    assert_int_equal(kiln_map_decode(context, hdr, sizeof hdr - 1, "a.hdr", &def, &map, &error),
                     KILN_ERROR_UNSUPPORTED);
    assert_string_equal(error.message,
                        "a.hdr: is a hdr file, which has no layers, leave out --layer beauty");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            the_picture_is_the_plain_one_or_the_one_named_like_a_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(names_of_channels_may_be_spelled_out_or_in_lower_case,
                                        set_up, tear_down),
        cmocka_unit_test_setup_teardown(parts_are_searched_for_the_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_layer_may_be_named, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_no_picture_is_never_taken_for_one, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(the_choice_is_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(layers_are_described_in_printable_words, set_up, tear_down),
        cmocka_unit_test_setup_teardown(texts_are_escaped_and_cut, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_formats_have_no_layers, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
