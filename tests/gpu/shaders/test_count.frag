#version 460
// Counts its invocations.
layout(set = 0, binding = 0, std430) buffer Counter
{
    uint counter;
};
layout(location = 0) out vec4 color;

void main()
{
    atomicAdd(counter, 1);
    color = vec4(1);
}
