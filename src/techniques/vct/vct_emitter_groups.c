// Groups are split at the mean of their keys, the one with the largest second moment first, as the
// clusters of a light tree do (Walter et al. 2005, Lightcuts). Within a group lights follow the
// leaves of a k-d tree.
#include "techniques/vct/vct_emitter_groups.h"

#include <math.h>
#include <stdlib.h>

static int compare_index(const struct vct_light *a, const struct vct_light *b)
{
    return (a->index > b->index) - (a->index < b->index);
}

#define COMPARE_ALONG(axis)                                                                        \
    static int compare_##axis(const void *a, const void *b)                                        \
    {                                                                                              \
        const struct vct_light *l = a, *m = b;                                                     \
        const int order =                                                                          \
            (l->position.axis > m->position.axis) - (l->position.axis < m->position.axis);         \
        return order ? order : compare_index(l, m);                                                \
    }
COMPARE_ALONG(x)
COMPARE_ALONG(y)
COMPARE_ALONG(z)
#undef COMPARE_ALONG

// The order of the leaves of a balanced k-d tree.
static void order(struct vct_light *lights, int count)
{
    static int (*const compare[3])(const void *, const void *) = { compare_x, compare_y,
                                                                   compare_z };
    if (count < 2) return;
    struct box3 bounds = box3_empty();
    for (int i = 0; i < count; i++) bounds = box3_add_point(bounds, lights[i].position);
    qsort(lights, (size_t)count, sizeof *lights, compare[box3_longest_axis(bounds)]);
    order(lights, count / 2);
    order(lights + count / 2, count - count / 2);
}

int vct_light_side(vec3s normal)
{
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (fabsf(normal.raw[i]) > fabsf(normal.raw[axis])) axis = i;
    return 2 * axis + (normal.raw[axis] < 0.0f);
}

static struct box3 key_bounds(const struct vct_light *lights, int count)
{
    struct box3 bounds = box3_empty();
    for (int i = 0; i < count; i++) bounds = box3_add_point(bounds, lights[i].key);
    return bounds;
}

// Moves the lights before the mean along the longest axis to the front; returns their number.
static int partition(struct vct_light *lights, int count, struct box3 bounds)
{
    const int axis = box3_longest_axis(bounds);
    double sum = 0.0, flux = 0.0;
    for (int i = 0; i < count; i++) {
        sum += lights[i].flux * (double)lights[i].key.raw[axis];
        flux += lights[i].flux;
    }
    // Rounding must not leave all on one side.
    const double first = (double)bounds.min.raw[axis], last = (double)bounds.max.raw[axis],
                 mean = fmin(fmax(sum / flux, first), nextafter(last, -INFINITY));
    int before = 0;
    for (int i = 0; i < count; i++) {
        if ((double)lights[i].key.raw[axis] > mean) continue;
        const struct vct_light moved = lights[i];
        lights[i] = lights[before];
        lights[before++] = moved;
    }
    return before;
}

// Gain of a subdivision of the group, up to a factor: 0 if it has one key.
static double spread_of(const struct vct_light *lights, const struct vct_emitter_group *group)
{
    double flux = 0.0;
    for (int i = 0; i < group->count; i++) flux += lights[group->first + i].flux;
    const vec3s size = box3_size(key_bounds(lights + group->first, group->count));
    return flux * (double)glms_vec3_norm2(size);
}

static struct vct_emitter_group *widest_of(const struct vct_light *lights,
                                           struct vct_emitter_group *groups, int count)
{
    struct vct_emitter_group *widest = NULL;
    double most = 0.0;
    for (int i = 0; i < count; i++) {
        const double spread = spread_of(lights, &groups[i]);
        if (spread > most) widest = &groups[i];
        most = fmax(most, spread);
    }
    return widest;
}

int vct_group_lights(struct vct_light *lights, int count, int most,
                     struct vct_emitter_group *groups)
{
    if (count == 0) return 0;
    int made = 1;
    groups[0] = (struct vct_emitter_group){ 0, count };
    for (; made < most; made++) {
        struct vct_emitter_group *widest = widest_of(lights, groups, made);
        if (!widest) break;
        struct vct_light *first = lights + widest->first;
        const int before = partition(first, widest->count, key_bounds(first, widest->count));
        groups[made] = (struct vct_emitter_group){ widest->first + before, widest->count - before };
        widest->count = before;
    }
    for (int i = 0; i < made; i++) order(lights + groups[i].first, groups[i].count);
    return made;
}
