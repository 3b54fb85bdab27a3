#version 460
// The changed version of test_reload.comp: another value and another binding.
layout(local_size_x = 8) in;
layout(set = 0, binding = 1, std430) writeonly buffer Values
{
    uint values[];
};
layout(push_constant) uniform Push
{
    uint unused, value;
}
push;

void main()
{
    values[gl_GlobalInvocationID.x] = 2;
}
