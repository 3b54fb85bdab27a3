// Light of surfaces outside of all rooms. Needs level.glsl, lobe.glsl and MRT_OUTDOORS_BINDING.
#ifndef AG_MRT_OUTDOORS_GLSL
#define AG_MRT_OUTDOORS_GLSL

layout(set = 0, binding = MRT_OUTDOORS_BINDING) uniform sampler3D outdoors;

layout(constant_id = MRT_CONSTANT_OUTDOORS) const bool OUTDOORS = false;

const float MRT_OUTDOORS_OPEN = 0.5; // share of open probes around a place that is outdoors

// share: 1 outdoors, 0 enclosed. One step along the normal, the probes on the surface's side of a
// wall weigh most; those behind it, in a room or a solid, are not open.
mrt_light outdoor_light(vec3 position, vec3 normal, mrt_lobe lobe, out float share)
{
    share = 0.0;
    if (!OUTDOORS) return MRT_DARK;
    frame_probes grid = level.outdoors;
    vec3 last = vec3(grid.count_x, grid.count_y, grid.count_z) - 1.0;
    vec3 at = (position - grid.first_m) / grid.spacing_m + normal;
    vec3 texel = clamp(at, vec3(0.0), last) + 0.5, size = vec3(textureSize(outdoors, 0));
    float slab = float((FRAME_PROBE_SLABS - 1) * grid.slab);
    float open = textureLod(outdoors, (texel + vec3(0.0, 0.0, slab)) / size, 0.0).a;
    if (open <= 0.0) return MRT_DARK;
    share = smoothstep(0.0, MRT_OUTDOORS_OPEN, open);
    return scaled_light(probe_light_at(outdoors, grid.slab, texel, normal, lobe), 1.0 / open);
}

#endif
