// The window: GLFW, its events and its Vulkan surface.
#pragma once

#include "event.h"

#include <stdbool.h>
#include <vulkan/vulkan.h>

struct window;

// NULL, with a sentence in `error`: no display, or none that shows Vulkan.
struct window *window_open(const char *title, int width, int height, char error[512]);
void window_close(struct window *window);
// Extensions that the instance must enable; owned by GLFW.
const char **window_extensions(uint32_t *count);
bool window_surface(struct window *window, VkInstance instance, VkSurfaceKHR *out);

// Waits for events up to `wait_s` seconds, 0: not at all, and appends them to the queue.
void window_poll(struct window *window, double wait_s, struct event_queue *queue);
bool window_should_close(const struct window *window);
// Ends a wait of window_poll, from any thread.
void window_wake(void);
// Pixels of the image that is shown; 0×0 while minimised.
void window_pixels(const struct window *window, int *width, int *height);
// Pixels per unit of the interface: 1, or 2 where the display has twice as many.
float window_scale(const struct window *window);
void window_resize(struct window *window, int width, int height);
void window_title(struct window *window, const char *title);
// The mouse is hidden and moves without bounds while it turns the camera.
void window_capture_mouse(struct window *window, bool capture);
// The text must not be changed; valid until the next call. "" if there is none.
const char *window_clipboard(struct window *window);
void window_set_clipboard(struct window *window, const char *text);
double window_seconds(void);
