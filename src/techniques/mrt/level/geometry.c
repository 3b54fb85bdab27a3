// Geometry images.
#include "geometry.h"

#include "techniques/mrt/level/wall.h"

#include "core/parallel.h"

#include <math.h>

// Rays start in the middle of the block, which scenes fill less than their walls, and end behind
// the wall by a quarter of the block.
static const float RAY_END = 1.5f; // of the way from the middle to the wall

enum sight { SIGHT_NONE, SIGHT_BACK, SIGHT_FRONT };

struct geometry_job {
    const struct mrt_block_map *map;
    const struct mrt_atlas *atlas;
    const struct trace_scene *scene;
    struct mrt_geometry_texel *texels;
    enum sight *sight; // of each texel
};

// Whether the way from a point to the middle of the block leaves a solid: a thick wall, a pillar.
static bool is_in_solid(const struct trace_scene *scene, vec3s from, vec3s middle)
{
    struct trace_hit hit;
    vec3s way = glms_vec3_sub(middle, from);
    return glms_vec3_norm2(way) > 0.0f && trace_closest(scene, from, way, 1.0f, &hit) && !hit.front;
}

// A ray from the middle of the block to a wall.
struct wall_ray {
    vec3s from, to;
};

static struct wall_ray wall_ray_at(const struct mrt_block *block, int face, float s, float t)
{
    return (struct wall_ray){
        mrt_warp_point(block->corner, mrt_wall_middle(block, face, s, t)),
        mrt_warp_point(block->corner, mrt_wall_place(block, face, s, t).position),
    };
}

// An edge of the wall's texel along the ray onto the surface.
static vec3s on_surface(vec3s edge, vec3s way, vec3s normal)
{
    const float along = glms_vec3_dot(way, normal);
    return glms_vec3_muladds(way, -glms_vec3_dot(edge, normal) / along, edge);
}

static const float SAME_PLACE = 1e-3f; // edges of a texel

static bool has_part(const struct geometry_job *job, const struct wall_ray *ray,
                     const struct mrt_geometry_texel *texel, int part)
{
    const vec3s place = glms_vec3_add(texel->position, mrt_part_way(texel, part));
    const float most2 = SAME_PLACE * SAME_PLACE * glms_vec3_norm2(texel->edge[0]);
    struct trace_hit hit;
    return trace_closest(job->scene, ray->from, glms_vec3_sub(ray->to, ray->from), RAY_END, &hit) &&
           glms_vec3_distance2(hit.position, place) < most2;
}

// The middle of a texel may see far more of an emitter than the rest of it: on a ceiling, beside a
// panel close below.
static void find_parts(const struct geometry_job *job, const struct mrt_block *block, int face,
                       float s, float t, struct mrt_geometry_texel *out)
{
    const float size = 1.0f / (float)job->atlas->resolution;
    const struct wall_ray middle = wall_ray_at(block, face, s, t);
    const vec3s way = glms_vec3_sub(middle.to, middle.from);
    const struct mrt_wall_place wall = mrt_wall_place(block, face, s, t);
    const mat3s jacobian = mrt_warp_jacobian(block->corner, wall.position);
    const vec3s by[2] = { wall.by_s, wall.by_t };
    for (int a = 0; a < 2; a++) {
        const vec3s edge = glms_vec3_scale(glms_mat3_mulv(jacobian, by[a]), size);
        out->edge[a] = on_surface(edge, way, out->normal);
    }
    for (int part = 0; part < MRT_PARTS * MRT_PARTS; part++) {
        const vec2s at = glms_vec2_scale(mrt_part_place(part), size);
        const struct wall_ray ray = wall_ray_at(block, face, s + at.x, t + at.y);
        if (has_part(job, &ray, out, part)) out->parts |= (uint16_t)(1u << part);
    }
}

// Through a hole, surfaces farther behind the wall are those of the neighbour.
static const float HOLE_END = 1.1f;

static enum sight look_at_wall(const struct geometry_job *job, const struct mrt_tile *tile, int k,
                               struct mrt_geometry_texel *out)
{
    int n = job->atlas->resolution;
    const struct mrt_block *block = &job->map->blocks[tile->block];
    const float s = ((float)(k % n) + 0.5f) / (float)n, t = ((float)(k / n) + 0.5f) / (float)n;
    const struct wall_ray ray = wall_ray_at(block, tile->face, s, t);
    bool solid = is_in_solid(job->scene, ray.from, mrt_block_middle(block));
    struct trace_hit hit;
    const vec3s way = glms_vec3_sub(ray.to, ray.from);
    const bool hole = mrt_block_hole_at(block, tile->face, s, t) > 0.0f;
    const bool found = trace_closest(job->scene, ray.from, way, hole ? HOLE_END : RAY_END, &hit);
    if (!found)
        *out = (struct mrt_geometry_texel){
            .position = ray.to,
            .normal = mrt_wall_normal(block, tile->face, s, t),
        };
    else
        *out = (struct mrt_geometry_texel){
            .position = hit.position,
            .normal = hit.normal,
            .reflectance = trace_reflectance(job->scene, way, &hit),
            .emission = hit.emission,
            .found = true,
        };
    out->across = mrt_wall_across(block, tile->face, s, t);
    out->area_m2 = mrt_wall_area(block, tile->face, s, t) / (float)(n * n);
    if (found) find_parts(job, block, tile->face, s, t, out);
    if (solid) return SIGHT_BACK;
    return !found ? SIGHT_NONE : hit.front ? SIGHT_FRONT : SIGHT_BACK;
}

// The texel nearest to texel k that sees a front; −1: none.
static int nearest_front(const enum sight *sight, int n, int k)
{
    int nearest = -1, least = 2 * n * n;
    for (int i = 0; i < n * n; i++) {
        int x = i % n - k % n, y = i / n - k / n;
        if (sight[i] != SIGHT_FRONT || x * x + y * y >= least) continue;
        least = x * x + y * y;
        nearest = i;
    }
    return nearest;
}

// Texels whose ray begins in a solid, such as a thick wall at the border of a block, get the
// nearest surface of their wall.
static void trace_tile(void *user, size_t i)
{
    const struct geometry_job *job = user;
    const struct mrt_tile *tile = &job->atlas->tiles[i];
    struct mrt_geometry_texel *texels = job->texels + tile->first_texel;
    enum sight *sight = job->sight + tile->first_texel;
    int n = job->atlas->resolution;
    for (int k = 0; k < n * n; k++) sight[k] = look_at_wall(job, tile, k, &texels[k]);
    for (int k = 0; k < n * n; k++) {
        const int from = sight[k] == SIGHT_BACK ? nearest_front(sight, n, k) : -1;
        const struct mrt_geometry_texel own = texels[k];
        if (from >= 0) texels[k] = texels[from];
        texels[k].area_m2 = own.area_m2;
        texels[k].across = own.across;
    }
}

struct mrt_geometry_texel *mrt_geometry_create(struct host *host, const struct mrt_block_map *map,
                                               const struct mrt_atlas *atlas,
                                               const struct trace_scene *scene)
{
    struct geometry_job job = { .map = map, .atlas = atlas, .scene = scene };
    job.texels = host_alloc(host, (size_t)atlas->texels, sizeof *job.texels);
    job.sight = host_alloc(host, (size_t)atlas->texels, sizeof *job.sight);
    if (job.texels && job.sight) {
        parallel_for((size_t)atlas->tile_count, 1, trace_tile, &job);
    } else {
        host_free(host, job.texels);
        job.texels = NULL;
    }
    host_free(host, job.sight);
    return job.texels;
}

// ---- surfaces that texels stand for

static const float FACES_WALL = 0.35f; // cosine (gpu/pixels/light_map.glsl)
static const float WITHIN = 1.5f;      // diagonals of a texel
static const float SAME_NORMAL = 0.5f; // cosine

static bool is_texel_of(const struct mrt_geometry_texel *texel, vec3s point, vec3s normal)
{
    return texel->found && glms_vec3_dot(texel->normal, normal) > SAME_NORMAL &&
           glms_vec3_distance2(texel->position, point) < WITHIN * WITHIN * 2.0f * texel->area_m2;
}

// A texel near the place on the wall, so that the edge of an object counts, too.
static bool tile_has(const struct mrt_geometry *g, int tile, vec2s place, vec3s point, vec3s normal)
{
    const int n = g->atlas->resolution;
    const struct mrt_geometry_texel *texels = g->texels + g->atlas->tiles[tile].first_texel;
    const int x = (int)floorf(place.x * (float)n), y = (int)floorf(place.y * (float)n);
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++)
            if (i >= 0 && i < n && j >= 0 && j < n &&
                is_texel_of(&texels[j * n + i], point, normal))
                return true;
    return false;
}

bool mrt_geometry_has(const struct mrt_geometry *g, int block, vec3s cell, vec3s point,
                      vec3s normal)
{
    const mat3s jacobian = mrt_warp_jacobian(g->map->blocks[block].corner, cell);
    for (int face = 0; face < CUBE_FACES; face++) {
        const int tile = g->atlas->tile_of_face[CUBE_FACES * block + face];
        const mat3s frame = cube_from_face(face);
        const vec3s inwards = vec3_unit(glms_mat3_mulv(jacobian, glms_vec3_negate(frame.col[2])));
        if (tile < 0 || glms_vec3_dot(inwards, normal) < FACES_WALL) continue;
        if (0.5f - glms_vec3_dot(frame.col[2], cell) < MRT_NEAR_WALL) return true;
        const vec2s place = { { 0.5f + glms_vec3_dot(frame.col[0], cell),
                                0.5f + glms_vec3_dot(frame.col[1], cell) } };
        if (tile_has(g, tile, place, point, normal)) return true;
    }
    return false;
}
