// The cones of each pixel, or its part of them.
//
// Pixels that share a set of cones are one sub-image (Hong 2015, sec. 4.2): every workgroup takes
// pixels of one alone, so that all its invocations go the same way through the volume. That is what
// the paper's splitting and translation of blocks is for; in compute the addresses are enough, and
// nothing is copied.
//
// Cones point along lines that are the same all over the world, each to the side on which the
// normal is: neighbours complete each other's set however their normals differ (cones/edges.comp:
// the normal that they start along). What they found is kept as vectors, Σ L d of each colour with
// Σ d, which any normal n near theirs can turn into irradiance:
//     E(n) = π n·(Σ L d) / n·(Σ d). (1)
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/trace.glsl"
#include "techniques/vct/cones/cone_sums.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler3D light;
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D red;   // Σ L d, Σ d.x
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D green; // Σ d.y
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D blue;  // Σ d.z
layout(set = 0, binding = 9) uniform writeonly image2D irradiance; // where pixels trace all cones
layout(set = 0, binding = 12) uniform sampler2D cone_normal;       // the way in which they start

#define VCT_SMALL_EMITTERS_BINDING 10
#include "techniques/vct/cones/small_emitters.glsl"

// Irradiance from one direction, as a part of (1): a whole set of cones has the share n·(Σ d) = ½,
// one alone has 1.
void add_small_emitters(inout vct_cone_sums sum, uint part, uint parts, vec3 at, vec3 up, int first)
{
    float share = set.cone_count == 1u ? 1.0 : 0.5;
    for (uint i = part * 7u % parts; i < VCT_EMITTER_POINTS; i += parts) {
        vec3 to, found = vct_small_emitter_light(light, i, at, up, first, to);
        sum.light += outerProduct(to, found * (share / VCT_PI));
    }
}

void main()
{
    // Workgroups that follow each other take the parts of the same blocks: what they read and write
    // stays in caches.
    uint side = set.interleave, parts = side * side, part = gl_WorkGroupID.x % parts;
    uvec2 block = uvec2(gl_WorkGroupID.x / parts, gl_WorkGroupID.y) * gl_WorkGroupSize.xy +
                  gl_LocalInvocationID.xy;
    // In each row of blocks they are shifted by one: what is thin and upright has other cones from
    // block to block.
    ivec2 pixel = ivec2(block * side + uvec2((part + block.y) % side, part / side));
    if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) return;
    ivec2 seen = pixel * int(set.step);
    float z = texelFetch(depth, seen, 0).r;
    vct_cone_sums sum = vct_cone_sums(mat3(0.0), vec3(0.0));
    vec3 n = vec3(0.0);
    if (z > 0.0) {
        n = octahedral_decode(texelFetch(normal, seen, 0).rg);
        vec3 at = (frame_world_position(frame_uv(uvec2(seen)), z) - clips.origin_m) / set.texel_m;
        vec3 up = octahedral_decode(texelFetch(cone_normal, pixel, 0).rg);
        vct_start first_grid = vct_start_at(at);
        // Parts that neighbours have are far apart in the set: 7 has no factor in common with 4, 9,
        // 16 and 25.
        uint first = part * 7u % parts % set.cone_count;
        for (uint i = first; i < set.cone_count; i += parts) {
            vec3 direction = set.cone_count == 1u ? up : set.cones[i].xyz;
            direction = dot(direction, up) < 0.0 ? -direction : direction;
            vec4 met = vct_cone(light, at, up, direction, set.offset, set.width_per_m, set.last_mip,
                                first_grid);
            vec3 found = met.rgb + (1.0 - met.a) * frame.sky;
            if (VCT_OCCLUSION) found = 1.0 - met.rgb;
            vct_add_cone(sum, found, set.cones[i].w * direction);
        }
        if (VCT_HAS_SMALL_EMITTERS) add_small_emitters(sum, part, parts, at, up, first_grid.level);
    }
    if (side == 1u && set.step == 1u) {
        imageStore(irradiance, pixel, vec4(vct_irradiance(sum, n, set.gain), 1.0));
        return;
    }
    imageStore(red, pixel, clamp(vec4(sum.light[0], sum.direction_index.x), -HALF_MAX, HALF_MAX));
    imageStore(green, pixel, clamp(vec4(sum.light[1], sum.direction_index.y), -HALF_MAX, HALF_MAX));
    imageStore(blue, pixel, clamp(vec4(sum.light[2], sum.direction_index.z), -HALF_MAX, HALF_MAX));
}
