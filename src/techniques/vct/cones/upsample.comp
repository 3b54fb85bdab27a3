// Joint bilateral upsampling from half resolution. Each pixel blends the cone sums of its four
// half-resolution neighbours by bilinear weight and surface similarity. Irradiance is then
// evaluated with the pixel's own normal, so that normal maps stay sharp.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set_block;
};
vct_cone_params set; // a copy that main begins with, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D red;
layout(set = 0, binding = 6) uniform sampler2D green;
layout(set = 0, binding = 7) uniform sampler2D blue;
layout(set = 0, binding = 8) uniform sampler2D cone_normal;
layout(set = 0, binding = 9) uniform writeonly image2D irradiance;

#include "techniques/vct/cones/upsample.glsl"

const float LEAST_FRACTION = 0.02; // of the cone set, weighted over the four neighbours

// Bilinear weight of neighbour 0…3 for full-resolution pixel 0…3.
float bilinear_weight(int neighbour, int pixel)
{
    vec2 offset = 0.5 * vec2(pixel & 1, pixel >> 1);
    vec2 weights = mix(1.0 - offset, offset, equal(ivec2(neighbour & 1, neighbour >> 1), ivec2(1)));
    return weights.x * weights.y;
}

// Fallback for a pixel whose surface is in none of the four neighbours: a larger neighbourhood, and
// if that does not contain it either, the neighbours' irradiance regardless of similarity.
vec3 irradiance_from_farther(ivec2 at, vct_surface_point here)
{
    vct_cone_sums sum = vct_cone_sums(mat3(0.0), vec3(0.0));
    vec4 fallback = vec4(0.0);
    for (int i = 0; i < 8; i++) {
        ivec2 side = (i & 1) == 0 ? ivec2(1 - (i & 2), 0) : ivec2(0, 1 - (i & 2));
        ivec2 corner = ivec2(1 - (i & 2), 1 - 2 * (i & 1));
        ivec2 there = vct_clamp_to_image(at + (i < 4 ? side : 2 * corner));
        vct_half_pixel p = vct_half_pixel_at(there);
        float near = i < 4 ? 1.0 : 0.25;
        vct_cone_sums sums = vct_cone_sums_at(there);
        vct_add(sum, sums, near * vct_similarity(p, here) * vct_cone_fraction(sums, p.up));
        if (p.valid) fallback += near * vec4(vct_irradiance(sums, p.up, set.gain), 1.0);
    }
    if (vct_cone_fraction(sum, here.normal) > LEAST_FRACTION)
        return vct_irradiance(sum, here.normal, set.gain);
    return fallback.rgb / max(fallback.a, 1e-6);
}

void main()
{
    frame = frame_block;
    set = set_block;
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.width, frame.height);
    if (any(greaterThanEqual(at, ivec2(set.width, set.height)))) return;
    vct_half_pixel near[4];
    vct_cone_sums sums[4];
    float fraction[4]; // of the cone set, a weight
    for (int i = 0; i < 4; i++) {
        ivec2 there = vct_clamp_to_image(at + ivec2(i & 1, i >> 1));
        near[i] = vct_half_pixel_at(there);
        sums[i] = vct_cone_sums_at(there);
        fraction[i] = vct_cone_fraction(sums[i], near[i].up);
    }
    uint missing = 0u; // bits of pixels whose surface is in none of the neighbours
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = 2 * at + ivec2(i & 1, i >> 1);
        if (any(greaterThanEqual(pixel, size))) continue;
        float z = texelFetch(depth, pixel, 0).r;
        vct_surface_point here =
            vct_surface_point_at(frame_world_position(frame_uv(uvec2(pixel)), max(z, 1e-12)),
                                 octahedral_decode(texelFetch(normal, pixel, 0).rg));
        vct_cone_sums sum = vct_cone_sums(mat3(0.0), vec3(0.0));
        for (int k = 0; k < 4; k++)
            vct_add(sum, sums[k],
                    bilinear_weight(k, i) * fraction[k] * vct_similarity(near[k], here));
        if (z <= 0.0)
            sum.direction = vec3(0.0);
        else if (vct_cone_fraction(sum, here.normal) < LEAST_FRACTION)
            missing |= 1u << i;
        imageStore(irradiance, pixel, vec4(vct_irradiance(sum, here.normal, set.gain), 1.0));
    }
    for (; missing != 0u; missing &= missing - 1u) {
        int i = findLSB(missing);
        ivec2 pixel = 2 * at + ivec2(i & 1, i >> 1);
        vct_surface_point here = vct_surface_point_at(
            frame_world_position(frame_uv(uvec2(pixel)), texelFetch(depth, pixel, 0).r),
            octahedral_decode(texelFetch(normal, pixel, 0).rg));
        imageStore(irradiance, pixel, vec4(irradiance_from_farther(at, here), 1.0));
    }
}
