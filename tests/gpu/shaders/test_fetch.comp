#version 460
// Copies the first mip of an image view to a buffer.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1, std430) writeonly buffer Texels
{
    vec4 texels[];
};

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = textureSize(image, 0);
    if (all(lessThan(p, size))) texels[p.y * size.x + p.x] = texelFetch(image, p, 0);
}
