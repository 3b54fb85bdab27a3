// The change of light at an object's own surface (Giuffrida 2016, appendix B.3): Σ c_j s_j in each
// of its pixels, s_j the self-transfer interpolated between the points of the triangle. Light d_j
// of punctual lights has its shadow in direct light: only its reflection is added, s_j and the
// occluded part of Y_j. Runs after the pass `apply`, on the same tiles.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/common/light_map/triangle.glsl"
#include "techniques/dnrt/dnrt_shared.h"

#include "techniques/dnrt/dnrt_object.glsl"

layout(local_size_x = DNRT_TILE, local_size_y = DNRT_LOCAL_ROWS) in;
layout(constant_id = 2) const uint COEFFICIENTS = 4;
layout(constant_id = 4) const uint PLANES = 3; // 4: with light of punctual lights

layout(push_constant, scalar) uniform push_block
{
    dnrt_self_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
layout(set = 0, binding = 4, scalar) uniform dnrt_objects
{
    dnrt_gpu_object object_table[DNRT_MAX_OBJECTS];
};
layout(set = 0, binding = 5, scalar) readonly buffer dnrt_tiles
{
    uint tile_table[]; // of dnrt_apply.comp
};
layout(set = 0, binding = 6, scalar) readonly buffer dnrt_own
{
    dnrt_own_instance instance_table[];
};
layout(set = 0, binding = 7, scalar) readonly buffer dnrt_patches
{
    dnrt_gpu_patch patch_table[];
};
layout(set = 0, binding = 8, scalar) readonly buffer dnrt_points
{
    uvec2 point_table[]; // [point][coefficient]: change by colour, occluded part
};
layout(set = 0, binding = 9, scalar) readonly buffer dnrt_light
{
    vec3 light_table[];
};
layout(set = 0, binding = 10, rgba16f) uniform image2D irradiance;

vec3 change_at(dnrt_gpu_patch patch_, vec2 at, vec3 n, uint light, uint punctual)
{
    uint steps = patch_.grid & DNRT_PATCH_STEPS, points[3], first = patch_.first;
    vec3 front = cross(patch_.corner[1] - patch_.corner[0], patch_.corner[2] - patch_.corner[0]);
    if ((patch_.grid & DNRT_PATCH_MIRRORED) != 0u) front = -front;
    if ((patch_.grid & DNRT_PATCH_TWO_SIDES) != 0u && dot(front, n) < 0.0)
        first += (steps + 1u) * (steps + 2u) / 2u;
    vec3 weights, sum = vec3(0.0);
    triangle_points(steps, at, points, weights);
    for (uint k = 0; k < 3; k++)
        for (uint j = 0; j < COEFFICIENTS; j++) {
            uvec2 packed = point_table[(first + points[k]) * COEFFICIENTS + j];
            vec4 change = vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
            sum += weights[k] * change.rgb * light_table[light + j];
            if (PLANES == 4u)
                sum += weights[k] * (change.rgb + change.a) * light_table[punctual + j];
        }
    return INV_PI * sum; // dnrt_light has π c_j
}

vec3 change_of(ivec2 pixel, uvec2 ids, float z)
{
    dnrt_own_instance of = instance_table[ids.x - 1u];
    uint triangle = light_map_triangle_of(ids, of.triangles);
    if (of.object < 0 || triangle == LIGHT_MAP_NO_TRIANGLE) return vec3(0.0);
    dnrt_gpu_object object = object_table[of.object];
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z) - object.centre;
    vec3 p = dnrt_object_from_world(object, position) / of.scale;
    vec3 n = dnrt_object_from_world(object, octahedral_decode(texelFetch(normal, pixel, 0).rg));
    dnrt_gpu_patch first = patch_table[of.first + triangle];
    dnrt_gpu_patch next = patch_table[of.next + triangle];
    vec2 at = triangle_weights(mix(first.corner[0], next.corner[0], object.part),
                               mix(first.corner[1], next.corner[1], object.part),
                               mix(first.corner[2], next.corner[2], object.part), p);
    uint light = push.light + uint(of.object) * DNRT_COEFFICIENTS;
    uint punctual = push.punctual + uint(of.object) * DNRT_COEFFICIENTS;
    vec3 change = change_at(first, at, n, light, punctual);
    return object.part > 0.0 ? mix(change, change_at(next, at, n, light, punctual), object.part)
                             : change;
}

void main()
{
    uint tile = tile_table[gl_WorkGroupID.x * (DNRT_TILE_BITS + push.words)];
    ivec2 first = ivec2(DNRT_TILE * uvec2(tile % push.tiles_x, tile / push.tiles_x) +
                        gl_LocalInvocationID.xy);
    for (int y = 0; y < DNRT_TILE; y += DNRT_LOCAL_ROWS) {
        ivec2 pixel = first + ivec2(0, y);
        if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) continue;
        uvec2 ids = texelFetch(id, pixel, 0).rg;
        float z = texelFetch(depth, pixel, 0).r;
        if (ids.x == 0u || ids.x > push.instances || !(z > 0.0)) continue;
        vec3 change = change_of(pixel, ids, z);
        if (change == vec3(0.0)) continue;
        vec4 before = imageLoad(irradiance, pixel);
        imageStore(irradiance, pixel,
                   vec4(clamp(before.rgb + change, vec3(0.0), vec3(HALF_MAX)), before.a));
    }
}
