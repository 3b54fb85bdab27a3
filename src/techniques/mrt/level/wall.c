// Coordinates on the walls of blocks.
#include "wall.h"

#include <math.h>

int mrt_block_walls(const struct mrt_block *block)
{
    int walls = 0;
    for (int f = 0; f < CUBE_FACES; f++) walls += mrt_block_has_wall(block, f);
    return walls;
}

struct mrt_shape mrt_block_shape(const struct mrt_block *block, int resolution)
{
    return mrt_block_is_tube(block) ? mrt_tube(resolution, mrt_block_bend(block))
                                    : mrt_cube(resolution, block->open);
}

struct mrt_wall_place mrt_wall_place(const struct mrt_block *block, int face, float s, float t)
{
    if (!mrt_block_is_tube(block)) {
        mat3s frame = cube_from_face(face);
        return (struct mrt_wall_place){ cube_face_point(face, s, t), frame.col[0], frame.col[1] };
    }
    const enum tube_bend bend = mrt_block_bend(block);
    const struct tube_frame axis = tube_axis(bend, t);
    const float angle = 2.0f * GLM_PIf * s, round = 2.0f * GLM_PIf * TUBE_RADIUS;
    vec3s by_s = glms_vec3_scale(axis.left, -sinf(angle) * round);
    by_s.y += cosf(angle) * round;
    // Bends turn by a right angle around a line at ½ to the side of the axis.
    float side = bend == TUBE_LEFT ? 1.0f : -1.0f;
    float length =
        bend == TUBE_STRAIGHT ? 1.0f : GLM_PI_2f * (0.5f - side * TUBE_RADIUS * cosf(angle));
    return (struct mrt_wall_place){ tube_wall(bend, s, t), by_s,
                                    glms_vec3_scale(axis.forward, length) };
}

vec3s mrt_wall_middle(const struct mrt_block *block, int face, float s, float t)
{
    if (mrt_block_is_tube(block)) return tube_axis(mrt_block_bend(block), t).origin;
    vec3s middle = cube_face_point(face, s, t);
    middle.raw[face / 2] = 0.0f;
    return middle;
}

vec3s mrt_block_middle(const struct mrt_block *block)
{
    vec3s middle =
        mrt_block_is_tube(block) ? tube_axis(mrt_block_bend(block), 0.5f).origin : GLMS_VEC3_ZERO;
    return mrt_warp_point(block->corner, middle);
}

// The derivatives by s and t in the scene, crossed: outwards.
static vec3s wall_cross(const struct mrt_block *block, int face, float s, float t)
{
    const struct mrt_wall_place at = mrt_wall_place(block, face, s, t);
    mat3s j = mrt_warp_jacobian(block->corner, at.position);
    return glms_vec3_cross(glms_mat3_mulv(j, at.by_s), glms_mat3_mulv(j, at.by_t));
}

float mrt_wall_area(const struct mrt_block *block, int face, float s, float t)
{
    return glms_vec3_norm(wall_cross(block, face, s, t));
}

vec3s mrt_wall_normal(const struct mrt_block *block, int face, float s, float t)
{
    return glms_vec3_negate(vec3_unit(wall_cross(block, face, s, t)));
}

vec3s mrt_wall_across(const struct mrt_block *block, int face, float s, float t)
{
    const struct mrt_wall_place at = mrt_wall_place(block, face, s, t);
    const vec3s along = mrt_block_is_tube(block) ? at.by_t : glms_vec3_negate(at.by_s);
    return vec3_unit(glms_mat3_mulv(mrt_warp_jacobian(block->corner, at.position), along));
}
