// A chart grows from its first triangle across edges. A first pass finds the triangles near to the
// first one's normal; their mean normal is the plane's, and the direction of an edge whose bounding
// rectangle is smallest is its u axis. The second pass takes the triangles near to that plane,
// except those that would cover the centre of a texel that the chart covers already.
#include "scene/charts/grow.h"

#include "scene/charts/raster.h"

#include "core/rng.h"

#include <math.h>
#include <string.h>

// Texels that the chart covers: a hash table whose entries of older charts are stale.
struct cover {
    uint64_t *texel;
    uint32_t *chart; // 1 + chart; 0: free
    size_t size, used;
};

struct growth {
    struct grown *out;
    const struct surface *surface;
    double texels_per_m;
    struct cover cover;
    uint32_t *queue, *visited; // visited: the pass that reached a triangle
    uint32_t queued, pass;
    bool failed;
};

// From world to the chart's texels.
struct frame {
    bool unwrapped;
    vec3s normal;
    double axis[2][3]; // of the plane, times texels per metre
    double scale;      // texels per unit of TEXCOORD_1
    double origin[2];
};

// ---- covered texels

static bool cover_resize(struct host *host, struct cover *cover, size_t size)
{
    uint64_t *texel = host_alloc(host, size, sizeof *texel);
    uint32_t *chart = host_alloc(host, size, sizeof *chart);
    if (!texel || !chart) {
        host_free(host, texel);
        host_free(host, chart);
        return false;
    }
    for (size_t i = 0; i < cover->size; i++) {
        if (cover->chart[i] == 0) continue;
        size_t at = (size_t)rng_mix(cover->texel[i]) & (size - 1);
        while (chart[at] != 0) at = (at + 1) & (size - 1);
        texel[at] = cover->texel[i];
        chart[at] = cover->chart[i];
    }
    host_free(host, cover->texel);
    host_free(host, cover->chart);
    cover->texel = texel;
    cover->chart = chart;
    cover->size = size;
    return true;
}

static uint64_t texel_key(int32_t x, int32_t y)
{
    return (uint64_t)(uint32_t)x << 32 | (uint32_t)y;
}

// The entry of a texel, or the free one where it would be.
static size_t cover_find(const struct cover *cover, uint64_t key)
{
    size_t at = (size_t)rng_mix(key) & (cover->size - 1);
    while (cover->chart[at] != 0 && cover->texel[at] != key) at = (at + 1) & (cover->size - 1);
    return at;
}

static bool is_free(void *user, int32_t x, int32_t y)
{
    const struct growth *growth = user;
    const size_t at = cover_find(&growth->cover, texel_key(x, y));
    return growth->cover.chart[at] != growth->out->count + 1;
}

static bool cover_texel(void *user, int32_t x, int32_t y)
{
    struct growth *growth = user;
    struct cover *cover = &growth->cover;
    if (2 * cover->used >= cover->size &&
        !cover_resize(growth->out->host, cover, 2 * cover->size)) {
        growth->failed = true;
        return false;
    }
    const size_t at = cover_find(cover, texel_key(x, y));
    if (cover->chart[at] == 0) cover->used++;
    cover->texel[at] = texel_key(x, y);
    cover->chart[at] = growth->out->count + 1;
    return true;
}

// ---- places

static struct raster_triangle place(const struct frame *frame, const struct surface_triangle *t)
{
    struct raster_triangle out;
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 2; a++) {
            double sum = -frame->origin[a];
            if (frame->unwrapped) sum += frame->scale * (double)t->uv[k].raw[a];
            for (int c = 0; c < 3 && !frame->unwrapped; c++)
                sum += frame->axis[a][c] * (double)t->corner[k].raw[c];
            out.at[k][a] = sum;
        }
    return out;
}

static bool fits_frame(const struct frame *frame, const struct surface_triangle *t)
{
    if (frame->unwrapped) return t->unwrapped;
    return glms_vec3_dot(frame->normal, t->normal) >= CHART_MIN_COSINE;
}

// ---- growing

// Calls accept for each triangle across an edge of an accepted one, once.
typedef bool (*grow_accept)(struct growth *growth, const struct frame *frame, uint32_t triangle);

static void grow_from(struct growth *growth, uint32_t seed, const struct frame *frame,
                      grow_accept accept)
{
    growth->pass++;
    growth->queued = 0;
    growth->visited[seed] = growth->pass;
    if (accept(growth, frame, seed)) growth->queue[growth->queued++] = seed;
    for (uint32_t i = 0; i < growth->queued && !growth->failed; i++) {
        const struct surface_triangle *t = &growth->surface->triangles[growth->queue[i]];
        for (int k = 0; k < 3; k++) {
            const uint32_t next = t->neighbor[k];
            if (next == CHART_NONE || growth->out->chart_of[next] != CHART_NONE) continue;
            if (growth->visited[next] == growth->pass) continue;
            growth->visited[next] = growth->pass;
            if (accept(growth, frame, next)) growth->queue[growth->queued++] = next;
        }
    }
}

static bool accept_near(struct growth *growth, const struct frame *frame, uint32_t triangle)
{
    return fits_frame(frame, &growth->surface->triangles[triangle]);
}

// Charts stay below CHART_MAX_SIDE. The first triangle is in this range: choose_origin sees to it.
static bool is_in_range(const struct raster_triangle *placed)
{
    const double side = (double)CHART_MAX_SIDE;
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 2; a++)
            if (!(placed->at[k][a] >= -0.125 * side && placed->at[k][a] <= 0.8125 * side))
                return false;
    return true;
}

static bool accept_free(struct growth *growth, const struct frame *frame, uint32_t triangle)
{
    const struct surface_triangle *t = &growth->surface->triangles[triangle];
    if (!fits_frame(frame, t)) return false;
    const struct raster_triangle placed = place(frame, t);
    if (!is_in_range(&placed)) return false;
    if (!raster_centres(&placed, is_free, growth)) return false;
    if (!raster_centres(&placed, cover_texel, growth)) return false;
    memcpy(growth->out->place[triangle], placed.at, sizeof placed.at);
    return true;
}

// ---- the frame of a chart

static void set_axes(struct frame *frame, vec3s u, double texels_per_m)
{
    const vec3s v = glms_vec3_cross(frame->normal, u);
    for (int c = 0; c < 3; c++) {
        frame->axis[0][c] = texels_per_m * (double)u.raw[c];
        frame->axis[1][c] = texels_per_m * (double)v.raw[c];
    }
}

struct bounds {
    double low[2], high[2];
};

static struct bounds bounds_of(const struct growth *growth, const struct frame *frame)
{
    struct bounds bounds = { { INFINITY, INFINITY }, { -INFINITY, -INFINITY } };
    for (uint32_t i = 0; i < growth->queued; i++) {
        const struct raster_triangle at =
            place(frame, &growth->surface->triangles[growth->queue[i]]);
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 2; a++) {
                bounds.low[a] = fmin(bounds.low[a], at.at[k][a]);
                bounds.high[a] = fmax(bounds.high[a], at.at[k][a]);
            }
    }
    return bounds;
}

// Triangles whose edges are tried as the u axis, at most.
enum { TRIED_TRIANGLES = 8 };

static void choose_axes(const struct growth *growth, struct frame *frame)
{
    vec3s best, unused;
    double least = INFINITY;
    basis_of(frame->normal, &best, &unused);
    for (uint32_t i = 0; i < growth->queued && i < TRIED_TRIANGLES; i++) {
        const struct surface_triangle *t = &growth->surface->triangles[growth->queue[i]];
        for (int k = 0; k < 3; k++) {
            const vec3s edge = vec3_towards(t->corner[k], t->corner[(k + 1) % 3]);
            const float along = glms_vec3_dot(edge, frame->normal);
            const vec3s u = vec3_unit(glms_vec3_sub(edge, glms_vec3_scale(frame->normal, along)));
            if (glms_vec3_norm2(u) == 0.0f) continue;
            set_axes(frame, u, growth->texels_per_m);
            const struct bounds b = bounds_of(growth, frame);
            const double area = (b.high[0] - b.low[0]) * (b.high[1] - b.low[1]);
            if (!(area < least)) continue;
            least = area;
            best = u;
        }
    }
    set_axes(frame, best, growth->texels_per_m);
}

static vec3s mean_normal(const struct growth *growth)
{
    vec3s sum = glms_vec3_zero();
    for (uint32_t i = 0; i < growth->queued; i++) {
        const struct surface_triangle *t = &growth->surface->triangles[growth->queue[i]];
        sum = glms_vec3_muladds(t->normal, t->area_m2, sum);
    }
    return vec3_unit(sum);
}

// TEXCOORD_1 is scaled so that the island's area in texels is that of its surface.
static bool choose_scale(const struct growth *growth, struct frame *frame)
{
    double world = 0.0, texture = 0.0;
    frame->scale = 1.0;
    for (uint32_t i = 0; i < growth->queued; i++) {
        const struct surface_triangle *t = &growth->surface->triangles[growth->queue[i]];
        const struct raster_triangle at = place(frame, t);
        world += (double)t->area_m2;
        texture += 0.5 * fabs(raster_area2(&at));
    }
    frame->scale = growth->texels_per_m * sqrt(world / texture);
    return isfinite(frame->scale) && frame->scale > 0.0;
}

// The least coordinates, or half the largest side before the first triangle.
static void choose_origin(const struct growth *growth, uint32_t seed, struct frame *frame)
{
    const struct bounds bounds = bounds_of(growth, frame);
    const struct raster_triangle first = place(frame, &growth->surface->triangles[seed]);
    for (int a = 0; a < 2; a++) {
        const double low = fmin(first.at[0][a], fmin(first.at[1][a], first.at[2][a]));
        frame->origin[a] = fmax(bounds.low[a], low - 0.5 * (double)CHART_MAX_SIDE);
    }
}

static struct frame planar_frame(struct growth *growth, uint32_t seed)
{
    const vec3s first = growth->surface->triangles[seed].normal;
    struct frame frame = { .normal = first };
    grow_from(growth, seed, &frame, accept_near);
    frame.normal = mean_normal(growth);
    if (!fits_frame(&frame, &growth->surface->triangles[seed])) frame.normal = first;
    choose_axes(growth, &frame);
    choose_origin(growth, seed, &frame);
    return frame;
}

static bool unwrapped_frame(struct growth *growth, uint32_t seed, struct frame *frame)
{
    *frame = (struct frame){ .unwrapped = growth->surface->triangles[seed].unwrapped };
    if (!frame->unwrapped) return false;
    grow_from(growth, seed, frame, accept_near);
    frame->normal = mean_normal(growth);
    if (!choose_scale(growth, frame)) return false;
    choose_origin(growth, seed, frame);
    return true;
}

// ---- charts

// Rounding errors of coordinates, sums of products: a chart that begins at −ROUNDING begins at 0.
static const double ROUNDING = 1e-6;

// Moves the least coordinates to 0: the second pass may have taken more or fewer triangles.
static void close_chart(struct growth *growth, uint32_t first, const struct frame *frame)
{
    struct grown *out = growth->out;
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    for (uint32_t i = 0; i < 6 * growth->queued; i++) {
        const double at = out->place[growth->queue[i / 6]][i / 2 % 3][i % 2];
        low[i % 2] = fmin(low[i % 2], floor(at + ROUNDING));
        high[i % 2] = fmax(high[i % 2], at);
    }
    for (uint32_t i = 0; i < 6 * growth->queued; i++) {
        double *at = &out->place[growth->queue[i / 6]][i / 2 % 3][i % 2];
        *at = fmax(*at - low[i % 2], 0.0);
    }
    for (uint32_t i = 0; i < growth->queued; i++) {
        out->order[first + i] = growth->queue[i];
        out->chart_of[growth->queue[i]] = out->count;
    }
    out->charts[out->count++] = (struct grown_chart){ .first_triangle = first,
                                                      .triangle_count = growth->queued,
                                                      .unwrapped = frame->unwrapped,
                                                      .normal = frame->normal,
                                                      .width = high[0] - low[0],
                                                      .height = high[1] - low[1] };
}

// False without memory, or where the triangle alone is wider than an atlas may be.
static bool grow_chart(struct growth *growth, uint32_t seed, uint32_t first)
{
    struct frame frame;
    const bool unwrapped = unwrapped_frame(growth, seed, &frame);
    if (unwrapped) grow_from(growth, seed, &frame, accept_free);
    if ((!unwrapped || growth->queued == 0) && !growth->failed) {
        frame = planar_frame(growth, seed);
        grow_from(growth, seed, &frame, accept_free);
    }
    if (growth->queued == 0 || growth->failed) return false;
    close_chart(growth, first, &frame);
    return true;
}

static bool grow_all(struct growth *growth)
{
    uint32_t placed = 0;
    memset(growth->out->chart_of, 0xff, growth->surface->count * sizeof *growth->out->chart_of);
    for (uint32_t t = 0; t < growth->surface->count; t++) {
        if (growth->out->chart_of[t] != CHART_NONE) continue;
        if (!grow_chart(growth, t, placed)) return false;
        placed += growth->queued;
    }
    return true;
}

bool grow_charts(struct grown *out, struct host *host, const struct surface *surface,
                 double texels_per_m)
{
    const size_t count = surface->count;
    struct growth growth = { .out = out, .surface = surface, .texels_per_m = texels_per_m };
    *out = (struct grown){ .host = host };
    out->order = host_alloc(host, count, sizeof *out->order);
    out->chart_of = host_alloc(host, count, sizeof *out->chart_of);
    out->place = host_alloc(host, count, sizeof *out->place);
    out->charts = host_alloc(host, count, sizeof *out->charts);
    growth.queue = host_alloc(host, count, sizeof *growth.queue);
    growth.visited = host_alloc(host, count, sizeof *growth.visited);
    const bool ok = out->order && out->chart_of && out->place && out->charts && growth.queue &&
                    growth.visited && cover_resize(host, &growth.cover, 4096) && grow_all(&growth);
    host_free(host, growth.queue);
    host_free(host, growth.visited);
    host_free(host, growth.cover.texel);
    host_free(host, growth.cover.chart);
    if (!ok) grown_finish(out);
    return ok;
}

void grown_finish(struct grown *grown)
{
    if (!grown->host) return;
    host_free(grown->host, grown->order);
    host_free(grown->host, grown->chart_of);
    host_free(grown->host, grown->place);
    host_free(grown->host, grown->charts);
    *grown = (struct grown){ 0 };
}
