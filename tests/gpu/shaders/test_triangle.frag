#version 460
layout(push_constant) uniform Push
{
    vec4 color;
    float depth;
    float size;
}
push;
layout(location = 0) out vec4 color;

void main()
{
    color = push.color;
}
