// Vectors perpendicular to a unit vector.
#ifndef AG_CORE_BASIS_GLSL
#define AG_CORE_BASIS_GLSL

// Columns: tangent, bitangent, n. Equal to basis_of (core/vec.h), also for n.z = −0.
mat3 basis_of(vec3 n)
{
    float side = (floatBitsToUint(n.z) & 0x80000000u) != 0u ? -1.0 : 1.0;
    float a = -1.0 / (side + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x),
                vec3(b, side + n.y * n.y * a, -n.y), n);
}

// One of length 1, perpendicular to an axis of the world, too.
vec3 perpendicular_to(vec3 n)
{
    return normalize(abs(n.y) < 0.7 ? cross(n, vec3(0, 1, 0)) : cross(n, vec3(1, 0, 0)));
}

#endif
