// The GLSL that kiln writes for tables, on a texture and on an array, against kiln_table_lookup.
#include "files/lookup/tables.h"
#include "gl.h"
#include "headless.h"

#include "kit/context.h"

enum { POINTS = 256 };

static view_headless *headless;
static view_gl gl;
static __typeof__(&glTexImage3D) tex_image_3d;

static int start(void **state)
{
    const char *missing = "";
    if (set_up_folder(state) || view_headless_create(&headless, &error) ||
        !view_gl_load(&gl, view_headless_lookup, &missing)) {
        fprintf(stderr, "%s%s\n", error.message, missing);
        return -1;
    }
    tex_image_3d = (__typeof__(&glTexImage3D))view_headless_lookup("glTexImage3D");
    GLuint frame, buffer, array;
    gl.GenVertexArrays(1, &array);
    gl.BindVertexArray(array);
    gl.GenFramebuffers(1, &frame);
    gl.GenRenderbuffers(1, &buffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, POINTS, 2);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    gl.Viewport(0, 0, POINTS, 2);
    return gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE;
}

static int stop(void **state)
{
    view_headless_destroy(headless);
    return tear_down_folder(state);
}

// The table with the numbers that it has in a format.
static void round_table(kiln_table *table, kiln_table_format format)
{
    kiln_table rounded;
    CHECK_OK(kiln_table_save(context, table, in_folder("r.ktx2"),
                             &(kiln_table_save_def){.format = format}, &error));
    CHECK_OK(kiln_table_load(context, in_folder("r.ktx2"), &rounded, &error));
    kiln_table_free(table);
    *table = rounded;
}

static void append_file(char *text, size_t room, const char *name)
{
    size_t used = strlen(text), size;
    uint8_t *bytes = read_file(in_folder(name), &size);
    assert_true(used + size + 1 < room);
    memcpy(text + used, bytes, size + 1);
    free(bytes);
}

static GLuint link_lookup(const kiln_table *table, kiln_table_format format)
{
    static char text[1 << 20];
    static const char *const swizzles[] = {"r", "rg", "rgb", "rgba"};
    const char *nov = table->def.kind == KILN_TABLE_E_AVERAGE ? "" : "p.x, ";
    const char *third = table->def.depth > 1 ? ", p.z" : "";
    CHECK_OK(kiln_table_save(context, table, in_folder("t.glsl"),
                             &(kiln_table_save_def){.format = format}, &error));
    CHECK_OK(
        kiln_table_lookup_save(context, &table->def, in_folder("t_lookup.glsl"), NULL, &error));
    snprintf(text, sizeof text,
             "uniform highp sampler2D points;\nuniform highp sampler%dD numbers;\n"
             "out vec4 color;\n",
             table->def.depth > 1 ? 3 : 2);
    append_file(text, sizeof text, "t.glsl");
    append_file(text, sizeof text, "t_lookup.glsl");
    size_t used = strlen(text);
    snprintf(text + used, sizeof text - used,
             "void main()\n{\n    ivec2 at = ivec2(gl_FragCoord.xy);\n"
             "    vec3 p = texelFetch(points, ivec2(at.x, 0), 0).xyz;\n    color = vec4(0.0);\n"
             "    if (at.y == 0)\n        color.%s = t_lookup(numbers, %sp.y%s);\n"
             "    else\n        color.%s = t_lookup(%sp.y%s);\n}\n",
             swizzles[table->image.channels - 1], nov, third, swizzles[table->image.channels - 1],
             nov, third);
    GLuint program;
    CHECK_OK(view_link(&gl, text, &program, &error));
    gl.UseProgram(program);
    gl.Uniform1i(gl.GetUniformLocation(program, "points"), 0);
    gl.Uniform1i(gl.GetUniformLocation(program, "numbers"), 1);
    return program;
}

static GLuint upload(int unit, const kiln_table *table, const float *pixels)
{
    static const GLenum stored[] = {GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F};
    static const GLenum given[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    const kiln_table_def *def = &table->def;
    int c = table->image.channels - 1;
    GLenum target = def->depth > 1 ? GL_TEXTURE_3D : GL_TEXTURE_2D;
    GLuint texture;
    gl.ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    gl.GenTextures(1, &texture);
    gl.BindTexture(target, texture);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (def->depth > 1)
        tex_image_3d(target, 0, (GLint)stored[c], def->width, def->height, def->depth, 0, given[c],
                     GL_FLOAT, pixels);
    else
        gl.TexImage2D(target, 0, (GLint)stored[c], def->width, def->height, 0, given[c], GL_FLOAT,
                      pixels);
    static const GLenum clamped[] = {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R};
    for (int i = 0; i < 3; i++)
        gl.TexParameteri(target, clamped[i], GL_CLAMP_TO_EDGE);
    gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, unit ? GL_LINEAR : GL_NEAREST);
    gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, unit ? GL_LINEAR : GL_NEAREST);
    return texture;
}

// Largest error of the lookups of one table on the texture and on the array.
static void measure(int index, double off[2])
{
    static float points[POINTS][4], seen[2][POINTS][4];
    kiln_table table;
    kiln_table_format format = (kiln_table_format)(1 + index % 4);
    CHECK_OK(lookup_table(context, index, &table, &error));
    round_table(&table, format);
    uint64_t seed = (uint64_t)index + 77;
    for (int i = 0; i < POINTS; i++) {
        double point[3];
        lookup_point(&seed, point);
        for (int c = 0; c < 3; c++)
            points[i][c] = (float)point[c];
    }
    kiln_table list = {.def = {.width = POINTS, .height = 1, .depth = 1}, .image = {.channels = 4}};
    GLuint textures[2] = {upload(0, &list, &points[0][0]), upload(1, &table, table.image.pixels)};
    GLuint program = link_lookup(&table, format);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.ReadPixels(0, 0, POINTS, 2, GL_RGBA, GL_FLOAT, seen);
    assert_int_equal(gl.GetError(), 0);
    for (int i = 0; i < POINTS; i++) {
        double wanted[4] = {0};
        kiln_table_lookup(&table, (double)points[i][0], (double)points[i][1], (double)points[i][2],
                          wanted);
        for (int k = 0; k < 2; k++)
            for (int c = 0; c < table.image.channels; c++)
                off[k] = fmax(off[k], fabs((double)seen[k][i][c] - wanted[c]));
    }
    gl.DeleteTextures(2, textures);
    gl.DeleteProgram(program);
    kiln_table_free(&table);
}

// On neighbours that differ by up to 1 and 7 texels a side: floats err by some 1e-6 then, and
// filters of texture units may have weights of 8 bits.
static void lookups_agree(void **unused)
{
    (void)unused;
    double off[2] = {0};
    assert_true(view_gl_has(&gl, "GL_OES_texture_float_linear"));
    for (int i = 0; i < LOOKUP_TABLES; i++) {
        double one[2] = {0};
        measure(i, one);
        if (one[1] > 1e-5 || one[0] > 1e-5)
            print_message("table %d: %.2g %.2g\n", i, one[0], one[1]);
        for (int k = 0; k < 2; k++)
            off[k] = fmax(off[k], one[k]);
    }
    print_message("off by %.2g on textures, %.2g on arrays\n", off[0], off[1]);
    CHECK_BELOW(off[1], 2e-6);
    CHECK_BELOW(off[0], 1.0 / 256);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lookups_agree)};
    return cmocka_run_group_tests(tests, start, stop);
}
