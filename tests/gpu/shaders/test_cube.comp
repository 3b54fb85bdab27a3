#version 460
// Samples the six faces of a cube map along the axes, in the order +x, −x, +y, −y, +z, −z.
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform samplerCube cube;
layout(set = 0, binding = 1, std430) writeonly buffer Faces
{
    float faces[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= 6) return;
    vec3 direction = vec3(0);
    direction[i / 2] = i % 2 == 0 ? 1 : -1;
    faces[i] = textureLod(cube, direction, 0).x;
}
