// Materials, cameras and lights that several built-in scenes use.
#include "scene/builtin/parts.h"

#include <stdio.h>

int builtin_diffuse(struct scene *scene, const char *name, vec3s reflectance)
{
    struct material material = material_default();
    material.name = name;
    material.base_color = vec4_of(reflectance, 1);
    return scene_add_material(scene, &material);
}

int builtin_emitter(struct scene *scene, const char *name, vec3s radiance)
{
    struct material material = material_default();
    material.name = name;
    material.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    material.emissive = radiance;
    return scene_add_material(scene, &material);
}

bool builtin_camera(struct scene *scene, const char *name, vec3s position, vec3s target,
                    float vertical_fov_rad)
{
    struct camera camera = {
        .name = name,
        .vertical_fov_rad = vertical_fov_rad,
        .near_m = 0.01f,
    };
    camera.node = scene_add_node_looking(scene, name, position, glms_vec3_sub(target, position));
    return camera.node >= 0 && scene_add_camera(scene, &camera) >= 0;
}

bool builtin_point_light(struct scene *scene, const char *name, vec3s position, vec3s candela)
{
    struct light light = { .name = name, .type = LIGHT_POINT, .intensity = candela };
    light.node = scene_add_node_looking(scene, name, position, vec3_of(0, -1, 0));
    return light.node >= 0 && scene_add_light(scene, &light) >= 0;
}

bool builtin_sun(struct scene *scene, const char *name, vec3s position, vec3s direction, vec3s lux)
{
    struct light light = { .name = name, .type = LIGHT_SUN, .intensity = lux };
    light.node = scene_add_node_looking(scene, name, position, direction);
    return light.node >= 0 && scene_add_light(scene, &light) >= 0;
}

bool builtin_sphere_light(struct scene *scene, vec3s centre, bool as_point, float lumens)
{
    static const float RADIUS = 0.12f;
    // Normalised to luminance 1, so that `lumens` is the luminous flux.
    vec3s white = vec3_of(1.13f, 0.98f, 0.815f);
    white = glms_vec3_scale(white, 1.0f / luminance(white));
    if (as_point) {
        return builtin_point_light(scene, "light", centre,
                                   glms_vec3_scale(white, lumens / (4.0f * GLM_PIf)));
    }
    // A Lambertian emitter of luminance L and area A has the luminous flux π L A.
    float area_m2 = 4.0f * GLM_PIf * RADIUS * RADIUS;
    int material =
        builtin_emitter(scene, "light", glms_vec3_scale(white, lumens / (GLM_PIf * area_m2)));
    if (material < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_sphere(&builder, centre, RADIUS, 24);
    return shape_emit(&builder, "light", material) >= 0;
}

bool builtin_block(struct scene *scene, const char *name, mat4s world_from_block, const char *shape,
                   const char *neighbors)
{
    char extras[256];
    snprintf(extras, sizeof extras, "{\"afterglow_block\":{\"shape\":\"%s\",\"neighbors\":{%s}}}",
             shape, neighbors);
    struct node node = node_default();
    node.name = name;
    node.has_matrix = true;
    node.matrix = world_from_block;
    node.extras = extras;
    return scene_add_node(scene, &node) >= 0;
}
