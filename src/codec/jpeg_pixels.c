// Decoding and encoding of JPEG pictures by libjpeg-turbo. In: the bytes of a picture, or 8-bit
// samples. Out: the samples, or the bytes. libjpeg's errors end the work by longjmp. Data that end
// too early or are damaged fail, because libjpeg would fill the rest with grey.
#include "codec/jpeg_pixels.h"

#include "codec/file_info.h"
#include "codec/jpeg_block.h"

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

// A progressive picture may have any number of scans, each of which costs the time of a picture and
// may have few bytes, as may a scan with arithmetic coding. The pixels of all scans are therefore
// limited by the number of bytes. libjpeg's own writer makes 10 scans; its pictures of one colour
// have 1700 such pixels a byte.
enum { PIXELS_A_BYTE = 8192, PIXELS_ALWAYS = 1 << 26 };

typedef struct decoder {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    struct jpeg_source_mgr source;
    ki_reader rest; // bytes of the file that libjpeg has not been given
    jmp_buf stop;
    kiln_context *context;
    double pixels;      // number of pixels of the picture, which each scan can cover once
    double pixels_most; // greatest sum of pixels over all scans that is decoded
    bool cancelled, too_many_scans;
    char fault[JMSG_LENGTH_MAX];
} decoder;

static _Noreturn void stop(j_common_ptr jpeg)
{
    decoder *d = jpeg->client_data;
    char text[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, text);
    ki_copy_printable(d->fault, sizeof d->fault, text);
    longjmp(d->stop, 1);
}

// Called by libjpeg for warnings (level below 0) and traces. A warning says that data are damaged
// or end early, which is an error here.
static void take_message(j_common_ptr jpeg, int level)
{
    int code = jpeg->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER ||
                      code == JWRN_HUFF_BAD_CODE || code == JWRN_MUST_RESYNC))
        stop(jpeg);
}

static void watch(j_common_ptr jpeg)
{
    decoder *d = jpeg->client_data;
    d->cancelled = !ki_go_on(d->context);
    d->too_many_scans = ki_max(1, d->jpeg.input_scan_number) * d->pixels > d->pixels_most;
    if (d->cancelled || d->too_many_scans)
        longjmp(d->stop, 1);
}

// The functions by which libjpeg takes the bytes of the file. It gets them in parts and the caller
// is asked before each part, because a file may have millions of markers before its first scan. At
// the end of the file libjpeg gets an end marker and a warning, which is an error here.

enum { PART = 1 << 20 };

static void need_no_work(j_decompress_ptr jpeg)
{
    (void)jpeg;
}

static boolean give_part(j_decompress_ptr jpeg)
{
    static const JOCTET end[] = {0xff, JPEG_EOI};
    decoder *d = jpeg->client_data;
    watch((j_common_ptr)jpeg);
    size_t left = ki_reader_left(&d->rest), size = left < PART ? left : PART;
    if (!size)
        WARNMS(jpeg, JWRN_JPEG_EOF);
    d->source.next_input_byte = size ? ki_read_bytes(&d->rest, size) : end;
    d->source.bytes_in_buffer = size ? size : sizeof end;
    return TRUE;
}

static void skip_bytes(j_decompress_ptr jpeg, long count)
{
    decoder *d = jpeg->client_data;
    while (count > 0 && (size_t)count > d->source.bytes_in_buffer) {
        count -= (long)d->source.bytes_in_buffer;
        give_part(jpeg);
    }
    if (count > 0) {
        d->source.next_input_byte += count;
        d->source.bytes_in_buffer -= (size_t)count;
    }
}

static void begin_source(decoder *d, ki_span picture)
{
    d->rest = ki_reader_make(picture.bytes, picture.size);
    d->source = (struct jpeg_source_mgr){.init_source = need_no_work,
                                         .fill_input_buffer = give_part,
                                         .skip_input_data = skip_bytes,
                                         .resync_to_restart = jpeg_resync_to_restart,
                                         .term_source = need_no_work};
    d->jpeg.src = &d->source;
}

static void begin(decoder *d, kiln_context *context)
{
    d->context = context;
    d->jpeg.err = jpeg_std_error(&d->errors);
    d->errors.error_exit = stop;
    d->errors.emit_message = take_message;
    d->jpeg.client_data = d;
}

// Calls ki_jpeg_block_limit for all blocks of a component if `change` is true. Otherwise returns
// whether all of them fit.
static bool visit_blocks(decoder *d, jpeg_component_info *component, jvirt_barray_ptr blocks,
                         bool change)
{
    const uint16_t *steps = component->quant_table->quantval;
    for (JDIMENSION y = 0; y < component->height_in_blocks; y++) {
        JBLOCKARRAY row =
            d->jpeg.mem->access_virt_barray((j_common_ptr)&d->jpeg, blocks, y, 1, change);
        watch((j_common_ptr)&d->jpeg);
        for (JDIMENSION x = 0; x < component->width_in_blocks; x++) {
            if (change)
                ki_jpeg_block_limit(row[0][x], steps);
            else if (!ki_jpeg_block_fits(row[0][x], steps))
                return false;
        }
    }
    return true;
}

// Brings all coefficients to a range in which libjpeg-turbo gives the same samples on every
// processor. Coefficients of other pictures than coarse or damaged ones stay as they are.
static void limit_blocks(decoder *d)
{
    jvirt_barray_ptr *blocks = jpeg_read_coefficients(&d->jpeg);
    bool fit = true;
    for (int i = 0; i < d->jpeg.num_components && fit; i++)
        if (d->jpeg.comp_info[i].quant_table) // else there are no data of this component
            fit = visit_blocks(d, &d->jpeg.comp_info[i], blocks[i], false);
    for (int i = 0; i < d->jpeg.num_components && !fit; i++) {
        JQUANT_TBL *table = d->jpeg.comp_info[i].quant_table; // the component's own copy
        if (!table)
            continue;
        visit_blocks(d, &d->jpeg.comp_info[i], blocks[i], true);
        for (int k = 0; k < DCTSIZE2; k++)
            table->quantval[k] = 1;
    }
}

// Reads the coefficients of all scans.
static void read_scans(decoder *d)
{
    int event;
    do {
        watch((j_common_ptr)&d->jpeg);
        event = jpeg_consume_input(&d->jpeg);
    } while (event != JPEG_REACHED_EOI && event != JPEG_SUSPENDED);
}

// Decodes a picture to `samples`. Returns false if libjpeg stopped with an error.
static bool decode(decoder *d, ki_span picture, const ki_jpeg_head *head, uint8_t *samples)
{
    struct jpeg_decompress_struct *jpeg = &d->jpeg;
    if (setjmp(d->stop))
        return false;
    jpeg_create_decompress(jpeg);
    jpeg->client_data = d;
    d->progress.progress_monitor = watch;
    jpeg->progress = &d->progress;
    begin_source(d, picture);
    jpeg_read_header(jpeg, TRUE);
    jpeg->out_color_space = head->components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW; // gives the same bits on every processor, see limit_blocks
    // Smoothing invents coefficients that a progressive file lacks, differently in each version.
    jpeg->do_block_smoothing = FALSE;
    jpeg->buffered_image = TRUE; // all coefficients are read before the first is transformed
    jpeg_start_decompress(jpeg);
    read_scans(d);
    limit_blocks(d);
    jpeg_start_output(jpeg, jpeg->input_scan_number);
    if (jpeg->output_width != (JDIMENSION)head->width ||
        jpeg->output_height != (JDIMENSION)head->height ||
        jpeg->output_components != head->components)
        return false;
    size_t line = (size_t)head->width * (size_t)head->components;
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW row = samples + line * jpeg->output_scanline;
        jpeg_read_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_output(jpeg);
    jpeg_finish_decompress(jpeg);
    return true;
}

static kiln_result fail(const decoder *d, const char *name, kiln_error *error)
{
    if (d->cancelled)
        return ki_fail_cancelled(error, "reading");
    if (d->too_many_scans)
        return ki_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s: the JPEG has %d scans or more, too many for its %.0f pixels and its size", name,
            d->jpeg.input_scan_number, d->pixels);
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: the JPEG is damaged: %s", name,
                   d->fault[0] ? d->fault : "its size changes");
}

kiln_result ki_jpeg_samples(kiln_context *context, ki_span picture, const ki_jpeg_head *head,
                            const char *name, uint8_t **samples, kiln_error *error)
{
    size_t count = (size_t)head->width * (size_t)head->height * (size_t)head->components;
    decoder *d = ki_alloc(context, 1, sizeof *d);
    *samples = ki_alloc_raw(context, count, 1);
    // libjpeg takes the picture's coefficients from malloc. A block of their size, which nobody
    // touches, makes the context's memory limit count them.
    uint8_t *reserve = ki_alloc_raw(context, count, 2);
    kiln_result result = KILN_OK;
    if (!d || !*samples || !reserve) {
        result = ki_fail_memory(context, error, name, 3 * count);
    } else {
        begin(d, context);
        d->pixels = (double)head->width * head->height;
        d->pixels_most = PIXELS_ALWAYS + PIXELS_A_BYTE * (double)picture.size;
        if (!decode(d, picture, head, *samples))
            result = fail(d, name, error);
        jpeg_destroy_decompress(&d->jpeg);
    }
    ki_free(reserve);
    if (result != KILN_OK) {
        ki_free(*samples);
        *samples = NULL;
    }
    ki_free(d);
    return result;
}

// ----------------------------------------------------------------------------------------- writing

enum { ROOM = 16384 }; // bytes that libjpeg makes before they are appended to the writer

typedef struct encoder {
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_destination_mgr destination;
    jmp_buf stop;
    ki_writer *writer;
    bool cancelled;
    char fault[JMSG_LENGTH_MAX];
    uint8_t room[ROOM];
} encoder;

static _Noreturn void stop_writing(j_common_ptr jpeg)
{
    encoder *e = jpeg->client_data;
    char text[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, text);
    ki_copy_printable(e->fault, sizeof e->fault, text);
    longjmp(e->stop, 1);
}

static void offer_room(j_compress_ptr jpeg)
{
    encoder *e = jpeg->client_data;
    e->destination.next_output_byte = e->room;
    e->destination.free_in_buffer = ROOM;
}

static boolean append_room(j_compress_ptr jpeg)
{
    encoder *e = jpeg->client_data;
    ki_write(e->writer, e->room, ROOM);
    offer_room(jpeg);
    return TRUE;
}

static void append_rest(j_compress_ptr jpeg)
{
    encoder *e = jpeg->client_data;
    ki_write(e->writer, e->room, ROOM - e->destination.free_in_buffer);
}

static void set_up(encoder *e, int width, int height, int channels, int quality)
{
    struct jpeg_compress_struct *jpeg = &e->jpeg;
    jpeg_create_compress(jpeg);
    jpeg->client_data = e;
    e->destination.init_destination = offer_room;
    e->destination.empty_output_buffer = append_room;
    e->destination.term_destination = append_rest;
    jpeg->dest = &e->destination;
    jpeg->image_width = (JDIMENSION)width;
    jpeg->image_height = (JDIMENSION)height;
    jpeg->input_components = channels;
    jpeg->in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(jpeg);
    jpeg_set_quality(jpeg, quality, TRUE);
    jpeg->dct_method = JDCT_ISLOW; // gives the same bits on every processor
    jpeg->comp_info[0].h_samp_factor = jpeg->comp_info[0].v_samp_factor = 1;
}

// Encodes a picture. Returns false if libjpeg stopped with an error, or the caller asks to stop.
static bool encode(encoder *e, const uint8_t *samples, int width, int height, int channels,
                   int quality)
{
    struct jpeg_compress_struct *jpeg = &e->jpeg;
    if (setjmp(e->stop))
        return false;
    set_up(e, width, height, channels, quality);
    jpeg_start_compress(jpeg, TRUE);
    while (jpeg->next_scanline < jpeg->image_height) {
        size_t line = (size_t)width * (size_t)channels * jpeg->next_scanline;
        JSAMPROW row = (JSAMPROW)(samples + line);
        e->cancelled = !ki_go_on(e->writer->context);
        if (e->cancelled)
            return false;
        jpeg_write_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_compress(jpeg);
    return true;
}

kiln_result ki_jpeg_write(const uint8_t *samples, int width, int height, int channels, int quality,
                          const char *name, ki_writer *writer, kiln_error *error)
{
    encoder *e = ki_alloc(writer->context, 1, sizeof *e);
    if (!e)
        return ki_fail_memory(writer->context, error, name, sizeof *e);
    e->writer = writer;
    e->jpeg.err = jpeg_std_error(&e->errors);
    e->errors.error_exit = stop_writing;
    e->jpeg.client_data = e;
    kiln_result result = KILN_OK;
    if (!encode(e, samples, width, height, channels, quality) && e->cancelled)
        result = ki_fail_cancelled(error, "writing");
    else if (e->fault[0])
        result = ki_fail(error, KILN_ERROR_ARGUMENT, "%s: libjpeg says: %s", name, e->fault);
    else if (writer->failed)
        result = ki_fail_memory(writer->context, error, name, writer->size);
    jpeg_destroy_compress(&e->jpeg);
    ki_free(e);
    return result;
}
