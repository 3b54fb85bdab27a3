#include "techniques/ort/bake/near.h"

#include <math.h>
#include <stdlib.h>

// Light beyond the reach is left out; weights are brought to sums without it.
static const double SHARE_BEYOND = 0.002;

void ort_kernel_init(struct ort_kernel *k, const struct ort_options *options)
{
    double reach_mm = 0.0;
    k->mm = options->mm_per_unit;
    for (int c = 0; c < 3; c++) {
        k->profile[c] = ort_profile_of(options, c);
        reach_mm = fmax(reach_mm, ort_profile_reach(&k->profile[c], SHARE_BEYOND));
    }
    const double step_mm = reach_mm / ORT_KERNEL_STEPS, mm = (double)k->mm;
    k->reach_m = (float)(reach_mm / mm);
    k->steps_per_m = (float)(mm / step_mm);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i <= ORT_KERNEL_STEPS; i++)
            k->per_m2[c][i] = (float)(ort_profile_at(&k->profile[c], i * step_mm) * mm * mm);
    for (int c = 0; c < 3; c++) k->per_m2[c][ORT_KERNEL_STEPS + 1] = 0.0f;
}

static float mean_of_disk(const struct ort_kernel *k, int c, float area_m2)
{
    if (!(area_m2 > 0.0f)) return 0.0f;
    const double radius_mm = sqrt((double)area_m2 / GLM_PI) * (double)k->mm;
    return (float)(1.0 - ort_profile_beyond(&k->profile[c], radius_mm)) / area_m2;
}

static void add_at(const struct ort_kernel *k, float distance_m, float weight, float out[3])
{
    const float at = distance_m * k->steps_per_m;
    if (!(at < ORT_KERNEL_STEPS)) return;
    const int i = (int)at;
    const float t = at - (float)i;
    for (int c = 0; c < 3; c++)
        out[c] += weight * (k->per_m2[c][i] + t * (k->per_m2[c][i + 1] - k->per_m2[c][i]));
}

// Nine points of Gauss and Legendre on a square, one of whose sides is along the distance; points
// on both sides of it are the same. Profiles are convex: at middles alone, the light of a plane
// would sum to 0.89.
static void add_mean_of_square(const struct ort_kernel *k, float distance_m, float side_m,
                               float out[3])
{
    static const float AT = 0.387298335f; // √(3/5) / 2
    static const float WEIGHT[3] = { 5.0f / 18, 8.0f / 18, 5.0f / 18 };
    for (int i = 0; i < 3; i++) {
        const float along = distance_m + (float)(i - 1) * AT * side_m;
        add_at(k, fabsf(along), WEIGHT[i] * WEIGHT[1], out);
        add_at(k, hypotf(along, AT * side_m), 2.0f * WEIGHT[i] * WEIGHT[0], out);
    }
}

void ort_kernel_at(const struct ort_kernel *k, float distance_m, float area_m2, float out[3])
{
    static const float NEAR = 4.0f; // sides of the texel, beyond which its middle has the mean
    const float side_m = sqrtf(fmaxf(area_m2, 0.0f));
    for (int c = 0; c < 3; c++) out[c] = 0.0f;
    if (!(distance_m > 0.0f))
        for (int c = 0; c < 3; c++) out[c] = mean_of_disk(k, c, area_m2);
    else if (distance_m < NEAR * side_m)
        add_mean_of_square(k, distance_m, side_m, out);
    else
        add_at(k, distance_m, 1.0f, out);
}

// ---- cells

static uint64_t cell_along(const struct ort_near *near, int axis, float position)
{
    const float cell = (position - near->origin.raw[axis]) * near->per_cell;
    return cell > 0.0f ? (uint64_t)cell + 1 : 1; // cell 0 is beside the first
}

static uint64_t cell_of(const struct ort_near *near, uint64_t x, uint64_t y, uint64_t z)
{
    return (z * near->side[1] + y) * near->side[0] + x;
}

static int compare(const void *a, const void *b)
{
    const struct ort_near_item *p = a, *q = b;
    if (p->cell != q->cell) return p->cell < q->cell ? -1 : 1;
    return p->texel < q->texel ? -1 : p->texel > q->texel;
}

// Along an axis at most, so that a product of three fits in 64 bits.
static const float MOST_CELLS = 1 << 20;

static void set_grid(struct ort_near *near, const struct ort_map *map, float reach_m)
{
    struct box3 box = box3_empty();
    for (uint32_t i = 0; i < map->texel_count; i++)
        box = box3_add_point(box, chart_texel_of(&map->charts, i)->centroid);
    const vec3s size = box3_size(box);
    near->origin = box.min;
    near->per_cell = fminf(1.0f / reach_m, MOST_CELLS / fmaxf(glms_vec3_max(size), 1e-30f));
    for (int a = 0; a < 3; a++) near->side[a] = cell_along(near, a, box.max.raw[a]) + 2;
}

bool ort_near_init(struct ort_near *near, const struct ort_map *map, float reach_m)
{
    *near = (struct ort_near){ .host = map->host, .count = map->texel_count };
    near->items = host_alloc(near->host, near->count, sizeof *near->items);
    if (!near->items) return false;
    if (near->count == 0) return true;
    set_grid(near, map, reach_m);
    for (uint32_t i = 0; i < near->count; i++) {
        const vec3s p = chart_texel_of(&map->charts, i)->centroid;
        near->items[i] =
            (struct ort_near_item){ cell_of(near, cell_along(near, 0, p.x),
                                            cell_along(near, 1, p.y), cell_along(near, 2, p.z)),
                                    i };
    }
    qsort(near->items, near->count, sizeof *near->items, compare);
    return true;
}

void ort_near_finish(struct ort_near *near)
{
    if (!near->host) return;
    host_free(near->host, near->items);
    *near = (struct ort_near){ 0 };
}

// The first item at or behind a cell.
static uint32_t first_item(const struct ort_near *near, uint64_t cell)
{
    uint32_t low = 0, high = near->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (near->items[middle].cell < cell)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void ort_near_visit(const struct ort_near *near, vec3s position,
                    void (*visit)(void *user, uint32_t texel), void *user)
{
    const uint64_t x = cell_along(near, 0, position.x), y = cell_along(near, 1, position.y);
    const uint64_t z = cell_along(near, 2, position.z);
    for (uint64_t k = z - 1; k <= z + 1; k++)
        for (uint64_t j = y - 1; j <= y + 1; j++) {
            const uint64_t last = cell_of(near, x + 1, j, k);
            for (uint32_t i = first_item(near, cell_of(near, x - 1, j, k));
                 i < near->count && near->items[i].cell <= last; i++)
                visit(user, near->items[i].texel);
        }
}

// ---- strips

static struct ort_strip strip_of(const struct charts *charts, uint32_t texel)
{
    enum { MOST_PARTS = 31 };
    const struct chart_triangle *t = chart_triangle_of(charts, texel);
    const vec2s a = glms_vec2_sub(t->place[1], t->place[0]),
                b = glms_vec2_sub(t->place[2], t->place[0]);
    const vec3s along_a = glms_vec3_sub(t->corner[1], t->corner[0]);
    const vec3s along_b = glms_vec3_sub(t->corner[2], t->corner[0]);
    const float area = a.x * b.y - a.y * b.x;
    if (area == 0.0f) return (struct ort_strip){ .parts = 1 };
    const vec3s x =
        glms_vec3_sub(glms_vec3_scale(along_a, b.y / area), glms_vec3_scale(along_b, a.y / area));
    const vec3s y =
        glms_vec3_sub(glms_vec3_scale(along_b, a.x / area), glms_vec3_scale(along_a, b.x / area));
    const bool is_wide = glms_vec3_norm2(x) > glms_vec3_norm2(y);
    const vec3s longer = is_wide ? x : y, shorter = is_wide ? y : x;
    const float ratio = glms_vec3_norm(longer) / fmaxf(glms_vec3_norm(shorter), 1e-30f);
    const int parts = 2 * (int)(fminf(ratio + 0.5f, MOST_PARTS) / 2.0f) + 1;
    return (struct ort_strip){ glms_vec3_divs(longer, (float)parts), parts };
}

struct ort_strip *ort_make_strips(struct host *host, const struct charts *charts)
{
    struct ort_strip *strips = host_alloc(host, charts->side_texel_count, sizeof *strips);
    for (uint32_t i = 0; strips && i < charts->side_texel_count; i++)
        strips[i] = strip_of(charts, i);
    return strips;
}
