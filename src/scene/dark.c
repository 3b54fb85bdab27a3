// A scene is dark by the luminance of its emitters and by their luminous flux over its area.
#include "scene/dark.h"

#include <math.h>

// glTF's emissiveFactor without KHR_materials_emissive_strength is at most 1 cd/m², often for
// colour rather than light; a luminaire or a screen has 100 cd/m² and more.
static const float LUMINAIRE = 10.0f;     // cd/m²
static const float MOONLIGHT_LUX = 0.25f; // full moon

static bool has_lights(const struct scene *scene)
{
    for (int i = 0; i < scene->light_count; i++)
        if (!scene->lights[i].off) return true;
    return false;
}

static double instance_area(const struct scene_pose *pose, int instance)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const vec3s *deformed = pose->deformed[instance].positions;
    const mat4s world_from_mesh = pose_world_from_instance(pose, instance);
    double area = 0.0;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        vec3s corner[3];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh->indices[i + k];
            corner[k] = deformed ? deformed[v] : mat4_point(world_from_mesh, mesh->positions[v]);
        }
        vec3s normal = glms_vec3_cross(glms_vec3_sub(corner[1], corner[0]),
                                       glms_vec3_sub(corner[2], corner[0]));
        float twice = glms_vec3_norm(normal);
        if (isfinite(twice)) area += 0.5 * (double)twice;
    }
    return area;
}

// The illuminance is an upper bound: emissive maps count as white.
static bool emission_lights(const struct scene_pose *pose)
{
    double flux = 0.0, area = 0.0;
    for (int i = 0; i < pose->scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(pose->scene, i);
        if (mesh->index_count == 0) continue;
        float radiance = luminance(pose->scene->materials[mesh->material].emissive);
        if (radiance >= LUMINAIRE) return true;
        double own = instance_area(pose, i);
        flux += GLM_PI * (double)radiance * own;
        area += own;
    }
    return flux > 0.0 && flux >= (double)MOONLIGHT_LUX * area;
}

bool pose_is_dark(const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    struct world_light sun;
    if (has_lights(scene) || !environment_is_black(&scene->environment) ||
        environment_sun_light(&scene->environment, &sun))
        return false;
    return !scene_has_emission(scene) || !emission_lights(pose);
}
