#include "edits.h"

#include <string.h>

enum ag_result edits_move(struct edits *edits, struct ag_scene *scene, int instance,
                          const float world_from_mesh[16])
{
    int at = 0;
    while (at < edits->instance_count && edits->instances[at].index != instance) at++;
    if (at == EDITS_EACH) return AG_ERROR_MEMORY;
    const enum ag_result result = ag_scene_set_instance_transform(scene, instance, world_from_mesh);
    if (result != AG_OK) return result;
    if (at == edits->instance_count) edits->instance_count++;
    edits->instances[at].index = instance;
    memcpy(edits->instances[at].world_from_mesh, world_from_mesh, 16 * sizeof *world_from_mesh);
    return AG_OK;
}

enum ag_result edits_set_material(struct edits *edits, struct ag_scene *scene, int material,
                                  const struct ag_material_desc *desc)
{
    int at = 0;
    while (at < edits->material_count && edits->materials[at].index != material) at++;
    if (at == EDITS_EACH) return AG_ERROR_MEMORY;
    const enum ag_result result = ag_scene_set_material(scene, material, desc);
    if (result != AG_OK) return result;
    if (at == edits->material_count) edits->material_count++;
    edits->materials[at].index = material;
    edits->materials[at].material = *desc;
    return AG_OK;
}

void edits_take_lights(struct edits *edits, struct ag_scene *scene, int animation, double time_s)
{
    struct ag_scene_info info = { 0 };
    struct ag_light_info light;
    if (ag_scene_get_info(scene, animation, time_s, &info) != AG_OK) return;
    edits->light_count = 0;
    for (int i = 0; i < info.lights && i < EDITS_LIGHTS; i++)
        if (ag_scene_get_light(scene, i, animation, time_s, &light) == AG_OK)
            edits->lights[edits->light_count++] = light.light;
    memcpy(edits->sky, info.sky, sizeof edits->sky);
    edits->lights_changed = true;
}

static enum ag_result apply_lights(const struct edits *edits, struct ag_scene *scene)
{
    struct ag_scene_info info = { 0 };
    enum ag_result result = ag_scene_get_info(scene, -1, 0.0, &info);
    for (int i = 0; i < edits->light_count && result == AG_OK; i++)
        result = i < info.lights ? ag_scene_set_light(scene, i, &edits->lights[i])
                                 : ag_scene_add_light(scene, &edits->lights[i], NULL);
    return result == AG_OK ? ag_scene_set_sky(scene, edits->sky) : result;
}

enum ag_result edits_apply(const struct edits *edits, struct ag_scene *scene)
{
    enum ag_result result = AG_OK;
    for (int i = 0; i < edits->instance_count && result == AG_OK; i++)
        result = ag_scene_set_instance_transform(scene, edits->instances[i].index,
                                                 edits->instances[i].world_from_mesh);
    for (int i = 0; i < edits->material_count && result == AG_OK; i++)
        result =
            ag_scene_set_material(scene, edits->materials[i].index, &edits->materials[i].material);
    if (result == AG_OK && edits->lights_changed) result = apply_lights(edits, scene);
    return result;
}
