#include "scene/charts/sight.h"

#include <math.h>
#include <stdlib.h>

// Over the surface, in distances between the places.
static const float HEIGHT = 0.25f;

struct sight_box {
    vec3s low, high;
};

// ---- the hierarchy

struct keyed {
    uint64_t key;
    uint32_t triangle;
};

static int compare_keys(const void *a, const void *b)
{
    const struct keyed *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static struct sight_box triangle_box(const struct surface_triangle *t)
{
    const vec3s *c = t->corner;
    return (struct sight_box){ glms_vec3_minv(c[0], glms_vec3_minv(c[1], c[2])),
                               glms_vec3_maxv(c[0], glms_vec3_maxv(c[1], c[2])) };
}

static struct sight_box join(struct sight_box a, struct sight_box b)
{
    return (struct sight_box){ glms_vec3_minv(a.low, b.low), glms_vec3_maxv(a.high, b.high) };
}

static struct sight_box empty_box(void)
{
    return (struct sight_box){ vec3_of(INFINITY, INFINITY, INFINITY),
                               vec3_of(-INFINITY, -INFINITY, -INFINITY) };
}

enum { AXIS_BITS = 21 };

// Bits of the three coordinates in turn (Morton order).
static uint64_t curve_of(vec3s at, const struct sight_box *bounds)
{
    uint64_t key = 0;
    uint32_t cell[3];
    for (int a = 0; a < 3; a++) {
        const float size = bounds->high.raw[a] - bounds->low.raw[a];
        const float part = size > 0.0f ? (at.raw[a] - bounds->low.raw[a]) / size : 0.0f;
        cell[a] = (uint32_t)(fminf(fmaxf(part, 0.0f), 1.0f) * (float)((1 << AXIS_BITS) - 1));
    }
    for (int bit = AXIS_BITS - 1; bit >= 0; bit--)
        for (int a = 0; a < 3; a++) key = key << 1 | (cell[a] >> bit & 1);
    return key;
}

static bool sort_triangles(struct sight *s)
{
    const uint32_t count = s->surface->count;
    struct keyed *keyed = host_alloc(s->host, count, sizeof *keyed);
    struct sight_box bounds = empty_box();
    if (!keyed) return false;
    for (uint32_t t = 0; t < count; t++)
        bounds = join(bounds, triangle_box(&s->surface->triangles[t]));
    for (uint32_t t = 0; t < count; t++) {
        const struct sight_box box = triangle_box(&s->surface->triangles[t]);
        const vec3s middle = glms_vec3_scale(glms_vec3_add(box.low, box.high), 0.5f);
        keyed[t] = (struct keyed){ curve_of(middle, &bounds), t };
    }
    qsort(keyed, count, sizeof *keyed, compare_keys);
    for (uint32_t t = 0; t < count; t++) s->order[t] = keyed[t].triangle;
    host_free(s->host, keyed);
    return true;
}

// Triangles of a lowest box, adjacent in the order.
enum { LEAF = 4 };

static void make_boxes(struct sight *s)
{
    const uint32_t leaves = 1u << s->levels;
    for (uint32_t leaf = 0; leaf < leaves; leaf++) {
        struct sight_box *box = &s->boxes[leaves - 1 + leaf];
        *box = empty_box();
        for (uint64_t i = (uint64_t)leaf * LEAF; i < (uint64_t)(leaf + 1) * LEAF; i++)
            if (i < s->surface->count)
                *box = join(*box, triangle_box(&s->surface->triangles[s->order[i]]));
    }
    for (uint32_t n = leaves - 1; n-- > 0;)
        s->boxes[n] = join(s->boxes[2 * n + 1], s->boxes[2 * n + 2]);
}

bool sight_init(struct sight *out, struct host *host, const struct surface *surface)
{
    *out = (struct sight){ .host = host, .surface = surface };
    while ((uint64_t)LEAF << out->levels < surface->count) out->levels++;
    out->order = host_alloc(host, surface->count, sizeof *out->order);
    out->boxes = host_alloc(host, (size_t)2 << out->levels, sizeof *out->boxes);
    const bool ok = out->order && out->boxes && sort_triangles(out);
    if (ok) make_boxes(out);
    if (!ok) sight_finish(out);
    return ok;
}

void sight_finish(struct sight *sight)
{
    if (!sight->host) return;
    host_free(sight->host, sight->order);
    host_free(sight->host, sight->boxes);
    *sight = (struct sight){ 0 };
}

// ---- segments

struct segment {
    double from[3], along[3];
    struct sight_box box;
};

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Möller & Trumbore 1997.
static bool meets(const struct segment *s, const struct surface_triangle *t)
{
    double a[3], b[3], to[3], p[3], q[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)t->corner[1].raw[k] - (double)t->corner[0].raw[k];
        b[k] = (double)t->corner[2].raw[k] - (double)t->corner[0].raw[k];
        to[k] = s->from[k] - (double)t->corner[0].raw[k];
    }
    cross(s->along, b, p);
    cross(to, a, q);
    const double scale = 1.0 / dot(a, p);
    const double u = scale * dot(to, p), v = scale * dot(s->along, q), at = scale * dot(b, q);
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > 0.0 && at < 1.0;
}

static bool overlap(const struct sight_box *a, const struct sight_box *b)
{
    for (int k = 0; k < 3; k++)
        if (a->low.raw[k] > b->high.raw[k] || b->low.raw[k] > a->high.raw[k]) return false;
    return true;
}

static bool meets_any(const struct sight *sight, const struct segment *s)
{
    const uint32_t leaves = 1u << sight->levels;
    uint32_t stack[64], depth = 0;
    for (stack[depth++] = 0; depth > 0;) {
        const uint32_t n = stack[--depth];
        if (!overlap(&sight->boxes[n], &s->box)) continue;
        if (n < leaves - 1) {
            stack[depth++] = 2 * n + 2;
            stack[depth++] = 2 * n + 1;
            continue;
        }
        for (uint64_t i = (uint64_t)(n - (leaves - 1)) * LEAF, k = 0; k < LEAF; i++, k++)
            if (i < sight->surface->count && meets(s, &sight->surface->triangles[sight->order[i]]))
                return true;
    }
    return false;
}

bool sight_is_free(const struct sight *sight, const struct sight_place *a,
                   const struct sight_place *b)
{
    const float height = HEIGHT * glms_vec3_distance(a->position, b->position);
    const vec3s from = glms_vec3_muladds(a->normal, height, a->position);
    const vec3s to = glms_vec3_muladds(b->normal, height, b->position);
    struct segment segment = { .box = { glms_vec3_minv(from, to), glms_vec3_maxv(from, to) } };
    for (int k = 0; k < 3; k++) {
        segment.from[k] = (double)from.raw[k];
        segment.along[k] = (double)to.raw[k] - (double)from.raw[k];
    }
    return !meets_any(sight, &segment);
}
