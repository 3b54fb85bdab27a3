#version 460
// One step of a ping-pong: each texel becomes its right neighbour's value plus one, cyclic.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D source;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D destination;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(source);
    if (any(greaterThanEqual(p, size))) return;
    uint value = imageLoad(source, ivec2((p.x + 1) % size.x, p.y)).x;
    imageStore(destination, p, uvec4(value + 1));
}
