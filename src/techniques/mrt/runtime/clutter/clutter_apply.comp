// Irradiance of the pixels of clutter from its light map, found by the triangle that they show.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/mrt/runtime/level.glsl"

layout(local_size_x = MRT_LOCAL_2D, local_size_y = MRT_LOCAL_2D) in;

layout(set = 0, binding = 2, scalar) readonly buffer mrt_clutter_instances
{
    mrt_gpu_clutter_instance instance_table[]; // in number_table
};
layout(set = 0, binding = 3, scalar) readonly buffer mrt_clutter_numbers
{
    uint number_table[]; // of each triangle of the scene; ~0: not clutter
};
layout(set = 0, binding = 4, scalar) readonly buffer mrt_clutter_triangles
{
    mrt_gpu_clutter_triangle triangle_table[];
};
layout(set = 0, binding = 5) uniform sampler2DArray clutter_map;
layout(set = 0, binding = 6) uniform usampler2D id;
layout(set = 0, binding = 7) uniform sampler2D depth;
layout(set = 0, binding = 8) uniform sampler2D normal;
layout(set = 0, binding = 10, scalar) readonly buffer mrt_clutter_moves
{
    mrt_gpu_clutter_move move_table[];
};
layout(push_constant, scalar) uniform push_block
{
    mrt_clutter_apply_push push;
};
layout(set = 0, binding = 9, rgba16f) uniform writeonly image2D irradiance;

vec3 map_irradiance(mrt_gpu_clutter_triangle triangle, vec3 position, vec3 n)
{
    vec2 at =
        vec2(dot(triangle.u_axis, position), dot(triangle.v_axis, position)) + triangle.offset;
    vec2 uv = clamp(at, triangle.low, triangle.high) / vec2(textureSize(clutter_map, 0).xy);
    vec3 sum;
    for (int c = 0; c < 3; c++)
        sum[c] = sh4_dot(textureLod(clutter_map, vec3(uv, float(c)), 0.0), n);
    return max(sum, vec3(0.0));
}

// Whether the map lights the pixel.
bool find_light(ivec2 pixel, out vec3 light)
{
    uvec2 shown = texelFetch(id, pixel, 0).rg;
    if (shown.x == 0u) return false;
    uint instance = shown.x - 1u, of_instance = shown.y - 1u;
    // One that was added since the map was made has the light of probes.
    if (instance >= push.instances || of_instance >= instance_table[instance].triangles)
        return false;
    uint number = number_table[instance_table[instance].first + of_instance];
    if (number == ~0u) return false;
    mrt_gpu_clutter_triangle triangle = triangle_table[number];
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    float z = texelFetch(depth, pixel, 0).r;
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    if (instance < push.moved) {
        mrt_gpu_clutter_move move = move_table[instance];
        position = mat3(move.x, move.y, move.z) * position + move.by;
        n = mat3(move.x, move.y, move.z) * n;
        n /= max(length(n), 1e-20);
    }
    // The map has the light of the front.
    if (dot(n, triangle.normal) <= 0.0) return false;
    light = level.gain * map_irradiance(triangle, position, n);
    return true;
}

// Alpha is 0 where apply.comp has to find the light.
void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec3 light = vec3(0.0);
    bool found = find_light(pixel, light);
    imageStore(irradiance, pixel, vec4(min(light, vec3(HALF_MAX)), found ? 1.0 : 0.0));
}
