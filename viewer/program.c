// Compiles and links the shaders. All programs share one vertex shader.
#include "gl.h"
#include "internal.h"

static kiln_result compile(const view_gl *gl, GLenum stage, const char *text, GLuint *shader,
                           kiln_error *error)
{
    const char *parts[] = {"#version 300 es\n"
                           "precision highp float;\nprecision highp int;\n"
                           "precision highp sampler2D;\nprecision highp samplerCube;\n",
                           text};
    *shader = gl->CreateShader(stage);
    gl->ShaderSource(*shader, 2, parts, NULL);
    gl->CompileShader(*shader);
    GLint good = 0;
    gl->GetShaderiv(*shader, GL_COMPILE_STATUS, &good);
    if (good)
        return KILN_OK;
    char log[384] = "";
    gl->GetShaderInfoLog(*shader, sizeof log, NULL, log);
    return view_fail(error, KILN_ERROR_UNSUPPORTED, "the driver does not compile a shader: %s",
                     log);
}

kiln_result view_link(const view_gl *gl, const char *fragment_text, GLuint *program,
                      kiln_error *error)
{
    GLuint vertex = 0, fragment = 0;
    *program = 0;
    kiln_result result = compile(gl, GL_VERTEX_SHADER, view_shader_screen_vert, &vertex, error);
    if (result == KILN_OK)
        result = compile(gl, GL_FRAGMENT_SHADER, fragment_text, &fragment, error);
    if (result == KILN_OK) {
        GLint good = 0;
        *program = gl->CreateProgram();
        gl->AttachShader(*program, vertex);
        gl->AttachShader(*program, fragment);
        gl->LinkProgram(*program);
        gl->GetProgramiv(*program, GL_LINK_STATUS, &good);
        if (!good) {
            char log[384] = "";
            gl->GetProgramInfoLog(*program, sizeof log, NULL, log);
            gl->DeleteProgram(*program);
            *program = 0;
            result = view_fail(error, KILN_ERROR_UNSUPPORTED,
                               "the driver does not link a shader: %s", log);
        }
    }
    gl->DeleteShader(vertex);
    gl->DeleteShader(fragment);
    return result;
}
