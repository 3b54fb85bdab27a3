// Handles in the image: arrows move the chosen light or instance along an axis, a fourth handle
// turns it; a block has one for each face. Lights have them while the tab Light is shown, instances
// in the tab Inspect, blocks in the tab Method.
#pragma once

#include <stdbool.h>

struct viewer;

enum gizmo_handle {
    HANDLE_NONE = -1,
    HANDLE_X,
    HANDLE_Y,
    HANDLE_Z,
    HANDLE_TURN,
    HANDLE_FACE, // the first of six
    HANDLE_COUNT = HANDLE_FACE + 6
};

struct gizmo {
    int light;                // chosen; -1: none
    enum gizmo_handle handle; // under the mouse, or held
    bool held;
    float mouse_x;      // where it was taken, pixels of the window
    float centre[3];    // of the handles then
    float direction[3]; // of the axis along which it is moved
    float along;        // place on that axis, m: then, of a face so far
    float world[16];    // of the instance then
    float position[3];  // of the light then
};

extern const char *const gizmo_handles[HANDLE_COUNT]; // "x", "turn", "-x" …

void gizmo_draw(struct viewer *v);
// The pixel of the window at which a handle is; false: it is not shown.
bool gizmo_find(struct viewer *v, enum gizmo_handle handle, float *x, float *y);
void gizmo_hover(struct viewer *v); // the mouse has moved
// Takes the handle or chooses the light under the mouse; false: there is none.
bool gizmo_press(struct viewer *v);
void gizmo_drag(struct viewer *v);
void gizmo_release(struct viewer *v);
