// The grid of outdoor probes (outdoors.comp), for lookups. Needs level.glsl and
// MRT_OUTDOORS_BINDING.
#ifndef AG_MRT_OUTDOOR_PROBES_GLSL
#define AG_MRT_OUTDOOR_PROBES_GLSL

layout(set = 0, binding = MRT_OUTDOORS_BINDING) uniform sampler3D outdoors;

layout(constant_id = MRT_CONSTANT_OUTDOORS) const bool OUTDOORS = false;

const float MRT_OUTDOORS_OPEN = 0.5; // share of open probes around a place that is outdoors

// Edges beyond its block over which a place outdoors blends out of the light of the room.
const float MRT_LEAVING = 0.25;

// Texel of a place, which is moved by this many spacings.
vec3 outdoor_texel(vec3 position, vec3 moved)
{
    frame_probes grid = level.outdoors;
    vec3 last = vec3(grid.count_x, grid.count_y, grid.count_z) - 1.0;
    return clamp((position - grid.first_m) / grid.spacing_m + moved, vec3(0.0), last) + 0.5;
}

vec4 outdoor_slab(vec3 texel, int slab)
{
    vec3 at = texel + vec3(0.0, 0.0, float(slab * level.outdoors.slab));
    return textureLod(outdoors, at / vec3(textureSize(outdoors, 0)), 0.0);
}

// Share of open probes around a texel.
float outdoor_open(vec3 texel)
{
    return outdoor_slab(texel, FRAME_PROBE_SLABS - 1).a;
}

#endif
