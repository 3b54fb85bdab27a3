// Light of a surface from a light map, whose layers are the colours of a side. A texel is the
// irradiance E along the surface's normal, and the vector irradiance V: bands 0 and 1 of spherical
// harmonics have E(n) = (E + n·V) / 2. n·V is E for the surface's own normal, so that E(n) is exact
// there, and in uniform light for all normals. Include core/half.glsl and core/math.glsl first.
#ifndef AG_LIGHT_MAP_LOOKUP_GLSL
#define AG_LIGHT_MAP_LOOKUP_GLSL

#include "frame/lobe.glsl"
#include "techniques/common/light_map/surface_shared.h"

// Irradiance and vector irradiance by colour.
struct light_map_light {
    vec3 irradiance;
    mat3 vector; // a column for each colour
};

// per_size: 1 / width and height of the map.
light_map_light light_map_lookup(sampler2DArray light_map, vec2 per_size, vec3 place, vec3 n)
{
    vec2 uv = place.xy * per_size;
    light_map_light light;
    for (int c = 0; c < 3; c++) {
        vec4 texel =
            textureLod(light_map, vec3(uv, place.z * float(LIGHT_MAP_LAYERS) + float(c)), 0.0);
        light.irradiance[c] = 0.5 * (texel.x + dot(texel.yzw, n));
        light.vector[c] = texel.yzw;
    }
    light.irradiance = clamp(light.irradiance, vec3(0.0), vec3(HALF_MAX));
    return light;
}

// Part along the surface of the mean direction of a specular lobe.
vec3 light_map_lobe_along(vec3 n, vec3 to_viewer, float alpha)
{
    return (dot(to_viewer, n) * n - to_viewer) * lobe_lean(alpha);
}

// Share of the first order in the radiance of a lobe. A mirror has no mean over directions that
// would hide what two bands lack: there the mean radiance E/π has the lesser error.
float light_map_first_order_share(float alpha)
{
    const float WHOLE_FROM = 0.3; // roughness
    return smoothstep(0.0, WHOLE_FROM * WHOLE_FROM, alpha);
}

// t of light_map_radiance_along, times the share.
vec3 light_map_shared_along(vec3 n, vec3 to_viewer, float alpha)
{
    return light_map_first_order_share(alpha) * light_map_lobe_along(n, to_viewer, alpha);
}

// Radiance in the mean direction of a specular lobe, L(ω) = E(n)/π + 3/(2π) V·t, with t the part of
// ω along the surface. Its irradiance is E(n), its vector irradiance along the surface V. Uniform
// light is exact.
vec3 light_map_radiance_along(light_map_light light, vec3 along)
{
    return INV_PI * (light.irradiance + 1.5 * (along * light.vector));
}

vec3 light_map_radiance(light_map_light light, vec3 n, vec3 to_viewer, float alpha)
{
    return light_map_radiance_along(light, light_map_shared_along(n, to_viewer, alpha));
}

#endif
