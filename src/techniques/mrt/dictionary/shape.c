// Texels and rays of dictionary shapes.
#include "shape.h"

#include <assert.h>
#include <math.h>

struct mrt_shape mrt_cube(int resolution, unsigned missing)
{
    assert(resolution >= 1 && missing < CUBE_ALL_FACES);
    return (struct mrt_shape){ MRT_CUBE, resolution, missing };
}

static bool is_open(const struct mrt_shape *shape, int face)
{
    return shape->missing >> face & 1u;
}

int mrt_shape_openings(const struct mrt_shape *shape)
{
    int count = 0;
    for (int f = 0; f < CUBE_FACES; f++) count += is_open(shape, f);
    return count;
}

int mrt_shape_texels(const struct mrt_shape *shape)
{
    return (CUBE_FACES - mrt_shape_openings(shape)) * shape->resolution * shape->resolution;
}

// Faces that are present follow each other in ascending order.
static int first_texel(const struct mrt_shape *shape, int face)
{
    int before = 0;
    for (int f = 0; f < face; f++) before += !is_open(shape, f);
    return before * shape->resolution * shape->resolution;
}

static int face_of_slot(const struct mrt_shape *shape, int slot)
{
    for (int f = 0; f < CUBE_FACES; f++)
        if (!is_open(shape, f) && slot-- == 0) return f;
    assert(false);
    return 0;
}

struct mrt_point mrt_shape_texel(const struct mrt_shape *shape, int texel)
{
    int n = shape->resolution, in_face = texel % (n * n);
    int face = face_of_slot(shape, texel / (n * n));
    float s = ((float)(in_face % n) + 0.5f) / (float)n;
    float t = ((float)(in_face / n) + 0.5f) / (float)n;
    mat3s frame = cube_from_face(face);
    frame.col[0] = glms_vec3_negate(frame.col[0]);
    frame.col[2] = glms_vec3_negate(frame.col[2]);
    return (struct mrt_point){ cube_face_point(face, s, t), frame };
}

static int cell_of(float x, int n)
{
    int i = (int)(x * (float)n);
    return i < n - 1 ? i : n - 1;
}

int mrt_shape_texel_at(const struct mrt_shape *shape, int face, float s, float t)
{
    if (is_open(shape, face)) return -1;
    int n = shape->resolution;
    return first_texel(shape, face) + cell_of(t, n) * n + cell_of(s, n);
}

// The two texel centres around x (0…1) of n, and the weight of the second.
static float between(float x, int n, int *low, int *high)
{
    float place = fminf(fmaxf(x * (float)n - 0.5f, 0.0f), (float)(n - 1));
    *low = (int)place;
    *high = *low + 1 < n ? *low + 1 : *low;
    return place - (float)*low;
}

static void look_up(const struct mrt_shape *shape, int face, struct mrt_hit *hit)
{
    int n = shape->resolution, base = first_texel(shape, face), i[2], j[2];
    float a = between(hit->s, n, &i[0], &i[1]), b = between(hit->t, n, &j[0], &j[1]);
    hit->texels = 4;
    for (int k = 0; k < 4; k++) {
        hit->texel[k] = base + j[k >> 1] * n + i[k & 1];
        hit->weight[k] = (k & 1 ? a : 1.0f - a) * (k >> 1 ? b : 1.0f - b);
    }
}

void mrt_shape_trace(const struct mrt_shape *shape, vec3s from, vec3s direction,
                     struct mrt_hit *hit)
{
    struct cube_exit exit = cube_trace(from, direction);
    *hit = (struct mrt_hit){ .opening = -1, .s = exit.s, .t = exit.t };
    if (is_open(shape, exit.face))
        hit->opening = exit.face;
    else
        look_up(shape, exit.face, hit);
}
