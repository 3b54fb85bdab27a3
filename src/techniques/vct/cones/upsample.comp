// From what was found at every second pixel of every second row to the irradiance of all: of the
// vectors at the four places about a pixel, as near as they are in the picture and as alike as
// their surfaces are, with the pixel's own normal, so that normal maps stay sharp.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D red;
layout(set = 0, binding = 6) uniform sampler2D green;
layout(set = 0, binding = 7) uniform sampler2D blue;
layout(set = 0, binding = 8) uniform sampler2D cone_normal;
layout(set = 0, binding = 9) uniform writeonly image2D irradiance;

#include "techniques/vct/cones/upsample.glsl"

const float LEAST_LIKE = 0.02; // of the four places together

// Of one of four places, for a pixel of those between them.
float share_in_picture(int of, int pixel)
{
    vec2 between = 0.5 * vec2(pixel & 1, pixel >> 1);
    vec2 share = mix(1.0 - between, between, equal(ivec2(of & 1, of >> 1), ivec2(1)));
    return share.x * share.y;
}

// Where none of the four shows the pixel's surface: places farther off; and where they do not
// either, what each place about has for itself.
vec3 gather_farther(ivec2 at, vct_surface_point here)
{
    vct_cone_sums sum = vct_cone_sums(mat3(0.0), vec3(0.0));
    vec4 any = vec4(0.0);
    for (int i = 0; i < 8; i++) {
        ivec2 side = (i & 1) == 0 ? ivec2(1 - (i & 2), 0) : ivec2(0, 1 - (i & 2));
        ivec2 corner = ivec2(1 - (i & 2), 1 - 2 * (i & 1));
        ivec2 there = vct_within(at + (i < 4 ? side : 2 * corner));
        vct_half_pixel p = vct_half_pixel_at(there);
        float near = i < 4 ? 1.0 : 0.25;
        vct_cone_sums found = vct_cone_sums_at(there);
        vct_add(sum, found, near * vct_similarity(p, here) * vct_cone_fraction(found, p.up));
        if (p.valid) any += near * vec4(vct_irradiance(found, p.up, set.gain), 1.0);
    }
    if (vct_cone_fraction(sum, here.normal) > LEAST_LIKE)
        return vct_irradiance(sum, here.normal, set.gain);
    return any.rgb / max(any.a, 1e-6);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.width, frame.height);
    if (any(greaterThanEqual(at, ivec2(set.width, set.height)))) return;
    vct_half_pixel near[4];
    vct_cone_sums found[4];
    float share[4]; // of the cones: places that found few count little
    for (int i = 0; i < 4; i++) {
        ivec2 there = vct_within(at + ivec2(i & 1, i >> 1));
        near[i] = vct_half_pixel_at(there);
        found[i] = vct_cone_sums_at(there);
        share[i] = vct_cone_fraction(found[i], near[i].up);
    }
    uint lost = 0u; // pixels of whose surface none of these places is
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = 2 * at + ivec2(i & 1, i >> 1);
        if (any(greaterThanEqual(pixel, size))) continue;
        float z = texelFetch(depth, pixel, 0).r;
        vct_surface_point here =
            vct_surface_point_at(frame_world_position(frame_uv(uvec2(pixel)), max(z, 1e-12)),
                                 octahedral_decode(texelFetch(normal, pixel, 0).rg));
        vct_cone_sums sum = vct_cone_sums(mat3(0.0), vec3(0.0));
        for (int k = 0; k < 4; k++)
            vct_add(sum, found[k],
                    share_in_picture(k, i) * share[k] * vct_similarity(near[k], here));
        if (z <= 0.0)
            sum.direction_index = vec3(0.0);
        else if (vct_cone_fraction(sum, here.normal) < LEAST_LIKE)
            lost |= 1u << i;
        imageStore(irradiance, pixel, vec4(vct_irradiance(sum, here.normal, set.gain), 1.0));
    }
    for (; lost != 0u; lost &= lost - 1u) {
        int i = findLSB(lost);
        ivec2 pixel = 2 * at + ivec2(i & 1, i >> 1);
        vct_surface_point here = vct_surface_point_at(
            frame_world_position(frame_uv(uvec2(pixel)), texelFetch(depth, pixel, 0).r),
            octahedral_decode(texelFetch(normal, pixel, 0).rg));
        imageStore(irradiance, pixel, vec4(gather_farther(at, here), 1.0));
    }
}
