#include "edits.h"

#include <string.h>

// ---- equality, member by member: structs have padding

static bool same_floats(const float *a, const float *b, int count)
{
    for (int i = 0; i < count; i++)
        if (a[i] != b[i]) return false;
    return true;
}

static bool same_material(const struct ag_material_desc *a, const struct ag_material_desc *b)
{
    return same_floats(a->base_color, b->base_color, 4) &&
           same_floats(a->emissive, b->emissive, 3) &&
           same_floats(a->specular_color, b->specular_color, 3) && a->metallic == b->metallic &&
           a->roughness == b->roughness && a->ior == b->ior && a->specular == b->specular &&
           a->double_sided == b->double_sided && a->unlit == b->unlit &&
           a->alpha_cutoff == b->alpha_cutoff;
}

static bool same_light(const struct ag_light_desc *a, const struct ag_light_desc *b)
{
    return a->type == b->type && a->enabled == b->enabled && a->inner_rad == b->inner_rad &&
           a->outer_rad == b->outer_rad && same_floats(a->position, b->position, 3) &&
           same_floats(a->direction, b->direction, 3) && same_floats(a->intensity, b->intensity, 3);
}

bool edits_moved(const struct edits_instance *edit)
{
    return !same_floats(edit->first, edit->world_from_mesh, 16);
}

bool edits_changed(const struct edits_material *edit)
{
    return !same_material(&edit->first, &edit->material);
}

bool edits_changed_instances(const struct edits *edits)
{
    for (int i = 0; i < edits->instance_count; i++)
        if (edits_moved(&edits->instances[i])) return true;
    return false;
}

bool edits_changed_materials(const struct edits *edits)
{
    for (int i = 0; i < edits->material_count; i++)
        if (edits_changed(&edits->materials[i])) return true;
    return false;
}

bool edits_changed_lights(const struct edits *edits)
{
    const struct edits_lights *a = &edits->first_lights, *b = &edits->lights;
    if (a->count != b->count || !same_floats(a->sky, b->sky, 3)) return true;
    for (int i = 0; i < a->count; i++)
        if (a->removed[i] != b->removed[i] || !same_light(&a->lights[i], &b->lights[i]))
            return true;
    return false;
}

bool edits_changed_environment(const struct edits *edits)
{
    return !environment_choices_same(&edits->first_environment, &edits->environment);
}

// ---- changes

void edits_begin(struct edits *edits, const struct edits_moment *at)
{
    struct edits_lights *lights = &edits->first_lights;
    struct ag_scene_info info;
    struct ag_light_info light;
    memset(edits, 0, sizeof *edits);
    if (ag_scene_get_info(at->scene, at->animation, at->time_s, &info) != AG_OK) return;
    for (int i = 0; i < info.lights && i < EDITS_LIGHTS; i++)
        if (ag_scene_get_light(at->scene, i, at->animation, at->time_s, &light) == AG_OK)
            lights->lights[lights->count++] = light.light;
    memcpy(lights->sky, info.sky, sizeof lights->sky);
    edits->lights = *lights;
}

enum ag_result edits_find_instance(struct edits *edits, const struct edits_moment *at, int index,
                                   struct edits_instance **out)
{
    struct ag_instance_info info;
    for (int i = 0; i < edits->instance_count; i++)
        if (edits->instances[i].index == index) {
            *out = &edits->instances[i];
            return AG_OK;
        }
    if (edits->instance_count == EDITS_EACH) return AG_ERROR_MEMORY;
    const enum ag_result result =
        ag_scene_get_instance(at->scene, index, at->animation, at->time_s, &info);
    if (result != AG_OK) return result;
    struct edits_instance *instance = *out = &edits->instances[edits->instance_count++];
    instance->index = index;
    instance->first_mobility = info.mobility;
    memcpy(instance->first, info.world_from_mesh, sizeof instance->first);
    memcpy(instance->world_from_mesh, info.world_from_mesh, sizeof instance->first);
    return AG_OK;
}

enum ag_result edits_move(struct edits *edits, const struct edits_moment *at, int instance,
                          const float world_from_mesh[16])
{
    struct edits_instance *edit;
    enum ag_result result = edits_find_instance(edits, at, instance, &edit);
    if (result == AG_OK)
        result = ag_scene_set_instance_transform(at->scene, instance, world_from_mesh);
    if (result == AG_OK) memcpy(edit->world_from_mesh, world_from_mesh, sizeof edit->first);
    return result;
}

enum ag_result edits_find_material(struct edits *edits, const struct edits_moment *at, int index,
                                   struct edits_material **out)
{
    struct ag_material_info info;
    for (int i = 0; i < edits->material_count; i++)
        if (edits->materials[i].index == index) {
            *out = &edits->materials[i];
            return AG_OK;
        }
    if (edits->material_count == EDITS_EACH) return AG_ERROR_MEMORY;
    const enum ag_result result = ag_scene_get_material(at->scene, index, &info);
    if (result != AG_OK) return result;
    struct edits_material *material = *out = &edits->materials[edits->material_count++];
    material->index = index;
    material->first = material->material = info.material;
    return AG_OK;
}

enum ag_result edits_set_material(struct edits *edits, const struct edits_moment *at, int material,
                                  const struct ag_material_desc *desc)
{
    struct edits_material *edit;
    enum ag_result result = edits_find_material(edits, at, material, &edit);
    if (result == AG_OK) result = ag_scene_set_material(at->scene, material, desc);
    if (result == AG_OK) edit->material = *desc;
    return result;
}

// Sets a light of a scene, or adds it behind the last.
static enum ag_result put_light(struct ag_scene *scene, int light, const struct ag_light_desc *desc)
{
    struct ag_scene_info info;
    const enum ag_result result = ag_scene_get_info(scene, -1, 0.0, &info);
    if (result != AG_OK) return result;
    return light < info.lights ? ag_scene_set_light(scene, light, desc)
                               : ag_scene_add_light(scene, desc, NULL);
}

bool edits_has_light(const struct edits *edits, int light)
{
    return light >= 0 && light < edits->lights.count && !edits->lights.removed[light];
}

enum ag_result edits_set_light(struct edits *edits, struct ag_scene *scene, int light,
                               const struct ag_light_desc *desc)
{
    if (!edits_has_light(edits, light)) return AG_ERROR_ARGUMENT;
    const enum ag_result result = ag_scene_set_light(scene, light, desc);
    if (result != AG_OK) return result;
    edits->lights.lights[light] = *desc;
    edits->light_touched[light] = true;
    return AG_OK;
}

enum ag_result edits_add_light(struct edits *edits, struct ag_scene *scene,
                               const struct ag_light_desc *desc)
{
    struct edits_lights *lights = &edits->lights;
    if (lights->count == EDITS_LIGHTS) return AG_ERROR_MEMORY;
    const enum ag_result result = put_light(scene, lights->count, desc);
    if (result != AG_OK) return result;
    edits->light_touched[lights->count] = true;
    lights->removed[lights->count] = false;
    lights->lights[lights->count++] = *desc;
    return AG_OK;
}

enum ag_result edits_remove_light(struct edits *edits, struct ag_scene *scene, int light)
{
    struct edits_lights *lights = &edits->lights;
    if (!edits_has_light(edits, light)) return AG_ERROR_ARGUMENT;
    struct ag_light_desc off = lights->lights[light];
    off.enabled = false;
    const enum ag_result result = ag_scene_set_light(scene, light, &off);
    if (result != AG_OK) return result;
    edits->light_touched[light] = lights->removed[light] = true;
    while (lights->count > edits->first_lights.count && lights->removed[lights->count - 1])
        lights->removed[--lights->count] = false;
    return AG_OK;
}

enum ag_result edits_set_sky(struct edits *edits, struct ag_scene *scene, const float radiance[3])
{
    const enum ag_result result = ag_scene_set_sky(scene, radiance);
    if (result != AG_OK) return result;
    memcpy(edits->lights.sky, radiance, sizeof edits->lights.sky);
    edits->sky_touched = true;
    return AG_OK;
}

// ---- all changes at once

static enum ag_result apply_instance(const struct edits_instance *edit, struct ag_scene *scene)
{
    enum ag_result result =
        ag_scene_set_instance_transform(scene, edit->index, edit->world_from_mesh);
    if (result == AG_OK && !edits_moved(edit) && edit->first_mobility == AG_MOBILITY_STATIC)
        result = ag_scene_set_instance_mobility(scene, edit->index, AG_MOBILITY_STATIC);
    return result;
}

// A scene cannot lose one light: those that were removed, or undone, are off.
static enum ag_result apply_light(const struct edits *edits, struct ag_scene *scene, int light)
{
    struct ag_light_desc desc;
    ag_light_desc_default(&desc, AG_LIGHT_POINT);
    if (light < edits->lights.count) desc = edits->lights.lights[light];
    desc.enabled &= edits_has_light(edits, light);
    return put_light(scene, light, &desc);
}

static enum ag_result apply_lights(const struct edits *edits, struct ag_scene *scene)
{
    enum ag_result result = AG_OK;
    for (int i = 0; i < EDITS_LIGHTS && result == AG_OK; i++)
        if (edits->light_touched[i]) result = apply_light(edits, scene, i);
    if (result == AG_OK && edits->sky_touched) result = ag_scene_set_sky(scene, edits->lights.sky);
    return result;
}

enum ag_result edits_apply(const struct edits *edits, struct ag_scene *scene)
{
    enum ag_result result = AG_OK;
    for (int i = 0; i < edits->instance_count && result == AG_OK; i++)
        result = apply_instance(&edits->instances[i], scene);
    for (int i = 0; i < edits->material_count && result == AG_OK; i++)
        result =
            ag_scene_set_material(scene, edits->materials[i].index, &edits->materials[i].material);
    return result == AG_OK ? apply_lights(edits, scene) : result;
}

void edits_forget(struct edits *edits)
{
    for (int i = 0; i < edits->instance_count; i++)
        memcpy(edits->instances[i].world_from_mesh, edits->instances[i].first,
               sizeof edits->instances[i].first);
    for (int i = 0; i < edits->material_count; i++)
        edits->materials[i].material = edits->materials[i].first;
    edits->lights = edits->first_lights;
    edits->environment = edits->first_environment;
}

// Entries stay in their order: the first are the same in both.
static void take_objects(struct edits *edits, const struct edits *values)
{
    for (int i = 0; i < values->instance_count; i++) edits->instances[i] = values->instances[i];
    for (int i = 0; i < values->material_count; i++) edits->materials[i] = values->materials[i];
    if (edits->instance_count < values->instance_count)
        edits->instance_count = values->instance_count;
    if (edits->material_count < values->material_count)
        edits->material_count = values->material_count;
}

enum ag_result edits_restore(struct edits *edits, const struct edits *values,
                             struct ag_scene *scene)
{
    edits_forget(edits);
    take_objects(edits, values);
    edits->lights = values->lights;
    edits->environment = values->environment;
    edits->environment_touched |= values->environment_touched;
    edits->sky_touched |= values->sky_touched;
    for (int i = 0; i < EDITS_LIGHTS; i++) edits->light_touched[i] |= values->light_touched[i];
    return edits_apply(edits, scene);
}
