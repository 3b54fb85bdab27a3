#include "scene/environment.h"

#include "core/hash.h"
#include "scene/environment/environment_map.h"
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

static uint64_t add_map(const struct environment *environment, uint64_t key)
{
    const float turn[] = { environment->strength, environment->rotation_rad };
    key = hash_bytes(turn, sizeof turn, key);
    return hash_bytes(&environment->map->key, sizeof environment->map->key, key);
}

uint64_t environment_key(const struct environment *environment)
{
    const uint64_t key = hash_bytes(environment->sky.raw, sizeof environment->sky.raw, 0);
    return environment->map ? add_map(environment, key) : key;
}

uint64_t environment_map_use_key(const struct environment *environment)
{
    return environment->map ? add_map(environment, 0) : 0;
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

// ---- patches

int environment_patch_of(vec3s d)
{
    const float sum = fabsf(d.x) + fabsf(d.y) + fabsf(d.z);
    float u = d.x / sum, v = d.z / sum;
    if (d.y < 0.0f) {
        const float folded = (1.0f - fabsf(v)) * (u >= 0.0f ? 1.0f : -1.0f);
        v = (1.0f - fabsf(u)) * (v >= 0.0f ? 1.0f : -1.0f);
        u = folded;
    }
    const int last = ENVIRONMENT_PATCH_SIDE - 1;
    const int x = (int)((0.5f * u + 0.5f) * ENVIRONMENT_PATCH_SIDE);
    const int y = (int)((0.5f * v + 0.5f) * ENVIRONMENT_PATCH_SIDE);
    return (y < last ? y : last) * ENVIRONMENT_PATCH_SIDE + (x < last ? x : last);
}

// A point of the octahedron; solid angles of squares are as its inverse cubed length.
static vec3s octahedron_at(float u, float v)
{
    const float height = 1.0f - fabsf(u) - fabsf(v);
    if (height >= 0.0f) return vec3_of(u, height, v);
    return vec3_of((1.0f - fabsf(v)) * (u >= 0.0f ? 1.0f : -1.0f), height,
                   (1.0f - fabsf(u)) * (v >= 0.0f ? 1.0f : -1.0f));
}

static vec3s patch_mean(const struct environment *environment, int patch)
{
    enum { POINTS = 4, ALL = ENVIRONMENT_PATCH_SIDE * POINTS };
    vec3s sum = vec3_of(0, 0, 0);
    float weights = 0.0f;
    for (int i = 0; i < POINTS * POINTS; i++) {
        const int x = patch % ENVIRONMENT_PATCH_SIDE * POINTS + i % POINTS;
        const int y = patch / ENVIRONMENT_PATCH_SIDE * POINTS + i / POINTS;
        const vec3s at = octahedron_at((2.0f * (float)x + 1.0f) / ALL - 1.0f,
                                       (2.0f * (float)y + 1.0f) / ALL - 1.0f);
        const float length = glms_vec3_norm(at), weight = 1.0f / (length * length * length);
        const vec3s d = environment_map_direction(environment, glms_vec3_divs(at, length));
        sum = glms_vec3_muladds(environment_map_coarse(environment->map, d), weight, sum);
        weights += weight;
    }
    return glms_vec3_divs(sum, weights);
}

void environment_patches(const struct environment *environment, vec3s out[ENVIRONMENT_PATCHES])
{
    for (int i = 0; i < ENVIRONMENT_PATCHES; i++) {
        out[i] = environment->sky;
        if (environment->map)
            out[i] = glms_vec3_muladds(patch_mean(environment, i), environment->strength, out[i]);
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
