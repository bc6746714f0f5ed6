// Tables for engines: what --for writes, decoded again, is the integrals.
#include <kiln/brdf.h>
#include <png.h>
#include <unistd.h>

#include "kit/context.h"

static void save(int size, kiln_table_format format, const char *path)
{
    kiln_table table;
    kiln_table_def def = {.kind = KILN_TABLE_DFG_MULTISCATTER, .width = size, .height = size};
    kiln_table_save_def how = {.format = format};
    CHECK_OK(kiln_table_create(context, &def, &table, &error));
    CHECK_OK(kiln_table_save(context, &table, path, &how, &error));
    kiln_table_free(&table);
}

// What texel (x, y) stands for: n.v to the right, roughness from 0 in the first row.
static void integrals(int size, int x, int y, double wanted[3])
{
    static const kiln_model model = {0};
    double nov = (x + 0.5) / size, roughness = (y + 0.5) / size, ab[2];
    kiln_energy_split(&model, roughness, nov, ab);
    wanted[0] = ab[1];
    wanted[1] = ab[0] + ab[1];
    wanted[2] = kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, fmax(roughness, 0.01), nov);
}

static double half(unsigned bits)
{
    int exponent = (int)(bits >> 10 & 31);
    double fraction = (double)(bits & 1023) / 1024;
    return exponent ? ldexp(1 + fraction, exponent - 15) : ldexp(fraction, -14);
}

// Filament: dfg.inc, 128 x 128 texels of three halves, as its CubemapIBL::DFG orders them:
// DFV_Multiscatter's x, y and the cloth's. cmgen's file begins with the row of roughness 0.
static void filaments_halves_are_the_integrals(void **state)
{
    (void)state;
    enum { SIZE = 128 };
    const char *path = in_folder("dfg.inc");
    char line[256];
    save(SIZE, KILN_TABLE_FORMAT_AUTO, path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int count = 0;
    while (fgets(line, sizeof line, file)) {
        char *at = line, *end;
        if (!strncmp(line, "//", 2))
            continue;
        for (; *at == '0'; at = end + strspn(end, ", \n"), count++) {
            unsigned bits = (unsigned)strtoul(at, &end, 16);
            int texel = count / 3, x = texel % SIZE, y = texel / SIZE;
            assert_int_equal(*end, ',');
            if (texel % 31)
                continue;
            double wanted[3];
            integrals(SIZE, x, y, wanted);
            CHECK_NEAR(half(bits), wanted[count % 3], wanted[count % 3] / 2047 + 6e-8);
        }
    }
    assert_int_equal(count, 3 * SIZE * SIZE);
    fclose(file);
    unlink(path);
}

// Babylon.js: 256 x 256 texels of RGBD, value = c^2.2 / D.
static void babylons_picture_is_the_integrals(void **state)
{
    (void)state;
    enum { SIZE = 256 };
    const char *path = in_folder("brdf.png");
    save(SIZE, KILN_TABLE_FORMAT_RGBD, path);
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&image, path));
    assert_int_equal(image.width, SIZE);
    assert_int_equal(image.height, SIZE);
    assert_int_equal(image.format, PNG_FORMAT_RGBA);
    uint8_t *bytes = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(bytes);
    assert_true(png_image_finish_read(&image, NULL, bytes, 0, NULL));
    for (int i = 0; i < SIZE * SIZE; i += 131) {
        double wanted[3], quotient = bytes[4 * i + 3] / 255.0;
        integrals(SIZE, i % SIZE, i / SIZE, wanted);
        for (int c = 0; c < 3; c++) {
            // The root is rounded to half a step; the power's slope there is 2.2 s^1.2.
            double s = bytes[4 * i + c] / 255.0, top = s + 0.5 / 255;
            CHECK_NEAR(pow(s, 2.2) / quotient, wanted[c],
                       2.2 * pow(top, 1.2) * 0.5001 / 255 / quotient + 1e-6);
        }
    }
    free(bytes);
    unlink(path);
}

static void other_numbers_of_channels_are_refused(void **state)
{
    (void)state;
    const char *path = in_folder("e.png");
    kiln_table table = {0};
    kiln_table_def def = {.width = 4, .height = 4};
    CHECK_OK(kiln_table_create(context, &def, &table, &error));
    kiln_table_save_def how = {.format = KILN_TABLE_FORMAT_RGBD};
    assert_int_equal(kiln_table_save(context, &table, path, &how, &error), KILN_ERROR_ARGUMENT);
    assert_int_not_equal(access(path, F_OK), 0);
    kiln_table_free(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(filaments_halves_are_the_integrals),
        cmocka_unit_test(babylons_picture_is_the_integrals),
        cmocka_unit_test(other_numbers_of_channels_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_empty_folder);
}
