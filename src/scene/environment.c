#include "scene/environment.h"

#include "core/hash.h"
#include "scene/environment_map.h"
#include "scene/pose.h"

static const float Y0 = 0.282094792f; // √(1/4π)

vec3s environment_map_light(const struct environment *environment, vec3s direction)
{
    const vec3s d = environment_map_direction(environment, direction);
    return glms_vec3_scale(environment_map_radiance(environment->map, d), environment->strength);
}

vec3s environment_mean(const struct environment *environment)
{
    vec3s mean = environment->sky;
    for (int c = 0; environment->map && c < 3; c++)
        mean.raw[c] += environment->strength * environment->map->sh[c][0] * Y0;
    return mean;
}

bool environment_is_black(const struct environment *environment)
{
    const vec3s mean = environment_mean(environment);
    return !(mean.x > 0.0f || mean.y > 0.0f || mean.z > 0.0f);
}

uint64_t environment_key(const struct environment *environment)
{
    const float turn[] = { environment->strength, environment->rotation_rad };
    uint64_t key = hash_bytes(environment->sky.raw, sizeof environment->sky.raw, 0);
    if (!environment->map) return key;
    key = hash_bytes(turn, sizeof turn, key);
    return hash_bytes(&environment->map->key, sizeof environment->map->key, key);
}

static mat3s world_from_map(const struct environment *environment)
{
    mat3s m;
    for (int i = 0; i < 3; i++) {
        vec3s axis = vec3_of(i == 0, i == 1, i == 2);
        m.col[i] = environment_world_direction(environment, axis);
    }
    return m;
}

void environment_sh(const struct environment *environment, int bands, float out[3][SH_MAX_COUNT])
{
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < SH_COUNT(bands); i++) out[c][i] = 0.0f;
        if (environment->map)
            sh_rotate(bands, world_from_map(environment), environment->map->sh[c], out[c]);
        for (int i = 0; i < SH_COUNT(bands); i++) out[c][i] *= environment->strength;
        out[c][0] += environment->sky.raw[c] / Y0;
    }
}

bool environment_sun_light(const struct environment *environment, struct world_light *out)
{
    if (!environment->map || !environment->map->sun.found) return false;
    const struct environment_sun *sun = &environment->map->sun;
    *out = (struct world_light){
        .type = LIGHT_SUN,
        .direction = glms_vec3_negate(environment_world_direction(environment, sun->to_sun)),
        .intensity = glms_vec3_scale(sun->illuminance_lux, environment->strength),
    };
    return true;
}
