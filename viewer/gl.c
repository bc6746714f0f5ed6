#include "gl.h"

#include <string.h>

bool view_gl_load(view_gl *gl, view_lookup *lookup, const char **missing)
{
#ifdef __EMSCRIPTEN__
    (void)lookup;
    (void)missing;
#define VIEW_GL_SET(name) gl->name = gl##name;
    VIEW_GL_FUNCTIONS(VIEW_GL_SET)
#else
#define VIEW_GL_SET(name)                                                                          \
    if (!(gl->name = (__typeof__(gl->name))lookup("gl" #name))) {                                  \
        *missing = "gl" #name;                                                                     \
        return false;                                                                              \
    }
    VIEW_GL_FUNCTIONS(VIEW_GL_SET)
#endif
#undef VIEW_GL_SET
    return true;
}

bool view_gl_has(const view_gl *gl, const char *extension)
{
    GLint count = 0;
    gl->GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; i++) {
        const char *name = (const char *)gl->GetStringi(GL_EXTENSIONS, (GLuint)i);
        if (name && !strcmp(name, extension))
            return true;
    }
    return false;
}
