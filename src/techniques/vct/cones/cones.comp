// Traces the diffuse cones of each pixel: the whole set, or a subset with interleaved sampling.
//
// Pixels that trace the same subset form a sub-image (Hong 2015, sec. 4.2). Each workgroup traces
// pixels of one sub-image, so that its invocations have the same directions. The paper copies
// pixels into sub-images for this; here the addressing does it without a copy.
//
// Cone directions are world-space lines, flipped into the hemisphere of the cone normal
// (cones/edges.comp): subsets of neighbours complete each other even if their normals differ.
// The results are stored as Σ L d of each colour channel and Σ d. For any normal n near the cone
// normal they give the irradiance
//     E(n) = π n·(Σ L d) / n·(Σ d). (1)
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "techniques/vct/vct_constants.h"
layout(constant_id = VCT_CONSTANT_MAP) const bool VCT_HAS_MAP = false;
#define ENVIRONMENT_MAP_BINDING 19
#define ENVIRONMENT_HAS_MAP     VCT_HAS_MAP
#include "frame/environment_map.glsl"
#include "frame/octahedral.glsl"
#define VCT_GRID_BINDING 0
#define VCT_GRID_COPIED
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/trace.glsl"
#include "techniques/vct/cones/cone_sums.glsl"
#if !VCT_SVO
#include "techniques/vct/rays/jitter.glsl"
#include "techniques/vct/rays/ray.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set_block;
};
vct_cone_params set; // a copy that main begins with, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler3D light;
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D red;   // Σ L d, Σ d.x
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D green; // Σ d.y
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D blue;  // Σ d.z
layout(set = 0, binding = 9) uniform writeonly image2D irradiance; // if each pixel traces all cones
layout(set = 0, binding = 12) uniform sampler2D cone_normal;       // axis of the cone set

const uint LEVEL_SET = 625u; // beyond the numbers of the strata

#define VCT_SMALL_EMITTERS_BINDING 10
#include "techniques/vct/cones/small_emitters.glsl"

// Converts irradiance from one direction to a term of (1), whose denominator n·(Σ d) is about ½
// for a whole cone set and 1 for a single cone.
void add_small_emitters(inout vct_cone_sums sum, uint part, uint parts, vec3 at, vec3 up, int first)
{
    float projected = set.cone_count == 1u ? 1.0 : 0.5;
    for (uint i = part * 7u % parts; i < VCT_EMITTER_POINTS; i += parts) {
        vec3 to, arriving = vct_small_emitter_light(light, i, at, up, first, to);
        sum.light += outerProduct(to, arriving * (projected / PI));
    }
}

#if !VCT_SVO
// Rays near the border of a level are divided between it and the next coarser one.
int level_of_ray(vct_start start, uint tile, uint number)
{
    if (VCT_CLIPS == 1) return 0;
    float chance = fract(vct_low_discrepancy(tile, number + LEVEL_SET).x + set.level_chance);
    return start.level + (chance < start.next ? 1 : 0);
}
#endif

void main()
{
    frame = frame_block;
    set = set_block;
    vct = vct_block;
    vec3 origin_m = clips.origin_m;
    // Consecutive workgroups trace the sub-images of the same blocks: better cache locality.
    uint side = set.interleave, parts = side * side, part = gl_WorkGroupID.x % parts;
    // Eight consecutive invocations, which software drivers run together, are 4 x 2 near pixels.
    uvec2 local = gl_LocalInvocationID.xy;
    uvec2 block = uvec2(gl_WorkGroupID.x / parts, gl_WorkGroupID.y) * gl_WorkGroupSize.xy +
                  uvec2(local.x & 3u | (local.y & 1u) << 2u, local.x >> 2u | (local.y & 6u));
    // Each row of blocks shifts the pattern by one pixel, so that thin vertical objects get
    // different cones in successive blocks.
    ivec2 pixel = ivec2(block * side + uvec2((part + block.y) % side, part / side));
    if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) return;
    ivec2 frame_pixel = pixel * int(set.step);
    float z = texelFetch(depth, frame_pixel, 0).r;
    vct_cone_sums sum = vct_cone_sums(mat3(0.0), vec3(0.0));
    vec3 n = vec3(0.0);
    if (z > 0.0) {
        n = octahedral_decode(texelFetch(normal, frame_pixel, 0).rg);
        vec3 at = (frame_world_position(frame_uv(uvec2(frame_pixel)), z) - origin_m) / set.texel_m;
        vec3 up = octahedral_decode(texelFetch(cone_normal, pixel, 0).rg);
        vct_start start = vct_start_at(at);
        // Neighbours trace distant parts of the set; 7 is coprime with 4, 9, 16 and 25.
#if !VCT_SVO
        uint tile = vct_morton(block), rows = set.cone_count / set.columns;
        mat3 world_from_set = mat3(set.set_axes[0], set.set_axes[1], set.set_axes[2]);
#endif
        uint first = part * 7u % parts % set.cone_count;
        uint i = first;
        do {
            vec3 direction = set.cone_count == 1u ? up : set_block.cones[i].xyz;
#if !VCT_SVO
            if (VCT_RAYS) {
                vec2 jitter = vct_low_discrepancy(tile, part + i * parts);
                direction = world_from_set *
                            vct_uniform_direction(vct_in_stratum(i, set.columns, rows, jitter));
            }
#endif
            direction = dot(direction, up) < 0.0 ? -direction : direction;
            vec4 traced;
#if !VCT_SVO
            if (VCT_RAYS)
                traced = vct_trace_ray(at, up, direction, 0.5 * set.texel_m * vct.decay_per_m,
                                       level_of_ray(start, tile, part + i * parts));
            else
#endif
                traced = vct_cone(light, at, up, direction, set.offset, set.width_per_m,
                                  set.last_mip, start);
            vec3 radiance =
                traced.rgb + (1.0 - traced.a) * environment_lobe(direction, set.environment_sigma);
            if (VCT_OCCLUSION) radiance = 1.0 - traced.rgb;
            vct_add_cone(sum, radiance, set_block.cones[i].w * direction);
            i += parts;
        } while (i < set.cone_count);
        if (VCT_HAS_SMALL_EMITTERS) add_small_emitters(sum, part, parts, at, up, start.level);
    }
    if (side == 1u && set.step == 1u) {
        imageStore(irradiance, pixel, vec4(vct_irradiance(sum, n, set.gain), 1.0));
        return;
    }
    imageStore(red, pixel, clamp(vec4(sum.light[0], sum.direction.x), -HALF_MAX, HALF_MAX));
    imageStore(green, pixel, clamp(vec4(sum.light[1], sum.direction.y), -HALF_MAX, HALF_MAX));
    imageStore(blue, pixel, clamp(vec4(sum.light[2], sum.direction.z), -HALF_MAX, HALF_MAX));
}
