// The probe volume: irradiance of a surface of any normal n at the centre of each cell,
// E(n) = ∫ I(ω) (−n·ω)₊ dω as in apply.comp: one factor per band, with the sign of band 1
// flipped because n points towards the light. Not clamped: light from one side only may leave E
// slightly negative. Lookups between them end at walls as those of pixels do.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/probes.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#define LPV_WALLS_BINDING 3
#include "techniques/lpv/lpv_lookup.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(set = 0, binding = 1) uniform sampler3D light;
layout(set = 0, binding = 2) uniform writeonly image3D probes;

layout(push_constant, scalar) uniform push_block
{
    frame_probes grid;
};

// The slabs of common/probes/lookup.glsl.
void store_walls(ivec3 cell)
{
    vec4 covered = vec4(0.0), place = vec4(0.0);
    for (int axis = 0; axis < 3; axis++) {
        lpv_wall wall = lpv_wall_below(cell, lpv_cells(), axis);
        covered[axis] = max(wall.from_below, wall.from_above);
        place[axis] = wall.place;
    }
    ivec3 slab = cell + ivec3(0, 0, FRAME_PROBE_SLABS * grid.slab);
    imageStore(probes, slab, covered);
    imageStore(probes, slab + ivec3(0, 0, grid.slab), place);
}

void main()
{
    ivec3 cell = lpv_cell_of_invocation(1);
    if (!lpv_inside(cell)) return;
    vec4 slabs[7];
    lpv_fetch_slabs(light, cell, slabs);
    vec3 coefficients[9];
    for (int i = 0; i < 9; i++) {
        float weight = sh9_cosine_weight(i) * lpv.irradiance_scale *
                       (i == 0  ? 1.0
                        : i < 4 ? lpv.window_1
                                : lpv.window_2) *
                       (i > 0 && i < 4 ? -1.0 : 1.0);
        for (int colour = 0; colour < 3; colour++) {
            int value = 3 * i + colour;
            coefficients[i][colour] =
                clamp(weight * slabs[value / 4][value % 4], -HALF_MAX, HALF_MAX);
        }
    }
    for (int s = 0; s < FRAME_PROBE_SLABS; s++)
        imageStore(probes, cell + ivec3(0, 0, s * grid.slab), probes_slab(coefficients, s));
    if (LPV_GEOMETRY == LPV_GEOMETRY_SCENE) store_walls(cell);
}
