#include "techniques/vct/vct_twin.h"

#include <math.h>
#include <stdlib.h>

struct vct_twin_volume vct_twin_volume(const struct vct_fixture *fixture, uint32_t level)
{
    struct vct_twin_volume v = { .light = vct_fixture_light(fixture, level),
                                 .dim = (int)vct_volume_dim(&fixture->vct->options) >> level };
    for (int a = 0; a < 3; a++)
        v.size[a] = (fixture->vct->clipmap.levels[0].grid.cells[a] / 2 + (1 << level) - 1) >> level;
    return v;
}

const float *vct_twin_texel(const struct vct_twin_volume *v, int direction, const int at[3])
{
    return v->light + 4 * (((size_t)at[2] * (size_t)v->dim + (size_t)at[1]) * VCT_TWIN_DIRECTIONS *
                               (size_t)v->dim +
                           (size_t)(direction * v->dim + at[0]));
}

bool vct_twin_in_use(const struct vct_twin_volume *v, const int at[3])
{
    return at[0] < v->size[0] && at[1] < v->size[1] && at[2] < v->size[2];
}

struct vct_twin vct_twin_of(const struct vct_fixture *fixture)
{
    const struct vct_options *o = &fixture->vct->options;
    struct vct_twin twin = {
        .level_count = (int)vct_volume_mips(o),
        .occlusion = o->occlusion,
        .decay = 2.0 * (double)fixture->vct->clipmap.levels[0].grid.cell_m * (double)o->decay,
        .offset = (double)o->offset,
    };
    for (int i = 0; i < twin.level_count; i++)
        twin.levels[i] = vct_twin_volume(fixture, (uint32_t)i);
    return twin;
}

void vct_twin_finish(struct vct_twin *twin)
{
    for (int i = 0; i < twin->level_count; i++) free(twin->levels[i].light);
}

static void filtered(const struct vct_twin_volume *v, int direction, const double at[3],
                     double out[4])
{
    int low[3], high[3];
    double f[3];
    for (int a = 0; a < 3; a++) {
        const double clamped = fmin(fmax(at[a], 0.5), v->size[a] - 0.5) - 0.5;
        low[a] = (int)floor(clamped);
        if (low[a] > v->size[a] - 1) low[a] = v->size[a] - 1;
        high[a] = low[a] + 1 < v->size[a] ? low[a] + 1 : low[a];
        f[a] = clamped - low[a];
    }
    for (int k = 0; k < 4; k++) out[k] = 0.0;
    for (int i = 0; i < 8; i++) {
        const int corner[3] = { i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                                i & 4 ? high[2] : low[2] };
        const double weight =
            (i & 1 ? f[0] : 1 - f[0]) * (i & 2 ? f[1] : 1 - f[1]) * (i & 4 ? f[2] : 1 - f[2]);
        const float *t = vct_twin_texel(v, direction, corner);
        for (int k = 0; k < 4; k++) out[k] += weight * (double)t[k];
    }
}

// ---- The receiver's own sheet: see cones/receiver.glsl ------------------------------------------

struct receiver {
    int axis;
    double slope[3], height, spread;
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static struct receiver receiver_at(const double at[3], const double normal[3])
{
    struct receiver r = { 0 };
    for (int a = 1; a < 3; a++)
        if (fabs(normal[a]) > fabs(normal[r.axis])) r.axis = a;
    for (int a = 0; a < 3; a++) r.slope[a] = normal[a] / normal[r.axis];
    r.height = dot(r.slope, at);
    r.spread = sqrt(fmax(3.0 * (dot(r.slope, r.slope) - 1.0), 1e-6));
    return r;
}

// Fraction of the heights of the plane that are below `end`.
static double below(const struct receiver *r, double end)
{
    return fmin(fmax(end / r->spread + 0.5, 0.0), 1.0);
}

// at: in texels of the level.
static double receiver_opacity(const struct receiver *r, const double at[3], double texel)
{
    const double place = at[r->axis] - 0.5, layer = floor(place), slack = 0.02 / texel;
    const double plane = at[r->axis] - dot(r->slope, at) + r->height / texel - layer;
    const double low = below(r, 1.0 - plane + slack) - below(r, -plane - slack),
                 high = below(r, 2.0 - plane + slack) - below(r, 1.0 - plane - slack);
    return low + (place - layer) * (high - low);
}

struct sample {
    double light[4], axes[3];
};

// 1 within the volume, 0 from half a texel beyond it on; `within`: the nearest position inside of
// the outermost centres.
static double weight_at(const struct vct_twin_volume *v, const double at[3], double within[3])
{
    double weight = 1.0;
    for (int a = 0; a < 3; a++) {
        within[a] = fmin(fmax(at[a], 0.5), v->size[a] - 0.5);
        weight *= fmin(fmax(2.0 - 2.0 * fabs(at[a] - within[a]), 0.0), 1.0);
    }
    return weight;
}

// Without the receiver's own sheet. place: in texels of the level.
static struct sample sample_volume(const struct vct_twin_volume *v, const struct receiver *r,
                                   double texel, const double place[3], const double direction[3],
                                   const double counted[3])
{
    struct sample s = { 0 };
    double at[3];
    const double weight = weight_at(v, place, at);
    const double own = receiver_opacity(r, at, texel);
    double others = 0.0;
    for (int a = 0; a < 3; a++) {
        double t[4];
        filtered(v, 2 * a + (direction[a] < 0.0), at, t);
        for (int k = 0; k < 4; k++) s.light[k] += fabs(counted[a]) * t[k];
        const double plane = own * fabs(r->slope[a]);
        if (fabs(counted[a]) > 0.0) s.axes[a] = fmax(t[3] - plane, 0.0) / fmax(1.0 - plane, 1e-3);
        others += fabs(counted[a]) * s.axes[a];
    }
    const double part = s.light[3] > 0.0 ? weight * others / s.light[3] : 0.0;
    for (int k = 0; k < 4; k++) s.light[k] *= part;
    for (int a = 0; a < 3; a++) s.axes[a] *= weight;
    return s;
}

static void cover(double sum[4], const struct sample *here, const struct sample *before)
{
    const double alpha = here->light[3];
    double sheet = 0.0;
    for (int a = 0; a < 3; a++) sheet = fmax(sheet, before->axes[a] + here->axes[a]);
    if (alpha <= 0.0) return;
    const double covered = vct_fixture_visible_alpha(1.0 - sum[3], alpha, fmin(sheet, 1.0));
    for (int k = 0; k < 3; k++) sum[k] += covered * here->light[k] / alpha;
    sum[3] += covered;
}

static double smooth(double low, double high, double x)
{
    const double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// The sample half a texel back along the surface; it is added to `add`.
static struct sample sample_behind(const struct vct_twin_volume *fine, const struct receiver *r,
                                   const double from[3], const double normal[3],
                                   const double direction[3], double add[4])
{
    const double along = dot(direction, normal);
    double level_with[3], at[3];
    for (int a = 0; a < 3; a++) {
        level_with[a] = direction[a] - along * normal[a];
        at[a] = from[a] - 0.5 * level_with[a];
    }
    const struct sample s = sample_volume(fine, r, 1.0, at, direction, level_with);
    const double ahead = smooth(0.25, 0.5, add[3] / fmax(add[3] + s.light[3], 1e-6));
    for (int k = 0; k < 4; k++) add[k] += s.light[k];
    for (int k = 0; k < 3; k++) add[k] *= ahead;
    return s;
}

// Replaces radiance with the occlusion of the sample.
static void use_occlusion(const struct vct_twin *twin, const double normal[3],
                          const double direction[3], double middle, double light[4])
{
    double r = middle;
    for (int a = 0; a < 3; a++) r += twin->offset * normal[a] * direction[a];
    for (int k = 0; k < 3; k++) light[k] = light[3] / (1.0 + twin->decay * r);
}

// Whether the ray has left the volume and the reach of its filter.
static bool beyond(const struct vct_twin_volume *v, const double at[3], const double direction[3])
{
    bool left = false;
    for (int a = 0; a < 3; a++)
        left = left || (direction[a] > 0.0 ? at[a] - v->size[a] : -at[a]) > 0.5;
    return left;
}

// As cones/trace.glsl, step by step, but without its early termination.
void vct_twin_trace(const struct vct_twin *twin, const double surface[3], const double normal[3],
                    const double direction[3], double wide, double sum[4])
{
    const struct vct_twin_volume *levels = twin->levels;
    const struct receiver receiver = receiver_at(surface, normal);
    double from[3], distance = 0.5;
    for (int a = 0; a < 3; a++) from[a] = surface[a] + twin->offset * normal[a];
    struct sample before = { 0 };
    for (int k = 0; k < 4; k++) sum[k] = 0.0;
    for (int i = 0, previous = 0; i < 256 && sum[3] <= 0.98; i++) {
        const double start = distance - 0.5 * (double)(1 << previous);
        int level = (int)(log2(fmax(wide * start, 1.0)) + 0.5);
        if (level >= twin->level_count) level = twin->level_count - 1;
        level = previous = level > previous ? level : previous;
        const double texel = (double)(1 << level);
        double at[3];
        for (int a = 0; a < 3; a++) at[a] = (from[a] + direction[a] * distance) / texel;
        if (beyond(&levels[level], at, direction)) return;
        struct sample here =
            sample_volume(&levels[level], &receiver, texel, at, direction, direction);
        if (i == 0)
            before = sample_behind(&levels[0], &receiver, from, normal, direction, here.light);
        if (twin->occlusion) use_occlusion(twin, normal, direction, distance, here.light);
        cover(sum, &here, &before);
        before = here;
        distance += texel;
    }
    if (sum[3] <= 0.98) return;
    for (int k = 0; k < 4; k++) sum[k] /= sum[3];
}
