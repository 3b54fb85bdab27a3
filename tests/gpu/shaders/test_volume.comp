#version 460
// In place: value = 2 · value + z.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform image3D volume;

void main()
{
    ivec3 p = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(p, imageSize(volume)))) return;
    imageStore(volume, p, vec4(imageLoad(volume, p).x * 2 + float(p.z)));
}
