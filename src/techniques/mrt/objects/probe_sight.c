// Rays from voxels to the probes around them.
#include "techniques/mrt/objects/delta.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

enum { CORNERS = 8, POINTS, DIRECTIONS = 16, ALL_OPEN = 255 };

static const float CORNER = 0.49f; // of a voxel's edge, from its middle

struct job {
    const struct mrt_clutter_cell *cell;
    uint32_t *voxels;
    int edge;
};

struct voxel {
    vec3s middle;
    int texel[3]; // of the brick: the lowest probe around
};

// In the cell. Probes beyond an opening are sought up to it; those beyond a wall are the nearest of
// the block (bricks.comp).
static float coordinate_of(const struct mrt_clutter_cell *cell, int axis, int texel)
{
    const int probes = cell->rays->probes;
    const float p = (float)probes;
    const int side = texel > 0, face = 2 * axis + side;
    float most = 0.5f - 0.5f / p;
    if (texel == 0 || texel > probes) most = mrt_block_beyond(cell->block, face) >= 0 ? 0.5f : most;
    return fminf(fmaxf(((float)texel - 0.5f) / p - 0.5f, -most), most);
}

static struct voxel voxel_of(const struct job *job, size_t i)
{
    const size_t n = (size_t)job->edge, at[3] = { i % n, i / n % n, i / (n * n) };
    struct voxel out;
    for (int a = 0; a < 3; a++) {
        const float unit = ((float)at[a] + 0.5f) / (float)job->edge;
        out.middle.raw[a] = unit - 0.5f;
        out.texel[a] = (int)floorf(unit * (float)job->cell->rays->probes + 0.5f);
    }
    return out;
}

// One of POINTS: the corners of a voxel and its middle, which may be in a gap between solids.
static vec3s point_of(const struct job *job, const struct voxel *voxel, int point)
{
    const float by = CORNER / (float)job->edge;
    if (point == CORNERS) return voxel->middle;
    return glms_vec3_add(voxel->middle,
                         vec3_of(point & 1 ? by : -by, point & 2 ? by : -by, point & 4 ? by : -by));
}

// Bits of the probes that a place sees; solid: it sees backs alone.
static uint32_t visible_from(const struct job *job, const struct voxel *voxel, vec3s from,
                             bool *solid)
{
    uint32_t visible = 0;
    int backs = 0;
    for (int c = 0; c < CORNERS; c++) {
        struct trace_hit hit;
        vec3s to;
        for (int a = 0; a < 3; a++)
            to.raw[a] = coordinate_of(job->cell, a, voxel->texel[a] + (c >> a & 1));
        if (!mrt_delta_blocked(job->cell, from, to, &hit))
            visible |= 1u << c;
        else
            backs += mrt_is_inside_at(job->cell->rays->clutter, &hit);
    }
    *solid = backs == CORNERS;
    return visible;
}

static uint32_t open_from(const struct job *job, vec3s from)
{
    uint32_t open = 0;
    for (uint32_t i = 0; i < DIRECTIONS; i++) {
        const vec3s way = sample_sphere(sobol_2d(i, 1));
        struct mrt_hit wall;
        struct trace_hit hit;
        mrt_shape_trace(&job->cell->shape, from, way, &wall);
        open +=
            !mrt_delta_blocked(job->cell, from, glms_vec3_muladds(way, wall.distance, from), &hit);
    }
    return ALL_OPEN * open / DIRECTIONS;
}

// The least of a voxel's points that are in no solid.
static void find_visibility(void *user, size_t i)
{
    const struct job *job = user;
    const struct voxel voxel = voxel_of(job, i);
    uint32_t visible = MRT_VOXEL_PROBES, open = ALL_OPEN;
    bool solid[POINTS];
    int solids = 0;
    if (mrt_is_stopped(job->cell->rays->stop)) return;
    for (int k = 0; k < POINTS; k++) {
        const uint32_t of = visible_from(job, &voxel, point_of(job, &voxel, k), &solid[k]);
        solids += solid[k];
        if (!solid[k]) visible &= of;
    }
    if (solids == POINTS) visible = open = 0;
    for (int k = 0; visible == 0 && k < POINTS; k++) {
        const uint32_t of = solid[k] ? open : open_from(job, point_of(job, &voxel, k));
        open = of < open ? of : open;
    }
    job->voxels[i] = visible | open << MRT_VOXEL_OPEN;
    if (solids > 0) job->voxels[i] |= MRT_VOXEL_SOLID;
}

void mrt_probe_sight(const struct mrt_clutter_cell *cell, uint32_t *voxels)
{
    struct job job = { cell, voxels, mrt_sight_edge(cell->rays->probes) };
    const size_t n = (size_t)job.edge;
    parallel_for(n * n * n, 64, find_visibility, &job);
}
