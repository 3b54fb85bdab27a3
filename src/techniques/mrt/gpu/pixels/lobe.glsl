// Light of a surface: irradiance, and the radiance in the mean direction of its specular lobe.
// SPECULAR: 0, without the latter. Include core/half.glsl, core/math.glsl, core/sh.glsl and
// frame/probes.glsl first.
#ifndef AG_MRT_LOBE_GLSL
#define AG_MRT_LOBE_GLSL

#include "techniques/common/light_map/lookup.glsl"

// The specular lobe towards the viewer, in the world.
struct mrt_lobe {
    light_map_lobe surface;
    vec3 mean; // direction, unit
};
const mrt_lobe MRT_NO_LOBE = mrt_lobe(light_map_lobe(vec3(0.0), 0.0), vec3(0.0));

struct mrt_light {
    vec3 irradiance;
    vec3 radiance;
};

const mrt_light MRT_DARK = mrt_light(vec3(0.0), vec3(0.0));

mrt_lobe mrt_lobe_of(vec3 normal, vec3 to_viewer, float alpha)
{
    return mrt_lobe(light_map_lobe_of(normal, to_viewer, alpha),
                    normalize(lobe_mean(normal, to_viewer, alpha)));
}

mrt_light mix_light(mrt_light a, mrt_light b, float share)
{
    return mrt_light(mix(a.irradiance, b.irradiance, share), mix(a.radiance, b.radiance, share));
}

mrt_light scaled_light(mrt_light light, float scale)
{
    return mrt_light(scale * light.irradiance, scale * light.radiance);
}

mrt_light sum_of_lights(mrt_light a, mrt_light b)
{
    return mrt_light(a.irradiance + b.irradiance, a.radiance + b.radiance);
}

// Vector irradiance along a surface of light whose irradiance by normal is `texel`.
vec3 vector_of_fit(vec4 texel)
{
    return MRT_VECTOR_OF_SLOPE * SH_Y1 * texel.wyz;
}

// Light of probes, whose irradiance by normal is smooth over more than a lobe: E/π of a surface
// that faces its mean direction.
mrt_light probe_light_at(sampler3D volume, int slab, vec3 texel, vec3 normal, mrt_lobe lobe)
{
    vec3 c[9];
    probes_coefficients_at(volume, slab, texel, c);
    mrt_light light = mrt_light(max(sh9_dot(c, normal), vec3(0.0)), vec3(0.0));
#if SPECULAR
    light.radiance = INV_PI * max(sh9_dot(c, lobe.mean), vec3(0.0));
#endif
    return light;
}

#endif
