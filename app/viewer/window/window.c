#include "window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct window {
    GLFWwindow *handle;
    struct event_queue *queue; // during window_poll
};

static char last_error[256]; // of GLFW

static void remember_error(int code, const char *text)
{
    (void)code;
    snprintf(last_error, sizeof last_error, "%s", text);
}

// ---- callbacks

static void push(GLFWwindow *handle, const struct event *event)
{
    struct window *window = glfwGetWindowUserPointer(handle);
    if (window->queue) event_push(window->queue, event);
}

// Positions come in the window's units, which differ from pixels on some displays.
static void on_mouse(GLFWwindow *handle, double x, double y)
{
    int width, height, pixels_x, pixels_y;
    glfwGetWindowSize(handle, &width, &height);
    glfwGetFramebufferSize(handle, &pixels_x, &pixels_y);
    if (width <= 0 || height <= 0) return;
    push(handle, &(struct event){ .kind = EVENT_MOUSE,
                                  .x = (float)(x * pixels_x / width),
                                  .y = (float)(y * pixels_y / height) });
}

static void on_button(GLFWwindow *handle, int button, int action, int modifiers)
{
    (void)modifiers;
    push(handle,
         &(struct event){ .kind = EVENT_BUTTON, .code = button, .down = action == GLFW_PRESS });
}

static void on_scroll(GLFWwindow *handle, double x, double y)
{
    push(handle, &(struct event){ .kind = EVENT_SCROLL, .x = (float)x, .y = (float)y });
}

static int modifier_bits(int modifiers)
{
    return (modifiers & GLFW_MOD_SHIFT ? MODIFIER_SHIFT : 0) |
           (modifiers & GLFW_MOD_CONTROL ? MODIFIER_CONTROL : 0) |
           (modifiers & GLFW_MOD_ALT ? MODIFIER_ALT : 0);
}

// Keys that move are where they are on the keyboard; with control they are the letter on the key.
static int key_code(int key, int scan_code, int modifiers)
{
    const char *name = modifiers & GLFW_MOD_CONTROL ? glfwGetKeyName(key, scan_code) : NULL;
    const bool letter = name && name[0] >= 'a' && name[0] <= 'z' && name[1] == 0;
    return letter ? GLFW_KEY_A + name[0] - 'a' : key;
}

static void on_key(GLFWwindow *handle, int key, int scan_code, int action, int modifiers)
{
    if (key == GLFW_KEY_UNKNOWN) return;
    push(handle, &(struct event){ .kind = EVENT_KEY,
                                  .code = key_code(key, scan_code, modifiers),
                                  .down = action != GLFW_RELEASE,
                                  .modifiers = modifier_bits(modifiers) });
}

static void on_character(GLFWwindow *handle, unsigned character)
{
    push(handle, &(struct event){ .kind = EVENT_TEXT, .code = (int)character });
}

static void on_drop(GLFWwindow *handle, int count, const char **paths)
{
    struct event event = { .kind = EVENT_DROP };
    if (count < 1 || strlen(paths[0]) >= sizeof event.text) return;
    strcpy(event.text, paths[0]);
    push(handle, &event);
}

static void on_focus(GLFWwindow *handle, int focused)
{
    push(handle, &(struct event){ .kind = EVENT_FOCUS, .down = focused == GLFW_TRUE });
}

// ---- the window

static struct window *fail(struct window *window, char error[512], const char *what,
                           const char *remedy)
{
    snprintf(error, 512, "cannot open a window: %s%s%s%s; %s", what, last_error[0] ? " (" : "",
             last_error, last_error[0] ? ")" : "", remedy);
    window_close(window);
    return NULL;
}

static bool is_set(const char *variable)
{
    const char *value = getenv(variable);
    return value && value[0];
}

// Without a Wayland display GLFW must not look for one: libwayland prints a line of its own.
static bool begin(void)
{
    if (!is_set("WAYLAND_DISPLAY") && !is_set("DISPLAY")) return false;
#ifdef GLFW_PLATFORM // since GLFW 3.4
    if (!is_set("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    return glfwInit() == GLFW_TRUE;
}

struct window *window_open(const char *title, int width, int height, char error[512])
{
    struct window *window = calloc(1, sizeof *window);
    last_error[0] = 0;
    glfwSetErrorCallback(remember_error);
    if (!window || !begin())
        return fail(window, error, "there is no display",
                    "set DISPLAY or WAYLAND_DISPLAY, or use afterglow render");
    if (!glfwVulkanSupported())
        return fail(window, error, "the display system cannot show Vulkan images",
                    "use afterglow render");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window->handle = glfwCreateWindow(width, height, title, NULL, NULL);
    if (!window->handle)
        return fail(window, error, "the display refuses one", "use afterglow render");
    glfwSetWindowUserPointer(window->handle, window);
    glfwSetCursorPosCallback(window->handle, on_mouse);
    glfwSetMouseButtonCallback(window->handle, on_button);
    glfwSetScrollCallback(window->handle, on_scroll);
    glfwSetKeyCallback(window->handle, on_key);
    glfwSetCharCallback(window->handle, on_character);
    glfwSetDropCallback(window->handle, on_drop);
    glfwSetWindowFocusCallback(window->handle, on_focus);
    glfwSetWindowSizeLimits(window->handle, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    return window;
}

void window_close(struct window *window)
{
    if (window && window->handle) glfwDestroyWindow(window->handle);
    free(window);
    glfwTerminate();
}

const char **window_extensions(uint32_t *count)
{
    return glfwGetRequiredInstanceExtensions(count);
}

bool window_surface(struct window *window, VkInstance instance, VkSurfaceKHR *out)
{
    return glfwCreateWindowSurface(instance, window->handle, NULL, out) == VK_SUCCESS;
}

void window_poll(struct window *window, double wait_s, struct event_queue *queue)
{
    window->queue = queue;
    if (wait_s > 0)
        glfwWaitEventsTimeout(wait_s);
    else
        glfwPollEvents();
    window->queue = NULL;
}

bool window_should_close(const struct window *window)
{
    return glfwWindowShouldClose(window->handle);
}

void window_wake(void)
{
    glfwPostEmptyEvent();
}

void window_pixels(const struct window *window, int *width, int *height)
{
    glfwGetFramebufferSize(window->handle, width, height);
    if (glfwGetWindowAttrib(window->handle, GLFW_ICONIFIED)) *width = *height = 0;
}

float window_scale(const struct window *window)
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(window->handle, &x, &y);
    return x > 0.5f && x < 8.0f ? x : 1.0f;
}

void window_resize(struct window *window, int width, int height)
{
    glfwSetWindowSize(window->handle, width, height);
}

void window_title(struct window *window, const char *title)
{
    glfwSetWindowTitle(window->handle, title);
}

void window_capture_mouse(struct window *window, bool capture)
{
    glfwSetInputMode(window->handle, GLFW_CURSOR,
                     capture ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

const char *window_clipboard(struct window *window)
{
    const char *text = glfwGetClipboardString(window->handle);
    return text ? text : "";
}

void window_set_clipboard(struct window *window, const char *text)
{
    glfwSetClipboardString(window->handle, text);
}

double window_seconds(void)
{
    return glfwGetTime();
}
