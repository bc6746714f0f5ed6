// The window of window.h. In: a view and callbacks that set environments. Out: frames on the
// screen, or one screenshot. GLFW's functions are found by dlopen; keys and mouse change the view
// by controls.h, and a frame is drawn after each change.
//
#include "window.h"

#include "controls.h"
#include "gl.h"
#include "internal.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_FUNCTIONS(X)                                                                          \
    X(CreateWindow)                                                                                \
    X(DestroyWindow)                                                                               \
    X(GetCursorPos)                                                                                \
    X(GetError)                                                                                    \
    X(GetFramebufferSize)                                                                          \
    X(GetKey)                                                                                      \
    X(GetMouseButton)                                                                              \
    X(GetProcAddress)                                                                              \
    X(GetWindowSize)                                                                               \
    X(GetWindowUserPointer)                                                                        \
    X(Init)                                                                                        \
    X(InitHint)                                                                                    \
    X(MakeContextCurrent)                                                                          \
    X(SetCharCallback)                                                                             \
    X(SetCursorPosCallback)                                                                        \
    X(SetFramebufferSizeCallback)                                                                  \
    X(SetKeyCallback)                                                                              \
    X(SetMouseButtonCallback)                                                                      \
    X(SetScrollCallback)                                                                           \
    X(SetWindowRefreshCallback)                                                                    \
    X(SetWindowTitle)                                                                              \
    X(SetWindowShouldClose)                                                                        \
    X(SetWindowUserPointer)                                                                        \
    X(SwapBuffers)                                                                                 \
    X(Terminate)                                                                                   \
    X(WaitEventsTimeout)                                                                           \
    X(WindowHint)                                                                                  \
    X(WindowShouldClose)

typedef struct glfw_functions {
#define MEMBER(name) __typeof__(&glfw##name) name; // NOLINT(bugprone-macro-parentheses)
    GLFW_FUNCTIONS(MEMBER)
#undef MEMBER
} glfw_functions;

typedef struct window {
    glfw_functions glfw;
    GLFWwindow *handle;
    view_options options;
    bool allowed[VIEW_SCENE_COUNT];
    bool dragging;
    bool stale;  // the frame on the screen was drawn before the last change of `options`
    double x, y; // last position of the mouse pointer
} window;

// ----------------------------------------------------------------------------------------- loading

static bool find(void *library, const char *name, void *function)
{
    void *symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol;
}

static void *open_library(void)
{
    void *library = dlopen("libglfw.so.3", RTLD_NOW | RTLD_LOCAL);
    return library ? library : dlopen("libglfw.so", RTLD_NOW | RTLD_LOCAL);
}

// GLFW stays loaded until the process ends.
static kiln_result load(glfw_functions *glfw, kiln_error *error)
{
    void *library = open_library();
    if (!library)
        return view_fail(error, KILN_ERROR_UNSUPPORTED,
                         "the library GLFW (libglfw.so.3; Debian: libglfw3) cannot be loaded; the "
                         "window needs GLFW, but kiln render does not");
#define FIND(name)                                                                                 \
    if (!find(library, "glfw" #name, &glfw->name))                                                 \
        return view_fail(error, KILN_ERROR_UNSUPPORTED, "libglfw.so.3 has no glfw" #name);
    GLFW_FUNCTIONS(FIND)
#undef FIND
    return KILN_OK;
}

static view_function lookup(const char *name)
{
    __typeof__(&glfwGetProcAddress) get = NULL;
    return find(open_library(), "glfwGetProcAddress", &get) ? (view_function)get(name) : NULL;
}

// --------------------------------------------------------------------------------------- callbacks

// Callbacks receive only the GLFW handle: GLFW's own function returns the window that was stored
// with it.
static window *of(GLFWwindow *handle)
{
    __typeof__(&glfwGetWindowUserPointer) get = NULL;
    return find(open_library(), "glfwGetWindowUserPointer", &get) ? get(handle) : NULL;
}

static void on_move(GLFWwindow *handle, double x, double y)
{
    window *w = of(handle);
    double right = x - w->x, down = y - w->y;
    int width, height;
    w->glfw.GetWindowSize(handle, &width, &height);
    bool first = w->glfw.GetMouseButton(handle, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    bool second = w->glfw.GetMouseButton(handle, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    bool shift = w->glfw.GetKey(handle, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                 w->glfw.GetKey(handle, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    w->x = x;
    w->y = y;
    if (height < 1 || (!first && !second))
        return;
    if (second || shift)
        view_turn(&w->options, right, height);
    else
        view_orbit(&w->options, right, down, height);
    w->stale = true;
}

// While a button is held, frames are drawn with fewer rays a pixel, which makes dragging smooth.
// Releasing the button draws all rays.
static void on_button(GLFWwindow *handle, int button, int action, int mods)
{
    (void)button;
    (void)mods;
    window *w = of(handle);
    w->dragging = action == GLFW_PRESS;
    w->stale = true;
}

static void on_wheel(GLFWwindow *handle, double x, double y)
{
    (void)x;
    window *w = of(handle);
    view_zoom(&w->options, y);
    w->stale = true;
}

static void on_character(GLFWwindow *handle, unsigned code)
{
    window *w = of(handle);
    if (code == 'h')
        for (int i = 0; view_keys[i]; i++)
            puts(view_keys[i]);
    else if (code == 'q')
        w->glfw.SetWindowShouldClose(handle, GLFW_TRUE);
    else if (code < 128)
        w->stale |= view_key(&w->options, (char)code, w->allowed);
    fflush(stdout);
}

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int mods)
{
    (void)scancode;
    (void)mods;
    window *w = of(handle);
    double step = 24;
    if (action == GLFW_RELEASE)
        return;
    if (key == GLFW_KEY_ESCAPE)
        w->glfw.SetWindowShouldClose(handle, GLFW_TRUE);
    else if (key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT)
        view_orbit(&w->options, key == GLFW_KEY_LEFT ? -step : step, 0, 720);
    else if (key == GLFW_KEY_UP || key == GLFW_KEY_DOWN)
        view_orbit(&w->options, 0, key == GLFW_KEY_UP ? step : -step, 720);
    else
        return;
    w->stale = true;
}

static void on_size(GLFWwindow *handle, int width, int height)
{
    (void)width;
    (void)height;
    of(handle)->stale = true;
}

static void on_refresh(GLFWwindow *handle)
{
    of(handle)->stale = true;
}

// ----------------------------------------------------------------------------------------- opening

static kiln_result say(const window *w, const char *what, kiln_error *error)
{
    const char *why = NULL;
    w->glfw.GetError(&why);
    return view_fail(error, KILN_ERROR_UNSUPPORTED, "%s%s%s", what, why ? ": " : "",
                     why ? why : "");
}

// GLFW 3.4 tries Wayland first. Without XDG_RUNTIME_DIR and WAYLAND_DISPLAY there is no Wayland
// screen to find, and libwayland prints a warning: only X11 is tried then. GLFW 3.3 supports only
// X11 and reports the hint as an error, which is dropped here.
static void choose_platform(const glfw_functions *glfw)
{
#ifdef __linux__
    // values of GLFW_PLATFORM and GLFW_PLATFORM_X11 in GLFW 3.4's header
    enum { PLATFORM = 0x00050003, PLATFORM_X11 = 0x00060004 };
    if (!getenv("XDG_RUNTIME_DIR") && !getenv("WAYLAND_DISPLAY")) {
        glfw->InitHint(PLATFORM, PLATFORM_X11);
        glfw->GetError(NULL);
    }
#else
    (void)glfw;
#endif
}

static kiln_result open_window(window *w, const view_window_def *def, kiln_error *error)
{
    const glfw_functions *glfw = &w->glfw;
    choose_platform(glfw);
    if (!glfw->Init())
        return say(w, "GLFW finds no screen on which a window can open", error);
    glfw->WindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
    glfw->WindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfw->WindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfw->WindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    glfw->WindowHint(GLFW_DEPTH_BITS, 0);
    glfw->WindowHint(GLFW_STENCIL_BITS, 0);
    w->handle = glfw->CreateWindow(def->width ? def->width : 1280, def->height ? def->height : 720,
                                   def->title ? def->title : "kiln", NULL, NULL);
    if (!w->handle)
        return say(w, "GLFW cannot open a window with OpenGL ES 3.0", error);
    glfw->MakeContextCurrent(w->handle);
    glfw->SetWindowUserPointer(w->handle, w);
    glfw->SetCursorPosCallback(w->handle, on_move);
    glfw->SetMouseButtonCallback(w->handle, on_button);
    glfw->SetScrollCallback(w->handle, on_wheel);
    glfw->SetCharCallback(w->handle, on_character);
    glfw->SetKeyCallback(w->handle, on_key);
    glfw->SetFramebufferSizeCallback(w->handle, on_size);
    glfw->SetWindowRefreshCallback(w->handle, on_refresh);
    return KILN_OK;
}

// Reads the window's pixels into a picture: values 0 to 1, row 0 at the top.
static kiln_result shoot(kiln_context *context, int width, int height, kiln_image *image,
                         kiln_error *error)
{
    view_gl gl;
    const char *missing = NULL;
    size_t row = (size_t)width * 4;
    uint8_t *bytes = malloc(row * (size_t)height);
    if (!bytes || !view_gl_load(&gl, lookup, &missing)) {
        free(bytes);
        return view_fail(error, KILN_ERROR_MEMORY,
                         "cannot read the picture of %d x %d from the window", width, height);
    }
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
    kiln_result result = kiln_image_create(context, width, height, 3, image, error);
    for (size_t i = 0; result == KILN_OK && i < (size_t)width * (size_t)height * 3; i++) {
        size_t x = i / 3 % (size_t)width, y = i / 3 / (size_t)width;
        image->pixels[i] = (float)bytes[((size_t)height - 1 - y) * row + 4 * x + i % 3] / 255;
    }
    free(bytes);
    return result;
}

// Shows the progress of the sampled bake in the window's title.
static kiln_result ask_textbook(window *w, const view_window_def *def, view_renderer *renderer,
                                double *done, kiln_error *error)
{
    const char *title = def->title ? def->title : "kiln";
    char words[160];
    kiln_result result = def->textbook(def->user, renderer, def->screenshot != NULL, done, error);
    snprintf(words, sizeof words, "%.100s: %.0f %% of the textbook's bake is done", title,
             100 * *done);
    w->glfw.SetWindowTitle(w->handle, *done < 1 ? words : title);
    w->stale |= *done == 1;
    return result;
}

static kiln_result loop(window *w, kiln_context *context, const view_window_def *def,
                        view_renderer *renderer, kiln_error *error)
{
    double textbook = 0; // finished share of the sampled bake, 0 to 1
    w->stale = true;
    while (!w->glfw.WindowShouldClose(w->handle) && (!def->go_on || def->go_on(def->user))) {
        int width, height;
        if (w->options.scene == VIEW_SCENE_COMPARE && def->textbook && textbook < 1) {
            kiln_result result = ask_textbook(w, def, renderer, &textbook, error);
            if (result != KILN_OK)
                return result;
        }
        w->glfw.GetFramebufferSize(w->handle, &width, &height);
        if (w->stale && width > 0 && height > 0) {
            view_options o = w->options;
            if (w->dragging)
                o.samples = 1;
            w->stale = false;
            kiln_result result = view_prepare(renderer, &o, error);
            if (result != KILN_OK)
                return result;
            view_draw(renderer, &o, width, height);
            if (def->screenshot)
                return shoot(context, width, height, def->screenshot, error);
            w->glfw.SwapBuffers(w->handle);
        }
        w->glfw.WaitEventsTimeout(0.1);
    }
    return KILN_OK;
}

kiln_result view_window(kiln_context *context, const view_window_def *def, kiln_error *error)
{
    window w = {.options = def->options,
                .allowed = {true, def->has_environment, true, def->has_environment, def->textbook}};
    view_renderer *renderer = NULL;
    kiln_result result = load(&w.glfw, error);
    if (result != KILN_OK)
        return result;
    result = open_window(&w, def, error);
    if (result == KILN_OK)
        result = view_create(context, lookup, &renderer, error);
    if (result == KILN_OK && def->prepare)
        result = def->prepare(def->user, renderer, error);
    if (result == KILN_OK)
        result = loop(&w, context, def, renderer, error);
    view_destroy(renderer);
    if (w.handle)
        w.glfw.DestroyWindow(w.handle);
    w.glfw.Terminate();
    return result;
}
