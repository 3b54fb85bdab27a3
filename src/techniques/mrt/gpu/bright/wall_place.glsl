// Places of texels on the walls of affine blocks, in world space.
#ifndef AG_MRT_WALL_PLACE_GLSL
#define AG_MRT_WALL_PLACE_GLSL

#include "techniques/mrt/gpu/face.glsl"
#include "techniques/mrt/gpu/level.glsl"

struct mrt_wall {
    vec3 corner;       // of texel 0
    vec3 right, along; // edges of a texel
    vec3 normal;       // inwards, of the length of a texel's area
};

mrt_wall wall_of(uint block, int face)
{
    mat3 frame = cube_from_face(face), edges = edges_of_block(block);
    float size = 1.0 / float(level.resolution);
    mrt_wall wall;
    wall.right = edges * frame[0] * size;
    wall.along = edges * frame[1] * size;
    wall.corner = block_table[block].middle + edges * (0.5 * (frame[2] - frame[0] - frame[1]));
    wall.normal = cross(wall.right, wall.along);
    if (dot(wall.normal, edges * frame[2]) > 0.0) wall.normal = -wall.normal;
    return wall;
}

vec3 place_of(mrt_wall wall, uint texel)
{
    vec2 at = vec2(float(texel % level.resolution), float(texel / level.resolution)) + 0.5;
    return wall.corner + at.x * wall.right + at.y * wall.along;
}

#endif
