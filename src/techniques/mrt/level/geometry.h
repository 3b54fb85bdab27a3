// Geometry images of a level (Loos 2015, sections 3.5.2 and 3.6.2): the point of the scene that
// each texel of the level stands for, by rays onto the scene. Direct light is computed there.
#pragma once

#include "trace/trace.h"

#include "techniques/mrt/level/atlas.h"

// Shares of reflectors: those of light that surfaces in no block send (light/reflectors.h).
struct mrt_reflector_row {
    uint32_t first, count;
};

// Edges of a block up to which a surface has its wall's light: MRT_WALL_DISTANCE in
// gpu/pixels/light_map.glsl.
#define MRT_NEAR_WALL 0.15f

enum { MRT_PARTS = 4 }; // along an edge of a texel

// The middle of a part, in edges of the texel from its middle.
static inline vec2s mrt_part_place(int part)
{
    const float x = (float)(part % MRT_PARTS), y = (float)(part / MRT_PARTS);
    return (vec2s){ { (x + 0.5f) / MRT_PARTS - 0.5f, (y + 0.5f) / MRT_PARTS - 0.5f } };
}

struct mrt_geometry_texel {
    vec3s position;    // world
    vec3s normal;      // unit, towards the middle of the block
    vec3s reflectance; // for light that bounces (trace_reflectance); 0 where there is no surface
    vec3s emission;    // towards the middle of the block, cd/m²
    bool found;        // false: no surface, the wall of the block stands for it
    float area_m2;     // of the wall, or of the surface of clutter
    vec3s emitted;     // irradiance of emissive surfaces, lux (area_light.h)
    float sky;         // irradiance of a sky of radiance 1/π
    // Integrals of that light's radiance times direction along the surface, world: of emissive
    // surfaces by colour, of the sky. Parts along the normal mean nothing.
    vec3s emitted_vector[3], sky_vector;
    vec3s across; // of walls, unit: the first axis of the frame of irradiance by normal
    // Parts of the texel that have the surface of its middle: bit MRT_PARTS y + x; 0: unknown.
    // `edge` spans the texel on that surface.
    uint16_t parts;
    vec3s edge[2];
    struct mrt_reflector_row reflected;
    // Share of the block's light that is missing: objects inside it, which reflectors stand for,
    // hide their part of the hemisphere, and reflect the same irradiance.
    vec3s hidden;
};

// The middle of a part, from the texel's position.
static inline vec3s mrt_part_way(const struct mrt_geometry_texel *texel, int part)
{
    const vec2s at = mrt_part_place(part);
    return glms_vec3_muladds(texel->edge[1], at.y, glms_vec3_scale(texel->edge[0], at.x));
}

// The reflectance for the block's light.
static inline vec3s mrt_shown_reflectance(const struct mrt_geometry_texel *texel)
{
    return glms_vec3_mul(texel->reflectance, glms_vec3_sub(vec3_of(1, 1, 1), texel->hidden));
}

// One for each texel of the level, without light. The caller frees it with host_free.
struct mrt_geometry_texel *mrt_geometry_create(struct host *host, const struct mrt_block_map *map,
                                               const struct mrt_atlas *atlas,
                                               const struct trace_scene *scene);

// Geometry images with their level.
struct mrt_geometry {
    const struct mrt_block_map *map;
    const struct mrt_atlas *atlas;
    const struct mrt_geometry_texel *texels;
};
// Whether a texel stands for a surface in a block of cubes, or the block's wall does: pixels near a
// wall that they face have its light. `cell` is its place there.
bool mrt_geometry_has(const struct mrt_geometry *geometry, int block, vec3s cell, vec3s point,
                      vec3s normal);
