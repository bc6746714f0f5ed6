// JPEG blocks whose inverse transform leaves the range of libjpeg-turbo's integers: their samples
// are those of the formula, clamped to 0..255, whether libjpeg-turbo uses vector units or not. CTest
// runs this program twice, the second time with libjpeg-turbo's C code, and the sum over all
// samples is the same.
#include "codec/codec.h"
#include "codec/jpeg_block.h"

#include "kit/context.h"
#include "kit/random.h"

#include <jpeglib.h>

enum { SIDE = 8, BLOCKS = 8, SIZE = SIDE * BLOCKS, STEP = 32 };

// The samples of a block by the definition of the transform (ITU-T T.81, A.3.3), by libm.
static void samples_by_definition(const int16_t *coefficients, double *samples)
{
    for (int i = 0; i < DCTSIZE2; i++) {
        double sum = 0;
        for (int v = 0; v < SIDE; v++)
            for (int u = 0; u < SIDE; u++)
                sum += (v ? 1 : sqrt(0.5)) * (u ? 1 : sqrt(0.5)) * STEP *
                       coefficients[v * SIDE + u] * cos((2 * (i / SIDE) + 1) * v * pi / 16) *
                       cos((2 * (i % SIDE) + 1) * u * pi / 16);
        samples[i] = fmin(fmax(sum / 4 + 128, 0), 255);
    }
}

// Block b, counted row by row, has coefficients of up to 4 2^(b / 8), so that the samples of the
// first row of blocks go little beyond 0..255, and those of the last a hundred times as far.
static void fill_blocks(int16_t coefficients[BLOCKS * BLOCKS][DCTSIZE2])
{
    uint64_t state = 1;
    for (int b = 0; b < BLOCKS * BLOCKS; b++)
        for (int i = 0; i < DCTSIZE2; i++) {
            int most = 4 << (b / BLOCKS);
            coefficients[b][i] =
                (int16_t)((int)(random_bits(&state) % (2 * (unsigned)most)) - most);
        }
}

// Writes a grey picture of given quantized coefficients.
static ki_writer write_blocks(int16_t coefficients[BLOCKS * BLOCKS][DCTSIZE2], bool progressive)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned int steps[DCTSIZE2];
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = jpeg.image_height = SIZE;
    jpeg.input_components = 1;
    jpeg.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&jpeg);
    if (progressive)
        jpeg_simple_progression(&jpeg);
    for (int i = 0; i < DCTSIZE2; i++)
        steps[i] = STEP;
    jpeg_add_quant_table(&jpeg, 0, steps, 100, TRUE);
    jvirt_barray_ptr array =
        jpeg.mem->request_virt_barray((j_common_ptr)&jpeg, JPOOL_IMAGE, TRUE, BLOCKS, BLOCKS, 1);
    jpeg_write_coefficients(&jpeg, &array);
    for (int y = 0; y < BLOCKS; y++) {
        JBLOCKARRAY row =
            jpeg.mem->access_virt_barray((j_common_ptr)&jpeg, array, (JDIMENSION)y, 1, TRUE);
        memcpy(row[0], coefficients[y * BLOCKS], BLOCKS * sizeof(JBLOCK));
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    ki_writer w = {.context = context};
    ki_write(&w, bytes, size);
    free(bytes);
    return w;
}

// The byte from which a linear value was made by the curve of sRGB.
static int byte_of(float value)
{
    double x = (double)value;
    double coded = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
    return (int)floor(255 * coded + 0.5);
}

static void samples_are_clamped_on_every_processor(void **state)
{
    int16_t coefficients[BLOCKS * BLOCKS][DCTSIZE2];
    (void)state;
    fill_blocks(coefficients);
    for (int progressive = 0; progressive < 2; progressive++) {
        ki_writer w = write_blocks(coefficients, progressive);
        ki_decoded decoded;
        CHECK_OK(ki_decode(context, w.bytes, w.size, "a.jpg", &decoded, NULL, &error));
        uint64_t hash = 0;
        for (int b = 0; b < BLOCKS * BLOCKS; b++) {
            double wanted[DCTSIZE2];
            samples_by_definition(coefficients[b], wanted);
            for (int i = 0; i < DCTSIZE2; i++) {
                int x = b % BLOCKS * SIDE + i % SIDE, y = b / BLOCKS * SIDE + i / SIDE;
                int byte = byte_of(decoded.image.pixels[3 * (y * SIZE + x)]);
                // 1/2 for the rounding of a sample, and the rest for that of 64 coefficients
                CHECK_NEAR((double)byte, wanted[i], 2);
                hash = random_hash(hash + (uint64_t)byte);
            }
        }
        assert_true(hash == 0x31538adb47917c9cu);
        ki_decoded_free(&decoded);
        ki_writer_free(&w);
    }
}

// A block with one coefficient, whose greatest sample is coefficient * step / 8 or, off the mean,
// nearly a quarter; and blocks whose sums of a column or of a row leave 16 bits.
static void ranges_have_these_ends(void **state)
{
    static const struct {
        int16_t first, second;
        int place; // of the second
        uint16_t step;
        bool fits;
    } rows[] = {
        {0, 0, 1, 65535, true},       {2000, 0, 1, 1, true},
        {-2000, 0, 1, 1, true},       {4032, 0, 1, 1, true},
        {4033, 0, 1, 1, false},       {-63, 0, 1, 64, true},
        {-64, 0, 1, 64, false},       {0, 2000, 9, 1, true},
        {0, 2120, 9, 1, false}, // 2120 / 4 cos^2(pi / 16) = 510
        {-32768, 0, 1, 65535, false}, {-32768, -32768, 63, 65535, false},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        int16_t coefficients[DCTSIZE2] = {rows[i].first};
        uint16_t steps[DCTSIZE2];
        coefficients[rows[i].place] = rows[i].second;
        for (int k = 0; k < DCTSIZE2; k++)
            steps[k] = rows[i].step;
        assert_int_equal(ki_jpeg_block_fits(coefficients, steps), rows[i].fits);
        int16_t limited[DCTSIZE2];
        memcpy(limited, coefficients, sizeof limited);
        ki_jpeg_block_limit(limited, steps);
        for (int k = 0; k < DCTSIZE2 && rows[i].fits; k++)
            assert_int_equal(limited[k], coefficients[k] * rows[i].step);
        for (int k = 0; k < DCTSIZE2; k++)
            steps[k] = 1;
        assert_true(ki_jpeg_block_fits(limited, steps));
    }
}

// Limited, a block of black and white that goes beyond both is of black and white: 1024 times the
// sign of its mean, and other coefficients of 0.
static void limited_blocks_are_those_of_clamped_samples(void **state)
{
    uint16_t steps[DCTSIZE2];
    (void)state;
    for (int k = 0; k < DCTSIZE2; k++)
        steps[k] = 255;
    for (int sign = -1; sign <= 1; sign += 2) {
        int16_t coefficients[DCTSIZE2] = {(int16_t)(sign * 1000)};
        ki_jpeg_block_limit(coefficients, steps);
        assert_int_equal(coefficients[0], sign < 0 ? -1024 : 1016);
        for (int k = 1; k < DCTSIZE2; k++)
            assert_int_equal(coefficients[k], 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_are_clamped_on_every_processor),
        cmocka_unit_test(ranges_have_these_ends),
        cmocka_unit_test(limited_blocks_are_those_of_clamped_samples),
    };
    return cmocka_run_group_tests_name("jpeg_range", tests, set_up_folder, tear_down_folder);
}
