#version 460
// Twice the texel at the pixel.
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 color;

void main()
{
    color = 2 * texelFetch(image, ivec2(gl_FragCoord.xy), 0);
}
