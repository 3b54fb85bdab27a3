// Light of each texel: transfer of the maps, and the first-order light of the sky, emissive
// surfaces and paint, unless that scatters below surfaces and is in the maps. The maps have no
// directions: their vector irradiance is along the normal.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define LIGHT_MAP_TEXELS_BINDING  1
#define LIGHT_MAP_PAINT_BINDING   5
#define LIGHT_MAP_SKY_BINDING     6
#define LIGHT_MAP_PATCHES_BINDING 7
#include "techniques/common/light_map/texels.glsl"
#include "techniques/ort/ort_shared.h"

layout(local_size_x = ORT_LOCAL) in;
layout(constant_id = ORT_FINISH_SCATTERS) const bool SCATTERS = false;

layout(push_constant, scalar) uniform push_block
{
    ort_finish_push push;
};
layout(set = 0, binding = 2) uniform usampler2D ort_places;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D ort_sums;
layout(set = 0, binding = 4, rg32ui) uniform writeonly uimage2D texel_light; // [colour][texel]

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    uint place = texelFetch(ort_places, light_map_at(i), 0).x;
    uint x = place & 0xffffu, y = place >> 16;
    uint run = ((x / ORT_RUN) * push.height + y) * 6u + x % ORT_RUN / 4u;
    vec3 normal = light_map_texel_part(i, push.texels, TEXEL_NORMAL).xyz;
    vec3 painted = SCATTERS ? vec3(0.0) : light_map_painted_light(i, push.sources);
    vec4 area_light[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    if (!SCATTERS) area_light = light_map_area_light(i, push.texels, push.sources);
    for (int c = 0; c < 3; c++) {
        float sum = imageLoad(ort_sums, light_map_at(run + 2 * c))[x % 4u] / ORT_MAP_SCALE;
        sum += painted[c];
        // Pixels have (x + n·yzw) / 2. Light that leaves a surface does not depend on n.
        vec4 light = SCATTERS ? vec4(2.0 * sum, vec3(0.0)) : vec4(sum, sum * normal);
        light += area_light[c];
        imageStore(texel_light, light_map_at(c * push.texels + i),
                   uvec4(light_map_pack(light), 0u, 0u));
    }
}
