#include "headless.h"

#include "internal.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#define EGL_FUNCTIONS(X)                                                                           \
    X(BindAPI)                                                                                     \
    X(ChooseConfig)                                                                                \
    X(CreateContext)                                                                               \
    X(DestroyContext)                                                                              \
    X(GetDisplay)                                                                                  \
    X(GetError)                                                                                    \
    X(GetProcAddress)                                                                              \
    X(Initialize)                                                                                  \
    X(MakeCurrent)                                                                                 \
    X(QueryString)                                                                                 \
    X(Terminate)

typedef struct egl_functions {
#define MEMBER(name) __typeof__(&egl##name) name; // NOLINT(bugprone-macro-parentheses)
    EGL_FUNCTIONS(MEMBER)
#undef MEMBER
} egl_functions;

struct view_headless {
    egl_functions egl;
    EGLDisplay display;
    EGLContext context;
};

// Copies dlsym's object pointer into a function pointer: POSIX allows this, ISO C has no cast for
// it.
static bool find(void *library, const char *name, void *function)
{
    void *symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol;
}

// EGL stays loaded until the process ends: some drivers cannot be unloaded safely.
static kiln_result load(egl_functions *egl, kiln_error *error)
{
    void *library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return view_fail(error, KILN_ERROR_UNSUPPORTED,
                         "the library EGL (libEGL.so.1) cannot be loaded; rendering needs EGL and "
                         "a driver such as Mesa's (Debian: libegl1 and libgl1-mesa-dri)");
#define FIND(name)                                                                                 \
    if (!find(library, "egl" #name, &egl->name))                                                   \
        return view_fail(error, KILN_ERROR_UNSUPPORTED, "libEGL.so.1 has no egl" #name);
    EGL_FUNCTIONS(FIND)
#undef FIND
    return KILN_OK;
}

static EGLDisplay open_display(const egl_functions *egl)
{
    const char *extensions = egl->QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDisplay display = EGL_NO_DISPLAY;
    if (extensions && strstr(extensions, "EGL_MESA_platform_surfaceless")) {
        PFNEGLGETPLATFORMDISPLAYEXTPROC get =
            (PFNEGLGETPLATFORMDISPLAYEXTPROC)egl->GetProcAddress("eglGetPlatformDisplayEXT");
        display = get ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : display;
        if (display && egl->Initialize(display, NULL, NULL))
            return display;
    }
    display = egl->GetDisplay(EGL_DEFAULT_DISPLAY);
    return display && egl->Initialize(display, NULL, NULL) ? display : EGL_NO_DISPLAY;
}

static kiln_result start(view_headless *h, kiln_error *error)
{
    const egl_functions *egl = &h->egl;
    h->display = open_display(egl);
    if (!h->display)
        return view_fail(error, KILN_ERROR_UNSUPPORTED,
                         "EGL offers no display, not even one without a surface; install a driver "
                         "such as Mesa's (Debian: libgl1-mesa-dri)");
    static const EGLint want[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0,
                                  EGL_NONE};
    static const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0,
                                     EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    egl->BindAPI(EGL_OPENGL_ES_API);
    if (!egl->ChooseConfig(h->display, want, &config, 1, &count) || count < 1)
        return view_fail(error, KILN_ERROR_UNSUPPORTED, "EGL offers no OpenGL ES 3.0");
    h->context = egl->CreateContext(h->display, config, EGL_NO_CONTEXT, version);
    if (!h->context)
        return view_fail(error, KILN_ERROR_UNSUPPORTED,
                         "EGL makes no OpenGL ES 3.0 context (error 0x%04x)",
                         (unsigned)egl->GetError());
    if (!egl->MakeCurrent(h->display, EGL_NO_SURFACE, EGL_NO_SURFACE, h->context))
        return view_fail(error, KILN_ERROR_UNSUPPORTED,
                         "EGL cannot draw without a surface (error 0x%04x)",
                         (unsigned)egl->GetError());
    return KILN_OK;
}

kiln_result view_headless_create(view_headless **headless, kiln_error *error)
{
    *headless = NULL;
    view_headless *h = calloc(1, sizeof *h);
    if (!h)
        return view_fail(error, KILN_ERROR_MEMORY, "out of memory");
    kiln_result result = load(&h->egl, error);
    if (result == KILN_OK)
        result = start(h, error);
    if (result == KILN_OK)
        *headless = h;
    else
        view_headless_destroy(h);
    return result;
}

void view_headless_destroy(view_headless *h)
{
    if (h && h->display) {
        h->egl.MakeCurrent(h->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (h->context)
            h->egl.DestroyContext(h->display, h->context);
        h->egl.Terminate(h->display);
    }
    free(h);
}

view_function view_headless_lookup(const char *name)
{
    // EGL is loaded already; dlopen only adds a user to its count.
    void *library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    __typeof__(&eglGetProcAddress) get = NULL;
    return library && find(library, "eglGetProcAddress", &get) ? (view_function)get(name) : NULL;
}
