#include "techniques/mrt/clutter/cell_ray.h"

bool mrt_cell_ray_enter(const struct mrt_block_map *map, int block, vec3s from, vec3s way,
                        struct mrt_cell_ray *ray)
{
    const vec3s *corner = map->blocks[block].corner;
    ray->block = block;
    if (!mrt_warp_inverse(corner, from, &ray->position)) return false;
    ray->position = glms_vec3_maxv(glms_vec3_minv(ray->position, vec3_of(0.5f, 0.5f, 0.5f)),
                                   vec3_of(-0.5f, -0.5f, -0.5f));
    const mat3s cell_from_world = glms_mat3_inv(mrt_warp_jacobian(corner, ray->position));
    ray->direction = vec3_unit(glms_mat3_mulv(cell_from_world, way));
    return glms_vec3_norm2(ray->direction) > 0.0f;
}

vec3s mrt_cell_ray_end(const struct mrt_block_map *map, int resolution,
                       const struct mrt_cell_ray *ray, struct mrt_hit *hit)
{
    const struct mrt_block *block = &map->blocks[ray->block];
    const struct mrt_shape shape = mrt_block_shape(block, resolution);
    mrt_shape_trace(&shape, ray->position, ray->direction, hit);
    return mrt_warp_point(block->corner,
                          glms_vec3_muladds(ray->direction, hit->distance, ray->position));
}

mat3s mrt_frame_of_normal(vec3s normal)
{
    mat3s frame;
    basis_of(normal, &frame.col[0], &frame.col[1]);
    frame.col[2] = normal;
    return frame;
}
