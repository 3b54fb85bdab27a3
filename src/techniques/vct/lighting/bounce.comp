// Light from other voxels and the sky on the faces of voxels, by rays or cones: irradiance. With
// one bounce from emission and sky only, with more from all light that the voxels sent in the
// previous frame. Faces of one block that lie on one surface are a part (lighting/parts.comp) and
// share the irradiance at their centre: bounced light varies slowly.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "core/basis.glsl"
#include "frame/frame.glsl"
#include "techniques/vct/vct_constants.h"
layout(constant_id = VCT_CONSTANT_MAP) const bool VCT_HAS_MAP = false;
#define ENVIRONMENT_MAP_BINDING 19
#define ENVIRONMENT_HAS_MAP     VCT_HAS_MAP
#include "frame/environment_map.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/lighting/part.glsl"
#include "techniques/vct/volume/volume_shared.h"

layout(local_size_x = VCT_BLOCK_LOCAL) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler3D light;
layout(set = 0, binding = 4) uniform usampler2D vct_parts;
layout(set = 0, binding = 5, scalar) readonly buffer vct_part_counts
{
    vct_part_count counts;
};
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D vct_bounced;

#include "techniques/vct/cones/trace.glsl"
#if !VCT_SVO
#include "techniques/vct/rays/jitter.glsl"
#define VCT_RAY_VOXELS_CHANGE
#include "techniques/vct/rays/ray.glsl"
#endif

#define VCT_SMALL_EMITTERS_BINDING 10
#include "techniques/vct/cones/small_emitters.glsl"

const uint EMITTER_SAMPLES = 4u; // of the points on a small emitter

vec3 small_emitters_at(vec3 at, vec3 normal)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < EMITTER_SAMPLES; i++) {
        vec3 to, found = vct_small_emitter_light(light, i * (VCT_EMITTER_POINTS / EMITTER_SAMPLES),
                                                 at, normal, vct.level, to);
        sum += found * dot(normal, to);
    }
    return sum * (float(VCT_EMITTER_POINTS) / float(EMITTER_SAMPLES));
}

vec3 arriving(vec4 traced, vec3 direction)
{
    return traced.rgb * vct.light_scale +
           (1.0 - traced.a) * environment_lobe(direction, set.environment_sigma);
}

#if !VCT_SVO
vec3 sum_of_rays(vec3 at, mat3 world_from_local, uint part_number)
{
    vec3 sum = vec3(0.0), normal = world_from_local[2];
    for (uint i = 0u; i < set.cone_count; i++) {
        vec2 jitter = vct_low_discrepancy(part_number, i);
        vec3 direction = world_from_local *
                         vct_cosine_direction(
                             vct_in_stratum(i, set.columns, set.cone_count / set.columns, jitter));
        sum += arriving(vct_trace_ray(at, normal, direction, 0.0, vct.level), direction);
    }
    return sum * (PI / float(set.cone_count));
}
#endif

vec3 sum_of_cones(vec3 at, mat3 world_from_local)
{
    vec3 sum = vec3(0.0), normal = world_from_local[2];
    for (uint i = 0u; i < set.cone_count; i++) {
        vec3 direction = world_from_local * set.cones[i].xyz;
        sum += set.cones[i].w *
               arriving(vct_cone(light, at, normal, direction, set.offset, set.width_per_m,
                                 set.last_mip, vct_start(vct.level, 0.0)),
                        direction);
    }
    return sum;
}

vec3 irradiance(vct_part_record part)
{
    mat3 world_from_local = basis_of(part.normal);
    vec3 position = vct_world_from_voxels(part.position);
    // With one grid both origins are equal, and the subtraction is exact.
    vec3 at = (position - (VCT_CLIPS > 1 ? clips.origin_m : vct.origin_m)) / set.texel_m;
    vec3 sum;
#if !VCT_SVO
    if (VCT_RAYS)
        sum = sum_of_rays(at, world_from_local, part.number);
    else
#endif
        sum = sum_of_cones(at, world_from_local);
    if (VCT_HAS_SMALL_EMITTERS) sum += small_emitters_at(at, part.normal);
    return min(sum, vec3(HALF_MAX));
}

shared uint chosen[VCT_BLOCK_LOCAL * VCT_PARTS_EACH], chosen_count;

// Those of a workgroup's parts whose turn it is take consecutive invocations.
void choose()
{
    uint each = set.in_turns == 0u ? 1u : VCT_PARTS_EACH;
    uint turns = set.in_turns == 0u ? 1u : max(counts.count / VCT_PARTS_OF_TURN, 1u);
    if (gl_LocalInvocationID.x == 0u) chosen_count = 0u;
    barrier();
    for (uint i = 0u; i < each; i++) {
        uint part = (gl_WorkGroupID.x * each + i) * VCT_BLOCK_LOCAL + gl_LocalInvocationID.x;
        if (part >= counts.count) break;
        uint turn = vct_part_turn(texelFetch(vct_parts, vct_face_texel(part), 0));
        if (turn % turns == set.frame % turns) chosen[atomicAdd(chosen_count, 1u)] = part;
    }
    barrier();
}

void main()
{
    choose();
    for (uint i = gl_LocalInvocationID.x; i < chosen_count; i += VCT_BLOCK_LOCAL) {
        ivec2 at = vct_face_texel(chosen[i]);
        vct_part_record part = vct_unpack_part(texelFetch(vct_parts, at, 0));
        imageStore(vct_bounced, at, vec4(irradiance(part), 0.0));
    }
}
