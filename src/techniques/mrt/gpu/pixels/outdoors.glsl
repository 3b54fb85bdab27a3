// Light of surfaces outside of all rooms. Needs level.glsl, lobe.glsl and MRT_OUTDOORS_BINDING.
#ifndef AG_MRT_OUTDOORS_GLSL
#define AG_MRT_OUTDOORS_GLSL

#include "techniques/mrt/gpu/outdoor_probes.glsl"

// share: 1 outdoors, 0 enclosed. One step along the normal, the probes on the surface's side of a
// wall weigh most; those behind it, in a room or a solid, are not open.
mrt_light outdoor_light(vec3 position, vec3 normal, mrt_lobe lobe, out float share)
{
    share = 0.0;
    if (!OUTDOORS) return MRT_DARK;
    vec3 texel = outdoor_texel(position, normal);
    float open = outdoor_open(texel);
    if (open <= 0.0) return MRT_DARK;
    share = smoothstep(0.0, MRT_OUTDOORS_OPEN, open);
    return scaled_light(probe_light_at(outdoors, level.outdoors.slab, texel, normal, lobe),
                        1.0 / open);
}

#endif
