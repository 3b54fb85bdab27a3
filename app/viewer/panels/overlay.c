#include "overlay.h"

#include "viewer/operations.h"

#include <stdio.h>

static bool in_region(const struct viewer *v, float x, float y)
{
    const struct region r = viewer_region(v);
    return x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1;
}

void overlay_lights(const struct viewer *v)
{
    const float unit = window_scale(v->window);
    struct ag_light_info light;
    for (int i = 0; i < v->edits.lights.count; i++) {
        float x, y;
        char text[16];
        if (!edits_has_light(&v->edits, i) ||
            ag_scene_get_light(v->desc->scene, i, v->desc->animation, v->time_s, &light) != AG_OK ||
            light.light.type == AG_LIGHT_SUN || !viewer_project(v, light.light.position, &x, &y) ||
            !in_region(v, x, y))
            continue;
        snprintf(text, sizeof text, "%d", i);
        ui_disk(x, y, 6.0f * unit, 0x101012c0);
        ui_disk(x, y, 4.0f * unit, light.light.enabled ? 0xffe080ff : 0x808080ff);
        ui_label(x + 8.0f * unit, y - 7.0f * unit, 0xffffffff, text);
    }
}

static void corner(const struct ag_mesh_info *mesh, const float world[16], int index, float out[3])
{
    const float p[3] = { index & 1 ? mesh->bounds_max[0] : mesh->bounds_min[0],
                         index & 2 ? mesh->bounds_max[1] : mesh->bounds_min[1],
                         index & 4 ? mesh->bounds_max[2] : mesh->bounds_min[2] };
    for (int i = 0; i < 3; i++)
        out[i] = world[12 + i] + world[i] * p[0] + world[4 + i] * p[1] + world[8 + i] * p[2];
}

void overlay_selection(const struct viewer *v)
{
    struct ag_instance_info instance;
    struct ag_mesh_info mesh;
    if (v->picked_instance < 0 ||
        ag_scene_get_instance(v->desc->scene, v->picked_instance, v->desc->animation, v->time_s,
                              &instance) != AG_OK ||
        ag_scene_get_mesh(v->desc->scene, instance.mesh, &mesh) != AG_OK)
        return;
    for (int i = 0; i < 8; i++)
        for (int axis = 1; axis < 8; axis *= 2) { // the edges that begin at a corner
            float from[3], to[3], x0, y0, x1, y1;
            if (i & axis) continue;
            corner(&mesh, instance.world_from_mesh, i, from);
            corner(&mesh, instance.world_from_mesh, i | axis, to);
            if (viewer_project(v, from, &x0, &y0) && viewer_project(v, to, &x1, &y1))
                ui_stroke(x0, y0, x1, y1, 0xffc040c0, 1.5f * window_scale(v->window));
        }
}
