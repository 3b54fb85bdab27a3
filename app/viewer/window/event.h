// Input of the window or of a script: mouse, keys, characters, dropped files.
#pragma once

#include <stdbool.h>

enum event_kind {
    EVENT_MOUSE,  // x, y: pixels of the window from the left and the top
    EVENT_BUTTON, // code: button, 0 left, 1 right, 2 middle
    EVENT_SCROLL, // x, y: steps
    EVENT_KEY,    // code: of GLFW
    EVENT_TEXT,   // code: a Unicode character
    EVENT_DROP,   // text: a path
    EVENT_FOCUS,  // down: the window has the keyboard
};

enum event_modifier { MODIFIER_SHIFT = 1, MODIFIER_CONTROL = 2, MODIFIER_ALT = 4 };

struct event {
    enum event_kind kind;
    float x, y;
    int code;
    int modifiers; // of keys: bits of event_modifier
    bool down;     // buttons and keys
    char text[1024];
};

// Events in the order of their arrival. A full queue drops mouse positions first, then all others.
enum { EVENT_CAPACITY = 256 };
struct event_queue {
    struct event events[EVENT_CAPACITY];
    int count;
};

void event_push(struct event_queue *queue, const struct event *event);
// The GLFW code of a key's name: "w", "5", "f1", "escape", "left" …; 0: unknown.
int event_key_code(const char *name);
