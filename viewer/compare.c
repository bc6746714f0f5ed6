// Where and how much two pictures of a view differ.
#include "reference.h"

#include <math.h>

static bool shows_ball(const view_options *o, double x, double y, int width, int height)
{
    view_ball balls[VIEW_MAX_BALLS];
    double eye[3], right[3], up[3], back[3], d[3], size = 0;
    int count = view_balls(o, balls);
    view_camera_axes(&o->camera, eye, right, up, back);
    double slope = tan(o->camera.fov / 2 * 0.017453292519943295);
    for (int c = 0; c < 3; c++) {
        d[c] = (2 * x / width - 1) * slope * width / height * right[c] +
               (1 - 2 * y / height) * slope * up[c] - back[c];
        size += d[c] * d[c];
    }
    for (int i = 0; i < count; i++) {
        double along = 0, away = 0;
        for (int c = 0; c < 3; c++) {
            along += (balls[i].centre[c] - eye[c]) * d[c];
            away += (balls[i].centre[c] - eye[c]) * (balls[i].centre[c] - eye[c]);
        }
        if (along > 0 && away - along * along / size < balls[i].radius * balls[i].radius)
            return true;
    }
    return false;
}

// White where there is no error, red where the picture is too bright, blue where it is too dark.
static void colour(float pixel[3])
{
    double mean = ((double)pixel[0] + (double)pixel[1] + (double)pixel[2]) / 3;
    double strength = fmin(fabs(mean) / 0.25, 1);
    pixel[0] = (float)(mean > 0 ? 1 : 1 - strength);
    pixel[1] = (float)(1 - strength);
    pixel[2] = (float)(mean < 0 ? 1 : 1 - strength);
}

view_error view_compare(const view_options *o, kiln_image *image, const kiln_image *truth,
                        bool colours)
{
    int width = image->width, height = image->height;
    size_t count[2] = {0};
    double squares[2] = {0}, sum = 0;
    view_error e = {0};
    for (int i = 0; i < width * height; i++) {
        float *a = image->pixels + 3 * (size_t)i;
        const float *b = truth->pixels + 3 * (size_t)i;
        int half = i / width >= height / 2;
        bool shows = shows_ball(o, i % width + 0.5, i / width + 0.5, width, height);
        count[half] += shows;
        for (int c = 0; c < 3; c++) {
            sum += shows ? (double)b[c] / 3 : 0;
            a[c] = shows ? a[c] - b[c] : 0;
            squares[half] += (double)a[c] * (double)a[c] / 3;
            e.largest = fmax(e.largest, fabs((double)a[c]));
        }
    }
    size_t all = count[0] + count[1];
    double mean = all && sum > 0 ? sum / (double)all : 1;
    e.largest /= mean;
    e.rms = all ? sqrt((squares[0] + squares[1]) / (double)all) / mean : 0;
    e.upper = count[0] ? sqrt(squares[0] / (double)count[0]) / mean : 0;
    e.lower = count[1] ? sqrt(squares[1] / (double)count[1]) / mean : 0;
    for (int i = 0; i < width * height; i++) {
        float *a = image->pixels + 3 * (size_t)i;
        for (int c = 0; c < 3; c++)
            a[c] = (float)((double)a[c] / mean);
        if (colours)
            colour(a);
    }
    return e;
}
