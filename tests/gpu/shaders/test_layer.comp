#version 460
// layer = below + 1; both are 2D views of layers of one array.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D below;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D layer;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(layer)))) return;
    imageStore(layer, p, texelFetch(below, p, 0) + 1);
}
