// The functions of OpenGL ES 3.0 that the renderer calls. They are looked up at run time: the
// program starts on machines without OpenGL.
#ifndef KILN_VIEWER_GL_H
#define KILN_VIEWER_GL_H

#include "viewer.h"

#include <GLES3/gl3.h>

#define VIEW_GL_FUNCTIONS(X)                                                                       \
    X(ActiveTexture)                                                                               \
    X(AttachShader)                                                                                \
    X(BindBuffer)                                                                                  \
    X(BindBufferBase)                                                                              \
    X(BindFramebuffer)                                                                             \
    X(BindRenderbuffer)                                                                            \
    X(BindTexture)                                                                                 \
    X(BindVertexArray)                                                                             \
    X(BufferData)                                                                                  \
    X(CheckFramebufferStatus)                                                                      \
    X(CompileShader)                                                                               \
    X(CreateProgram)                                                                               \
    X(CreateShader)                                                                                \
    X(DeleteBuffers)                                                                               \
    X(DeleteFramebuffers)                                                                          \
    X(DeleteProgram)                                                                               \
    X(DeleteRenderbuffers)                                                                         \
    X(DeleteShader)                                                                                \
    X(DeleteTextures)                                                                              \
    X(DeleteVertexArrays)                                                                          \
    X(Disable)                                                                                     \
    X(DrawArrays)                                                                                  \
    X(FramebufferRenderbuffer)                                                                     \
    X(GenBuffers)                                                                                  \
    X(GenFramebuffers)                                                                             \
    X(GenRenderbuffers)                                                                            \
    X(GenTextures)                                                                                 \
    X(GenVertexArrays)                                                                             \
    X(GetError)                                                                                    \
    X(GetIntegerv)                                                                                 \
    X(GetProgramInfoLog)                                                                           \
    X(GetProgramiv)                                                                                \
    X(GetShaderInfoLog)                                                                            \
    X(GetShaderiv)                                                                                 \
    X(GetString)                                                                                   \
    X(GetStringi)                                                                                  \
    X(GetUniformBlockIndex)                                                                        \
    X(GetUniformLocation)                                                                          \
    X(LinkProgram)                                                                                 \
    X(PixelStorei)                                                                                 \
    X(ReadPixels)                                                                                  \
    X(RenderbufferStorage)                                                                         \
    X(ShaderSource)                                                                                \
    X(TexImage2D)                                                                                  \
    X(TexParameteri)                                                                               \
    X(Uniform1f)                                                                                   \
    X(Uniform1i)                                                                                   \
    X(Uniform2f)                                                                                   \
    X(UniformBlockBinding)                                                                         \
    X(UseProgram)                                                                                  \
    X(Viewport)

typedef struct view_gl {
#define VIEW_GL_MEMBER(name) __typeof__(&gl##name) name; // NOLINT(bugprone-macro-parentheses)
    VIEW_GL_FUNCTIONS(VIEW_GL_MEMBER)
#undef VIEW_GL_MEMBER
} view_gl;

/// Looks the functions of VIEW_GL_FUNCTIONS up by name. Returns false if one is missing and stores
/// its name in `missing`.
bool view_gl_load(view_gl *gl, view_lookup *lookup, const char **missing);
/// Returns whether the current GL context offers this extension.
bool view_gl_has(const view_gl *gl, const char *extension);

/// Compiles and links a program of the full-screen triangle's vertex shader and a fragment shader,
/// whose text has no version and precision lines.
KILN_CHECKED kiln_result view_link(const view_gl *gl, const char *fragment, GLuint *program,
                                   kiln_error *error);

/// Replaces `texture` by a new cube texture, bound to a unit: half floats, all mip levels,
/// trilinear filter.
KILN_CHECKED kiln_result view_upload_cube(const view_gl *gl, int unit, GLuint *texture,
                                          const kiln_map *map, kiln_error *error);
/// Replaces `texture` by a new 2D texture of 32-bit floats, bound to a unit, without filter.
void view_upload_image(const view_gl *gl, int unit, GLuint *texture, const kiln_image *image);

#endif
