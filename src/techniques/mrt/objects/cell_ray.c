// Rays in the cells of blocks, and clutter on them.
#include "techniques/mrt/objects/delta.h"

#include <math.h>

bool mrt_cell_of_point(const struct mrt_block_map *map, int block, vec3s world, vec3s *cell)
{
    if (!mrt_warp_inverse(map->blocks[block].corner, world, cell)) return false;
    *cell = glms_vec3_maxv(glms_vec3_minv(*cell, vec3_of(0.5f, 0.5f, 0.5f)),
                           vec3_of(-0.5f, -0.5f, -0.5f));
    return true;
}

bool mrt_cell_ray(const struct mrt_clutter_rays *rays, int block, vec3s from, vec3s way,
                  struct mrt_hit *hit, vec3s *end)
{
    const struct mrt_block *of = &rays->map->blocks[block];
    const struct mrt_shape shape = mrt_block_shape(of, rays->resolution);
    vec3s position;
    if (!mrt_cell_of_point(rays->map, block, from, &position)) return false;
    const mat3s cell_from_world = glms_mat3_inv(mrt_warp_jacobian(of->corner, position));
    const vec3s direction = vec3_unit(glms_mat3_mulv(cell_from_world, way));
    if (!(glms_vec3_norm2(direction) > 0.0f)) return false;
    mrt_shape_trace(&shape, position, direction, hit);
    *end = mrt_warp_point(of->corner, glms_vec3_muladds(direction, hit->distance, position));
    return true;
}

float mrt_passing_share(const struct mrt_block *block, const struct mrt_hit *hit, int *face)
{
    *face = hit->opening;
    if (hit->opening >= 0) return 1.0f;
    if (mrt_block_is_tube(block)) return 0.0f;
    *face = hit->face;
    return mrt_block_hole_at(block, hit->face, hit->s, hit->t);
}

mat3s mrt_frame_of_normal(vec3s normal)
{
    mat3s frame;
    basis_of(normal, &frame.col[0], &frame.col[1]);
    frame.col[2] = normal;
    return frame;
}

// ---- clutter between two points of a cell

// Rays start and end so much of their way from walls: clutter may stand on them.
static const float OFFSET = 1e-3f;

// Whether the segment from start to start + way touches the box.
static bool touches(struct box3 box, vec3s start, vec3s way)
{
    float enter = 0.0f, leave = 1.0f;
    for (int a = 0; a < 3; a++) {
        // Infinite where the segment is at right angles to the axis.
        const float one = (box.min.raw[a] - start.raw[a]) / way.raw[a];
        const float other = (box.max.raw[a] - start.raw[a]) / way.raw[a];
        enter = fmaxf(enter, fminf(one, other));
        leave = fminf(leave, fmaxf(one, other));
    }
    return !(enter > leave);
}

bool mrt_delta_blocked(const struct mrt_clutter_cell *cell, vec3s from, vec3s to,
                       struct trace_hit *hit)
{
    const vec3s start = mrt_warp_point(cell->block->corner, from);
    const vec3s way = glms_vec3_sub(mrt_warp_point(cell->block->corner, to), start);
    if (!touches(cell->bounds, start, way)) return false;
    return trace_closest(cell->rays->objects, glms_vec3_muladds(way, OFFSET, start), way,
                         1.0f - 2.0f * OFFSET, hit);
}

// ---- bounds

static struct box3 widened(struct box3 box)
{
    const float margin = 1e-3f * glms_vec3_max(box3_size(box));
    const vec3s by = vec3_of(margin, margin, margin);
    return (struct box3){ glms_vec3_sub(box.min, by), glms_vec3_add(box.max, by) };
}

struct box3 mrt_bounds_of_block(const struct mrt_block *block)
{
    return widened(mrt_warp_bounds(block->corner));
}

struct box3 mrt_bounds_of_triangle(const struct chart_triangle *triangle)
{
    struct box3 box = box3_empty();
    for (int k = 0; k < 3; k++) box = box3_add_point(box, triangle->corner[k]);
    return box;
}

struct mrt_clutter_cell mrt_clutter_cell_of(const struct mrt_clutter_rays *rays, int block)
{
    const struct charts *charts = &rays->clutter->charts;
    struct mrt_clutter_cell cell = {
        .rays = rays, .block = &rays->map->blocks[block], .index = block, .bounds = box3_empty()
    };
    const struct box3 at = mrt_bounds_of_block(cell.block);
    cell.shape = mrt_block_shape(cell.block, rays->resolution);
    for (uint32_t t = 0; t < charts->triangle_count; t++) {
        const struct box3 box = mrt_bounds_of_triangle(&charts->triangles[t]);
        if (box3_intersects(box, at)) cell.bounds = box3_union(cell.bounds, box);
    }
    if (!box3_is_empty(cell.bounds)) cell.bounds = widened(cell.bounds);
    return cell;
}
