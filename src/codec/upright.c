#include "codec/upright.h"

#include "codec/report.h"
#include "image/image.h"

#include <string.h>

void ki_note_upright(int orientation, kiln_load_report *report)
{
    if (orientation != 1)
        ki_note(report, KILN_NOTE_CONVERSION, false,
                "the picture was turned upright by Exif's orientation %d", orientation);
}

typedef struct turn_job {
    const kiln_image *from, *to;
    bool exchanged, from_right, from_bottom;
} turn_job;

// Task of one thread: fills row y of the upright picture. Each pixel is copied from the stored
// picture, whose rows and columns may be exchanged and may be counted from the right and from the
// bottom.
static void turn_row(void *data, int y)
{
    const turn_job *j = data;
    int w = j->from->width, h = j->from->height;
    float *to = j->to->pixels + 3 * (size_t)y * (size_t)j->to->width;
    for (int x = 0; x < j->to->width; x++, to += 3) {
        int from_x = j->exchanged ? y : x, from_y = j->exchanged ? x : y;
        from_x = j->from_right ? w - 1 - from_x : from_x;
        from_y = j->from_bottom ? h - 1 - from_y : from_y;
        memcpy(to, j->from->pixels + 3 * ((size_t)from_y * (size_t)w + (size_t)from_x),
               3 * sizeof *to);
    }
}

kiln_result ki_turn_upright(kiln_context *context, int orientation, kiln_image *image,
                            kiln_error *error)
{
    int o = orientation;
    kiln_image upright = {.width = o >= 5 ? image->height : image->width,
                          .height = o >= 5 ? image->width : image->height,
                          .channels = 3};
    if (o == 1)
        return KILN_OK;
    kiln_result result = ki_image_allocate(context, &upright, error);
    if (result != KILN_OK)
        return result;
    turn_job job = {image, &upright, o >= 5, o == 2 || o == 3 || o == 7 || o == 8,
                    o == 3 || o == 4 || o == 6 || o == 7};
    if (!ki_parallel_steps(context, NULL, upright.height, turn_row, &job)) {
        kiln_image_free(&upright);
        return ki_fail_cancelled(error, "reading");
    }
    kiln_image_free(image);
    *image = upright;
    return KILN_OK;
}
