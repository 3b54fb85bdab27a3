// A level of the depth pyramid: the nearest surface of each cell, the largest reversed depth
// (Uludag 2014). The first level is a copy of the depth buffer; beyond the image there is no
// surface.
//
// Permutation: FIRST, the copy.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D finer;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D level;

float nearest_of(ivec2 cell)
{
#if FIRST
    return any(greaterThanEqual(cell, textureSize(finer, 0))) ? 0.0 : texelFetch(finer, cell, 0).r;
#else
    ivec2 first = 2 * cell;
    return max(max(texelFetch(finer, first, 0).r, texelFetch(finer, first + ivec2(1, 0), 0).r),
               max(texelFetch(finer, first + ivec2(0, 1), 0).r,
                   texelFetch(finer, first + ivec2(1, 1), 0).r));
#endif
}

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, imageSize(level)))) return;
    imageStore(level, cell, vec4(nearest_of(cell)));
}
