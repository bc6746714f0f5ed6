// The OpenGL ES 3.0 renderer. In: a view, an environment's cubes and harmonics, tables. Out: the
// picture in the bound framebuffer, or read back as floats. One triangle covers the screen. The
// fragment shader scene.frag computes each pixel from the textures and one block of uniforms.
#include "gl.h"
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The uniform block View of shaders/scene.frag in the layout std140.
typedef struct block {
    float eye[4], right[4], up[4], back[4], light[4], turn[4], screen[4], handout_average[4];
    int32_t mode[4], flags[4], levels[4];
    float table_layout[8][4];
    float level_roughness[VIEW_SLOT_COUNT][KILN_MAX_LEVELS];
    float harmonics[VIEW_SLOT_COUNT][9][4];
    float balls[VIEW_MAX_BALLS][5][4];
    float discs[KILN_MAX_LIGHTS][2][4];
    float ground[4];
} block;

_Static_assert(offsetof(block, mode) == 128, "std140");
_Static_assert(offsetof(block, table_layout) == 176, "std140");
_Static_assert(offsetof(block, balls) == 720, "std140");
_Static_assert(offsetof(block, discs) == 5840, "std140");

enum { TONE_LINEAR, TONE_NEUTRAL, TONE_ASSIGNMENT };

// Texture unit of each sampler; the names in `samplers` are in the same order. The nine tables
// begin at TABLES. EDGE and LOBES count from there.
enum {
    ENVIRONMENT,
    ENVIRONMENT_TEXTBOOK,
    IRRADIANCE,
    TABLES,
    EDGE = 6,
    LOBES = 7,
    TEXTURES = TABLES + LOBES + VIEW_SLOT_COUNT
};
static const char *const samplers[TEXTURES] = {"environment",
                                               "environment_textbook",
                                               "irradiance",
                                               "handout_e",
                                               "handout_e_average",
                                               "handout_split",
                                               "e",
                                               "e_average",
                                               "split_sum",
                                               "edge_sum",
                                               "lobes",
                                               "lobes_textbook"};

struct view_renderer {
    kiln_context *context;
    view_gl gl;
    GLuint program, vertices, buffer, texture[TEXTURES];
    bool has_float;
    kiln_lights lights;
    // tables of lobes with 1 to 3 taps for the levels of each slot; without pixels where not made
    // yet
    kiln_table lobes[VIEW_SLOT_COUNT][KILN_MAX_TAPS];
    const kiln_table *uploaded[VIEW_SLOT_COUNT]; // the table of lobes in each slot's texture
    block block;
    char name[128];
};

// ---------------------------------------------------------------------------------------- textures

static kiln_result set_cube(view_renderer *r, int unit, const kiln_map *map, kiln_error *error)
{
    return view_upload_cube(&r->gl, unit, &r->texture[unit], map, error);
}

static void set_table(view_renderer *r, int place, const kiln_table *table)
{
    const kiln_image *image = &table->image;
    view_upload_image(&r->gl, TABLES + place, &r->texture[TABLES + place], image);
    // the tables of lobes, one for each slot, have the same layout
    float *layout = r->block.table_layout[place < LOBES ? place : LOBES];
    layout[0] = (float)table->def.axis;
    if (table->def.axis == KILN_AXIS_GRAZING && table->def.model.g == KILN_G_SCHLICK_TEXT)
        // KILN_AXIS_GRAZING of KILN_G_SCHLICK_TEXT has a number of its own in the shader
        layout[0]++;
    layout[1] = table->def.corners;
    layout[2] = table->def.complement;
    layout[3] = table->def.flip;
}

kiln_result view_set_tables(view_renderer *r, const kiln_table *e, const kiln_table *e_average,
                            const kiln_table *split, kiln_error *error)
{
    const kiln_table *tables[3] = {e, e_average, split};
    for (int i = 0; i < 3; i++)
        if (tables[i] && tables[i]->image.channels != (i == 2 ? 2 : 1))
            return view_fail(error, KILN_ERROR_ARGUMENT, "table %d has %d channels, not %d", i,
                             tables[i]->image.channels, i == 2 ? 2 : 1);
    for (int i = 0; i < 3; i++)
        if (tables[i]) {
            kiln_g g = tables[i]->def.model.g;
            bool schlick = g == KILN_G_SCHLICK_K2 || g == KILN_G_SCHLICK_TEXT;
            set_table(r, schlick ? i : 3 + i, tables[i]);
        }
    return KILN_OK;
}

kiln_result view_set_environment(view_renderer *r, view_slot slot, const kiln_map *levels,
                                 const kiln_sh *sh, const kiln_map *irradiance, kiln_error *error)
{
    if (levels->shape != KILN_SHAPE_CUBE || (irradiance && irradiance->shape != KILN_SHAPE_CUBE))
        return view_fail(error, KILN_ERROR_ARGUMENT, "the environment must be a cube");
    if (sh->bands < 3 || sh->irradiance)
        return view_fail(
            error, KILN_ERROR_ARGUMENT,
            "the environment needs spherical harmonics of its radiance with 3 bands or more");
    kiln_result result = set_cube(r, ENVIRONMENT + (int)slot, levels, error);
    if (result == KILN_OK && irradiance)
        result = set_cube(r, IRRADIANCE, irradiance, error);
    if (result != KILN_OK)
        return result;
    block *b = &r->block;
    b->levels[slot] = levels->level_count;
    for (int i = 0; i < levels->level_count; i++)
        b->level_roughness[slot][i] = levels->roughness[i];
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            b->harmonics[slot][i][c] = (float)sh->c[i][c];
    return KILN_OK;
}

void view_set_lights(view_renderer *r, const kiln_lights *lights)
{
    r->lights = lights ? *lights : (kiln_lights){.count = 0};
}

// ------------------------------------------------------------------------------------------ tables

// Computes the exact tables E, E_avg and (A, B) of the model with shadowing `g`. E_avg is the mean
// of E as the shader interpolates it, which keeps the furnace white.
static kiln_result make_model_tables(view_renderer *r, kiln_g g, kiln_error *error)
{
    kiln_table e = {0}, average = {0}, split = {0};
    kiln_table_def def = {.kind = KILN_TABLE_E,
                          .model = {.g = g},
                          .axis = KILN_AXIS_GRAZING,
                          .corners = true,
                          .complement = true};
    kiln_result result = kiln_table_create(r->context, &def, &e, error);
    if (result == KILN_OK)
        result = kiln_table_average(r->context, &e, 0, &average, error);
    // A and B change at every n.v, and at low roughness KILN_AXIS_GRAZING has all but its last
    // texels where n.v is small: at roughness 0.1 a table of this axis has errors of B up to 0.02.
    def = (kiln_table_def){.kind = KILN_TABLE_DFG,
                           .model = {.g = g},
                           .width = 256,
                           .height = 256,
                           .axis = KILN_AXIS_SQRT,
                           .corners = true};
    if (result == KILN_OK)
        result = kiln_table_create(r->context, &def, &split, error);
    if (result == KILN_OK)
        result = view_set_tables(r, &e, &average, &split, error);
    kiln_table_free(&split);
    kiln_table_free(&average);
    kiln_table_free(&e);
    return result;
}

static kiln_result make_tables(view_renderer *r, kiln_error *error)
{
    kiln_table edge = {0};
    kiln_result result = make_model_tables(r, KILN_G_SCHLICK_K2, error);
    if (result == KILN_OK)
        result = make_model_tables(r, KILN_G_SMITH, error);
    if (result == KILN_OK)
        result = view_edge_create(r->context, &edge, error);
    if (result == KILN_OK)
        set_table(r, EDGE, &edge);
    kiln_table_free(&edge);
    return result;
}

// Returns the number of taps, at most 0 where the view needs none.
static int taps_of(const view_options *o)
{
    return (int)o->reflections - VIEW_REFLECTIONS_ONE + 1;
}

// Whether the table has the size, the taps and the levels of `def`.
static bool suits(const kiln_table *table, const kiln_table_def *def)
{
    const kiln_table_def *has = &table->def;
    bool same = table->image.pixels && has->width == def->width &&
                has->tap_count == def->tap_count && has->level_count == def->level_count;
    for (int i = 0; i < def->level_count && same; i++)
        same = has->level_roughness[i] == def->level_roughness[i];
    return same;
}

// Sets the size, the taps and the levels of the table of lobes for a slot. A slot without an
// environment gets equal steps of roughness, which VIEW_SCENE_FURNACE reads.
static kiln_table_def lobes_def(const block *b, int slot, const view_options *o)
{
    enum { EQUAL_STEPS = 7, LOBES_SIZE = 32 };
    int count = b->levels[slot] > 1 ? b->levels[slot] : EQUAL_STEPS;
    kiln_table_def def = {.kind = KILN_TABLE_LOBES,
                          .width = o->lobes_size ? o->lobes_size : LOBES_SIZE,
                          .tap_count = taps_of(o),
                          .level_count = count};
    def.height = def.width;
    for (int i = 0; i < count; i++)
        def.level_roughness[i] =
            b->levels[slot] > 1 ? b->level_roughness[slot][i] : (float)i / (EQUAL_STEPS - 1);
    return def;
}

// Makes the table of lobes for the levels of one slot, or finds it among those of the other slot.
static kiln_result make_lobes(view_renderer *r, int slot, const view_options *o, kiln_error *error)
{
    kiln_table_def def = lobes_def(&r->block, slot, o);
    kiln_table *own = &r->lobes[slot][def.tap_count - 1];
    kiln_table *other = &r->lobes[!slot][def.tap_count - 1];
    const kiln_table *found = suits(own, &def) || !suits(other, &def) ? own : other;
    if (!suits(found, &def)) {
        kiln_table_free(own);
        memset(r->uploaded, 0, sizeof r->uploaded);
        kiln_result result = kiln_table_create(r->context, &def, own, error);
        if (result != KILN_OK)
            return result;
    }
    if (r->uploaded[slot] != found)
        set_table(r, LOBES + slot, found);
    r->uploaded[slot] = found;
    return KILN_OK;
}

kiln_result view_prepare(view_renderer *r, const view_options *o, kiln_error *error)
{
    int slots = o->scene == VIEW_SCENE_COMPARE ? VIEW_SLOT_COUNT : 1;
    kiln_result result = KILN_OK;
    if (taps_of(o) < 1 || o->scene == VIEW_SCENE_ASSIGNMENT)
        return KILN_OK;
    for (int slot = 0; slot < slots && result == KILN_OK; slot++)
        result = make_lobes(r, slot, o, error);
    return result;
}

// Binds black textures: a sampler without a texture would be incomplete.
static kiln_result make_darkness(view_renderer *r, kiln_error *error)
{
    kiln_map black = {0};
    kiln_sh sh = {.bands = 3};
    kiln_result result = kiln_map_create(r->context, KILN_SHAPE_CUBE, 1, 1, &black, error);
    for (int slot = 0; slot < VIEW_SLOT_COUNT && result == KILN_OK; slot++)
        result = view_set_environment(r, (view_slot)slot, &black, &sh, &black, error);
    kiln_map_free(&black);
    return result;
}

// ------------------------------------------------------------------------------------------ making

static kiln_result start(view_renderer *r, view_lookup *lookup, kiln_error *error)
{
    const char *missing = NULL;
    if (!view_gl_load(&r->gl, lookup, &missing))
        return view_fail(error, KILN_ERROR_UNSUPPORTED, "the driver has no %s", missing);
    const view_gl *gl = &r->gl;
    const char *name = (const char *)gl->GetString(GL_RENDERER);
    for (size_t i = 0; name && name[i] && i + 1 < sizeof r->name; i++)
        r->name[i] = name[i];
    r->has_float =
        view_gl_has(gl, "GL_EXT_color_buffer_float") || view_gl_has(gl, "EXT_color_buffer_float");
    kiln_result result = view_link(gl, view_shader_scene_frag, &r->program, error);
    if (result != KILN_OK)
        return result;
    gl->GenVertexArrays(1, &r->vertices);
    gl->GenBuffers(1, &r->buffer);
    gl->UseProgram(r->program);
    for (int i = 0; i < TEXTURES; i++)
        gl->Uniform1i(gl->GetUniformLocation(r->program, samplers[i]), i);
    gl->UniformBlockBinding(r->program, gl->GetUniformBlockIndex(r->program, "View"), 0);
    result = make_darkness(r, error);
    return result == KILN_OK ? make_tables(r, error) : result;
}

kiln_result view_create(kiln_context *context, view_lookup *lookup, view_renderer **renderer,
                        kiln_error *error)
{
    *renderer = NULL;
    view_renderer *r = calloc(1, sizeof *r);
    if (!r)
        return view_fail(error, KILN_ERROR_MEMORY, "out of memory");
    r->context = context;
    kiln_result result = start(r, lookup, error);
    if (result == KILN_OK)
        *renderer = r;
    else
        view_destroy(r);
    return result;
}

void view_destroy(view_renderer *r)
{
    for (int i = 0; r && i < VIEW_SLOT_COUNT * KILN_MAX_TAPS; i++)
        kiln_table_free(&r->lobes[i / KILN_MAX_TAPS][i % KILN_MAX_TAPS]);
    if (r && r->program) {
        const view_gl *gl = &r->gl;
        gl->DeleteTextures(TEXTURES, r->texture);
        gl->DeleteBuffers(1, &r->buffer);
        gl->DeleteVertexArrays(1, &r->vertices);
        gl->DeleteProgram(r->program);
    }
    free(r);
}

const char *view_gl_name(const view_renderer *r)
{
    return r->name;
}

// ----------------------------------------------------------------------------------------- drawing

static void copy3(float to[4], const double from[3])
{
    for (int c = 0; c < 3; c++)
        to[c] = (float)from[c];
}

static void fill_balls(block *b, const view_options *o)
{
    view_ball balls[VIEW_MAX_BALLS];
    b->mode[3] = view_balls(o, balls);
    for (int i = 0; i < b->mode[3]; i++) {
        const view_ball *ball = &balls[i];
        float(*to)[4] = b->balls[i];
        copy3(to[0], ball->centre);
        copy3(to[1], ball->f0);
        copy3(to[2], ball->f_average);
        copy3(to[3], ball->albedo);
        copy3(to[4], ball->f82);
        to[0][3] = (float)ball->radius;
        to[1][3] = (float)ball->roughness;
        to[2][3] = (float)ball->method;
        to[3][3] = (float)ball->metallic;
    }
}

static void fill_discs(block *b, const view_options *o, const kiln_lights *lights)
{
    view_disc discs[KILN_MAX_LIGHTS];
    view_plane ground;
    int count = view_discs(o, lights, discs);
    for (int i = 0; i < count; i++) {
        copy3(b->discs[i][0], discs[i].direction);
        copy3(b->discs[i][1], discs[i].radiance);
        b->discs[i][0][3] = (float)discs[i].sine;
    }
    b->ground[2] = view_ground(o, &ground);
    b->ground[0] = (float)ground.height;
    b->ground[1] = (float)ground.albedo;
    b->ground[3] = (float)count;
}

static void fill_block(block *b, const view_options *o, int width, int height, bool linear)
{
    static const double degree = 0.017453292519943295;
    double eye[3], right[3], up[3], back[3];
    view_camera_axes(&o->camera, eye, right, up, back);
    copy3(b->eye, eye);
    copy3(b->right, right);
    copy3(b->up, up);
    copy3(b->back, back);
    double slope = tan(o->camera.fov / 2 * degree);
    b->right[3] = (float)(slope * width / height);
    b->up[3] = (float)slope;
    b->back[3] = (float)exp2(o->exposure);
    // the light comes from the direction (0, 0, 1) and has radiance 1
    b->light[2] = b->light[3] = 1;
    b->turn[0] = (float)cos(o->rotation * degree);
    b->turn[1] = (float)sin(o->rotation * degree);
    b->turn[2] = (float)o->split;
    b->turn[3] = (float)o->background;
    b->screen[0] = (float)width;
    b->screen[1] = (float)height;
    b->screen[2] = (float)o->reflections;
    copy3(b->handout_average, view_handout_albedo);
    bool assignment = o->scene == VIEW_SCENE_ASSIGNMENT;
    b->mode[0] = (int32_t)o->scene;
    b->mode[1] = (int32_t)o->debug;
    b->mode[2] = o->samples < 1 ? 1 : o->samples > 8 ? 8 : o->samples;
    b->flags[0] = linear ? TONE_LINEAR : assignment ? TONE_ASSIGNMENT : TONE_NEUTRAL;
    b->flags[1] = o->as_printed;
    b->flags[2] = o->occlusion;
    b->flags[3] = o->cube_diffuse;
    b->levels[2] = o->debug_level;
    b->levels[3] = assignment;
    fill_balls(b, o);
}

static void draw(view_renderer *r, const view_options *o, int width, int height, bool linear)
{
    const view_gl *gl = &r->gl;
    fill_block(&r->block, o, width, height, linear);
    fill_discs(&r->block, o, &r->lights);
    gl->Viewport(0, 0, width, height);
    gl->Disable(GL_BLEND);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
    gl->Disable(GL_DITHER);
    gl->UseProgram(r->program);
    for (int i = 0; i < TEXTURES; i++) {
        gl->ActiveTexture(GL_TEXTURE0 + (GLenum)i);
        gl->BindTexture(i < TABLES ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D, r->texture[i]);
    }
    gl->BindBuffer(GL_UNIFORM_BUFFER, r->buffer);
    gl->BufferData(GL_UNIFORM_BUFFER, sizeof r->block, &r->block, GL_DYNAMIC_DRAW);
    gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, r->buffer);
    gl->BindVertexArray(r->vertices);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

void view_draw(view_renderer *r, const view_options *o, int width, int height)
{
    draw(r, o, width, height, false);
}

// --------------------------------------------------------------------------------------- pictures

// Reads the framebuffer (RGBA floats, bottom row first) into a picture of three channels, top row
// first.
static kiln_result read_back(view_renderer *r, int width, int height, kiln_image *image,
                             kiln_error *error)
{
    const view_gl *gl = &r->gl;
    size_t row = (size_t)width * 4;
    float *rgba = malloc(row * (size_t)height * sizeof *rgba);
    if (!rgba)
        return view_fail(error, KILN_ERROR_MEMORY, "out of memory: a picture of %d x %d", width,
                         height);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, rgba);
    kiln_result result = kiln_image_create(r->context, width, height, 3, image, error);
    for (int y = 0; y < height && result == KILN_OK; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                image->pixels[((size_t)y * (size_t)width + (size_t)x) * 3 + (size_t)c] =
                    rgba[(size_t)(height - 1 - y) * row + (size_t)x * 4 + (size_t)c];
    free(rgba);
    return result;
}

kiln_result view_picture(view_renderer *r, const view_options *o, int width, int height,
                         bool linear, kiln_image *image, kiln_error *error)
{
    const view_gl *gl = &r->gl;
    *image = (kiln_image){0};
    GLint limit = 0;
    gl->GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
    if (width < 1 || height < 1 || width > limit || height > limit)
        return view_fail(
            error, KILN_ERROR_ARGUMENT,
            "the picture is %d x %d, but %s draws pictures with sides of 1 to %d texels", width,
            height, r->name, (int)limit);
    if (!r->has_float)
        return view_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s cannot draw into textures of floats, for which it needs EXT_color_buffer_float",
            r->name);
    kiln_result result = view_prepare(r, o, error);
    if (result != KILN_OK)
        return result;
    GLuint frame = 0, buffer = 0;
    GLint before = 0;
    gl->GetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    gl->GenRenderbuffers(1, &buffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, width, height);
    gl->GenFramebuffers(1, &frame);
    gl->BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        result =
            view_fail(error, KILN_ERROR_UNSUPPORTED,
                      "%s cannot draw into a texture of %d x %d floats", r->name, width, height);
    } else {
        draw(r, o, width, height, linear);
        result = read_back(r, width, height, image, error);
    }
    gl->BindFramebuffer(GL_FRAMEBUFFER, (GLuint)before);
    gl->DeleteFramebuffers(1, &frame);
    gl->DeleteRenderbuffers(1, &buffer);
    return result;
}

kiln_result view_furnace_residual(view_renderer *r, const view_options *options, int width,
                                  int height, double *largest, double *rms, kiln_error *error)
{
    view_options o = *options;
    kiln_image image;
    o.scene = VIEW_SCENE_FURNACE;
    o.debug = VIEW_DEBUG_NONE;
    kiln_result result = view_picture(r, &o, width, height, true, &image, error);
    *largest = *rms = 0;
    if (result != KILN_OK)
        return result;
    double sum = 0;
    size_t count = 0;
    // The row of balls with compensation lies in the upper half of the picture.
    for (size_t i = 0; i < (size_t)width * (size_t)(height / 2) * 3; i++) {
        double off = fabs((double)image.pixels[i] - 1);
        *largest = off > *largest ? off : *largest;
        sum += off * off;
        count += off > 0;
    }
    *rms = count ? sqrt(sum / (double)count) : 0;
    kiln_image_free(&image);
    return KILN_OK;
}
