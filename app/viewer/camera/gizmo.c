#include "gizmo.h"

#include "viewer/blocks/block_edit.h"
#include "viewer/scene/changes.h"
#include "vectors.h"
#include "viewer/operations.h"

#include <math.h>
#include <string.h>

static const float ARROW = 0.13f;       // length over the height of the image
static const float TURN = 1.8f;         // distance of the fourth handle over that length
static const float GRASP_PIXELS = 9.0f; // of the mouse from a handle's end
static const float RADIANS_PER_PIXEL = 0.01f;
static const uint32_t colors[HANDLE_COUNT] = { 0xff5050ff, 0x60e060ff, 0x5090ffff, 0xffe080ff,
                                               0xff5050ff, 0xff5050ff, 0x60e060ff, 0x60e060ff,
                                               0x5090ffff, 0x5090ffff };
static const uint32_t ACTIVE = 0xffffffff;

const char *const gizmo_handles[HANDLE_COUNT] = { "x",  "y",  "z",  "turn", "-x",
                                                  "+x", "-y", "+y", "-z",   "+z" };

// ---- what has handles

enum target_kind { TARGET_LIGHT, TARGET_INSTANCE, TARGET_BLOCK };

struct target {
    enum target_kind kind;
    int index;
    struct ag_light_desc light; // of a light; its direction is a unit vector
    float world[16];            // of an instance
    const struct block *block;
    float centre[3]; // of the handles
};

static bool find_light(struct viewer *v, struct target *out)
{
    struct ag_light_info info;
    out->kind = TARGET_LIGHT;
    out->index = v->gizmo.light;
    if (!edits_has_light(&v->edits, out->index) ||
        ag_scene_get_light(v->desc->scene, out->index, v->desc->animation, v->time_s, &info) !=
            AG_OK)
        return false;
    out->light = info.light;
    vec_normalize(out->light.direction);
    memcpy(out->centre, info.light.position, sizeof out->centre);
    if (info.light.type == AG_LIGHT_SUN) look_target(&v->look, out->centre); // it has no place
    return true;
}

static bool find_instance(struct viewer *v, struct target *out)
{
    struct ag_instance_info instance;
    struct ag_mesh_info mesh;
    out->kind = TARGET_INSTANCE;
    out->index = v->picked_instance;
    if (out->index < 0 ||
        ag_scene_get_instance(v->desc->scene, out->index, v->desc->animation, v->time_s,
                              &instance) != AG_OK ||
        instance.skinned || ag_scene_get_mesh(v->desc->scene, instance.mesh, &mesh) != AG_OK)
        return false;
    memcpy(out->world, instance.world_from_mesh, sizeof out->world);
    for (int i = 0; i < 3; i++) {
        out->centre[i] = out->world[12 + i];
        for (int k = 0; k < 3; k++)
            out->centre[i] +=
                out->world[4 * k + i] * 0.5f * (mesh.bounds_min[k] + mesh.bounds_max[k]);
    }
    return true;
}

static bool find_block(struct viewer *v, struct target *out)
{
    out->kind = TARGET_BLOCK;
    out->block = block_edit_chosen(v);
    if (!out->block) return false;
    block_centre(out->block, out->centre);
    return true;
}

static bool find(struct viewer *v, struct target *out)
{
    if (v->lighting) return find_light(v, out);
    return v->inspecting ? find_instance(v, out) : v->block_edit.shown && find_block(v, out);
}

static bool is_light(const struct target *target, enum ag_light_type type)
{
    return target->kind == TARGET_LIGHT && target->light.type == type;
}

static bool has(const struct target *target, enum gizmo_handle handle)
{
    if (target->kind == TARGET_BLOCK || handle >= HANDLE_FACE)
        return target->kind == TARGET_BLOCK && handle >= HANDLE_FACE;
    return handle == HANDLE_TURN ? !is_light(target, AG_LIGHT_POINT)
                                 : !is_light(target, AG_LIGHT_SUN);
}

// ---- places of handles

static float arrow_length(const struct viewer *v, const float centre[3])
{
    float forward[3], to[3];
    look_forward(&v->look, forward);
    for (int i = 0; i < 3; i++) to[i] = centre[i] - v->look.eye[i];
    const float depth = fmaxf(vec_dot(to, forward), 1e-3f);
    return 2.0f * ARROW * depth * tanf(0.5f * v->look.fov_deg * 0.01745329f);
}

static void handle_end(const struct viewer *v, const struct target *target,
                       enum gizmo_handle handle, float out[3])
{
    const float length = arrow_length(v, target->centre);
    float direction[3] = { 0 };
    if (handle >= HANDLE_FACE) {
        block_face_centre(target->block, handle - HANDLE_FACE, out);
        return;
    }
    if (handle != HANDLE_TURN) {
        direction[handle] = 1;
        vec_along(target->centre, length, direction, out);
        return;
    }
    // A spot points to its handle, a sun shines from it, an instance turns around the vertical.
    const float sign = is_light(target, AG_LIGHT_SUN) ? -1.0f : 1.0f;
    for (int i = 0; i < 3; i++)
        direction[i] = target->kind == TARGET_LIGHT ? sign * target->light.direction[i]
                       : i != 1                     ? 0.7071f
                                                    : 0;
    vec_along(target->centre, TURN * length, direction, out);
}

static enum gizmo_handle handle_at(struct viewer *v, const struct target *target)
{
    enum gizmo_handle best = HANDLE_NONE;
    float least = GRASP_PIXELS * window_scale(v->window);
    for (int i = 0; i < HANDLE_COUNT; i++) {
        float end[3], x, y;
        if (!has(target, (enum gizmo_handle)i)) continue;
        handle_end(v, target, (enum gizmo_handle)i, end);
        if (!viewer_project(v, end, &x, &y)) continue;
        const float distance = hypotf(v->mouse_x - x, v->mouse_y - y);
        if (distance >= least) continue;
        least = distance;
        best = (enum gizmo_handle)i;
    }
    return best;
}

// ---- drawing

static void draw_handle(struct viewer *v, const struct target *target, enum gizmo_handle handle)
{
    float end[3], x0, y0, x1, y1;
    if (!has(target, handle)) return;
    handle_end(v, target, handle, end);
    if (!viewer_project(v, target->centre, &x0, &y0) || !viewer_project(v, end, &x1, &y1)) return;
    const float scale = window_scale(v->window);
    const uint32_t color = v->gizmo.handle == handle ? ACTIVE : colors[handle];
    ui_stroke(x0, y0, x1, y1, color, 2.0f * scale);
    ui_disk(x1, y1, 6.0f * scale, 0x101012c0);
    ui_disk(x1, y1, 5.0f * scale, color);
}

void gizmo_draw(struct viewer *v)
{
    struct target target;
    if (!find(v, &target)) return;
    for (int i = 0; i < HANDLE_COUNT; i++) draw_handle(v, &target, (enum gizmo_handle)i);
}

bool gizmo_find(struct viewer *v, enum gizmo_handle handle, float *x, float *y)
{
    struct target target;
    float end[3];
    if (!find(v, &target) || !has(&target, handle)) return false;
    handle_end(v, &target, handle, end);
    return viewer_project(v, end, x, y);
}

// ---- dragging

// The place on the axis that is nearest to the ray under the mouse; false: the axis points at the
// camera.
static bool place_on_axis(const struct viewer *v, const float centre[3], const float direction[3],
                          float *out)
{
    float eye[3], ray[3], from_eye[3];
    viewer_ray(v, v->mouse_x, v->mouse_y, eye, ray);
    for (int i = 0; i < 3; i++) from_eye[i] = centre[i] - eye[i];
    const float b = vec_dot(direction, ray), span = 1.0f - b * b;
    if (span < 1e-3f) return false;
    *out = (b * vec_dot(ray, from_eye) - vec_dot(direction, from_eye)) / span;
    return true;
}

// The direction to the point at which the ray under the mouse meets the sphere of the fourth
// handle, on the side of `before`.
static void direction_at(const struct viewer *v, const float centre[3], const float before[3],
                         float out[3])
{
    const float radius = TURN * arrow_length(v, centre);
    float eye[3], ray[3], to[3], best = -2.0f;
    viewer_ray(v, v->mouse_x, v->mouse_y, eye, ray);
    for (int i = 0; i < 3; i++) to[i] = centre[i] - eye[i];
    const float nearest = vec_dot(to, ray);
    const float half = sqrtf(fmaxf(radius * radius - vec_dot(to, to) + nearest * nearest, 0.0f));
    for (int sign = -1; sign <= 1; sign += 2) {
        float point[3];
        vec_along(eye, nearest + (float)sign * half, ray, point);
        for (int i = 0; i < 3; i++) point[i] -= centre[i];
        vec_normalize(point);
        if (vec_dot(point, before) <= best) continue;
        best = vec_dot(point, before);
        memcpy(out, point, sizeof point);
    }
}

static void turn_light(struct viewer *v, struct target *target)
{
    struct ag_light_desc *light = &target->light;
    const float sign = light->type == AG_LIGHT_SUN ? -1.0f : 1.0f;
    float before[3];
    for (int i = 0; i < 3; i++) before[i] = sign * light->direction[i];
    direction_at(v, v->gizmo.centre, before, light->direction);
    for (int i = 0; i < 3; i++) light->direction[i] *= sign;
    viewer_set_light(v, target->index, light);
}

// Around the vertical axis through the centre.
static void turn_instance(struct viewer *v, const struct target *target)
{
    const struct gizmo *gizmo = &v->gizmo;
    const float angle = RADIANS_PER_PIXEL * (v->mouse_x - gizmo->mouse_x) / window_scale(v->window);
    const float c = cosf(angle), s = sinf(angle);
    float world[16];
    for (int column = 0; column < 4; column++) {
        const float *from = gizmo->world + 4 * column;
        const float ox = column == 3 ? gizmo->centre[0] : 0,
                    oz = column == 3 ? gizmo->centre[2] : 0;
        const float x = from[0] - ox, z = from[2] - oz;
        world[4 * column] = ox + c * x + s * z;
        world[4 * column + 1] = from[1];
        world[4 * column + 2] = oz - s * x + c * z;
        world[4 * column + 3] = from[3];
    }
    viewer_move_instance(v, target->index, world);
}

static void move_face(struct viewer *v, float place)
{
    struct gizmo *gizmo = &v->gizmo;
    float by[3];
    for (int i = 0; i < 3; i++) by[i] = (place - gizmo->along) * gizmo->direction[i];
    if (block_edit_move_face(v, gizmo->handle - HANDLE_FACE, by)) gizmo->along = place;
}

static void move(struct viewer *v, struct target *target)
{
    const struct gizmo *gizmo = &v->gizmo;
    float place;
    if (!place_on_axis(v, gizmo->centre, gizmo->direction, &place)) return;
    const float by = place - gizmo->along;
    if (target->kind == TARGET_BLOCK) {
        move_face(v, place);
    } else if (target->kind == TARGET_LIGHT) {
        memcpy(target->light.position, gizmo->position, sizeof gizmo->position);
        target->light.position[gizmo->handle] += by;
        viewer_set_light(v, target->index, &target->light);
    } else {
        float world[16];
        memcpy(world, gizmo->world, sizeof world);
        world[12 + gizmo->handle] += by;
        viewer_move_instance(v, target->index, world);
    }
}

void gizmo_drag(struct viewer *v)
{
    struct target target;
    if (!v->gizmo.held || !find(v, &target)) return;
    if (v->gizmo.handle != HANDLE_TURN)
        move(v, &target);
    else if (target.kind == TARGET_LIGHT)
        turn_light(v, &target);
    else
        turn_instance(v, &target);
}

void gizmo_hover(struct viewer *v)
{
    struct target target;
    if (!v->gizmo.held) v->gizmo.handle = find(v, &target) ? handle_at(v, &target) : HANDLE_NONE;
}

static bool choose_light(struct viewer *v)
{
    struct ag_light_info info;
    float x, y;
    for (int i = 0; v->lighting && i < v->edits.lights.count; i++) {
        if (!edits_has_light(&v->edits, i) ||
            ag_scene_get_light(v->desc->scene, i, v->desc->animation, v->time_s, &info) != AG_OK ||
            info.light.type == AG_LIGHT_SUN || !viewer_project(v, info.light.position, &x, &y) ||
            hypotf(v->mouse_x - x, v->mouse_y - y) > GRASP_PIXELS * window_scale(v->window))
            continue;
        v->gizmo.light = i;
        return true;
    }
    return false;
}

static bool choose_block(struct viewer *v)
{
    const struct blocks *blocks = &v->block_edit.blocks;
    for (int i = 0; v->block_edit.shown && i < blocks->count; i++) {
        float centre[3], x, y;
        block_centre(&blocks->at[i], centre);
        if (viewer_project(v, centre, &x, &y) &&
            hypotf(v->mouse_x - x, v->mouse_y - y) <= GRASP_PIXELS * window_scale(v->window))
            return block_edit_choose(v, i);
    }
    return false;
}

// The axis of a handle that moves.
static void find_axis(const struct target *target, enum gizmo_handle handle, float out[3])
{
    if (handle >= HANDLE_FACE) {
        block_face_normal(target->block, handle - HANDLE_FACE, out);
        return;
    }
    for (int i = 0; i < 3; i++) out[i] = i == (int)handle ? 1.0f : 0.0f;
}

bool gizmo_press(struct viewer *v)
{
    struct gizmo *gizmo = &v->gizmo;
    struct target target;
    gizmo_hover(v);
    if (gizmo->handle == HANDLE_NONE) return choose_light(v) || choose_block(v);
    find(v, &target);
    memcpy(gizmo->centre, target.centre, sizeof gizmo->centre);
    find_axis(&target, gizmo->handle, gizmo->direction);
    if (target.kind == TARGET_LIGHT)
        memcpy(gizmo->position, target.light.position, sizeof gizmo->position);
    if (target.kind == TARGET_INSTANCE) memcpy(gizmo->world, target.world, sizeof gizmo->world);
    gizmo->mouse_x = v->mouse_x;
    gizmo->held = gizmo->handle == HANDLE_TURN ||
                  place_on_axis(v, gizmo->centre, gizmo->direction, &gizmo->along);
    return true;
}

void gizmo_release(struct viewer *v)
{
    v->gizmo.held = false;
}
