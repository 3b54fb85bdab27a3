// Light of the voxels' faces: reflected direct and bounced light, and emission.
//
// Differs from Hong 2015, sec. 2.5.3.3.9, which scatters texels of reflective shadow maps into
// voxels and leaves cracks where these maps are coarser than the voxels (figure 47). Here each
// voxel samples the shadow maps: no cracks, no dependence on the order of additions, and no
// reflective shadow maps.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "frame/light.glsl"
#include "frame/shadow/shadow.glsl"
#define VCT_GRID_BINDING 4
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/volume/lit_face.glsl"
#include "techniques/vct/voxelize/surface.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};
layout(set = 0, binding = 5, scalar) readonly buffer vct_list
{
    uint list[];
};
layout(set = 0, binding = 6) uniform usampler2D vct_surfaces;
layout(set = 0, binding = 7, rgba32ui) uniform writeonly uimage2D vct_lit_voxels;
layout(set = 0, binding = 8, scalar) readonly buffer vct_arguments
{
    vct_voxel_counts counts;
};
layout(set = 0, binding = 9) uniform sampler2D vct_bounced;
layout(set = 0, binding = 10) uniform usampler2D vct_part_of_face;

layout(constant_id = VCT_CONSTANT_HAS_LIGHTS) const bool HAS_LIGHTS = true;

const float SHADOW_LIFT = 0.25; // voxels: offset of curved surfaces from the mean of their voxel

// A small value that loops or branches depend on. Mesa 22.3's lavapipe recompiles a shader for each
// value that comes from uniforms alone, which takes longer than the dispatch. A minimum with the
// length of a buffer, which is never less, prevents that.
uint no_recompile(uint number)
{
    return min(number, list.length());
}

// Irradiance from one light, scaled lux.
vec3 irradiance(frame_light light, vec3 position, vec3 normal)
{
    // Limits the distance to a light inside of the voxel.
    float nearest = max(LIGHT_MIN_DISTANCE_M, 0.5 * vct.cell_m);
    vec3 to_light;
    float attenuation = light_attenuation(light, position, 0.0, nearest * nearest, to_light);
    float cosine = dot(normal, to_light);
    if (attenuation == 0.0 || cosine <= 0.0) return vec3(0.0);
    if (light.shadow_first >= 0)
        attenuation *=
            shadow_visibility(light, position + normal * (SHADOW_LIFT * vct.cell_m), normal,
                              to_light, true, int(no_recompile(uint(vct.shadow_radius))));
    return light.intensity * (attenuation * cosine);
}

void main()
{
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= counts.listed) return;
    ivec2 from = vct_surface_texel(slot);
    vct_surface surface = vct_unpack_surface(texelFetch(vct_surfaces, from, 0));
    vec3 position =
        vct_world_from_voxels(vec3(vct_voxel_of_face(list[slot])) + 0.5 + surface.position);
    vct_lit_face r;
    r.opacity = surface.opacity;
    r.normal = surface.normal;
    vec3 emitted = vct_unpack_emission(texelFetch(vct_surfaces, from + ivec2(1, 0), 0));
    r.emitted =
        surface.emits ? clamp(emitted * vct.emission_scaled, -HALF_MAX, HALF_MAX) : vec3(0.0);

    vec3 arriving = vec3(0.0);
    for (uint i = 0; HAS_LIGHTS && i < no_recompile(vct.light_count); i++)
        arriving += irradiance(frame_light_table[i], position, surface.normal);
    if (no_recompile(vct.bounced) != 0u) {
        uint part = texelFetch(vct_part_of_face, vct_face_texel(slot), 0).r;
        if (part < vct.capacity) arriving += texelFetch(vct_bounced, vct_face_texel(part), 0).rgb;
    }
    r.reflected = min(arriving * surface.reflectance / PI, vec3(HALF_MAX));
    imageStore(vct_lit_voxels, vct_face_texel(vct.face_first + slot), vct_pack(r));
}
