// Tables in images (table.h).
#ifndef AG_LIGHT_MAP_TABLE_GLSL
#define AG_LIGHT_MAP_TABLE_GLSL

#include "core/half.glsl"
#include "techniques/common/light_map/map_shared.h"

// The texel of an entry.
ivec2 light_map_at(uint entry)
{
    return ivec2(entry % LIGHT_MAP_TABLE_WIDTH, entry / LIGHT_MAP_TABLE_WIDTH);
}

// Irradiance and vector irradiance as four halves.
uvec2 light_map_pack(vec4 light)
{
    light = clamp(light, -HALF_MAX, HALF_MAX);
    return uvec2(packHalf2x16(light.xy), packHalf2x16(light.zw));
}

vec4 light_map_unpack(uvec2 words)
{
    return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
}

#ifdef TEXEL_LIGHT_BINDING
layout(set = 0, binding = TEXEL_LIGHT_BINDING,
       rg32ui) uniform readonly uimage2D texel_light; // [colour][texel]

vec4 texel_light_of(uint texel, uint texels, int colour)
{
    return light_map_unpack(imageLoad(texel_light, light_map_at(colour * texels + texel)).xy);
}
#endif

#endif
