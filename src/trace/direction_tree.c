#include "trace/direction_tree.h"

#include <math.h>

vec3s direction_from_square(int axis, vec2s at)
{
    int a = axis < 3 ? axis : axis - 3;
    float x = at.x + at.y - 1.0f, y = at.x - at.y;
    float z = fmaxf(1.0f - fabsf(x) - fabsf(y), 0.0f);
    vec3s d;
    d.raw[a] = axis < 3 ? z : -z;
    d.raw[a == 2 ? 0 : a + 1] = x;
    d.raw[a == 0 ? 2 : a - 1] = y;
    return glms_vec3_normalize(d);
}

// ---- sampling

// Selects the second of two parts by their weights, and stretches *u over the chosen one.
static int choose(float first, float second, float *u)
{
    float share = first / (first + second);
    bool upper = !(*u < share);
    *u = upper ? (*u - share) / (1.0f - share) : *u / share;
    if (*u > 1.0f - 0x1p-24f) *u = 1.0f - 0x1p-24f; // fminf compiles to a call
    return upper;
}

vec2s direction_tree_sample(const struct direction_node *nodes, vec2s u)
{
    vec2s corner = { { 0.0f, 0.0f } };
    float size = 1.0f;
    for (uint16_t i = 0;;) {
        const float *share = nodes[i].share;
        int right = choose(share[0] + share[2], share[1] + share[3], &u.x);
        int upper = choose(share[right], share[right + 2], &u.y);
        size *= 0.5f;
        corner.x += size * (float)right;
        corner.y += size * (float)upper;
        i = nodes[i].child[right + 2 * upper];
        if (i == 0) return (vec2s){ { corner.x + size * u.x, corner.y + size * u.y } };
    }
}

// ---- fitting

// The quarters of a square with n records share PRIOR / (n + PRIOR) of its weight, so that a few
// records do not rule out a direction.
static const double PRIOR = 1.0;
static const double MIN_SHARE = 1.0 / 128.0; // of the tree's weight, of a divided square
enum { MIN_RECORDS = 8 };                    // of a divided square

struct fit {
    struct direction_node *nodes;
    int count;
    double min_weight;
};

// Moves records with at[axis] < middle to the front.
static int partition(struct direction_record *r, int count, int axis, float middle)
{
    int low = 0;
    for (int i = 0; i < count; i++)
        if (r[i].at.raw[axis] < middle) {
            struct direction_record t = r[i];
            r[i] = r[low];
            r[low++] = t;
        }
    return low;
}

static double weight_of(const struct direction_record *r, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) sum += (double)r[i].weight;
    return sum;
}

static void fit_node(struct fit *f, int index, struct direction_record *r, int count, vec2s corner,
                     float size, int depth)
{
    float half = 0.5f * size;
    int lower = partition(r, count, 1, corner.y + half);
    int from[5] = { 0, partition(r, lower, 0, corner.x + half), lower, 0, count };
    from[3] = lower + partition(r + lower, count - lower, 0, corner.x + half);
    double all = weight_of(r, count);
    for (int i = 0; i < 4; i++) {
        struct direction_record *part = r + from[i];
        int n = from[i + 1] - from[i];
        double weight = (count * weight_of(part, n) + PRIOR * 0.25 * all) / (count + PRIOR);
        f->nodes[index].share[i] = all > 0.0 ? (float)(weight / all) : 0.25f;
        f->nodes[index].child[i] = 0;
        if (n < MIN_RECORDS || weight < f->min_weight || depth >= DIRECTION_TREE_DEPTH ||
            f->count == DIRECTION_TREE_NODES)
            continue;
        vec2s at = { { corner.x + half * (float)(i & 1), corner.y + half * (float)(i >> 1) } };
        int child = f->count++;
        f->nodes[index].child[i] = (uint16_t)child;
        fit_node(f, child, part, n, at, half, depth + 1);
    }
}

int direction_tree_fit(struct direction_record *records, int count, struct direction_node *nodes)
{
    double weight = weight_of(records, count);
    if (!(weight > 0.0) || !isfinite(weight)) return 0;
    struct fit f = { .nodes = nodes, .count = 1, .min_weight = MIN_SHARE * weight };
    fit_node(&f, 0, records, count, (vec2s){ { 0.0f, 0.0f } }, 1.0f, 1);
    return f.count;
}
