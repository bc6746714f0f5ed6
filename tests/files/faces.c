// Names of six faces: the same cube comes from a folder, a pattern and a list, whichever names the
// files have.
#include <sys/stat.h>

#include "kit/context.h"

enum { N = 4 }; // size of the cubes here

static void path_of(char path[256], const char *before, const char *word, const char *after)
{
    snprintf(path, 256, "%s%s%s", before, word, after);
}

static void save_face(const float *texels, const char *path)
{
    kiln_image image;
    CHECK_OK(kiln_image_create(context, N, N, 3, &image, &error));
    memcpy(image.pixels, texels, 3 * N * N * sizeof(float));
    CHECK_OK(kiln_image_save(context, &image, path, &error));
    kiln_image_free(&image);
}

// Saves the faces of a cube under six names.
static void save_faces(const kiln_map *cube, const char *before, const char *const words[6],
                       const char *after)
{
    for (int face = 0; face < 6; face++) {
        char path[256];
        path_of(path, before, words[face], after);
        save_face(cube->level[0] + 3 * N * N * face, in_folder(path));
    }
}

// Loads the six files as a folder, by a pattern and as a list in another order, and checks that
// each way gives the cube and a note with this text, or no note.
static void check_ways(const kiln_map *cube, const char *before, const char *const words[6],
                       const char *after, const char *said)
{
    char pattern[256], paths[6][256];
    const char *list[6];
    path_of(pattern, before, "{face}", after);
    for (int i = 0; i < 6; i++) {
        char name[256];
        path_of(name, before, words[(5 * i + 2) % 6], after);
        snprintf(paths[i], sizeof paths[i], "%s", in_folder(name));
        list[i] = paths[i];
    }
    for (int way = 0; way < 3; way++) {
        kiln_map back;
        kiln_load_report report;
        const kiln_load_def def = {.report = &report};
        kiln_result result = way == 0 ? kiln_map_load(context, folder_path(), &def, &back, &error)
                             : way == 1
                                 ? kiln_map_load(context, in_folder(pattern), &def, &back, &error)
                                 : kiln_map_load_faces(context, list, &def, &back, &error);
        if (result != KILN_OK)
            fail_msg("%s, way %d: %s", pattern, way, error.message);
        check_same_levels(cube, &back);
        assert_int_equal(report.note_count, said != NULL);
        if (said)
            CHECK_SAYS(report.note[0].text, said);
        kiln_map_free(&back);
    }
}

static void names_tell_the_faces(void **state)
{
    (void)state;
    static const struct {
        const char *before, *words[6], *after, *said;
    } sets[] = {
        {"", {"px", "nx", "py", "ny", "pz", "nz"}, ".exr", NULL},
        {"sky_", {"px", "nx", "py", "ny", "pz", "nz"}, ".exr", NULL},
        {"sky.", {"PX", "NX", "PY", "NY", "PZ", "NZ"}, "_4k.exr", NULL},
        {"2k-", {"posx", "negx", "posy", "negy", "posz", "negz"}, ".exr", NULL},
        {"night", {"PosX", "NegX", "PosY", "NegY", "PosZ", "NegZ"}, ".exr", NULL},
        {"", {"p_x", "n_x", "p_y", "n_y", "p_z", "n_z"}, ".exr", NULL},
        {"a_", {"+x", "-x", "+y", "-y", "+z", "-z"}, ".exr", NULL},
        {"", {"x+", "x-", "y+", "y-", "z+", "z-"}, " small.exr", NULL},
        {"",
         {"right", "left", "top", "bottom", "front", "back"},
         ".exr",
         "top bottom front back are taken as +X"},
        {"Sky",
         {"Right", "Left", "Up", "Down", "Front", "Back"},
         ".exr",
         "right left up down front back are taken"},
        {"s_",
         {"right1", "left2", "top3", "bottom4", "front5", "back6"},
         ".exr",
         "back6 are taken as +X -X +Y -Y +Z -Z"},
    };
    kiln_map cube = make_steps(context, KILN_SHAPE_CUBE, N, 1);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        save_faces(&cube, sets[i].before, sets[i].words, sets[i].after);
        // Neither a picture of another name nor another file is in the way.
        save_face(cube.level[0], in_folder("ground.exr"));
        save_face(cube.level[0], in_folder("map_nx.exr"));
        write_file(in_folder("px.txt"), "text", 4);
        check_ways(&cube, sets[i].before, sets[i].words, sets[i].after, sets[i].said);
        folder_empty();
    }
    kiln_map_free(&cube);
}

// The direction of the point (s, t) of a side of a sky in Quake II and in Source, where s grows to
// the right and t upwards, for the sides rt lf up dn ft bk. In these engines x and y are level and
// z is up.
static void quake_direction(int side, double s, double t, double d[3])
{
    const double directions[6][3] = {{1, -s, t},  {-1, s, t},  {-t, -s, 1},
                                     {t, -s, -1}, {-s, -1, t}, {s, 1, t}};
    memcpy(d, directions[side], 3 * sizeof *d);
}

static void a_sky_of_quake_keeps_its_directions(void **state)
{
    (void)state;
    static const char *const words[6] = {"rt", "lf", "up", "dn", "ft", "bk"};
    for (int side = 0; side < 6; side++) {
        float texels[3 * N * N];
        for (int i = 0; i < N * N; i++) {
            double d[3];
            int x = i % N, y = i / N;
            quake_direction(side, 2 * (x + 0.5) / N - 1, 1 - 2 * (y + 0.5) / N, d);
            double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            texels[3 * i] = (float)(2 + d[0] / length);
            texels[3 * i + 1] = (float)(2 + d[2] / length);
            texels[3 * i + 2] = (float)(2 - d[1] / length);
        }
        char path[256];
        path_of(path, "space", words[side], ".exr");
        save_face(texels, in_folder(path));
    }
    kiln_map map;
    CHECK_OK(kiln_map_load(context, folder_path(), NULL, &map, &error));
    for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
        double d[3];
        kiln_map_direction(&map, 0, i, d);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)map.level[0][3 * i + (size_t)c], 2 + d[c], 1e-6);
    }
    check_ways(&map, "space", words, ".exr", "oriented as Quake and Source draw a sky");
    kiln_map_free(&map);
}

static void what_is_no_single_set_is_refused(void **state)
{
    (void)state;
    static const char *const axes[6] = {"px", "nx", "py", "ny", "pz", "nz"};
    static const char *const sides[6] = {"right", "left", "top", "bottom", "front", "back"};
    kiln_map cube = make_steps(context, KILN_SHAPE_CUBE, N, 1), back;
    assert_int_equal(kiln_map_load(context, folder_path(), NULL, &back, &error), KILN_ERROR_IO);
    CHECK_SAYS(error.message, "holds no six faces; name the files px nx py ny pz nz");
    save_faces(&cube, "a_", axes, ".exr");
    remove(in_folder("a_ny.exr"));
    assert_int_equal(kiln_map_load(context, folder_path(), NULL, &back, &error), KILN_ERROR_IO);
    CHECK_SAYS(error.message, "holds 5 of six faces, among them a_");
    CHECK_SAYS(error.message, "and lacks others such as a_ny.exr");
    assert_int_equal(kiln_map_load(context, in_folder("a_%s.exr"), NULL, &back, &error),
                     KILN_ERROR_IO);
    CHECK_SAYS(error.message, "a_ny.exr: cannot be opened");
    save_faces(&cube, "a_", axes, ".exr");
    save_faces(&cube, "a_", sides, ".exr");
    assert_int_equal(kiln_map_load(context, folder_path(), NULL, &back, &error), KILN_ERROR_IO);
    CHECK_SAYS(error.message, "holds two sets of faces, as a_p");
    assert_int_equal(kiln_map_load(context, in_folder("a_%s.exr"), NULL, &back, &error),
                     KILN_ERROR_IO);
    CHECK_SAYS(error.message, "fits two sets of faces, with px and with right");
    // The smaller levels of a set that kiln wrote are no second set.
    folder_empty();
    kiln_map levels = make_steps(context, KILN_SHAPE_CUBE, N, 3);
    CHECK_OK(kiln_map_save(context, &levels, in_folder("b.exr"), NULL, NULL, &error));
    CHECK_OK(kiln_map_load(context, folder_path(), NULL, &back, &error));
    assert_int_equal(back.size, N);
    kiln_map_free(&back);
    kiln_map_free(&levels);
    kiln_map_free(&cube);
}

static void names_order_a_list(void **state)
{
    (void)state;
    static const struct {
        const char *paths[6];
        bool told;
        int order[6];
    } lists[] = {
        {{"a/nz.png", "b/py.hdr", "px.exr", "ny.exr", "pz.exr", "nx.exr"},
         true,
         {2, 5, 1, 3, 4, 0}},
        {{"back", "bottom", "front", "left", "right", "top"}, true, {4, 3, 5, 1, 2, 0}},
        {{"1.exr", "2.exr", "3.exr", "4.exr", "5.exr", "6.exr"}, true, {0, 1, 2, 3, 4, 5}},
        {{"px/1.exr", "2.exr", "3.exr", "4.exr", "5.exr", "grownup.exr"}, true, {0, 1, 2, 3, 4, 5}},
        {{"1.exr", "2.exr", "3.exr", "4.exr", "5.exr", "a_px.exr"}, false, {0, 1, 2, 3, 4, 5}},
        {{"px", "px", "py", "ny", "pz", "nz"}, false, {0, 1, 2, 3, 4, 5}},
    };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        int order[6];
        assert_int_equal(kiln_faces_order(lists[i].paths, order), lists[i].told);
        for (int face = 0; face < 6; face++)
            assert_int_equal(order[face], lists[i].order[face]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(names_tell_the_faces, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(a_sky_of_quake_keeps_its_directions, set_up_folder,
                                        tear_down_folder),
        cmocka_unit_test_setup_teardown(what_is_no_single_set_is_refused, set_up_folder,
                                        tear_down_folder),
        cmocka_unit_test(names_order_a_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
