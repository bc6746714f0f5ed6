// The geometry and the materials of each scene, as numbers for the renderer and the reference. In:
// view_options. Out: the list of balls, the camera's axes, the tone curve, and the names of scenes,
// methods, materials and debug views.
#include "internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double degree = 0.017453292519943295, pi = 3.14159265358979323846;

// ------------------------------------------------------------------------------------------- names

static const char *const scene_names[] = {"assignment", "ibl", "furnace", "grid", "compare"};
static const char *const method_names[] = {"single", "kulla-conty", "handout", "fdez-aguera",
                                           "turquin"};
static const char *const material_names[] = {"gold",     "copper", "aluminium", "silver",  "iron",
                                             "titanium", "white",  "handout",   "plastic", "chalk"};
static const char *const debug_names[] = {"none",        "level", "table-e", "table-e-average",
                                          "table-split", "e",     "f"};
static const char *const reflections_names[] = {"straight", "bent", "one", "two", "three"};

const char *view_scene_name(int scene)
{
    return scene >= 0 && scene < VIEW_SCENE_COUNT ? scene_names[scene] : NULL;
}

const char *view_method_name(int method)
{
    return method >= 0 && method < VIEW_METHOD_COUNT ? method_names[method] : NULL;
}

const char *view_material_name(int material)
{
    return material >= 0 && material < VIEW_MATERIAL_COUNT ? material_names[material] : NULL;
}

const char *view_debug_name(int debug)
{
    return debug >= 0 && debug < VIEW_DEBUG_COUNT ? debug_names[debug] : NULL;
}

const char *view_reflections_name(int reflections)
{
    return reflections >= 0 && reflections < VIEW_REFLECTIONS_COUNT ? reflections_names[reflections]
                                                                    : NULL;
}

void view_describe(kiln_error *error, kiln_result result, const char *format, ...)
{
    if (!error)
        return;
    error->result = result;
    va_list list;
    va_start(list, format);
    vsnprintf(error->message, sizeof error->message, format, list);
    va_end(list);
}

// ------------------------------------------------------------------------------------------ camera

// Vertical field of view in degrees of the scenes other than the assignment's. A long lens shows all
// balls as circles, each seen from nearly the same direction: the outer balls are 1.04 times as long
// as wide, and would be so 1.13 times with a field of view of 45 degrees.
enum { LENS = 24 };

view_options view_defaults(view_scene scene)
{
    view_options o = {
        .scene = scene,
        .method = VIEW_METHOD_KULLA_CONTY,
        .material = VIEW_MATERIAL_GOLD,
        .camera = {.target = {20, 0, 0}, .elevation = 8, .distance = 640, .fov = LENS},
        .split = 0.5,
        .samples = 4,
        .reflections = VIEW_REFLECTIONS_BENT,
    };
    if (scene == VIEW_SCENE_ASSIGNMENT) {
        // The GAMES202 assignment's camera stands at (0, 80, 300) and looks at the origin.
        o.camera = (view_camera){.elevation = atan2(80, 300) / degree,
                                 .distance = sqrt(80.0 * 80 + 300.0 * 300),
                                 .fov = 75};
        o.method = VIEW_METHOD_KULLA_CONTY_HANDOUT;
        o.material = VIEW_MATERIAL_HANDOUT;
    } else if (scene == VIEW_SCENE_FURNACE) {
        o.material = VIEW_MATERIAL_WHITE;
    } else if (scene == VIEW_SCENE_GRID) {
        o.camera = (view_camera){.elevation = 0, .distance = 1170, .fov = LENS};
    }
    return o;
}

void view_camera_axes(const view_camera *c, double eye[3], double right[3], double up[3],
                      double back[3])
{
    double sin_a = sin(c->azimuth * degree), cos_a = cos(c->azimuth * degree);
    double sin_e = sin(c->elevation * degree), cos_e = cos(c->elevation * degree);
    // `back` points from the target to the eye. `right` is horizontal.
    back[0] = cos_e * sin_a;
    back[1] = sin_e;
    back[2] = cos_e * cos_a;
    right[0] = cos_a;
    right[1] = 0;
    right[2] = -sin_a;
    up[0] = -sin_e * sin_a;
    up[1] = cos_e;
    up[2] = -sin_e * cos_a;
    for (int i = 0; i < 3; i++)
        eye[i] = c->target[i] + c->distance * back[i];
}

// ------------------------------------------------------------------------------------------- balls

typedef struct substance {
    double f0[3], albedo[3];
} substance;

// Constants of the materials without measured indices; metals.c has the measured metals.
static const substance substances[VIEW_MATERIAL_COUNT] = {
    [VIEW_MATERIAL_WHITE] = {.f0 = {1, 1, 1}},
    [VIEW_MATERIAL_PLASTIC] = {.f0 = {0.04, 0.04, 0.04}, .albedo = {0.6, 0.05, 0.04}},
    [VIEW_MATERIAL_CHALK] = {.f0 = {0.04, 0.04, 0.04}, .albedo = {0.9, 0.9, 0.9}},
};

// The GAMES202 assignment's copper: its reflectivity before decoding by the power 2.2, and its edge
// tint.
const double view_handout_albedo[3] = {0.7216, 0.451, 0.2};
static const double handout_edge[3] = {0.827, 0.792, 0.678};

static const double edge = 1.0 / 7; // cosine of the angle that F82 belongs to

static void set_substance(view_ball *ball, view_material material)
{
    ball->metallic = material != VIEW_MATERIAL_PLASTIC && material != VIEW_MATERIAL_CHALK;
    ball->measured = material < VIEW_METAL_COUNT;
    if (ball->measured) {
        view_metal_fresnel(material, 1, ball->f0);
        view_metal_fresnel(material, edge, ball->f82);
        view_metal_average(material, ball->f_average);
        return;
    }
    for (int c = 0; c < 3; c++) {
        if (material == VIEW_MATERIAL_HANDOUT) {
            ball->f0[c] = pow(view_handout_albedo[c], 2.2);
            ball->f_average[c] = kiln_fresnel_conductor_average_fit(ball->f0[c], handout_edge[c]);
        } else {
            ball->f0[c] = substances[material].f0[c];
            ball->f_average[c] = (1 + 20 * ball->f0[c]) / 21;
        }
        ball->f82[c] = kiln_fresnel_schlick(ball->f0[c], edge);
        ball->albedo[c] = substances[material].albedo[c];
    }
}

// A ball at the origin with the material and the radius of all balls.
static view_ball make_ball(view_material material)
{
    view_ball ball = {.radius = 36};
    set_substance(&ball, material);
    return ball;
}

// Two rows of five balls: o->method in the upper row, one bounce in the lower row.
static int make_rows(const view_options *o, view_material material, view_ball *balls)
{
    enum { COLUMNS = 5 };
    int count = 0;
    const view_ball same = make_ball(material);
    for (int i = o->one_row ? COLUMNS : 0; i < 2 * COLUMNS; i++) {
        int column = i % COLUMNS;
        view_ball *ball = &balls[count++];
        *ball = same;
        ball->centre[0] = 180 - 80.0 * column;
        ball->centre[1] = i < COLUMNS ? 60 : -60;
        ball->roughness = 0.15 + 0.2 * column;
        ball->method = i < COLUMNS ? o->method : VIEW_METHOD_SINGLE;
    }
    return count;
}

// A grid of balls: roughness grows from 0 to 1 to the right, metallic from 0 to 1 upwards. F0 and
// the diffuse albedo are interpolated between a dielectric's and the metal's. A metal's colour is
// its F0.
static int make_grid(const view_options *o, view_ball *balls)
{
    enum { COLUMNS = 7, ROWS = 5 };
    const view_ball same = make_ball(o->material);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        int column = i % COLUMNS, row = i / COLUMNS;
        view_ball *ball = &balls[i];
        *ball = same;
        ball->centre[0] = 80.0 * column - 240;
        ball->centre[1] = 80.0 * row - 160;
        ball->roughness = column / (COLUMNS - 1.0);
        ball->method = o->method;
        bool metal = ball->metallic > 0;
        double m = ball->metallic = row / (ROWS - 1.0);
        for (int c = 0; c < 3; c++) {
            double colour = metal ? ball->f0[c] : ball->albedo[c];
            double f82 = metal ? same.f82[c] : kiln_fresnel_schlick(colour, edge);
            double average = metal ? same.f_average[c] : kiln_fresnel_schlick_average(colour);
            ball->f0[c] = 0.04 * (1 - m) + colour * m;
            ball->f82[c] = kiln_fresnel_schlick(0.04, edge) * (1 - m) + f82 * m;
            ball->f_average[c] = kiln_fresnel_schlick_average(0.04) * (1 - m) + average * m;
            ball->albedo[c] = colour * (1 - m);
        }
    }
    return COLUMNS * ROWS;
}

int view_balls(const view_options *o, view_ball balls[VIEW_MAX_BALLS])
{
    switch (o->scene) {
    case VIEW_SCENE_ASSIGNMENT:
        return make_rows(o, VIEW_MATERIAL_HANDOUT, balls);
    case VIEW_SCENE_FURNACE:
        return make_rows(o, VIEW_MATERIAL_WHITE, balls);
    case VIEW_SCENE_GRID:
        return make_grid(o, balls);
    case VIEW_SCENE_IBL:
    case VIEW_SCENE_COMPARE:
    case VIEW_SCENE_COUNT:
        break;
    }
    return make_rows(o, o->material, balls);
}

// ---------------------------------------------------------------------------------- ground, lights

static bool has_environment(const view_options *o)
{
    return o->scene != VIEW_SCENE_ASSIGNMENT && o->scene != VIEW_SCENE_FURNACE;
}

bool view_ground(const view_options *o, view_plane *ground)
{
    view_ball balls[VIEW_MAX_BALLS];
    int count = view_balls(o, balls);
    *ground = (view_plane){.albedo = 0.5};
    for (int i = 0; i < count; i++)
        ground->height = fmin(ground->height, balls[i].centre[1] - balls[i].radius);
    return o->ground && has_environment(o);
}

int view_discs(const view_options *o, const kiln_lights *lights, view_disc discs[KILN_MAX_LIGHTS])
{
    double c = cos(o->rotation * degree), s = sin(o->rotation * degree);
    int count = lights && has_environment(o) ? lights->count : 0;
    for (int i = 0; i < count; i++) {
        const kiln_light *light = &lights->light[i];
        double radius = fmax(0.01, fmin(light->angular_radius, 60)) * degree;
        view_disc *disc = &discs[i];
        *disc = (view_disc){.sine = sin(radius), .cosine = cos(radius)};
        disc->direction[0] = light->direction[0] * c + light->direction[2] * s;
        disc->direction[1] = light->direction[1];
        disc->direction[2] = light->direction[2] * c - light->direction[0] * s;
        for (int k = 0; k < 3; k++)
            disc->radiance[k] = light->irradiance[k] / (pi * disc->sine * disc->sine);
    }
    return count;
}

// -------------------------------------------------------------------------------------------- tone

static double tone_bend(double c, double peak)
{
    double less = (peak - 0.8) * (peak - 0.8) / (peak - 0.6);
    double bent = peak - less, white = 0.15 * less / (0.15 * less + 1);
    return c * bent / peak * (1 - white) + bent * white;
}

void view_tone(view_scene scene, const double radiance[3], double shown[3])
{
    double peak = fmax(radiance[0], fmax(radiance[1], radiance[2]));
    for (int i = 0; i < 3; i++) {
        double c = radiance[i];
        if (scene == VIEW_SCENE_ASSIGNMENT) {
            shown[i] = pow(c / (c + 1), 1 / 2.2);
        } else {
            c = peak > 0.8 ? tone_bend(c, peak) : c;
            shown[i] = c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055;
        }
    }
}
