// Every function of shaders/*.glsl against its C twin: random arguments in a float texture, results
// rendered into another, to 1e-5 relative.
#include "kit/kit.h"

#include "gl.h"
#include "headless.h"
#include "internal.h"

#include "brdf/brdf.h"

extern const char test_all_glsl[];

enum { COUNT = 2048, ARGUMENTS = 8 };

static view_headless *headless;
static view_gl gl;
static int table_unit; // of `table`, beside the arguments

static uint64_t seed = 1;

// ------------------------------------------------------------------------------------------ render

static int start(void **unused)
{
    (void)unused;
    kiln_error error;
    const char *missing = NULL;
    if (view_headless_create(&headless, &error) != KILN_OK) {
        fprintf(stderr, "%s\n", error.message);
        return -1;
    }
    return view_gl_load(&gl, view_headless_lookup, &missing) ? 0 : -1;
}

static int stop(void **unused)
{
    (void)unused;
    view_headless_destroy(headless);
    return 0;
}

// Evaluates `expression`, a vec3 of float x[8], for every row of arguments.
static void render(const char *expression, const float (*x)[ARGUMENTS], float (*result)[4])
{
    static char text[65536];
    kiln_error error = {0};
    GLuint program, texture = 0, frame = 0, target = 0, vertices = 0;
    int length =
        snprintf(text, sizeof text,
                 "%s\nuniform sampler2D arguments, table;\nout vec4 result;\nvoid main()\n{\n"
                 "float x[8];\nivec2 at = ivec2(gl_FragCoord.xy);\n"
                 "vec4 a = texelFetch(arguments, ivec2(0, at.x), 0);\n"
                 "vec4 b = texelFetch(arguments, ivec2(1, at.x), 0);\n"
                 "for (int i = 0; i < 4; i++) { x[i] = a[i]; x[i + 4] = b[i]; }\n"
                 "vec3 r;\n%s\nresult = vec4(r, 1.0);\n}\n",
                 test_all_glsl, expression);
    assert_true(length > 0 && (size_t)length < sizeof text);
    CHECK_OK(view_link(&gl, text, &program, &error));
    kiln_image image = {.width = 2, .height = COUNT, .channels = 4};
    image.pixels = (float *)x;
    view_upload_image(&gl, 0, &texture, &image);
    gl.GenRenderbuffers(1, &target);
    gl.BindRenderbuffer(GL_RENDERBUFFER, target);
    gl.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, COUNT, 1);
    gl.GenFramebuffers(1, &frame);
    gl.BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
    assert_int_equal(gl.CheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    gl.Viewport(0, 0, COUNT, 1);
    gl.GenVertexArrays(1, &vertices);
    gl.BindVertexArray(vertices);
    gl.UseProgram(program);
    gl.Uniform1i(gl.GetUniformLocation(program, "table"), table_unit);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.ReadPixels(0, 0, COUNT, 1, GL_RGBA, GL_FLOAT, result);
    assert_int_equal(gl.GetError(), GL_NO_ERROR);
    gl.DeleteVertexArrays(1, &vertices);
    gl.DeleteFramebuffers(1, &frame);
    gl.DeleteRenderbuffers(1, &target);
    gl.DeleteTextures(1, &texture);
    gl.DeleteProgram(program);
}

// ----------------------------------------------------------------------------------------- compare

typedef void twin(const double x[ARGUMENTS], double r[3]);

typedef struct function {
    const char *name, *expression;
    twin *twin;
    double low[ARGUMENTS], high[ARGUMENTS]; ///< of the arguments
} function;

// Random arguments, with the ends of their ranges now and then.
static void draw_arguments(const function *f, float x[ARGUMENTS])
{
    for (int i = 0; i < ARGUMENTS; i++) {
        double u = random_number(&seed), end = random_number(&seed);
        u = end < 0.02 ? 0 : end > 0.98 ? 1 : u;
        x[i] = (float)(f->low[i] + (f->high[i] - f->low[i]) * u);
    }
}

static void compare(const function *f)
{
    static float x[COUNT][ARGUMENTS], result[COUNT][4];
    double worst = 0;
    for (int i = 0; i < COUNT; i++)
        draw_arguments(f, x[i]);
    render(f->expression, (const float(*)[ARGUMENTS])x, result);
    for (int i = 0; i < COUNT; i++) {
        double arguments[ARGUMENTS], wanted[3] = {0};
        for (int k = 0; k < ARGUMENTS; k++)
            arguments[k] = (double)x[i][k];
        f->twin(arguments, wanted);
        for (int c = 0; c < 3; c++) {
            double got = (double)result[i][c], off = fabs(got - wanted[c]);
            if (!(off <= 1e-5 * fabs(wanted[c])))
                fail_msg("%s(%g, %g, %g, %g, %g, %g, %g, %g)[%d] is %.9g, C has %.9g (%.2g)",
                         f->name, arguments[0], arguments[1], arguments[2], arguments[3],
                         arguments[4], arguments[5], arguments[6], arguments[7], c, got, wanted[c],
                         off / fabs(wanted[c]));
            if (wanted[c] != 0)
                worst = fmax(worst, off / fabs(wanted[c]));
        }
    }
    print_message("%-32s %.1e\n", f->name, worst);
}

// ------------------------------------------------------------------------------------------- twins

static void c_ggx_d(const double x[ARGUMENTS], double r[3])
{
    r[0] = ki_ggx_d(x[0], x[1]);
}

static void c_smith_g1_schlick(const double x[ARGUMENTS], double r[3])
{
    r[0] = ki_smith_g1_schlick(x[0], x[1]);
    r[1] = ki_smith_g_schlick(x[0], x[1], x[2]);
}

static void c_schlick_k(const double x[ARGUMENTS], double r[3])
{
    r[0] = ki_schlick_k_ibl(x[0]);
    r[1] = ki_schlick_k_direct(x[0]);
}

static void c_smith_g1_over_cosine(const double x[ARGUMENTS], double r[3])
{
    r[0] = ki_smith_g1_over_cosine(x[0], x[1]);
}

static void c_visibility(const double x[ARGUMENTS], double r[3])
{
    kiln_model model = {.g = (kiln_g)(int)x[3]};
    r[0] = ki_visibility(&model, x[0], x[1], x[2]);
}

static void c_schlick_fresnel(const double x[ARGUMENTS], double r[3])
{
    r[0] = ki_schlick_fresnel(x[0]);
}

static void c_f82_edge(const double x[ARGUMENTS], double r[3])
{
    for (int c = 0; c < 3; c++)
        r[c] = 10 + ki_f82_edge(x[c], x[3 + c]);
}

static void c_fresnel_f82(const double x[ARGUMENTS], double r[3])
{
    for (int c = 0; c < 3; c++)
        r[c] = kiln_fresnel_f82(x[c], x[3 + c], x[6]);
}

static void c_fresnel_dielectric(const double x[ARGUMENTS], double r[3])
{
    r[0] = ki_fresnel_dielectric(x[0], x[1]);
}

static void c_fresnel_conductor_average_fit(const double x[ARGUMENTS], double r[3])
{
    for (int c = 0; c < 3; c++)
        r[c] = kiln_fresnel_conductor_average_fit(x[c], x[3 + c]);
}

static void c_kulla_conty(const double x[ARGUMENTS], double r[3])
{
    r[0] = kiln_kulla_conty(x[0], x[1], x[2]);
    r[1] = kiln_kulla_conty(1 - x[0], 1 - x[1], 1 - x[2]);
}

static void c_kulla_conty_fresnel(const double x[ARGUMENTS], double r[3])
{
    for (int c = 0; c < 3; c++)
        r[c] = kiln_kulla_conty_fresnel((kiln_f_add)(int)x[6], x[c], x[3 + c]);
}

static void c_turquin(const double x[ARGUMENTS], double r[3])
{
    for (int c = 0; c < 3; c++)
        r[c] = kiln_turquin(x[c], x[3]);
}

static void c_fdez_aguera_single(const double x[ARGUMENTS], double r[3])
{
    double multiple;
    for (int c = 0; c < 3; c++)
        kiln_fdez_aguera(x[c], x[3], x[4], &r[c], &multiple);
}

static void c_fdez_aguera_multiple(const double x[ARGUMENTS], double r[3])
{
    double single;
    for (int c = 0; c < 3; c++)
        kiln_fdez_aguera(x[c], x[3], x[4], &single, &r[c]);
}

static void c_table_axis(const double x[ARGUMENTS], double r[3])
{
    double k = ki_schlick_k_direct(x[1]), alpha = x[1] * x[1], c[2] = {alpha, k / (1 - k)};
    int axis = (int)x[2];
    r[0] = axis == 0 ? x[0] : axis == 1 ? sqrt(x[0]) : axis == 2 ? cbrt(x[0]) : 0;
    if (axis > 2 && x[0] > 0)
        r[0] = sqrt(x[0] * (1 + c[axis - 3]) / (x[0] + c[axis - 3]));
}

static void c_environment_level(const double x[ARGUMENTS], double r[3])
{
    // Levels of roughness 0, x1, x1 + x2, ..., 1: linear between them.
    double rise[5] = {0, x[1], x[1] + x[2], x[1] + x[2] + x[3], 1};
    for (int i = 1; i < 5; i++)
        if (x[0] >= rise[i - 1])
            r[0] = i - 1 + fmin((x[0] - rise[i - 1]) / (rise[i] - rise[i - 1]), 1);
    r[0] += 1; // away from 0, where there is no relative error
}

// The form factor of a ball wholly above the horizon: cos theta sin^2 of its half angle.
static void c_ball_occlusion(const double x[ARGUMENTS], double r[3])
{
    double d = 1 + x[1], sine = x[2] / d;
    r[0] = 1 - x[0] * sine * sine;
}

static void c_specular_occlusion(const double x[ARGUMENTS], double r[3])
{
    double alpha = x[2] * x[2];
    r[0] = 1 + fmin(fmax(pow(x[0] + x[1], exp2(-16 * alpha - 1)) - 1 + x[1], 0), 1);
}

static void c_bent_reflection(const double x[ARGUMENTS], double r[3])
{
    double alpha = x[6] * x[6], t = (1 - alpha) * (sqrt(1 - alpha) + alpha);
    for (int c = 0; c < 3; c++)
        r[c] = x[c] * (1 - t) + x[3 + c] * t;
}

// Sets n, t and v of a surface seen at the cosine nov, from the angles of n and t.
static void frame(const double angles[2], double nov, double n[3], double t[3], double v[3])
{
    double a = angles[0], b = angles[1], sine = sqrt(1 - nov * nov);
    n[0] = sin(a), n[1] = 0, n[2] = cos(a);
    t[0] = cos(b) * cos(a), t[1] = sin(b), t[2] = -cos(b) * sin(a);
    for (int c = 0; c < 3; c++)
        v[c] = nov * n[c] - sine * t[c];
}
#define FRAME(a, b)                                                                                \
    "vec3 n = vec3(sin(" a "), 0.0, cos(" a "));\n"                                                \
    "vec3 t = vec3(cos(" b ") * cos(" a "), sin(" b "), -cos(" b ") * sin(" a "));\n"

static void c_lobe_tangent(const double x[ARGUMENTS], double r[3])
{
    double n[3], t[3], v[3];
    frame(x, x[2], n, t, v);
    for (int c = 0; c < 3; c++)
        r[c] = 2 + t[c];
}

// The direction at the angle acos(n.v) - lean from n in the plane of n and t.
static void c_lobe_direction(const double x[ARGUMENTS], double r[3])
{
    double n[3], t[3], v[3], angle = acos(x[2]) - x[3];
    frame(x, x[2], n, t, v);
    for (int c = 0; c < 3; c++)
        r[c] = 2 + cos(angle) * n[c] + sin(angle) * t[c];
}

static void c_lobes_sum(const double x[ARGUMENTS], double r[3])
{
    double weights = fmin(fmax(1 - x[7], 0), 1);
    for (int c = 0; c < 3; c++)
        r[c] = fmax(x[c] + x[3 + c], 0.6 * weights * x[6]);
}

static void c_tone_assignment(const double x[ARGUMENTS], double r[3])
{
    view_tone(VIEW_SCENE_ASSIGNMENT, x, r);
}

static void c_tone_neutral(const double x[ARGUMENTS], double r[3])
{
    view_tone(VIEW_SCENE_IBL, x, r);
}

static void c_arc_cosine(const double x[ARGUMENTS], double r[3])
{
    r[0] = acos(x[0]);
    r[1] = acos(x[1]) - x[1] * sqrt(1 - x[1] * x[1]);
    r[2] = (acos(-x[2]) + x[2] * sqrt(1 - x[2] * x[2])) / pi;
}

static void c_disc_cosine(const double x[ARGUMENTS], double r[3])
{
    double u = fmin(x[0], 1), root = sqrt(1 - u * u);
    r[0] = x[0] >= 1 ? x[0] * x[1] : x[1] * (u * acos(-u) + root * (2 + u * u) / 3) / pi;
}

// (sin, cos) of an angle from the tangent of its half, which GLSL and C compute alike.
#define AT(k) "vec2(2.0 * " k ", (1.0 - " k ") * (1.0 + " k ")) / (1.0 + " k " * " k ")"

static void at_half(double k, double to[2])
{
    to[0] = 2 * k / (1 + k * k);
    to[1] = (1 - k) * (1 + k) / (1 + k * k);
}

// The integral of (x dy - y dx) / (alpha^2 + x^2 + y^2) along the border of a disc of light,
// divided by 2 pi, which ggx_disc of shaders/disc.glsl computes. Here the slopes x, y of the half
// vectors are taken relative to 0, in double precision; the shader takes them relative to the slope
// of the disc's centre, which floats need.
static double border_integral(double alpha, const double v[3], const double l[3], double sine)
{
    enum { NODES = 48 };
    double side = l[2] < 0 ? -1 : 1, a = -1 / (side + l[2]), sum = 0;
    const double t[3] = {1 + side * l[0] * l[0] * a, side * l[0] * l[1] * a, -side * l[0]};
    const double b[3] = {l[0] * l[1] * a, side + l[1] * l[1] * a, -l[1]};
    for (int i = 0; i < NODES; i++) {
        double phi = 2 * pi * i / NODES, h[3], d[3];
        for (int c = 0; c < 3; c++) {
            h[c] = v[c] + sqrt(1 - sine * sine) * l[c] + sine * (cos(phi) * t[c] + sin(phi) * b[c]);
            d[c] = sine * (cos(phi) * b[c] - sin(phi) * t[c]);
        }
        double x = h[0] / h[2], y = h[1] / h[2];
        double dx = (d[0] - x * d[2]) / h[2], dy = (d[1] - y * d[2]) / h[2];
        sum += (x * dy - y * dx) / (alpha * alpha + x * x + y * y);
    }
    return fabs(sum) / NODES;
}

// alpha; the half angles of v, l and the azimuth between the two; the disc's sine.
static void vectors(const double x[ARGUMENTS], double v[3], double l[3])
{
    double to_v[2], to_l[2], around[2];
    at_half(x[1], to_v);
    at_half(x[2], to_l);
    at_half(x[3], around);
    v[0] = to_v[0], v[1] = 0, v[2] = to_v[1];
    l[0] = to_l[0] * around[1], l[1] = to_l[0] * around[0], l[2] = to_l[1];
}
#define VECTORS                                                                                    \
    "vec2 p = " AT("x[1]") ", q = " AT("x[2]") ", s = " AT(                                        \
        "x[3]") ";\n"                                                                              \
                "vec3 v = vec3(p.x, 0.0, p.y), l = vec3(q.x * s.y, q.x * s.x, q.y);\n"

static void c_ggx_disc(const double x[ARGUMENTS], double r[3])
{
    double v[3], l[3];
    vectors(x, v, l);
    r[0] = border_integral(x[0], v, l, x[4]);
}

// The area that two circles share, by the angles that the chord has at both centres.
static void c_disc_hidden(const double x[ARGUMENTS], double r[3])
{
    double angle = 2 * atan(x[0]), ball = asin(x[2]), a = tan(asin(x[1]) / 2);
    double near = tan((angle - ball) / 2), far = tan((angle + ball) / 2);
    double middle = (near + far) / 2, b = (far - near) / 2, c = fabs(middle), area = 0;
    if (c <= fabs(a - b)) {
        area = pi * fmin(a, b) * fmin(a, b);
    } else if (c < a + b) {
        double p = acos((c * c + a * a - b * b) / (2 * c * a));
        double q = acos((c * c + b * b - a * a) / (2 * c * b));
        area = a * a * (p - sin(2 * p) / 2) + b * b * (q - sin(2 * q) / 2);
    }
    r[0] = 1 + area / (pi * a * a);
}

#define TO_1 1, 1, 1, 1, 1, 1, 1, 1
static const function functions[] = {
    {"ggx_d", "r = vec3(ggx_d(x[0], x[1]), 0.0, 0.0);", c_ggx_d, {1e-4}, {TO_1}},
    {"smith_g1_schlick, smith_g_schlick",
     "r = vec3(smith_g1_schlick(x[0], x[1]), smith_g_schlick(x[0], x[1], x[2]), 0.0);",
     c_smith_g1_schlick,
     {1e-6},
     {TO_1}},
    {"schlick_k_ibl, schlick_k_direct",
     "r = vec3(schlick_k_ibl(x[0]), schlick_k_direct(x[0]), 0.0);",
     c_schlick_k,
     {0},
     {TO_1}},
    {"smith_g1_over_cosine",
     "r = vec3(smith_g1_over_cosine(x[0], x[1]), 0.0, 0.0);",
     c_smith_g1_over_cosine,
     {1e-4},
     {TO_1}},
    {"visibility",
     "r = vec3(visibility(int(x[3]), x[0], x[1], x[2]), 0.0, 0.0);",
     c_visibility,
     {0.01, 1e-4},
     {1, 1, 1, 3.99}},
    {"schlick_fresnel",
     "r = vec3(schlick_fresnel(x[0]), 0.0, 0.0);",
     c_schlick_fresnel,
     {0},
     {TO_1}},
    {"f82_edge", // away from 0, where there is no relative error
     "r = 10.0 + f82_edge(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));",
     c_f82_edge,
     {0},
     {TO_1}},
    {"fresnel_f82", // likewise
     "r = fresnel_f82(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]), x[6]);",
     c_fresnel_f82,
     {0.2, 0.2, 0.2, 0.4, 0.4, 0.4},
     {TO_1}},
    {"fresnel_dielectric",
     "r = vec3(fresnel_dielectric(x[0], x[1]), 0.0, 0.0);",
     c_fresnel_dielectric,
     {1.05, 0},
     {3, 1}},
    {"fresnel_conductor_average_fit",
     "r = fresnel_conductor_average_fit(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));",
     c_fresnel_conductor_average_fit,
     {0},
     {TO_1}},
    {"kulla_conty, kulla_conty_missing",
     "r = vec3(kulla_conty(x[0], x[1], x[2]), kulla_conty_missing(x[0], x[1], x[2]), 0.0);",
     c_kulla_conty,
     {0, 0, 0.01},
     {1, 1, 0.99}},
    {"kulla_conty_fresnel",
     "r = kulla_conty_fresnel(int(x[6]), vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));",
     c_kulla_conty_fresnel,
     {0, 0, 0, 0.3, 0.3, 0.3},
     {1, 1, 1, 1, 1, 1, 1.99}},
    {"turquin", "r = turquin(vec3(x[0], x[1], x[2]), x[3]);", c_turquin, {0, 0, 0, 0.1}, {TO_1}},
    {"fdez_aguera, single",
     "vec3 m;\nfdez_aguera(vec3(x[0], x[1], x[2]), x[3], x[4], r, m);",
     c_fdez_aguera_single,
     {0, 0, 0, 0.1},
     {1, 1, 1, 0.5, 0.4}},
    {"fdez_aguera, multiple",
     "vec3 s;\nfdez_aguera(vec3(x[0], x[1], x[2]), x[3], x[4], s, r);",
     c_fdez_aguera_multiple,
     {0, 0, 0, 0.1},
     {1, 1, 1, 0.5, 0.4}},
    {"table_axis",
     "r = vec3(table_axis(int(x[2]), x[0], x[1]), 0.0, 0.0);",
     c_table_axis,
     {0, 0, 0},
     {1, 0.99, 4.99}},
    {"environment_level",
     "vec4 of_level[4];\nof_level[0] = vec4(0.0, x[1], x[1] + x[2], x[1] + x[2] + x[3]);\n"
     "of_level[1] = vec4(1.0);\nr = vec3(1.0 + environment_level(of_level, 5, x[0]), 0.0, 0.0);",
     c_environment_level,
     {0, 0.1, 0.1, 0.1},
     {1, 0.3, 0.3, 0.3}},
    {"ball_occlusion",
     "float s = sqrt(1.0 - x[0] * x[0]);\n"
     "r = vec3(ball_occlusion(vec3(0, 0, 1), (1.0 + x[1]) * vec3(s, 0.0, x[0]), x[2]), 0.0, 0.0);",
     c_ball_occlusion,
     {0, 0, 0},
     {1, 10, 0.9}},
    {"specular_occlusion",
     "r = vec3(1.0 + specular_occlusion(x[0], x[1], x[2]), 0.0, 0.0);",
     c_specular_occlusion,
     {0.01, 0.01},
     {TO_1}},
    {"bent_reflection",
     "r = bent_reflection(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]), x[6]);",
     c_bent_reflection,
     {0.1, 0.1, 0.1, 0.1, 0.1, 0.1},
     {1, 1, 1, 1, 1, 1, 0.99}},
    {"arc_cosine, circle_segment, disc_part",
     "r = vec3(arc_cosine(x[0]), circle_segment(x[1], sqrt((1.0 - x[1]) * (1.0 + x[1]))), "
     "disc_part(x[2]));",
     c_arc_cosine,
     {0, 0, -0.999},
     {1, 0.999, 1}},
    {"disc_cosine",
     "r = vec3(disc_cosine(x[0] * x[1], x[1]), 0.0, 0.0);",
     c_disc_cosine,
     {-0.5, 0.001},
     {3, 0.5}},
    {"ggx_disc", // near the peak, since floats cancel in the lobe's tail, as (slope / alpha)^2
     VECTORS "r = vec3(ggx_disc(x[0], v, l, x[4]), 0.0, 0.0);",
     c_ggx_disc,
     {0.25, 0, 0, -1, 0.002},
     {1, 0.5, 0.5, 1, 0.15}},
    {"disc_hidden", // of a ball at the distance 3
     "vec2 p = 3.0 * " AT("x[0]") ";\n"
                                  "r = vec3(1.0 + disc_hidden(vec3(0, 0, 1), x[1], vec3(p.x, 0.0, "
                                  "p.y), 3.0 * x[2]), 0.0, 0.0);",
     c_disc_hidden,
     {0, 0.05, 0.01},
     {0.6, 0.3, 0.9}},
    {"lobe_tangent", // away from 0, where there is no relative error
     FRAME("x[0]", "x[1]") "vec3 v = x[2] * n - sqrt((1.0 - x[2]) * (1.0 + x[2])) * t;\n"
                           "r = 2.0 + lobe_tangent(n, v, x[2]);",
     c_lobe_tangent,
     {-3, -3, 0},
     {3, 3, 0.99}},
    {"lobe_direction", // likewise
     FRAME("x[0]", "x[1]") "r = 2.0 + lobe_direction(n, t, x[2], x[3]);",
     c_lobe_direction,
     {-3, -3, 0, -1.5},
     {3, 3, 1, 1.5}},
    {"lobes_sum",
     "r = lobes_sum(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]), vec3(x[6]), x[7]);",
     c_lobes_sum,
     {0.5, 0.5, 0.5, -0.3, -0.3, -0.3, 0, -0.5},
     {1, 1, 1, 1, 1, 1, 2, 1.2}},
    {"tone_assignment",
     "r = tone_assignment(vec3(x[0], x[1], x[2]));",
     c_tone_assignment,
     {1e-4, 1e-4, 1e-4},
     {10, 10, 10}},
    {"tone_neutral, srgb_encode",
     "r = srgb_encode(tone_neutral(vec3(x[0], x[1], x[2])));",
     c_tone_neutral, // what white adds to a channel of 0 is all rounding near 0.8
     {0.02, 0.02, 0.02},
     {3, 3, 3}},
};

static void glsl_agrees_with_c(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        compare(&functions[i]);
}

// Draws nine coefficients of radiance, and writes the GLSL that declares them and then says `more`.
static void draw_harmonics(kiln_sh *sh, char expression[2048], const char *more)
{
    size_t used = (size_t)snprintf(expression, 2048, "vec3 c[9];\n");
    *sh = (kiln_sh){.bands = 3};
    for (int i = 0; i < 9; i++) {
        for (int k = 0; k < 3; k++)
            sh->c[i][k] = (double)(float)(random_number(&seed) - 0.5);
        used +=
            (size_t)snprintf(expression + used, 2048 - used, "c[%d] = vec3(%.9f, %.9f, %.9f);\n", i,
                             sh->c[i][0], sh->c[i][1], sh->c[i][2]);
    }
    assert_true(snprintf(expression + used, 2048 - used, "%s", more) < (int)(2048 - used));
}

// The series has no relative error where it crosses 0: against its largest value.
static void harmonics_agree_with_c(void **unused)
{
    (void)unused;
    static float x[COUNT][ARGUMENTS], result[COUNT][4];
    kiln_sh sh;
    char expression[2048];
    static const double lobe[] = {1, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
    draw_harmonics(&sh, expression, "r = sh_irradiance(c, vec3(x[0], x[1], x[2]));");
    sh.irradiance = true;
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++)
            sh.c[i][k] *= lobe[i];
    for (int i = 0; i < COUNT; i++) {
        double d[3];
        random_direction(&seed, d);
        for (int k = 0; k < 3; k++)
            x[i][k] = (float)d[k];
    }
    render(expression, (const float(*)[ARGUMENTS])x, result);
    for (int i = 0; i < COUNT; i++) {
        double direction[3] = {(double)x[i][0], (double)x[i][1], (double)x[i][2]}, value[3];
        kiln_sh_evaluate(&sh, direction, value);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)result[i][c], value[c], 1e-6);
    }
}

// One degree of the radiance from direction (a + s b) / k.
static double degree_at(const kiln_sh *sh, int degree, const double a[3], double s,
                        const double b[3], double k, int channel)
{
    kiln_sh part = {.bands = 3};
    double d[3], value[3];
    for (int i = degree * degree; i < (degree + 1) * (degree + 1); i++)
        memcpy(part.c[i], sh->c[i], sizeof part.c[i]);
    for (int c = 0; c < 3; c++)
        d[c] = (a[c] + s * b[c]) / k;
    kiln_sh_evaluate(&part, d, value);
    return value[channel];
}

// The six terms of lobes_rest, by values of the harmonics in directions: n'M t is half the
// difference of d'M d at (n + t) / sqrt(2) and (n - t) / sqrt(2).
static void the_rest_of_lobes_agrees_with_c(void **unused)
{
    (void)unused;
    static float x[COUNT][ARGUMENTS], result[COUNT][4];
    kiln_sh sh;
    char expression[2048];
    draw_harmonics(&sh, expression,
                   FRAME("x[6]", "x[7]") "float rest[6];\n"
                                         "for (int i = 0; i < 6; i++) rest[i] = x[i];\n"
                                         "r = lobes_rest(c, n, t, rest);");
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < ARGUMENTS; k++)
            x[i][k] = (float)((k < 6 ? 1 : 3) * (2 * random_number(&seed) - 1));
    render(expression, (const float(*)[ARGUMENTS])x, result);
    for (int i = 0; i < COUNT; i++) {
        double a[ARGUMENTS], n[3], t[3], v[3], root = sqrt(2);
        for (int k = 0; k < ARGUMENTS; k++)
            a[k] = (double)x[i][k];
        frame(a + 6, 1, n, t, v);
        const double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2],
                             n[0] * t[1] - n[1] * t[0]};
        for (int c = 0; c < 3; c++) {
            double mixed =
                degree_at(&sh, 2, n, 1, t, root, c) - degree_at(&sh, 2, n, -1, t, root, c);
            double across = degree_at(&sh, 2, t, 0, n, 1, c) - degree_at(&sh, 2, b, 0, n, 1, c);
            double wanted = a[0] * degree_at(&sh, 1, n, 0, t, 1, c) +
                            a[1] * degree_at(&sh, 1, t, 0, n, 1, c) +
                            a[2] * degree_at(&sh, 2, n, 0, t, 1, c) + a[3] * mixed / 2 +
                            a[4] * across + a[5] * degree_at(&sh, 0, n, 0, t, 1, c);
            CHECK_NEAR((double)result[i][c], wanted, 3e-6);
        }
    }
}

// lobes_at between texels of random numbers, against kiln_table_lookup.
static void check_lobes(int taps)
{
    static float x[COUNT][ARGUMENTS], result[COUNT][4];
    enum { SIZE = 16 };
    kiln_context *context = make_context(0);
    kiln_error error = {0};
    kiln_table table = {.def = {.kind = KILN_TABLE_LOBES, .tap_count = taps, .corners = taps % 2}};
    GLuint texture = 0;
    char expression[512];
    table.def.width = table.def.height = SIZE;
    table.def.depth = taps + 1;
    CHECK_OK(kiln_image_create(context, SIZE, SIZE * (taps + 1), 4, &table.image, &error));
    for (int i = 0; i < SIZE * SIZE * (taps + 1) * 4; i++)
        table.image.pixels[i] = (float)random_number(&seed);
    for (int i = 0; i < COUNT * ARGUMENTS; i++)
        x[i / ARGUMENTS][i % ARGUMENTS] = (float)random_number(&seed);
    view_upload_image(&gl, 1, &texture, &table.image);
    // x[2] chooses three of the numbers
    snprintf(expression, sizeof expression,
             "Lobes l = lobes_at(table, vec4(0.0, %d.0, 0.0, 0.0), %d, x[0], x[1]);\n"
             "int k = int(x[2] * %d.0);\n"
             "r = x[3] < 0.5 ? l.tap[k].xyz : x[3] < 0.8 ? vec3(l.rest[0], l.rest[1], l.rest[2])\n"
             "                              : vec3(l.rest[3], l.rest[4], l.rest[5]);",
             table.def.corners, taps, taps);
    table_unit = 1;
    render(expression, (const float(*)[ARGUMENTS])x, result);
    table_unit = 0;
    for (int i = 0; i < COUNT; i++) {
        double value[4 * (KILN_MAX_TAPS + 1)], rest[8], *wanted;
        kiln_table_lookup(&table, (double)x[i][0], (double)x[i][1], 0, value);
        for (int k = 0; k < taps; k++)
            rest[k] = value[4 * k + 3];
        memcpy(rest + taps, value + 4 * (size_t)taps, 4 * sizeof *rest);
        rest[5] = 1;
        for (int k = 0; k < taps; k++)
            rest[5] -= value[4 * k + 2];
        wanted = x[i][3] < 0.5F   ? value + 4 * (size_t)(x[i][2] * (float)taps)
                 : x[i][3] < 0.8F ? rest
                                  : rest + 3;
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)result[i][c], wanted[c], 4e-6);
    }
    gl.DeleteTextures(1, &texture);
    kiln_table_free(&table);
    kiln_context_destroy(context);
}

static void lobes_are_read_as_c_reads_them(void **unused)
{
    (void)unused;
    for (int taps = 1; taps <= KILN_MAX_TAPS; taps++)
        check_lobes(taps);
}

// table_read between texels, of every axis and both places of texels, against kiln_table_lookup.
static void check_table(kiln_context *context, const kiln_table_def *def)
{
    static float x[COUNT][ARGUMENTS], result[COUNT][4];
    kiln_error error = {0};
    kiln_table table;
    GLuint texture = 0;
    char expression[256];
    CHECK_OK(kiln_table_create(context, def, &table, &error));
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 2; k++)
            x[i][k] = (float)(random_number(&seed) < 0.05 ? random_number(&seed) < 0.5
                                                          : random_number(&seed));
    view_upload_image(&gl, 1, &texture, &table.image);
    int axis = (int)def->axis;
    axis += axis == KILN_AXIS_GRAZING && def->model.g == KILN_G_SCHLICK_TEXT;
    snprintf(expression, sizeof expression,
             "vec4 lies = vec4(%d.0, %d.0, %d.0, %d.0);\n"
             "r = vec3(table_read(table, lies, x[0], x[1]), "
             "1.0 - table_missing(table, lies, x[0], x[1]));",
             axis, def->corners, def->complement, def->flip);
    table_unit = 1;
    render(expression, (const float(*)[ARGUMENTS])x, result);
    table_unit = 0;
    for (int i = 0; i < COUNT; i++) {
        double value[4];
        kiln_table_lookup(&table, (double)x[i][0], (double)x[i][1], 0, value);
        if (table.image.channels == 1)
            CHECK_NEAR((double)result[i][2], value[0], 4e-6);
        for (int c = 0; c < 2 && table.image.channels == 2; c++)
            CHECK_NEAR((double)result[i][c], value[c], 4e-6);
    }
    gl.DeleteTextures(1, &texture);
    kiln_table_free(&table);
}

static void tables_are_read_as_c_reads_them(void **unused)
{
    (void)unused;
    kiln_context *context = make_context(0);
    for (int i = 0; i < 16; i++) {
        kiln_table_def def = {.kind = i % 3 == 2 ? KILN_TABLE_DFG : KILN_TABLE_E,
                              .model = {.g = i / 4 % 2 ? KILN_G_SCHLICK_TEXT : KILN_G_SMITH},
                              .width = 32,
                              .height = 24,
                              .axis = (kiln_axis)(i % 4),
                              .corners = i / 8,
                              .complement = i % 3 == 1,
                              .flip = i % 5 == 1};
        check_table(context, &def);
    }
    kiln_context_destroy(context);
}

// Whoever adds a function to a file of shaders/ adds its twin here. Others are tested through those
// that call them.
static void no_function_is_left_out(void **unused)
{
    (void)unused;
    static const char *const others[] = {"ggx_root",      "table_place",   "table_read",
                                         "table_missing", "sh_irradiance", "lobes_rest"};
    int found = 0;
    for (const char *line = test_all_glsl; line; line = strchr(line, '\n')) {
        char type[16], name[64];
        line += *line == '\n';
        const char *bracket = strchr(line, '('), *end = strchr(line, '\n');
        if (!bracket || (end && bracket > end) ||
            sscanf(line, "%15[a-z0-9] %63[a-z0-9_](", type, name) != 2 || line[0] == ' ')
            continue;
        bool tested = false;
        for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
            tested |= strstr(functions[i].expression, name) != NULL;
        for (size_t i = 0; i < sizeof others / sizeof *others; i++)
            tested |= !strcmp(others[i], name);
        if (!tested)
            fail_msg("%s has no twin in this test", name);
        found++;
    }
    assert_true(found > 20);
}

// D (n.h) / (4 v.h), summed over the points of a disc.
static double disc_sum(double alpha, const double v[3], const double l[3], double sine)
{
    enum { ACROSS = 400, AROUND = 256 };
    double side = l[2] < 0 ? -1 : 1, a = -1 / (side + l[2]), sum = 0,
           whole = 1 - sqrt(1 - sine * sine);
    const double t[3] = {1 + side * l[0] * l[0] * a, side * l[0] * l[1] * a, -side * l[0]};
    const double b[3] = {l[0] * l[1] * a, side + l[1] * l[1] * a, -l[1]};
    for (int i = 0; i < ACROSS * AROUND; i++) {
        int ring = i / AROUND;
        double less = whole * (ring + 0.5) / ACROSS, out = sqrt(less * (2 - less));
        double phi = 2 * pi * (i % AROUND + 0.5) / AROUND, h[3], size = 0, voh = 0;
        for (int c = 0; c < 3; c++) {
            h[c] = v[c] + (1 - less) * l[c] + out * (cos(phi) * t[c] + sin(phi) * b[c]);
            size += h[c] * h[c];
            voh += h[c] * v[c];
        }
        double noh = h[2] / sqrt(size);
        sum += ki_ggx_d(alpha, noh) * noh / (4 * voh / sqrt(size));
    }
    return sum * 2 * pi * whole / (ACROSS * AROUND);
}

// The integral along the border is that over the points of the disc, wherever the lobe is.
static void a_disc_mirrors_what_its_points_mirror(void **unused)
{
    (void)unused;
    static float x[COUNT][ARGUMENTS], result[COUNT][4];
    static const double alphas[] = {0.01, 0.05, 0.3, 1}, sines[] = {0.005, 0.03, 0.1};
    enum { SOME = 96 };
    double worst = 0;
    for (int i = 0; i < SOME; i++) {
        x[i][0] = (float)alphas[i % 4];
        x[i][4] = (float)sines[i / 4 % 3];
        x[i][1] = (float)(0.7 * random_number(&seed));
        // in the mirror direction, and a few degrees from there
        x[i][2] = x[i][1] + (float)(i % 2 ? 0.1 * random_number(&seed) : 0);
        x[i][3] = 1e6F;
    }
    render(VECTORS "r = vec3(ggx_disc(x[0], v, l, x[4]), 0.0, 0.0);", (const float(*)[ARGUMENTS])x,
           result);
    for (int i = 0; i < SOME; i++) {
        double at[ARGUMENTS], v[3], l[3];
        for (int k = 0; k < ARGUMENTS; k++)
            at[k] = (double)x[i][k];
        vectors(at, v, l);
        double wanted = disc_sum(at[0], v, l, at[4]);
        worst = fmax(worst, fabs((double)result[i][0] - wanted) / wanted);
        CHECK_NEAR((double)result[i][0], wanted, 5e-3 * wanted);
    }
    print_message("ggx_disc against the sum over the disc: %.1e\n", worst);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_disc_mirrors_what_its_points_mirror),
        cmocka_unit_test(glsl_agrees_with_c),
        cmocka_unit_test(no_function_is_left_out),
        cmocka_unit_test(harmonics_agree_with_c),
        cmocka_unit_test(tables_are_read_as_c_reads_them),
        cmocka_unit_test(the_rest_of_lobes_agrees_with_c),
        cmocka_unit_test(lobes_are_read_as_c_reads_them),
    };
    return cmocka_run_group_tests_name("shaders", tests, start, stop);
}
