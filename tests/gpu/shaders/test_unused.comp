#version 460
// Declares more than it uses.
layout(local_size_x = 8) in;
layout(set = 0, binding = 0, std430) readonly buffer Never
{
    uint never[];
};
layout(set = 0, binding = 1) uniform sampler2D neither;
layout(set = 0, binding = 2, std430) writeonly buffer Values
{
    uint values[];
};

void main()
{
    values[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x;
}
