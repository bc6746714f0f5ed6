// Uploads cubes of half floats and tables of floats as GL textures.
#include "gl.h"
#include "internal.h"

#include <math.h>
#include <stdlib.h>

// Converts a float that is not negative to an IEEE half, rounded to nearest even. Values above the
// largest finite half become that half.
static uint16_t half(float value)
{
    if (!(value > 0))
        return 0;
    if (value >= 65504.0f)
        return 0x7bff;
    int exponent;
    (void)frexpf(value, &exponent);
    if (exponent < -13) // subnormal half: a multiple of 2^-24
        return (uint16_t)lrintf(ldexpf(value, 24));
    // 11 bits with the leading one: 1024 to 2048
    uint32_t mantissa = (uint32_t)lrintf(ldexpf(value, 11 - exponent));
    return (uint16_t)(((uint32_t)(exponent + 14) << 10) + mantissa - 1024);
}

static void filter(const view_gl *gl, GLenum target, bool linear, int level_count)
{
    GLint small = level_count > 1 ? GL_LINEAR_MIPMAP_LINEAR : linear ? GL_LINEAR : GL_NEAREST;
    gl->TexParameteri(target, GL_TEXTURE_MIN_FILTER, small);
    gl->TexParameteri(target, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    gl->TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(target, GL_TEXTURE_MAX_LEVEL, level_count - 1);
}

static void fresh(const view_gl *gl, int unit, GLenum target, GLuint *texture)
{
    gl->DeleteTextures(1, texture);
    gl->GenTextures(1, texture);
    gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    gl->BindTexture(target, *texture);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

// Stores half floats, because OpenGL ES 3.0 need not filter 32-bit floats.
kiln_result view_upload_cube(const view_gl *gl, int unit, GLuint *texture, const kiln_map *map,
                             kiln_error *error)
{
    enum { FACES = 6 };
    size_t largest = (size_t)map->size * (size_t)map->size;
    uint16_t *texels = malloc(largest * 3 * sizeof *texels);
    if (!texels)
        return view_fail(error, KILN_ERROR_MEMORY, "out of memory: a face of %d x %d", map->size,
                         map->size);
    fresh(gl, unit, GL_TEXTURE_CUBE_MAP, texture);
    for (int level = 0; level < map->level_count; level++) {
        int size = kiln_map_level_size(map, level);
        size_t count = (size_t)size * (size_t)size * 3;
        for (int face = 0; face < FACES; face++) {
            const float *source = map->level[level] + (size_t)face * count;
            for (size_t i = 0; i < count; i++)
                texels[i] = half(source[i]);
            gl->TexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + (GLenum)face, level, GL_RGB16F, size,
                           size, 0, GL_RGB, GL_HALF_FLOAT, texels);
        }
    }
    free(texels);
    filter(gl, GL_TEXTURE_CUBE_MAP, true, map->level_count);
    return KILN_OK;
}

void view_upload_image(const view_gl *gl, int unit, GLuint *texture, const kiln_image *image)
{
    static const GLint stored[] = {GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F};
    static const GLenum given[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    int channels = image->channels - 1;
    fresh(gl, unit, GL_TEXTURE_2D, texture);
    gl->TexImage2D(GL_TEXTURE_2D, 0, stored[channels], image->width, image->height, 0,
                   given[channels], GL_FLOAT, image->pixels);
    filter(gl, GL_TEXTURE_2D, false, 1);
}
