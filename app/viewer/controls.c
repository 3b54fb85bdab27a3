// Mouse and keys in the image: flying, orbits, picking, the split line.
#include "controls.h"

#include "command.h"
#include "viewer/scene/opening.h"
#include "operations.h"
#include "viewer/methods/running.h"
#include "viewer/scene/undo.h"

#include <GLFW/glfw3.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LEFT, RIGHT, MIDDLE };
enum { FRAMES_OF_A_PICK = 4 }; // until one is finished
static const float RADIANS_PER_PIXEL = 0.004f, SPLIT_PIXELS = 6.0f;

static bool in_image(const struct viewer *v)
{
    const struct region r = viewer_region(v);
    return v->mouse_x >= r.x0 && v->mouse_x < r.x1 && v->mouse_y >= r.y0 && v->mouse_y < r.y1 &&
           !interface_wants_mouse();
}

static bool on_split(const struct viewer *v)
{
    const struct region r = viewer_region(v);
    return viewer_is_divided(v) && !v->side_by_side &&
           fabsf(v->mouse_x - (r.x0 + v->split_at * (r.x1 - r.x0))) < SPLIT_PIXELS;
}

static void move_mouse(struct viewer *v, float x, float y)
{
    const float dx = x - v->mouse_from_x, dy = y - v->mouse_y;
    const struct region r = viewer_region(v);
    v->mouse_from_x = x;
    v->mouse_right = viewer_is_side_by_side(v) && x >= r.x1 && x < r.x1 + (r.x1 - r.x0);
    if (v->mouse_right) x -= r.x1 - r.x0;
    v->mouse_x = x;
    v->mouse_y = y;
    if (v->gizmo.held) gizmo_drag(v);
    if (in_image(v)) gizmo_hover(v);
    paint_move(v);
    if (v->dragging_split) v->split_at = fminf(fmaxf((x - r.x0) / (r.x1 - r.x0), 0.0f), 1.0f);
    if (v->inspecting && in_image(v) && v->dirty < FRAMES_OF_A_PICK) v->dirty = FRAMES_OF_A_PICK;
    if (!v->turning && !v->orbiting) return;
    const float scale = RADIANS_PER_PIXEL / window_scale(v->window);
    if (v->orbiting)
        look_orbit(&v->look, -scale * dx, -scale * dy);
    else
        look_turn(&v->look, -scale * dx, -scale * dy);
    viewer_change(v);
}

// A frame tells which surface is there.
static void pick(struct viewer *v)
{
    v->picking = true;
    v->pick_right = v->mouse_right;
    v->pick_at[0] = (int)(v->scale * v->mouse_x);
    v->pick_at[1] = (int)(v->scale * v->mouse_y);
    if (v->dirty < FRAMES_OF_A_PICK) v->dirty = FRAMES_OF_A_PICK;
}

static void press(struct viewer *v, int button, bool down)
{
    if (!down) {
        if (button == RIGHT && v->turning) window_capture_mouse(v->window, v->turning = false);
        if (button == MIDDLE) v->orbiting = false;
        if (button == LEFT) v->dragging_split = v->orbiting = false;
        if (button == LEFT) gizmo_release(v);
        if (button == LEFT) paint_release(v);
        return;
    }
    if (!in_image(v)) return;
    if (button == RIGHT) window_capture_mouse(v->window, v->turning = true);
    if (button == MIDDLE) v->orbiting = true;
    if (button != LEFT) return;
    if (on_split(v))
        v->dragging_split = true;
    else if (v->keys[GLFW_KEY_LEFT_ALT])
        v->orbiting = true;
    else if (!paint_press(v) && !gizmo_press(v))
        pick(v);
}

// The sphere around an instance, or around the whole scene.
static void focus(struct viewer *v)
{
    struct ag_instance_info instance;
    struct ag_mesh_info mesh;
    struct ag_scene_info info;
    float centre[3], radius = 0, least[3], most[3];
    if (ag_scene_get_info(v->desc->scene, v->desc->animation, v->time_s, &info) != AG_OK) return;
    memcpy(least, info.bounds_min, sizeof least);
    memcpy(most, info.bounds_max, sizeof most);
    float world[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    if (v->picked_instance >= 0 &&
        ag_scene_get_instance(v->desc->scene, v->picked_instance, v->desc->animation, v->time_s,
                              &instance) == AG_OK &&
        ag_scene_get_mesh(v->desc->scene, instance.mesh, &mesh) == AG_OK) {
        memcpy(least, mesh.bounds_min, sizeof least);
        memcpy(most, mesh.bounds_max, sizeof most);
        memcpy(world, instance.world_from_mesh, sizeof world);
    }
    float half[3], middle[3], scale = 0;
    for (int i = 0; i < 3; i++) {
        half[i] = 0.5f * (most[i] - least[i]);
        middle[i] = 0.5f * (most[i] + least[i]);
        radius += half[i] * half[i];
    }
    for (int i = 0; i < 3; i++) {
        centre[i] = world[12 + i];
        for (int k = 0; k < 3; k++) centre[i] += world[4 * k + i] * middle[k];
        scale =
            fmaxf(scale, sqrtf(world[4 * i] * world[4 * i] + world[4 * i + 1] * world[4 * i + 1] +
                               world[4 * i + 2] * world[4 * i + 2]));
    }
    look_focus(&v->look, centre, scale * sqrtf(radius));
    viewer_change(v);
}

static void press_control_key(struct viewer *v, int key)
{
    if (key == GLFW_KEY_Y || (key == GLFW_KEY_Z && v->keys[GLFW_KEY_LEFT_SHIFT]))
        undo_forward(v);
    else if (key == GLFW_KEY_Z)
        undo_back(v);
}

static void press_key(struct viewer *v, int key, bool down)
{
    if (key >= 0 && key < (int)(sizeof v->keys / sizeof *v->keys)) v->keys[key] = down;
    if (!down || interface_wants_keys()) return;
    if (v->keys[GLFW_KEY_LEFT_CONTROL] || v->keys[GLFW_KEY_RIGHT_CONTROL]) {
        press_control_key(v, key);
        return;
    }
    if (key == GLFW_KEY_ESCAPE) record_end(v);
    if (key == GLFW_KEY_F) focus(v);
    if (key == GLFW_KEY_HOME) viewer_set_camera(v, v->scene_camera);
    if (key == GLFW_KEY_SPACE) v->playing = !v->playing;
    if (key == GLFW_KEY_F12) viewer_write(v, "afterglow.png");
}

void controls_event(struct viewer *v, const struct event *event)
{
    switch (event->kind) {
    case EVENT_MOUSE:
        move_mouse(v, event->x, event->y);
        break;
    case EVENT_BUTTON:
        press(v, event->code, event->down);
        break;
    case EVENT_KEY:
        press_key(v, event->code, event->down);
        break;
    case EVENT_SCROLL:
        if (!in_image(v)) break;
        if (v->turning) // while it flies: its speed
            v->look.speed = fminf(fmaxf(v->look.speed * powf(1.2f, event->y), 1e-3f), 1e5f);
        else
            look_zoom(&v->look, event->y);
        viewer_change(v);
        break;
    case EVENT_FOCUS:
        if (event->down) break;
        memset(v->keys, 0, sizeof v->keys); // their releases go to another window
        if (v->turning) window_capture_mouse(v->window, v->turning = false);
        break;
    case EVENT_DROP:
        viewer_open(v, event->text);
        break;
    case EVENT_TEXT:
        break;
    }
}

void controls_step(struct viewer *v, float seconds)
{
    const bool *keys = v->keys;
    if (interface_wants_keys() || keys[GLFW_KEY_LEFT_CONTROL]) return;
    const int right = keys[GLFW_KEY_D] - keys[GLFW_KEY_A];
    const int up = keys[GLFW_KEY_E] - keys[GLFW_KEY_Q];
    const int forward = keys[GLFW_KEY_W] - keys[GLFW_KEY_S];
    if (!right && !up && !forward) return;
    const float metres = v->look.speed * seconds * (keys[GLFW_KEY_LEFT_SHIFT] ? 4.0f : 1.0f);
    look_move(&v->look, metres * (float)right, metres * (float)up, metres * (float)forward);
    viewer_change(v);
}
