#version 460
// To[i] = From[i + 1] + 1, cyclic.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer From
{
    uint from[];
};
layout(set = 0, binding = 1, std430) writeonly buffer To
{
    uint to[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x, count = uint(from.length());
    if (i < count) to[i] = from[(i + 1) % count] + 1;
}
