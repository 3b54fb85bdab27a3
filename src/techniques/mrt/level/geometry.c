// Geometry images, and the walls that stand for surfaces.
#include "geometry.h"

#include "core/parallel.h"

#include <math.h>

// Rays start in the middle of the block, which scenes fill less than their walls, and end behind
// the wall by a quarter of the block.
static const float RAY_END = 1.5f; // of the way from the middle to the wall
enum { MAX_BACKS = 4 };            // surfaces seen from behind, where the middle is in a solid

struct geometry_job {
    const struct mrt_block_map *map;
    const struct mrt_atlas *atlas;
    const struct trace_scene *scene;
    struct mrt_geometry_texel *texels;
};

// The nearest front, else the nearest surface.
static bool find_surface(const struct trace_scene *scene, vec3s from, vec3s direction,
                         struct trace_hit *hit)
{
    struct trace_hit next;
    float left = RAY_END;
    vec3s at = from;
    if (!trace_closest(scene, from, direction, left, hit)) return false;
    next = *hit;
    for (int i = 0; i < MAX_BACKS && !next.front; i++) {
        left -= next.distance;
        at = trace_leave(&next, direction);
        if (!trace_closest(scene, at, direction, left, &next)) return true;
    }
    if (next.front) *hit = next;
    return true;
}

static struct mrt_geometry_texel texel_of(const struct geometry_job *job,
                                          const struct mrt_tile *tile, float s, float t)
{
    const vec3s *corner = job->map->blocks[tile->block].corner;
    vec3s wall = cube_face_point(tile->face, s, t), middle = wall;
    middle.raw[tile->face / 2] = 0.0f;
    vec3s from = mrt_warp_point(corner, middle), to = mrt_warp_point(corner, wall);
    struct trace_hit hit;
    if (find_surface(job->scene, from, glms_vec3_sub(to, from), &hit))
        return (struct mrt_geometry_texel){ .position = hit.position,
                                            .normal = hit.normal,
                                            .albedo =
                                                glms_vec3_scale(hit.albedo, 1.0f - hit.metallic),
                                            .emission = hit.emission,
                                            .found = true };
    return (struct mrt_geometry_texel){
        .position = to,
        .normal = glms_vec3_negate(mrt_warp_face_normal(corner, tile->face, wall)),
    };
}

static void trace_tile(void *user, size_t i)
{
    const struct geometry_job *job = user;
    const struct mrt_tile *tile = &job->atlas->tiles[i];
    int n = job->atlas->resolution;
    for (int k = 0; k < n * n; k++) {
        float s = ((float)(k % n) + 0.5f) / (float)n, t = ((float)(k / n) + 0.5f) / (float)n;
        job->texels[tile->first_texel + k] = texel_of(job, tile, s, t);
    }
}

struct mrt_geometry_texel *mrt_geometry_create(struct host *host, const struct mrt_block_map *map,
                                               const struct mrt_atlas *atlas,
                                               const struct trace_scene *scene)
{
    struct geometry_job job = { map, atlas, scene, NULL };
    job.texels = host_alloc(host, (size_t)atlas->texels, sizeof *job.texels);
    if (job.texels) parallel_for((size_t)atlas->tile_count, 1, trace_tile, &job);
    return job.texels;
}

// ---- walls of surfaces

// The surface's normal in the cell: gradients transform with the transposed Jacobian.
static vec3s normal_in_cell(const struct mrt_block *block, vec3s cell, vec3s normal)
{
    mat3s j = mrt_warp_jacobian(block->corner, cell);
    return vec3_unit(glms_mat3_mulv(glms_mat3_transpose(j), normal));
}

static float clamped(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);
}

static float outside(vec3s cell)
{
    return fmaxf(glms_vec3_max(glms_vec3_abs(cell)) - 0.5f, 0.0f);
}

bool mrt_wall_of_surface(const struct mrt_block *block, vec3s position, vec3s normal, float beyond,
                         struct mrt_wall_point *out)
{
    vec3s cell;
    if (!mrt_warp_inverse(block->corner, position, &cell) || outside(cell) > beyond) return false;
    vec3s n = normal_in_cell(block, cell, normal);
    float most = 0.0f;
    out->face = -1;
    for (int f = 0; f < CUBE_FACES; f++) {
        // The inner normal of a wall is that of its frame, reversed.
        float along = -glms_vec3_dot(cube_from_face(f).col[2], n);
        if (mrt_block_is_open(block, f) || along <= most) continue;
        most = along;
        out->face = f;
    }
    if (out->face < 0) return false;
    mat3s frame = cube_from_face(out->face);
    out->s = clamped(0.5f + glms_vec3_dot(frame.col[0], cell));
    out->t = clamped(0.5f + glms_vec3_dot(frame.col[1], cell));
    return true;
}

int mrt_block_of_surface(const struct mrt_block_map *map, vec3s position, vec3s normal,
                         float beyond, struct mrt_wall_point *out)
{
    int nearest = -1;
    float least = beyond;
    for (int b = 0; b < map->count; b++) {
        struct mrt_wall_point point;
        vec3s cell;
        if (!mrt_warp_inverse(map->blocks[b].corner, position, &cell)) continue;
        if (outside(cell) > least || (nearest >= 0 && outside(cell) == least)) continue;
        if (!mrt_wall_of_surface(&map->blocks[b], position, normal, beyond, &point)) continue;
        least = outside(cell);
        nearest = b;
        *out = point;
    }
    return nearest;
}
