#version 460
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint STEP = 1;
layout(set = 0, binding = 0, std430) buffer Values
{
    uint values[];
};
layout(push_constant) uniform Push
{
    uint scale, offset, count;
}
push;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < push.count) values[i] = values[i] * push.scale + push.offset * STEP;
}
