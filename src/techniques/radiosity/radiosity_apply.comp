// Irradiance of each pixel from the light map. With irradiance E along the surface's normal and
// vector irradiance V, bands 0 and 1 of spherical harmonics have E(n) = (E + n·V) / 2: n·V is E for
// the surface's own normal, so that E(n) is exact there, and in uniform light for all normals.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL_2D, local_size_y = RADIOSITY_LOCAL_2D) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_apply_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
layout(set = 0, binding = 4, scalar) readonly buffer radiosity_instances
{
    uint first_table[]; // [instances + 1] first triangle
};
layout(set = 0, binding = 5, scalar) readonly buffer radiosity_triangles
{
    radiosity_gpu_triangle triangle_table[];
};
layout(set = 0, binding = 6) uniform sampler2DArray light_map;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D irradiance;

// The place in the light map; z: the first layer, negative where there is none.
vec3 place_of(uvec2 ids, vec3 position)
{
    if (ids.x == 0u || ids.x > push.instances) return vec3(-1.0);
    uint triangle = first_table[ids.x - 1u] + ids.y - 1u;
    if (triangle >= first_table[ids.x]) return vec3(-1.0);
    radiosity_gpu_triangle t = triangle_table[triangle];
    if (t.sides == 0u) return vec3(-1.0);
    bool back = t.sides == 2u && dot(t.normal, frame.camera_position - position) < 0.0;
    return vec3(dot(t.u, vec4(position, 1.0)), dot(t.v, vec4(position, 1.0)),
                back ? float(RADIOSITY_LAYERS) : 0.0);
}

vec3 light_at(vec3 place, vec3 n)
{
    vec2 uv = place.xy / vec2(push.width, push.height);
    vec3 light;
    for (int c = 0; c < 3; c++) {
        vec4 texel = textureLod(light_map, vec3(uv, place.z + float(c)), 0.0);
        light[c] = 0.5 * (texel.x + dot(texel.yzw, n));
    }
    return clamp(light, vec3(0.0), vec3(HALF_MAX));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 result = vec3(0.0);
    if (z > 0.0) {
        vec3 place =
            place_of(texelFetch(id, pixel, 0).rg, frame_world_position(frame_uv(uvec2(pixel)), z));
        if (place.z >= 0.0)
            result = light_at(place, octahedral_decode(texelFetch(normal, pixel, 0).rg));
    }
    imageStore(irradiance, pixel, vec4(result, 1.0));
}
