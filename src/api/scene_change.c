// Changes of a scene that renderers may be using: they see them at their next frame.
#include "api/scene_parts.h"

#include "scene/limits.h"

_Static_assert(AG_MOBILITY_STATIC == 0, "anything else is movable");

// "instance 3 is not one of 2", and for removed ones "instance 1 was removed".
static enum ag_result instance_check(const char *function, const struct ag_scene *scene,
                                     int instance)
{
    struct ag_context *context = parts_context(scene);
    AG_REQUIRE_FOR(function, context, scene, "scene is NULL");
    const struct scene *s = scene->scene;
    AG_REQUIRE_FOR(function, context, scene->bakes == 0,
                   "the scene is in use by a bake: only its lights and sky may change");
    AG_REQUIRE_FOR(function, context, instance >= 0 && instance < s->instance_count,
                   "instance %d is not one of %d", instance, s->instance_count);
    AG_REQUIRE_FOR(function, context, s->instances[instance].mesh >= 0, "instance %d was removed",
                   instance);
    return AG_OK;
}

enum ag_result ag_scene_set_instance_transform(struct ag_scene *scene, int instance,
                                               const float *world_from_mesh)
{
    mat4s matrix;
    enum ag_result checked = instance_check(__func__, scene, instance);
    if (checked == AG_OK) checked = parts_matrix(__func__, scene, world_from_mesh, &matrix);
    if (checked != AG_OK) return checked;
    return api_done(scene->context, scene_set_instance_transform(scene->scene, instance, matrix));
}

enum ag_result ag_scene_set_instance_mobility(struct ag_scene *scene, int instance,
                                              enum ag_mobility mobility)
{
    const enum ag_result checked = instance_check(__func__, scene, instance);
    if (checked != AG_OK) return checked;
    AG_REQUIRE(scene->context, (unsigned)mobility <= AG_MOBILITY_MOVABLE, "mobility %d is unknown",
               (int)mobility);
    scene_set_instance_movable(scene->scene, instance, mobility != AG_MOBILITY_STATIC);
    return AG_OK;
}

enum ag_result ag_scene_remove_instance(struct ag_scene *scene, int instance)
{
    const enum ag_result checked = instance_check(__func__, scene, instance);
    if (checked == AG_OK) scene_remove_instance(scene->scene, instance);
    return checked;
}

enum ag_result ag_scene_update_mesh(struct ag_scene *scene, int mesh, const float *positions,
                                    const float *normals)
{
    REQUIRE_CHANGE(scene, positions);
    REQUIRE_NO_BAKE(scene);
    REQUIRE_INDEX(scene, "mesh", mesh, mesh_count);
    return api_done(scene->context, scene_update_mesh(scene->scene, mesh, (const vec3s *)positions,
                                                      (const vec3s *)normals));
}

enum ag_result ag_scene_set_material(struct ag_scene *scene, int material,
                                     const struct ag_material_desc *desc)
{
    REQUIRE_CHANGE(scene, desc);
    REQUIRE_NO_BAKE(scene);
    REQUIRE_INDEX(scene, "material", material, material_count);
    struct material values = scene->scene->materials[material];
    const enum ag_result checked = parts_material(__func__, scene, desc, &values);
    if (checked != AG_OK) return checked;
    AG_REQUIRE(scene->context,
               !desc->maps && values.alpha_mode == scene->scene->materials[material].alpha_mode,
               "the textures and the alpha mode of a material stay: add another material");
    return api_done(scene->context, scene_set_material(scene->scene, material, &values));
}

enum ag_result ag_scene_set_light(struct ag_scene *scene, int light,
                                  const struct ag_light_desc *desc)
{
    REQUIRE_CHANGE(scene, desc);
    REQUIRE_INDEX(scene, "light", light, light_count);
    struct placed_light values = { .light = scene->scene->lights[light] };
    const enum ag_result checked = parts_light(__func__, scene, desc, &values);
    if (checked != AG_OK) return checked;
    return api_done(scene->context, scene_set_light(scene->scene, light, &values));
}

enum ag_result ag_scene_remove_lights(struct ag_scene *scene)
{
    AG_REQUIRE(NULL, scene, "scene is NULL");
    scene_remove_lights(scene->scene);
    return AG_OK;
}

enum ag_result ag_scene_set_sky(struct ag_scene *scene, const float *radiance)
{
    AG_REQUIRE(NULL, scene, "scene is NULL");
    AG_REQUIRE(scene->context, radiance, "radiance is NULL");
    AG_REQUIRE(scene->context, limits_light(api_vec3(radiance)),
               "radiance is not within 0 to %g cd/m²", (double)SCENE_MAX_RADIANCE);
    scene_set_sky(scene->scene, api_vec3(radiance));
    return AG_OK;
}
