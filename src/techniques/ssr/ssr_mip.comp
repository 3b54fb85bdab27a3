// A mip of the radiance: a box filter.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D finer;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2D mip;

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(mip);
    if (any(greaterThanEqual(texel, size))) return;
    imageStore(mip, texel, textureLod(finer, (vec2(texel) + 0.5) / vec2(size), 0.0));
}
