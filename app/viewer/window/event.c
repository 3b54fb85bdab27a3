#include "event.h"

#include <GLFW/glfw3.h>

#include <string.h>

void event_push(struct event_queue *queue, const struct event *event)
{
    if (queue->count > 0 && event->kind == EVENT_MOUSE &&
        queue->events[queue->count - 1].kind == EVENT_MOUSE)
        queue->count--; // the later position
    if (queue->count < EVENT_CAPACITY) queue->events[queue->count++] = *event;
}

static const struct {
    const char *name;
    int code;
} keys[] = {
    { "space", GLFW_KEY_SPACE },
    { "escape", GLFW_KEY_ESCAPE },
    { "enter", GLFW_KEY_ENTER },
    { "tab", GLFW_KEY_TAB },
    { "backspace", GLFW_KEY_BACKSPACE },
    { "delete", GLFW_KEY_DELETE },
    { "left", GLFW_KEY_LEFT },
    { "right", GLFW_KEY_RIGHT },
    { "up", GLFW_KEY_UP },
    { "down", GLFW_KEY_DOWN },
    { "home", GLFW_KEY_HOME },
    { "end", GLFW_KEY_END },
    { "pageup", GLFW_KEY_PAGE_UP },
    { "pagedown", GLFW_KEY_PAGE_DOWN },
    { "shift", GLFW_KEY_LEFT_SHIFT },
    { "control", GLFW_KEY_LEFT_CONTROL },
    { "f1", GLFW_KEY_F1 },
    { "f2", GLFW_KEY_F2 },
    { "f5", GLFW_KEY_F5 },
    { "f11", GLFW_KEY_F11 },
    { "f12", GLFW_KEY_F12 },
};

int event_key_code(const char *name)
{
    if (name[0] && !name[1]) {
        if (name[0] >= 'a' && name[0] <= 'z') return GLFW_KEY_A + (name[0] - 'a');
        if (name[0] >= '0' && name[0] <= '9') return GLFW_KEY_0 + (name[0] - '0');
    }
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcmp(keys[i].name, name) == 0) return keys[i].code;
    return 0;
}
