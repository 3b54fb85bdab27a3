// The blur (Hong 2015, sec. 4.2): pixels that have found few of the cones, on surfaces too small
// for a whole block, borrow from others that look the same way from about the same plane.
// Bilateral, with a step that grows with the distance. Where all cones were found there is nothing
// to smooth, since sub-images have been interpolated.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/clipmap/clipmap.glsl"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D gathered; // irradiance, share of the cones
layout(set = 0, binding = 6) uniform writeonly image2D irradiance;

const float ENOUGH = 0.9; // of the cones
const int RINGS = 4;

vec3 position_of(ivec2 pixel, float z)
{
    return frame_world_position(frame_uv(uvec2(pixel)), z);
}

// How much a pixel says about another: its share of the cones, if it looks the same way from the
// same plane.
float like(ivec2 there, vec3 position, vec3 n, float share, float texel_m)
{
    float z = texelFetch(depth, there, 0).r;
    if (z <= 0.0) return 0.0;
    vec3 off = position_of(there, z) - position;
    float cosine = max(dot(n, octahedral_decode(texelFetch(normal, there, 0).rg)), 0.0);
    float near = clamp(1.0 - length(off) / texel_m, 0.0, 1.0);
    float c4 = cosine * cosine * cosine * cosine;
    return share * share * c4 * c4 * near;
}

vec3 borrowed(ivec2 pixel, vec4 own)
{
    vec3 position = position_of(pixel, texelFetch(depth, pixel, 0).r);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    float texel_m = set.texel_m * vct_texel_at((position - clips.origin_m) / set.texel_m);
    vec4 sum = own.a * own.a * vec4(own.rgb, 1.0);
    for (int ring = 0; ring < RINGS; ring++) {
        int step = 1 << ring;
        for (int i = 0; i < 4; i++) {
            // To the sides and to the corners by turns.
            ivec2 side = (i & 1) == 0 ? ivec2(1 - (i & 2), 0) : ivec2(0, 1 - (i & 2));
            ivec2 corner = ivec2(1 - (i & 2), 1 - 2 * (i & 1));
            ivec2 there = pixel + step * ((ring & 1) == 0 ? side : corner);
            if (any(lessThan(there, ivec2(0))) ||
                any(greaterThanEqual(there, ivec2(set.width, set.height))))
                continue;
            vec4 other = texelFetch(gathered, there, 0);
            if (other.a > 0.0)
                sum += like(there, position, n, other.a, texel_m) * vec4(other.rgb, 1.0);
        }
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : own.rgb;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) return;
    vec4 own = texelFetch(gathered, pixel, 0);
    vec3 result = own.rgb;
    if (own.a > 0.0 && own.a < ENOUGH) result = borrowed(pixel, own);
    imageStore(irradiance, pixel, vec4(result, 1.0));
}
