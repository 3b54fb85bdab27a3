// Texels and rays of dictionary shapes.
#include "shape.h"

#include <assert.h>
#include <math.h>

struct mrt_shape mrt_cube(int resolution, unsigned missing)
{
    assert(resolution >= 1 && missing < CUBE_ALL_FACES);
    return (struct mrt_shape){ MRT_CUBE, resolution, missing };
}

// A tube's openings are its begin and end.
struct mrt_shape mrt_tube(int resolution, enum tube_bend bend)
{
    static const int ends[] = { CUBE_FRONT, CUBE_RIGHT, CUBE_LEFT };
    assert(resolution >= 4);
    return (struct mrt_shape){ (enum mrt_shape_kind)(MRT_TUBE + (int)bend), resolution,
                               1u << CUBE_BACK | 1u << ends[bend] };
}

static enum tube_bend bend_of(const struct mrt_shape *shape)
{
    return (enum tube_bend)((int)shape->kind - MRT_TUBE);
}

int mrt_shape_openings(const struct mrt_shape *shape)
{
    int count = 0;
    for (int f = 0; f < CUBE_FACES; f++) count += mrt_shape_is_open(shape, f);
    return count;
}

int mrt_shape_texels(const struct mrt_shape *shape)
{
    int faces = shape->kind == MRT_CUBE ? CUBE_FACES - mrt_shape_openings(shape) : 1;
    return faces * shape->resolution * shape->resolution;
}

// Faces that are present follow each other in ascending order.
static int first_texel(const struct mrt_shape *shape, int face)
{
    int before = face;
    for (unsigned f = shape->missing & ((1u << face) - 1u); f; f &= f - 1u) before--;
    return before * shape->resolution * shape->resolution;
}

static int face_of_slot(const struct mrt_shape *shape, int slot)
{
    for (int f = 0; f < CUBE_FACES; f++)
        if (!mrt_shape_is_open(shape, f) && slot-- == 0) return f;
    assert(false);
    return 0;
}

static struct mrt_point tube_point(const struct mrt_shape *shape, float around, float along)
{
    struct tube_frame axis = tube_axis(bend_of(shape), along);
    float angle = 2.0f * GLM_PIf * around;
    vec3s inward = glms_vec3_scale(axis.left, -cosf(angle));
    inward.y -= sinf(angle);
    return (struct mrt_point){ tube_wall(bend_of(shape), around, along),
                               { .col = { axis.forward, glms_vec3_cross(inward, axis.forward),
                                          inward } } };
}

struct mrt_point mrt_shape_texel(const struct mrt_shape *shape, int texel)
{
    int n = shape->resolution, in_face = texel % (n * n);
    float s = ((float)(in_face % n) + 0.5f) / (float)n;
    float t = ((float)(in_face / n) + 0.5f) / (float)n;
    if (shape->kind != MRT_CUBE) return tube_point(shape, s, t);
    int face = face_of_slot(shape, texel / (n * n));
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

int mrt_shape_texel_near(const struct mrt_shape *shape, vec3s point)
{
    int n = shape->resolution;
    if (shape->kind != MRT_CUBE) {
        struct tube_place place = tube_locate(bend_of(shape), point);
        return cell_of(glm_max(place.along, 0.0f), n) * n + cell_of(place.around, n);
    }
    struct cube_exit at = cube_trace(vec3_of(0, 0, 0), point);
    if (mrt_shape_is_open(shape, at.face)) return -1;
    return first_texel(shape, at.face) + cell_of(at.t, n) * n + cell_of(at.s, n);
}

int mrt_shape_patches(const struct mrt_shape *shape)
{
    return shape->kind == MRT_CUBE ? CUBE_FACES - mrt_shape_openings(shape) : 4;
}

int mrt_shape_patch(const struct mrt_shape *shape, int texel)
{
    int n = shape->resolution;
    if (shape->kind == MRT_CUBE) return texel / (n * n);
    return (8 * (texel % n) + 4 + n) / (2 * n) % 4;
}

// The two texel centres around x (0…1) of n, and the weight of the second.
static float between(float x, int n, int *low, int *high)
{
    float place = glm_clamp(x * (float)n - 0.5f, 0.0f, (float)(n - 1));
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

// As look_up, with the first texel around next to the last.
static void look_up_tube(const struct mrt_shape *shape, struct tube_place at, struct mrt_hit *hit)
{
    int n = shape->resolution, j[2];
    float place = at.around * (float)n + (float)n - 0.5f, b = between(at.along, n, &j[0], &j[1]);
    int low = (int)place;
    float a = place - (float)low;
    hit->texels = 4;
    for (int k = 0; k < 4; k++) {
        hit->texel[k] = j[k >> 1] * n + (low + (k & 1)) % n;
        hit->weight[k] = (k & 1 ? a : 1.0f - a) * (k >> 1 ? b : 1.0f - b);
    }
}

static void trace_tube(const struct mrt_shape *shape, vec3s from, vec3s direction,
                       struct mrt_hit *hit)
{
    enum tube_exit exit = tube_trace(bend_of(shape), from, direction, &hit->distance);
    vec3s at = glms_vec3_muladds(direction, hit->distance, from);
    if (exit == TUBE_WALL) {
        look_up_tube(shape, tube_locate(bend_of(shape), at), hit);
        return;
    }
    hit->opening = CUBE_BACK;
    for (int f = 0; exit == TUBE_END && f < CUBE_FACES; f++)
        if (f != CUBE_BACK && mrt_shape_is_open(shape, f)) hit->opening = f;
    vec3s on_face = glms_mat3_mulv(glms_mat3_transpose(cube_from_face(hit->opening)), at);
    hit->s = on_face.x + 0.5f;
    hit->t = on_face.y + 0.5f;
}

static void trace_cube(const struct mrt_shape *shape, vec3s from, vec3s direction,
                       struct mrt_hit *hit)
{
    struct cube_exit exit = cube_trace(from, direction);
    hit->face = exit.face;
    hit->s = exit.s;
    hit->t = exit.t;
    hit->distance = exit.distance;
    if (mrt_shape_is_open(shape, exit.face))
        hit->opening = exit.face;
    else
        look_up(shape, exit.face, hit);
}

void mrt_shape_trace(const struct mrt_shape *shape, vec3s from, vec3s direction,
                     struct mrt_hit *hit)
{
    *hit = (struct mrt_hit){ .opening = -1 };
    if (shape->kind == MRT_CUBE)
        trace_cube(shape, from, direction, hit);
    else
        trace_tube(shape, from, direction, hit);
}

bool mrt_shape_points_at(const struct mrt_shape *shape, int face, vec3s from, vec3s direction)
{
    static const float ROUNDING = 1e-3f;
    const int axis = face / 2;
    const float plane = face & 1 ? 0.5f : -0.5f, speed = direction.raw[axis];
    if (shape->kind == MRT_CUBE) return true;
    if (!(speed * plane > 0.0f)) return false;
    vec3s at = glms_vec3_muladds(direction, (plane - from.raw[axis]) / speed, from);
    at.raw[axis] = 0.0f;
    return glms_vec3_norm(at) < TUBE_RADIUS + ROUNDING;
}
