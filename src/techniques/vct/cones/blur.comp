// Bilateral blur (Hong 2015, sec. 4.2) of pixels that gathered only part of the cone set: their
// surface is smaller than a pixel block. The step doubles from ring to ring. Pixels with the whole
// set need no blur: gathering interpolates the sub-images.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/clipmap/clipmap.glsl"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set_block;
};
vct_cone_params set; // a copy that main begins with, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D gathered; // irradiance, fraction of the cone set
layout(set = 0, binding = 6) uniform writeonly image2D irradiance;

const float COMPLETE = 0.9; // fraction of the cone set that needs no blur
const int RINGS = 4;

// Incomplete pixels are few and scattered. A workgroup lists its own and distributes them over its
// invocations: subgroups of which one pixel is incomplete would take as long as with all.
const int TILE = VCT_BLUR_TILE * VCT_LOCAL_2D; // pixels along the side of a workgroup
shared uint listed_count, listed[TILE * TILE];

// Weight of a neighbour: its squared fraction of the cone set, times similarity of normal and
// position.
float weight_of(ivec2 neighbour, vec3 position, vec3 n, float fraction, float per_texel_m)
{
    float z = texelFetch(depth, neighbour, 0).r;
    if (z <= 0.0) return 0.0;
    vec3 offset = frame_view_position(neighbour, frame_view_distance(z)) - position;
    float cosine = max(dot(n, octahedral_decode(texelFetch(normal, neighbour, 0).rg)), 0.0);
    float near = clamp(1.0 - length(offset) * per_texel_m, 0.0, 1.0);
    float c4 = cosine * cosine * cosine * cosine;
    return fraction * fraction * c4 * c4 * near;
}

vec3 blurred(ivec2 pixel)
{
    float z = texelFetch(depth, pixel, 0).r;
    vec3 position = frame_view_position(pixel, frame_view_distance(z));
    vec3 world = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    float texel_m = set.texel_m * vct_texel_at((world - clips.origin_m) / set.texel_m);
    vec4 own = texelFetch(gathered, pixel, 0), sum = own.a * own.a * vec4(own.rgb, 1.0);
    for (int ring = 0; ring < RINGS; ring++) {
        int step = 1 << ring;
        for (int i = 0; i < 4; i++) {
            // Rings alternate between edge neighbours and diagonal ones.
            ivec2 side = (i & 1) == 0 ? ivec2(1 - (i & 2), 0) : ivec2(0, 1 - (i & 2));
            ivec2 corner = ivec2(1 - (i & 2), 1 - 2 * (i & 1));
            ivec2 neighbour = pixel + step * ((ring & 1) == 0 ? side : corner);
            if (any(lessThan(neighbour, ivec2(0))) ||
                any(greaterThanEqual(neighbour, ivec2(set.width, set.height))))
                continue;
            vec4 other = texelFetch(gathered, neighbour, 0);
            if (other.a > 0.0)
                sum += weight_of(neighbour, position, n, other.a, 1.0 / texel_m) *
                       vec4(other.rgb, 1.0);
        }
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : own.rgb;
}

void main()
{
    frame = frame_block;
    set = set_block;
    ivec2 first = ivec2(gl_WorkGroupID.xy) * TILE;
    if (gl_LocalInvocationIndex == 0u) listed_count = 0u;
    barrier();
    for (int i = int(gl_LocalInvocationIndex); i < TILE * TILE; i += VCT_LOCAL_2D * VCT_LOCAL_2D) {
        ivec2 pixel = first + ivec2(i % TILE, i / TILE);
        if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) continue;
        vec4 own = texelFetch(gathered, pixel, 0);
        if (own.a > 0.0 && own.a < COMPLETE)
            listed[atomicAdd(listed_count, 1u)] = uint(i);
        else
            imageStore(irradiance, pixel, vec4(own.rgb, 1.0));
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < listed_count; i += VCT_LOCAL_2D * VCT_LOCAL_2D) {
        int place = int(listed[i]);
        ivec2 pixel = first + ivec2(place % TILE, place / TILE);
        imageStore(irradiance, pixel, vec4(blurred(pixel), 1.0));
    }
}
