// Vectors and matrices by value: cglm's struct API, column-major, depth 0…1.
// Include this file, never cglm itself: it fixes alignment and clip-space settings. Transforms are
// named `to_from`. All of cglm takes twice as long to compile.
#pragma once

#define CGLM_ALL_UNALIGNED
#define CGLM_FORCE_DEPTH_ZERO_TO_ONE
#include <cglm/struct/affine.h>
#include <cglm/struct/box.h>
#include <cglm/struct/mat3.h>
#include <cglm/struct/mat4.h>
#include <cglm/struct/quat.h>
#include <cglm/struct/vec2.h>
#include <cglm/struct/vec3.h>
#include <cglm/struct/vec4.h>

#include <stdbool.h>

static inline vec3s vec3_of(float x, float y, float z)
{
    return (vec3s){ { x, y, z } };
}

static inline vec3s vec3_xyz(vec4s v)
{
    return (vec3s){ { v.x, v.y, v.z } };
}

static inline vec4s vec4_of(vec3s v, float w)
{
    return (vec4s){ { v.x, v.y, v.z, w } };
}

// Affine transform of a point (w = 1, no division).
static inline vec3s mat4_point(mat4s to_from, vec3s p)
{
    return glms_mat4_mulv3(to_from, p, 1.0f);
}

// Affine transform of a direction (w = 0).
static inline vec3s mat4_direction(mat4s to_from, vec3s d)
{
    return glms_mat4_mulv3(to_from, d, 0.0f);
}

// The unit vector along v, without intermediate overflow or underflow. 0 where v is 0 or not
// finite.
vec3s vec3_unit(vec3s v);
// The unit vector from one point to another; 0 where they coincide.
vec3s vec3_towards(vec3s from, vec3s to);

// Luminance of linear Rec. 709.
static inline float luminance(vec3s rgb)
{
    return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
}

// An axis-aligned box; empty while min > max.
struct box3 {
    vec3s min, max;
};

struct box3 box3_empty(void);
struct box3 box3_add_point(struct box3 box, vec3s p);
struct box3 box3_union(struct box3 a, struct box3 b);
struct box3 box3_transform(mat4s to_from, struct box3 box);
bool box3_is_empty(struct box3 box);
bool box3_intersects(struct box3 a, struct box3 b); // also where they only touch
vec3s box3_centre(struct box3 box);
vec3s box3_size(struct box3 box);
int box3_longest_axis(struct box3 box); // of equal ones the first

// The transform of normals: the cofactor matrix, which is the inverse transpose times the
// determinant. It exists for singular matrices too; the sign is corrected for mirroring ones.
static inline mat3s mat4_normal_transform(mat4s m)
{
    const vec3s x = vec3_xyz(m.col[0]), y = vec3_xyz(m.col[1]), z = vec3_xyz(m.col[2]);
    mat3s cofactor = { .col = { glms_vec3_cross(y, z), glms_vec3_cross(z, x),
                                glms_vec3_cross(x, y) } };
    if (glms_vec3_dot(x, cofactor.col[0]) < 0.0f)
        for (int i = 0; i < 3; i++) cofactor.col[i] = glms_vec3_negate(cofactor.col[i]);
    return cofactor;
}

// Completes the unit vector n to a right-handed orthonormal basis (tangent, bitangent, n) (Duff et
// al. 2017, "Building an Orthonormal Basis, Revisited").
static inline void basis_of(vec3s n, vec3s *tangent, vec3s *bitangent)
{
    float sign = copysignf(1.0f, n.z);
    float a = -1.0f / (sign + n.z);
    float b = n.x * n.y * a;
    *tangent = vec3_of(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *bitangent = vec3_of(b, sign + n.y * n.y * a, -n.y);
}
