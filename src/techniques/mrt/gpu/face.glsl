// Faces of a block, in the order −x +x −y +y −z +z.
#ifndef AG_MRT_FACE_GLSL
#define AG_MRT_FACE_GLSL

// cube_from_face of dictionary/cube.h: columns u, v and n, n outward.
mat3 cube_from_face(int face)
{
    vec3 n = vec3(0.0), v = vec3(0.0);
    n[face / 2] = (face & 1) != 0 ? 1.0 : -1.0;
    v[face / 2 == 1 ? 2 : 1] = 1.0;
    return mat3(cross(v, n), v, n);
}

#endif
