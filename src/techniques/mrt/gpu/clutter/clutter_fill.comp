// The light map of clutter, in the atlas of its charts: the texels' own, and those of gutters and
// of texels inside objects, which have others' light. Light of emissive surfaces, the sky
// and reflectors is added. A layer for each of red, green, blue of a side.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "techniques/common/light_map/place.glsl"
#define MRT_REFLECTOR_LIGHT_BINDING  4
#define MRT_REFLECTOR_SHARES_BINDING 5
#include "techniques/mrt/gpu/reflectors.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    mrt_clutter_fill_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer mrt_clutter_places
{
    mrt_gpu_clutter_place place_table[];
};
layout(set = 0, binding = 1, scalar) readonly buffer mrt_clutter_light
{
    vec3 light_table[]; // [texel][4]
};
layout(set = 0, binding = 2, scalar) readonly buffer mrt_texels
{
    mrt_texel texel_table[];
};
layout(set = 0, binding = 3, rgba16f) writeonly uniform image2DArray clutter_map;

// Irradiance of a surface that sees all of its hemisphere: as environment_irradiance_at.
vec3 environment_at(vec3 normal)
{
    float transfer[9];
    vec3 sum = vec3(0.0);
    sh9_clamped_cosine(normal, transfer);
    for (int i = 0; i < 9; i++) sum += transfer[i] * push.environment_sh[i];
    return max(sum, vec3(0.0));
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.places) return;
    mrt_gpu_clutter_place place = place_table[i];
    vec3 area_light = texel_table[place.texel].emitted * push.emitted;
    area_light += texel_table[place.texel].sky * environment_at(texel_table[place.texel].normal);
    area_light += reflected_irradiance(texel_table[place.texel].reflected);
    vec3 values[4];
    for (uint v = 0u; v < 4u; v++) values[v] = light_table[place.light * 4u + v];
    values[0] += area_light / SH_Y0;
    uvec3 at = light_map_place(place.place);
    for (int c = 0; c < 3; c++) {
        vec4 texel = vec4(values[0][c], values[1][c], values[2][c], values[3][c]);
        imageStore(clutter_map, ivec3(at.xy, LIGHT_MAP_LAYERS * at.z + c),
                   clamp(texel, -HALF_MAX, HALF_MAX));
    }
}
