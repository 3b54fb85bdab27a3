#version 460
// Arguments for an indirect dispatch: one work group per 64 of the count.
layout(local_size_x = 8) in;
layout(set = 0, binding = 0, std140) uniform Count
{
    uint count;
};
layout(set = 0, binding = 1, std430) writeonly buffer Arguments
{
    uint arguments[3];
};

void main()
{
    if (gl_GlobalInvocationID.x == 0)
        arguments[0] = (count + 63) / 64, arguments[1] = 1, arguments[2] = 1;
}
