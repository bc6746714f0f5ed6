// Compares a picture of a view with its reference: errors of each ball, and a picture of
// differences.
#include "reference.h"

#include <math.h>

// Returns the index of the nearest ball on the ray through the image plane's point (sx, sy), or -1
// if the ray meets no ball.
static int ball_at(const view_ball *balls, int count, const view_camera *camera, double sx,
                   double sy)
{
    double eye[3], right[3], up[3], back[3], d[3], size = 0, nearest = 1e30;
    int found = -1;
    view_camera_axes(camera, eye, right, up, back);
    for (int c = 0; c < 3; c++) {
        d[c] = sx * right[c] + sy * up[c] - back[c];
        size += d[c] * d[c];
    }
    for (int i = 0; i < count; i++) {
        double along = 0, away = 0;
        for (int c = 0; c < 3; c++) {
            double to = balls[i].centre[c] - eye[c];
            along += to * d[c];
            away += to * to;
        }
        double rest = balls[i].radius * balls[i].radius - away + along * along / size;
        double t = along / sqrt(size) - sqrt(fmax(rest, 0));
        if (rest > 0 && t > 0 && t < nearest) {
            nearest = t;
            found = i;
        }
    }
    return found;
}

// Colours a relative difference: white for 0, red for a picture that is too bright, blue for one
// that is too dark; fully saturated from 25 % on.
static void colour(float pixel[3])
{
    double mean = ((double)pixel[0] + (double)pixel[1] + (double)pixel[2]) / 3;
    double strength = fmin(fabs(mean) / 0.25, 1);
    pixel[0] = (float)(mean > 0 ? 1 : 1 - strength);
    pixel[1] = (float)(1 - strength);
    pixel[2] = (float)(mean < 0 ? 1 : 1 - strength);
}

// Sums over the pixels of one ball and their three channels: the number of values, the true values,
// and the squared differences from the true values, in radiance and on the screen.
typedef struct sums {
    double count, truth, squares, screen;
} sums;

static void add(const view_options *o, const float a[3], const float b[3], sums *to)
{
    double x[3], y[3], stops = exp2(o->exposure);
    for (int c = 0; c < 3; c++) {
        double off = (double)a[c] - (double)b[c];
        to->count += 1;
        to->truth += (double)b[c];
        to->squares += off * off;
        x[c] = (double)a[c] * stops;
        y[c] = (double)b[c] * stops;
    }
    view_tone(o->scene, x, x);
    view_tone(o->scene, y, y);
    for (int c = 0; c < 3; c++)
        to->screen += 255.0 * 255 * (x[c] - y[c]) * (x[c] - y[c]);
}

static void finish(const sums *of, int count, view_error *e, double *mean)
{
    sums all = {0};
    e->ball_count = count;
    for (int i = 0; i < count; i++) {
        all.count += of[i].count;
        all.truth += of[i].truth;
        all.squares += of[i].squares;
        all.screen += of[i].screen;
        if (of[i].count > 0 && of[i].truth > 0) {
            e->ball[i] = sqrt(of[i].squares * of[i].count) / of[i].truth;
            e->ball_screen[i] = sqrt(of[i].screen / of[i].count);
        }
    }
    *mean = all.truth > 0 ? all.truth / all.count : 1;
    e->rms = all.count > 0 ? sqrt(all.squares / all.count) / *mean : 0;
    e->screen = all.count > 0 ? sqrt(all.screen / all.count) : 0;
}

// Returns the index of the ball that is seen at the centre of pixel `i` of a picture, or -1 if no
// ball is seen there.
static int ball_of(const view_options *o, const view_ball *balls, int count,
                   const kiln_image *image, int i)
{
    int width = image->width, height = image->height, x = i % width, y = i / width;
    double slope = tan(o->camera.fov / 2 * 0.017453292519943295);
    return ball_at(balls, count, &o->camera, (2 * (x + 0.5) / width - 1) * slope * width / height,
                   (1 - 2 * (y + 0.5) / height) * slope);
}

view_error view_noise(const view_options *o, const kiln_image *truth, const kiln_image *deviation)
{
    view_ball balls[VIEW_MAX_BALLS];
    int count = view_balls(o, balls);
    sums of[VIEW_MAX_BALLS] = {{.count = 0}};
    view_error e = {.rms = 0};
    double mean;
    for (int i = 0; i < truth->width * truth->height; i++) {
        int ball = ball_of(o, balls, count, truth, i);
        float low[3], high[3];
        for (size_t c = 0; c < 3; c++) {
            // the difference between these two on the screen is the noise there
            low[c] = truth->pixels[3 * (size_t)i + c] - 0.5F * deviation->pixels[3 * (size_t)i + c];
            high[c] = low[c] + deviation->pixels[3 * (size_t)i + c];
        }
        if (ball >= 0)
            add(o, high, low, &of[ball]);
    }
    finish(of, count, &e, &mean);
    return e;
}

view_error view_compare(const view_options *o, kiln_image *image, const kiln_image *truth,
                        bool colours)
{
    int width = image->width, height = image->height;
    view_ball balls[VIEW_MAX_BALLS];
    int count = view_balls(o, balls);
    double mean;
    sums of[VIEW_MAX_BALLS] = {{.count = 0}};
    view_error e = {.rms = 0};
    for (int i = 0; i < width * height; i++) {
        float *a = image->pixels + 3 * (size_t)i;
        const float *b = truth->pixels + 3 * (size_t)i;
        int ball = ball_of(o, balls, count, image, i);
        if (ball >= 0)
            add(o, a, b, &of[ball]);
        for (int c = 0; c < 3; c++) {
            a[c] = ball >= 0 ? a[c] - b[c] : 0;
            e.largest = fmax(e.largest, fabs((double)a[c]));
        }
    }
    finish(of, count, &e, &mean);
    e.largest /= mean;
    for (int i = 0; i < width * height; i++) {
        float *a = image->pixels + 3 * (size_t)i;
        for (int c = 0; c < 3; c++)
            a[c] = (float)((double)a[c] / mean);
        if (colours)
            colour(a);
    }
    return e;
}
