#version 460
// Comparisons of a reversed depth image with a reference, at texel centres.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2DShadow shadow;
layout(set = 0, binding = 1, std430) writeonly buffer Lit
{
    float lit[];
};
layout(push_constant) uniform Push
{
    float reference;
}
push;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = textureSize(shadow, 0);
    if (any(greaterThanEqual(p, size))) return;
    lit[p.y * size.x + p.x] =
        textureLod(shadow, vec3((vec2(p) + 0.5) / vec2(size), push.reference), 0);
}
