#version 460
// An array of bindings, which gpu.h does not support.
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform sampler2D images[2];
layout(set = 0, binding = 2, std430) writeonly buffer Values
{
    vec4 values[];
};

void main()
{
    values[0] = texelFetch(images[0], ivec2(0), 0) + texelFetch(images[1], ivec2(0), 0);
}
