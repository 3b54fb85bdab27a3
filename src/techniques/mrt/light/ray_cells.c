#include "techniques/mrt/light/ray_cells.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include <string.h>

enum seen { SEEN_WALL = 1, SEEN_SKY = 2, SEEN_REFLECTOR = 4 };

enum {
    GROUP = 2,           // texels along an edge of a group
    MOST_IN_CELL = 16,   // further rays
    MOST_FURTHER = 1024, // of a texel
    ALL_FURTHER = 1 << 22,
};

static const float RAY_OFFSET = 1e-3f; // m, along the normal

static size_t groups_in_row(size_t row)
{
    return (row + GROUP - 1) / GROUP;
}

// ---- scouts

struct scouts {
    const struct trace_scene *scene;
    const struct mrt_reflectors *reflectors;
    const struct mrt_texel_list *texels;
    struct mrt_ray_cells *out;
};

static enum seen look(const struct scouts *s, const struct mrt_geometry_texel *at, vec2s place)
{
    vec3s tangent, bitangent;
    const vec3s local = sample_hemisphere_cosine(place);
    const vec3s from = glms_vec3_muladds(at->normal, RAY_OFFSET, at->position);
    struct ray ray = { from, glms_vec3_scale(at->normal, local.z), 0.0f, INFINITY };
    struct ray_hit hit;
    basis_of(at->normal, &tangent, &bitangent);
    ray.direction = glms_vec3_muladds(tangent, local.x, ray.direction);
    ray.direction = glms_vec3_muladds(bitangent, local.y, ray.direction);
    if (!embree_closest(s->scene->embree, &ray, NULL, false, &hit)) return SEEN_SKY;
    const struct texel_hit at_hit = texel_hit_at(s->scene, &ray, &hit);
    return mrt_reflectors_have(s->reflectors, s->scene, &ray, &hit, &at_hit) ? SEEN_REFLECTOR
                                                                             : SEEN_WALL;
}

// The texels of a group together have a scout in each cell.
static void send_from_texel(const struct scouts *s, size_t group, uint32_t part, size_t texel)
{
    const uint32_t side = s->out->side, scouts = side * side / (GROUP * GROUP);
    const uint32_t seed = pcg_hash(~(uint32_t)group) | 1u;
    uint8_t *seen = s->out->seen + group * side * side;
    if (!s->texels->at[texel].found) return;
    for (uint32_t k = 0; k < scouts; k++) {
        const vec2s place = sobol_2d(part * scouts + k, seed);
        seen[texel_cell_at(side, place)] |= (uint8_t)look(s, &s->texels->at[texel], place);
    }
}

static void send_from_group(void *user, size_t group)
{
    const struct scouts *s = user;
    const size_t row = s->out->row, in_row = groups_in_row(row);
    for (uint32_t part = 0; part < GROUP * GROUP; part++) {
        const size_t x = group % in_row * GROUP + part % GROUP;
        const size_t y = group / in_row * GROUP + part / GROUP;
        if (x < row && y * row + x < s->texels->count) send_from_texel(s, group, part, y * row + x);
    }
}

// ---- cells of a texel

// The union over its group and those beside it in the same square.
static void seen_around(const struct mrt_ray_cells *c, size_t texel, uint8_t seen[MRT_MOST_CELLS])
{
    const uint32_t cells = c->side * c->side;
    const int in_row = (int)groups_in_row(c->row);
    const int x = (int)(texel % c->row / GROUP), y = (int)(texel / c->row / GROUP);
    const int square = y * GROUP / (int)c->row;
    memset(seen, 0, cells);
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            const int group = j * in_row + i;
            if (i < 0 || i >= in_row || j < 0 || group >= (int)c->groups) continue;
            if (j * GROUP / (int)c->row != square) continue;
            const uint8_t *of = c->seen + (size_t)group * cells;
            for (uint32_t k = 0; k < cells; k++) seen[k] |= of[k];
        }
}

// Adds what the cells beside each have seen along one axis.
static void spread(uint8_t *seen, int side, int stride, int across)
{
    for (int line = 0; line < side; line++) {
        uint8_t *at = seen + line * across, last = 0;
        for (int k = 0; k < side; k++) {
            const uint8_t own = at[k * stride], next = k + 1 < side ? at[(k + 1) * stride] : 0;
            at[k * stride] = own | last | next;
            last = own;
        }
    }
}

// A sky is uniform: away from its edge one ray tells all.
static bool needs_rays(uint8_t seen)
{
    return (seen & SEEN_REFLECTOR) || ((seen & SEEN_SKY) && (seen & SEEN_WALL));
}

uint32_t mrt_ray_cells_of(const struct mrt_ray_cells *c, size_t texel,
                          uint8_t further[MRT_MOST_CELLS])
{
    const int side = (int)c->side;
    uint32_t wanted = 0, each = MOST_IN_CELL;
    seen_around(c, texel, further);
    spread(further, side, 1, side);
    spread(further, side, side, 1);
    for (int k = 0; k < side * side; k++) wanted += needs_rays(further[k]);
    while (each * wanted > c->most) each /= 2;
    for (int k = 0; k < side * side; k++) further[k] = needs_rays(further[k]) ? (uint8_t)each : 0;
    return each * wanted;
}

// ---- cells of all texels

struct count_job {
    const struct mrt_ray_cells *cells;
    const struct mrt_texel_list *texels;
    uint8_t *needs;
};

static void count_one(void *user, size_t i)
{
    const struct count_job *job = user;
    uint8_t further[MRT_MOST_CELLS];
    job->needs[i] = job->texels->at[i].found && mrt_ray_cells_of(job->cells, i, further) > 0;
}

// Texels that need further rays get equal numbers.
static bool share_rays(struct mrt_ray_cells *cells, const struct mrt_texel_list *texels)
{
    struct count_job job = { cells, texels, host_alloc(cells->host, texels->count, 1) };
    size_t needing = 0;
    if (!job.needs) return false;
    cells->most = MOST_FURTHER;
    parallel_for(texels->count, 8, count_one, &job);
    for (size_t i = 0; i < texels->count; i++) needing += job.needs[i];
    if (needing * MOST_FURTHER > ALL_FURTHER) cells->most = (uint32_t)(ALL_FURTHER / needing);
    host_free(cells->host, job.needs);
    return true;
}

static uint32_t side_of(int rays)
{
    uint32_t side = 4;
    while (4 * side * side <= (uint32_t)rays && 4 * side * side <= MRT_MOST_CELLS) side *= 2;
    return side;
}

bool mrt_ray_cells_init(const struct trace_scene *scene, const struct mrt_reflectors *reflectors,
                        const struct mrt_texel_list *texels, int rays, struct mrt_ray_cells *out)
{
    const size_t row = (size_t)texels->row;
    *out = (struct mrt_ray_cells){ .host = scene->host, .row = row };
    if (row == 0 || !reflectors || texels->count == 0) return true;
    const size_t rows = (texels->count + row - 1) / row;
    out->side = side_of(rays);
    out->groups = groups_in_row(row) * ((rows + GROUP - 1) / GROUP);
    out->seen = host_alloc(scene->host, out->groups, out->side * out->side);
    if (!out->seen) return false;
    parallel_for(out->groups, 8, send_from_group,
                 &(struct scouts){ scene, reflectors, texels, out });
    return share_rays(out, texels);
}

void mrt_ray_cells_finish(struct mrt_ray_cells *cells)
{
    if (cells->host) host_free(cells->host, cells->seen);
    *cells = (struct mrt_ray_cells){ 0 };
}
