// Unit vectors and axis-aligned boxes.
#include "core/vec.h"

#include <float.h>
#include <math.h>

// Scaling by a power of two first is exact and avoids overflow and underflow of the squares.
vec3s vec3_unit(vec3s v)
{
    float largest = fmaxf(fmaxf(fabsf(v.x), fabsf(v.y)), fabsf(v.z));
    bool finite = isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
    if (!finite || largest <= 0.0f) return vec3_of(0, 0, 0);
    int exponent;
    frexpf(largest, &exponent);
    v = vec3_of(ldexpf(v.x, -exponent), ldexpf(v.y, -exponent), ldexpf(v.z, -exponent));
    return glms_vec3_scale(v, 1.0f / glms_vec3_norm(v));
}

vec3s vec3_towards(vec3s from, vec3s to)
{
    vec3s offset = glms_vec3_sub(to, from);
    if (isfinite(offset.x) && isfinite(offset.y) && isfinite(offset.z)) return vec3_unit(offset);
    // The offset overflows; half of it does not.
    return vec3_unit(glms_vec3_sub(glms_vec3_scale(to, 0.5f), glms_vec3_scale(from, 0.5f)));
}

struct box3 box3_empty(void)
{
    return (struct box3){ vec3_of(FLT_MAX, FLT_MAX, FLT_MAX),
                          vec3_of(-FLT_MAX, -FLT_MAX, -FLT_MAX) };
}

struct box3 box3_add_point(struct box3 box, vec3s p)
{
    return (struct box3){ glms_vec3_minv(box.min, p), glms_vec3_maxv(box.max, p) };
}

struct box3 box3_union(struct box3 a, struct box3 b)
{
    return (struct box3){ glms_vec3_minv(a.min, b.min), glms_vec3_maxv(a.max, b.max) };
}

// Arvo 1990, "Transforming Axis-Aligned Bounding Boxes": minimum and maximum of each row.
struct box3 box3_transform(mat4s to_from, struct box3 box)
{
    if (box3_is_empty(box)) return box3_empty();
    struct box3 out = { vec3_xyz(to_from.col[3]), vec3_xyz(to_from.col[3]) };
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++) {
            float low = to_from.raw[column][row] * box.min.raw[column];
            float high = to_from.raw[column][row] * box.max.raw[column];
            out.min.raw[row] += fminf(low, high);
            out.max.raw[row] += fmaxf(low, high);
        }
    }
    return out;
}

bool box3_is_empty(struct box3 box)
{
    return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
}

bool box3_intersects(struct box3 a, struct box3 b)
{
    for (int i = 0; i < 3; i++)
        if (!(a.min.raw[i] <= b.max.raw[i] && b.min.raw[i] <= a.max.raw[i])) return false;
    return true;
}

vec3s box3_centre(struct box3 box)
{
    return glms_vec3_scale(glms_vec3_add(box.min, box.max), 0.5f);
}

vec3s box3_size(struct box3 box)
{
    if (box3_is_empty(box)) return vec3_of(0.0f, 0.0f, 0.0f);
    return glms_vec3_sub(box.max, box.min);
}

int box3_longest_axis(struct box3 box)
{
    const vec3s size = box3_size(box);
    if (size.x >= size.y) return size.x >= size.z ? 0 : 2;
    return size.y >= size.z ? 1 : 2;
}
