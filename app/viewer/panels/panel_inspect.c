// The pixel under the mouse; the surface that was clicked: its instance, mesh and material.
#include "panel.h"

#include "overlay.h"
#include "viewer/scene/changes.h"
#include "viewer/operations.h"

#include <stdio.h>
#include <string.h>

static void edit_material(struct viewer *v, int index)
{
    struct ag_material_info info;
    if (ag_scene_get_material(v->desc->scene, index, &info) != AG_OK) return;
    struct ag_material_desc *m = &info.material;
    ui_text("material %d %s", index, info.name ? info.name : "");
    bool changed = ui_color("base color", m->base_color);
    changed |= ui_number("roughness", &m->roughness, 0, 1, "%.3f", false);
    changed |= ui_number("metallic", &m->metallic, 0, 1, "%.3f", false);
    changed |= ui_numbers("emissive (cd/m²)", m->emissive, 3, 1.0f, "%.1f");
    for (int i = 0; i < 3; i++)
        if (m->emissive[i] < 0) m->emissive[i] = 0;
    if (info.base_color_map) ui_faint("base color multiplies a texture");
    if (!changed) return;
    viewer_set_material(v, index, m);
}

static void move_instance(struct viewer *v, int index, const struct ag_instance_info *instance)
{
    float world[16];
    memcpy(world, instance->world_from_mesh, sizeof world);
    if (!ui_numbers("position (m)", world + 12, 3, 0.01f * v->look.speed, "%.3f")) return;
    viewer_move_instance(v, index, world);
}

static void show_instance(struct viewer *v, int index)
{
    struct ag_instance_info instance;
    struct ag_mesh_info mesh;
    if (ag_scene_get_instance(v->desc->scene, index, v->desc->animation, v->time_s, &instance) !=
            AG_OK ||
        ag_scene_get_mesh(v->desc->scene, instance.mesh, &mesh) != AG_OK)
        return;
    ui_text("instance %d %s", index, instance.name ? instance.name : "");
    ui_faint("mesh %d %s, %u triangles, %s", instance.mesh, mesh.name ? mesh.name : "",
             mesh.index_count / 3, instance.mobility == AG_MOBILITY_MOVABLE ? "movable" : "static");
    if (!instance.skinned) move_instance(v, index, &instance);
    if (mesh.material >= 0) edit_material(v, mesh.material);
}

void panel_inspect(struct viewer *v)
{
    v->inspecting = true;
    overlay_selection(v);
    gizmo_draw(v);
    panel_pixel(v);
    if (ui_section("Surface", true)) {
        if (v->picked_instance < 0)
            ui_text("Click a surface in the image.");
        else
            show_instance(v, v->picked_instance);
    }
    panel_probes(v);
    panel_texels(v);
}
