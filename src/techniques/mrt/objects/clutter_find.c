// Which parts of a scene are clutter.
#include "techniques/mrt/objects/clutter.h"

#include "scene/mesh_parts.h"

#include "techniques/mrt/level/wall.h"

#include <math.h>

// As in light_map.glsl: edges of the cell, and cosines.
static const float WALL_DISTANCE[2] = { 0.1f, MRT_NEAR_WALL };
static const float WALL_COSINE[2] = { 0.35f, 0.65f };

int mrt_block_of_point(const struct mrt_block_map *map, vec3s world, vec3s *cell)
{
    for (int b = 0; b < map->count; b++) {
        if (!box3_intersects(mrt_warp_bounds(map->blocks[b].corner), (struct box3){ world, world }))
            continue;
        if (!mrt_warp_inverse(map->blocks[b].corner, world, cell)) continue;
        if (glms_vec3_max(glms_vec3_abs(*cell)) <= 0.5f) return b;
    }
    return -1;
}

// How much a surface in a block is one of its walls, 0…1.
static float share_of_walls(const struct mrt_block *block, vec3s cell, vec3s normal)
{
    const mat3s j = mrt_warp_jacobian(block->corner, cell);
    const vec3s n = vec3_unit(glms_mat3_mulv(glms_mat3_transpose(j), normal));
    float most = 0.0f;
    for (int f = 0; f < CUBE_FACES; f++) {
        if (mrt_block_is_open(block, f)) continue;
        const float side = f & 1 ? 1.0f : -1.0f;
        const float distance = 0.5f - side * cell.raw[f / 2];
        const float share = glm_smoothstep(WALL_COSINE[0], WALL_COSINE[1], -side * n.raw[f / 2]) *
                            (1.0f - glm_smoothstep(WALL_DISTANCE[0], WALL_DISTANCE[1], distance));
        most = fmaxf(most, share);
    }
    return most;
}

// Points of a triangle: centroids of CUTS² parts, its edges cut into CUTS.
enum { CUTS = 4, POINTS = CUTS * CUTS };

static vec3s point_of(const vec3s corner[3], int i)
{
    // Row r of the cut triangle has 2 r + 1 parts, upright and reversed in turns.
    const int row = (int)sqrtf((float)i), column = i - row * row;
    const float third = column % 2 ? 2.0f : 1.0f;
    const float v = ((float)(column / 2) + third / 3.0f) / CUTS;
    const float up = ((float)row + (column % 2 ? 1.0f : 2.0f) / 3.0f) / CUTS;
    vec3s p = glms_vec3_scale(corner[0], 1.0f - up);
    p = glms_vec3_muladds(corner[1], up - v, p);
    return glms_vec3_muladds(corner[2], v, p);
}

struct finder {
    struct host *host;
    const struct scene_pose *pose;
    const struct mrt_block_map *map;
};

struct part_area {
    double all, inside; // inside: in blocks, on no wall
};

static void add_triangle(const struct finder *finder, const vec3s corner[3], bool mirrored,
                         struct part_area *area)
{
    vec3s normal =
        glms_vec3_cross(glms_vec3_sub(corner[1], corner[0]), glms_vec3_sub(corner[2], corner[0]));
    const double of_point = (double)glms_vec3_norm(normal) / (2.0 * POINTS);
    if (!isfinite(of_point)) return;
    normal = vec3_unit(mirrored ? glms_vec3_negate(normal) : normal);
    for (int i = 0; i < POINTS; i++) {
        vec3s cell;
        const int block = mrt_block_of_point(finder->map, point_of(corner, i), &cell);
        area->all += of_point;
        if (block < 0 || mrt_block_is_tube(&finder->map->blocks[block])) continue;
        const float share = share_of_walls(&finder->map->blocks[block], cell, normal);
        area->inside += of_point * (1.0 - (double)share);
    }
}

static void corners_of(const struct scene_pose *pose, int instance, uint32_t triangle,
                       vec3s corner[3])
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const vec3s *deformed = pose->deformed[instance].positions;
    const mat4s world_from_mesh = pose_world_from_instance(pose, instance);
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t v = mesh->indices[3 * (size_t)triangle + k];
        corner[k] = deformed ? deformed[v] : mat4_point(world_from_mesh, mesh->positions[v]);
    }
}

static bool find_in_instance(const struct finder *finder, int instance, bool *is_clutter)
{
    const struct mesh *mesh = scene_mesh_of(finder->pose->scene, instance);
    const uint32_t count = mesh->index_count / 3;
    const bool mirrored = pose_is_mirrored(finder->pose, instance);
    uint32_t *part = host_alloc(finder->host, count, sizeof *part);
    const int parts = part ? mesh_parts(finder->host, mesh, part) : -1;
    struct part_area *area =
        parts < 0 ? NULL : host_alloc(finder->host, (size_t)parts, sizeof *area);
    for (uint32_t t = 0; area && t < count; t++) {
        vec3s corner[3];
        corners_of(finder->pose, instance, t, corner);
        add_triangle(finder, corner, mirrored, &area[part[t]]);
    }
    for (uint32_t t = 0; area && t < count; t++)
        is_clutter[t] = 2.0 * area[part[t]].inside > area[part[t]].all;
    const bool ok = area;
    host_free(finder->host, part);
    host_free(finder->host, area);
    return ok;
}

static bool decide(const struct finder *finder, int instance, const unsigned char *named,
                   bool *is_clutter)
{
    const struct scene *scene = finder->pose->scene;
    const unsigned char name = named[scene->instances[instance].node];
    if (name == MRT_NAMED_NOT) return find_in_instance(finder, instance, is_clutter);
    for (uint32_t t = 0; t < scene_mesh_of(scene, instance)->index_count / 3; t++)
        is_clutter[t] = name == MRT_NAMED_CLUTTER;
    return true;
}

bool mrt_find_clutter(struct host *host, const struct scene_pose *pose,
                      const struct mrt_block_map *map, bool *is_clutter, size_t *count)
{
    const struct finder finder = { host, pose, map };
    unsigned char *named = mrt_named_nodes(host, pose->scene, map);
    size_t first = 0;
    bool ok = named;
    *count = 0;
    for (int i = 0; ok && i < pose->scene->instance_count; i++) {
        const uint32_t triangles = scene_mesh_of(pose->scene, i)->index_count / 3;
        ok = triangles == 0 || decide(&finder, i, named, is_clutter + first);
        for (uint32_t t = 0; t < triangles; t++) *count += is_clutter[first + t];
        first += triangles;
    }
    host_free(host, named);
    return ok;
}
