// Direct light of punctual lights at ray hits.
#include "scene/view/direct_light.h"

#include <math.h>

static const float GRAZING = 0.15f; // cosine below which irradiance is negligible

void direct_light_init(struct direct_light *direct, const struct scene_pose *pose,
                       const struct raycast *raycast, float offset)
{
    *direct = (struct direct_light){ .raycast = raycast, .offset = offset };
    for (int i = 0; i < pose_light_count(pose) && direct->count < DIRECT_LIGHTS_MAX; i++) {
        struct world_light light = pose_light(pose, i);
        if (luminance(light.intensity) <= 0.0f) continue;
        direct->lights[direct->count++] = light;
    }
}

// Whether the light reaches a point; both sides of a surface count, as materials are ignored.
static bool reaches(const struct direct_light *direct, const struct world_light *light,
                    vec3s position, vec3s normal)
{
    vec3s towards = glms_vec3_negate(light->direction);
    float distance = INFINITY;
    if (light->type != LIGHT_SUN) {
        vec3s offset = glms_vec3_sub(light->position, position);
        distance = glms_vec3_norm(offset);
        if (!(distance > 0.0f) || (light->range_m > 0.0f && distance > light->range_m))
            return false;
        towards = glms_vec3_scale(offset, 1.0f / distance);
    }
    if (light->type == LIGHT_SPOT && -glms_vec3_dot(light->direction, towards) < light->cos_outer)
        return false;
    if (glms_vec3_dot(normal, towards) < GRAZING) return false;
    return !raycast_blocked(direct->raycast, position, towards, distance);
}

void direct_light_count(const struct direct_light *direct, vec3s origin, vec3s direction,
                        struct lit_count *count)
{
    struct raycast_hit hit;
    if (!raycast_closest(direct->raycast, origin, direction, INFINITY, &hit)) return;
    vec3s normal = hit.front ? hit.normal : glms_vec3_negate(hit.normal);
    vec3s position = glms_vec3_muladds(direction, hit.distance, origin);
    position = glms_vec3_muladds(normal, direct->offset, position);
    count->hits++;
    for (int i = 0; i < direct->count; i++) {
        if (!reaches(direct, &direct->lights[i], position, normal)) continue;
        count->lit++;
        return;
    }
}

float lit_share(const struct lit_count *count)
{
    return count->hits > 0 ? (float)count->lit / (float)count->hits : 0.0f;
}
