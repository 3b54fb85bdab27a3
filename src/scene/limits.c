// Refuses scenes that 32-bit floats cannot trace.
#include "scene/limits.h"

#include "scene/environment/environment_map.h"
#include "scene/scene_check.h"

#include <math.h>

static bool is_within(vec3s p, float limit)
{
    return fabsf(p.x) <= limit && fabsf(p.y) <= limit && fabsf(p.z) <= limit;
}

bool limits_vertex(vec3s p)
{
    return is_within(p, SCENE_MAX_COORDINATE_M);
}

bool limits_position(vec3s p)
{
    return is_within(p, SCENE_MAX_DISTANCE_M);
}

bool limits_light(vec3s v)
{
    return v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f && v.x <= SCENE_MAX_RADIANCE &&
           v.y <= SCENE_MAX_RADIANCE && v.z <= SCENE_MAX_RADIANCE;
}

static bool too_far(const struct scene *scene, const char *what, const char *name, float limit)
{
    return host_fail(scene->host, FAIL_UNSUPPORTED,
                     "%s: %s %s reaches beyond the largest coordinate, %g m; scale the scene down",
                     scene->name, what, name, (double)limit);
}

static bool too_bright(const struct scene *scene, const char *what, const char *name)
{
    return host_fail(scene->host, FAIL_UNSUPPORTED,
                     "%s: %s %s is brighter than the largest light, %g cd/m², lux or candela",
                     scene->name, what, name, (double)SCENE_MAX_RADIANCE);
}

// A matrix may be singular, but not overflow.
static bool nodes_are_finite(const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    for (int i = 0; i < scene->node_count; i++) {
        if (floats_are_finite(&pose->world_from_node[i].raw[0][0], 16)) continue;
        return too_far(scene, "node", name_or_empty(scene->nodes[i].name), SCENE_MAX_COORDINATE_M);
    }
    return true;
}

static bool node_is_near(const struct scene_pose *pose, int node)
{
    return limits_position(vec3_xyz(pose->world_from_node[node].col[3]));
}

// The position of a sun has no effect.
static bool lights_are_near(const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    for (int i = 0; i < scene->light_count; i++) {
        const struct light *light = &scene->lights[i];
        if (light->type == LIGHT_SUN || node_is_near(pose, light->node)) continue;
        return too_far(scene, "light", name_or_empty(light->name), SCENE_MAX_DISTANCE_M);
    }
    return true;
}

static bool cameras_are_near(const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    for (int i = 0; i < scene->camera_count; i++) {
        if (node_is_near(pose, scene->cameras[i].node)) continue;
        return too_far(scene, "camera", name_or_empty(scene->cameras[i].name),
                       SCENE_MAX_DISTANCE_M);
    }
    return true;
}

// Whether no vertex of an instance overflows. The bounds alone would not tell: minima drop NaN.
static bool vertices_are_finite(const struct scene_pose *pose, int instance)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const vec3s *deformed = pose->deformed[instance].positions;
    if (deformed) return floats_are_finite(deformed->raw, 3 * (size_t)mesh->vertex_count);
    struct box3 box = box3_transform(pose_world_from_instance(pose, instance), mesh->bounds);
    return box3_is_empty(mesh->bounds) || (vec3_is_finite(box.min) && vec3_is_finite(box.max));
}

static bool geometry_is_near(const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    const struct box3 *bounds = &pose->bounds;
    bool near =
        box3_is_empty(*bounds) || (limits_vertex(bounds->min) && limits_vertex(bounds->max));
    for (int i = 0; near && i < scene->instance_count; i++) near = vertices_are_finite(pose, i);
    return near || too_far(scene, "its", "geometry", SCENE_MAX_COORDINATE_M);
}

bool limits_pose(const struct scene_pose *pose)
{
    return nodes_are_finite(pose) && lights_are_near(pose) && cameras_are_near(pose) &&
           geometry_is_near(pose);
}

static bool environment_is_dim(const struct environment *environment)
{
    if (!environment->map) return true;
    return environment->strength * environment_map_strongest(environment->map) <=
           SCENE_MAX_RADIANCE;
}

bool limits_scene(const struct scene *scene)
{
    if (!limits_light(scene->environment.sky)) return too_bright(scene, "the", "sky");
    if (!environment_is_dim(&scene->environment)) return too_bright(scene, "the", "environment");
    for (int i = 0; i < scene->material_count; i++) {
        const struct material *material = &scene->materials[i];
        if (limits_light(material->emissive)) continue;
        return too_bright(scene, "material", name_or_empty(material->name));
    }
    for (int i = 0; i < scene->light_count; i++) {
        if (limits_light(scene->lights[i].intensity)) continue;
        return too_bright(scene, "light", name_or_empty(scene->lights[i].name));
    }
    struct scene_pose pose;
    bool ok = pose_init(&pose, scene, -1, 0.0f) && limits_pose(&pose);
    pose_finish(&pose);
    return ok;
}
