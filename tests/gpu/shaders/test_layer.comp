#version 460
// A layer, seen as a 2D image, from the one below it in an array of layers: its value plus one.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D below;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D layer;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(layer)))) return;
    imageStore(layer, p, texelFetch(below, p, 0) + 1);
}
