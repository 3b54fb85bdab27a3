// Half of the gathering stage (Hong 2015, sec. 4.2): each pixel adds up what the pixels next to it in a row (or, then,
// a column) have traced, as far as one surface reaches. After rows and columns each has the light of all cones.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "frame/frame_shared.h"
#include "techniques/vct/vct_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool FINISH = false; // columns: write irradiance

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D edges;
layout(set = 0, binding = 4) uniform sampler2D gathered;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D result;

const float PI = 3.14159265;

bool ends(ivec2 pixel)
{
    uint bits = uint(texelFetch(edges, pixel, 0).r * 255.0 + 0.5);
    return (bits & (FINISH ? 2u : 1u)) != 0u;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) return;
    // Not FINISH ? ivec2(…) : ivec2(…): a vector chosen by a specialisation constant comes out as the second one on
    // Mesa 22.3.
    ivec2 along = ivec2(FINISH ? 0 : 1, FINISH ? 1 : 0);
    int here = FINISH ? pixel.y : pixel.x, count = int(FINISH ? set.height : set.width);
    int before = int(set.interleave - 1u) / 2, after = int(set.interleave) / 2;
    vec4 sum = texelFetch(gathered, pixel, 0);
    bool whole = true;
    for (int i = 1; i <= after; i++) {
        whole = whole && here + i < count && !ends(pixel + (i - 1) * along);
        if (whole) sum += texelFetch(gathered, pixel + i * along, 0);
    }
    whole = true;
    for (int i = 1; i <= before; i++) {
        whole = whole && here - i >= 0 && !ends(pixel - i * along);
        if (whole) sum += texelFetch(gathered, pixel - i * along, 0);
    }
    if (FINISH) sum = vec4(sum.a > 0.0 ? sum.rgb * (PI * set.gain / sum.a) : vec3(0.0), 1.0);
    imageStore(result, pixel, clamp(sum, 0.0, HALF_MAX));
}
