// The environment's map in specular lobes. A light map has the light of the sky in first order: its
// mean radiance L̄ over the directions that a texel sees, times the share R of a lobe that sees it,
// which the map would have under a sky of radiance 1 (visible_sky.h). With the mean L of the
// environment over the lobe and its visibility V,
//     radiance = first order + V (L − L̄),
// which changes nothing where the environment is uniform. Binding number:
// LIGHT_MAP_VISIBLE_SKY_BINDING, besides that of frame/environment_map.glsl. Include lookup.glsl
// and frame/environment_map.glsl first.
#ifndef AG_LIGHT_MAP_MIRROR_GLSL
#define AG_LIGHT_MAP_MIRROR_GLSL

layout(set = 0, binding = LIGHT_MAP_VISIBLE_SKY_BINDING) uniform sampler2DArray visible_sky;

// The sky that a place sees, as a cone about its vector irradiance. One of half-angle ρ about
// the normal has the irradiance sin²ρ of a sky of radiance 1/π.
struct light_map_sky {
    float share; // irradiance, 0…1
    vec3 axis;   // unit
};

const float LIGHT_MAP_LEAST_SKY = 1e-3; // share below which no lobe mirrors the sky

// L̄. A cosine-weighted hemisphere has the mean cosine 2/3 of a von Mises–Fisher distribution of
// deviation 0.58; that of narrower cones falls with sin ρ.
vec3 light_map_mean_sky(light_map_sky sky)
{
    return environment_lobe(sky.axis, 0.58 * sqrt(sky.share));
}

// V of a direction: √R within ρ, falling to 0 at 2ρ. R is too large beyond the cone, since it is
// linear in the direction, and too small within narrow ones, which its root makes up for: measured
// on metal, where R alone loses 3 % more light.
float light_map_sky_visibility(light_map_sky sky, float first_order, vec3 direction)
{
    float cos_twice = 1.0 - 2.0 * sky.share, cos_once = sqrt(1.0 - sky.share);
    return sqrt(clamp(first_order, 0.0, 1.0)) *
           smoothstep(cos_twice, cos_once, dot(direction, sky.axis));
}

// V (L − L̄). at: place of the map, 0…1; z: the side.
vec3 light_map_mirrored(vec3 at, vec3 n, vec3 to_viewer, float roughness)
{
    vec4 light = textureLod(visible_sky, at, 0.0);
    if (light.x < LIGHT_MAP_LEAST_SKY) return vec3(0.0);
    vec3 axis = light.yzw * inversesqrt(max(dot(light.yzw, light.yzw), 1e-12));
    light_map_sky sky = light_map_sky(min(light.x, 1.0), axis);
    float alpha = brdf_alpha(roughness);
    vec3 along = light_map_lobe_along(n, to_viewer, alpha);
    float first_order = 0.5 * (light.x + dot(light.yzw, n)) + 1.5 * dot(along, light.yzw);
    vec3 direction = normalize(lobe_mean(n, to_viewer, alpha));
    float visible = light_map_sky_visibility(sky, first_order, direction);
    vec3 detail = environment_lobe(direction, lobe_deviation(alpha)) - light_map_mean_sky(sky);
    return visible * (1.0 - lobe_roughness(roughness)) * detail;
}

#endif
