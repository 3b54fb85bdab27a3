#version 460
// A triangle that covers the screen, at the pushed depth; counter-clockwise in the image.
layout(push_constant) uniform Push
{
    vec4 color;
    float depth;
    float size;
}
push;

void main()
{
    vec2 corners[3] = vec2[](vec2(-1, -1), vec2(-1, 3), vec2(3, -1));
    gl_Position = vec4(corners[gl_VertexIndex] * push.size, push.depth, 1);
}
