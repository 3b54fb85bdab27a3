// The published probe volume (frame/probes.glsl and common/probes/lookup.glsl): the bricks of the
// blocks and outdoor probes, sampled at the places of a grid of the world.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_BLOCKS_BINDING     2
#define MRT_CELLS_BINDING      3
#define MRT_CANDIDATES_BINDING 4
#define MRT_BRICKS_BINDING     5
#define MRT_SIGHT_BINDING      7
#define MRT_OUTDOORS_BINDING   9
#include "core/half.glsl"
#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/probes.glsl"
#include "techniques/mrt/gpu/locate.glsl"
#include "techniques/mrt/gpu/bricks.glsl"
#include "techniques/mrt/gpu/outdoor_probes.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(set = 0, binding = 6, rgba16f) writeonly uniform image3D volume;

layout(set = 0, binding = 8) readonly buffer mrt_probe_places
{
    vec4 place_table[]; // offset from the grid, in spacings; 1: valid
};

layout(push_constant, scalar) uniform push_block
{
    frame_probes grid;
};

// Coefficients of a slab between the probes of blocks.
vec4 room_slab(mrt_visible_probes visible, int s)
{
    vec3 slab = vec3(0.0, 0.0, float(s * (int(level.probes) + 2)));
    vec4 values = vec4(0.0);
    for (int i = 0; i < visible.lookups; i++) {
        float weight;
        vec3 texel = lookup_of(visible, i, weight) + slab;
        values += weight * textureLod(bricks, texel / vec3(textureSize(bricks, 0)), 0.0);
    }
    return values;
}

// Outdoor probes around a place; open: 0, none.
struct mrt_open_place {
    vec3 texel;
    float open;
    float share; // of their light; the rest is that of the room
};

mrt_open_place open_place(vec3 position, mrt_place place)
{
    mrt_open_place at = mrt_open_place(vec3(0.5), 0.0, 0.0);
    if (!OUTDOORS || (place.block >= 0 && place.outside == 0.0)) return at;
    at.texel = outdoor_texel(position, vec3(0.0));
    at.open = outdoor_open(at.texel);
    float left = place.block < 0 ? 1.0 : smoothstep(0.0, MRT_LEAVING, place.outside);
    at.share = left * smoothstep(0.0, MRT_OUTDOORS_OPEN, at.open);
    return at;
}

vec4 outdoor_light(mrt_open_place at, int s)
{
    vec4 values = outdoor_slab(at.texel, s) / at.open;
    return s == FRAME_PROBE_SLABS - 1 ? vec4(values.rgb, 0.0) : values;
}

// Points that are in no block and not outdoors are dark, and not valid.
void main()
{
    int i = int(gl_GlobalInvocationID.x);
    ivec3 at = probes_cell(grid, i);
    if (at.z >= grid.count_z) return;
    vec4 offset = place_table[i];
    vec3 position = grid.first_m + grid.spacing_m * (vec3(at) + offset.xyz);
    mrt_place place = locate(position);
    mrt_open_place open = open_place(position, place);
    mrt_visible_probes visible;
    visible.lookups = 0;
    if (place.block >= 0) visible = visible_probes_at(place, vec3(0.0));
    for (int s = 0; s < FRAME_PROBE_SLABS; s++) {
        vec4 values = room_slab(visible, s);
        if (open.share > 0.0) values = mix(values, outdoor_light(open, s), open.share);
        imageStore(volume, at + ivec3(0, 0, s * grid.slab),
                   clamp(level.gain * values, -HALF_MAX, HALF_MAX));
    }
    if (place.block < 0 && open.share == 0.0) offset.w = 0.0;
    imageStore(volume, at + ivec3(0, 0, FRAME_PROBE_SLABS * grid.slab), offset);
}
