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
    bool stale;  // what is seen is not what `options` says
    double x, y; // of the mouse
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

// Stays loaded until the process ends.
static kiln_result load(glfw_functions *glfw, kiln_error *error)
{
    void *library = open_library();
    if (!library)
        return view_fail(error, KILN_ERROR_UNSUPPORTED,
                         "there is no GLFW here (libglfw.so.3; Debian: libglfw3): the window needs "
                         "it; kiln render does not");
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

// ---------------------------------------------------------------------------------------- the hands

// GLFW hands the window's pointer to callbacks only through a function of its own.
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

// While a button is held, fewer rays make it quick; afterwards all are drawn.
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

// ------------------------------------------------------------------------------------------ opening

static kiln_result say(const window *w, const char *what, kiln_error *error)
{
    const char *why = NULL;
    w->glfw.GetError(&why);
    return view_fail(error, KILN_ERROR_UNSUPPORTED, "%s%s%s", what, why ? ": " : "",
                     why ? why : "");
}

// GLFW 3.4 asks for a Wayland screen first, and libwayland prints a line of its own where the folder
// of Wayland's sockets is not named. No such screen can be found then, so only X11 is asked. GLFW 3.3
// knows no such hint, which is an error that is dropped here, and asks X11 alone.
static void choose_platform(const glfw_functions *glfw)
{
#ifdef __linux__
    enum { PLATFORM = 0x00050003, PLATFORM_X11 = 0x00060004 }; // as in the header of GLFW 3.4
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
        return say(w, "GLFW finds no screen to open a window on", error);
    glfw->WindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
    glfw->WindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfw->WindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfw->WindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    glfw->WindowHint(GLFW_DEPTH_BITS, 0);
    glfw->WindowHint(GLFW_STENCIL_BITS, 0);
    w->handle = glfw->CreateWindow(def->width ? def->width : 1280, def->height ? def->height : 720,
                                   def->title ? def->title : "kiln", NULL, NULL);
    if (!w->handle)
        return say(w, "GLFW makes no window with OpenGL ES 3.0", error);
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

// The window's pixels, 0 to 1, row 0 at the top.
static kiln_result shoot(kiln_context *context, int width, int height, kiln_image *image,
                         kiln_error *error)
{
    view_gl gl;
    const char *missing = NULL;
    size_t row = (size_t)width * 4;
    uint8_t *bytes = malloc(row * (size_t)height);
    if (!bytes || !view_gl_load(&gl, lookup, &missing)) {
        free(bytes);
        return view_fail(error, KILN_ERROR_MEMORY, "cannot read the window of %d x %d", width,
                         height);
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

// The textbook's bake takes a while: the title says how far it is.
static kiln_result ask_textbook(window *w, const view_window_def *def, view_renderer *renderer,
                                double *done, kiln_error *error)
{
    const char *title = def->title ? def->title : "kiln";
    char words[160];
    kiln_result result = def->textbook(def->user, renderer, def->screenshot != NULL, done, error);
    snprintf(words, sizeof words, "%.100s: the textbook bakes, %.0f %%", title, 100 * *done);
    w->glfw.SetWindowTitle(w->handle, *done < 1 ? words : title);
    w->stale |= *done == 1;
    return result;
}

static kiln_result loop(window *w, kiln_context *context, const view_window_def *def,
                        view_renderer *renderer, kiln_error *error)
{
    double textbook = 0; // how much of its bake is done
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
