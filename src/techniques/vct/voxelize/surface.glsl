// Surface attributes of a voxel's face, averaged over its triangles and packed into two RGBA32U
// texels. The second one holds emission, where the face emits.
#ifndef AG_VCT_SURFACE_GLSL
#define AG_VCT_SURFACE_GLSL

#include "techniques/vct/vct_voxel_images.glsl"
#include "techniques/vct/voxelize/voxelize_shared.h"

// Sums in fixed point, so that results do not depend on the order of triangles. Triangles are
// weighted with the area that they cover.
struct vct_sums {
    uint weight, opacity;
    uvec3 reflectance; // × opacity
    ivec3 normal;
    ivec3 position; // from the voxel's centre
    uvec3 emission; // × opacity; negative for small emitters
    uint covered;   // covered weight
    uint lines;     // that cross it visibly, as bits
};

struct vct_surface {
    vec3 reflectance;
    float opacity;
    bool covers;   // whether it covers any area
    uint lines;    // that cross it visibly, as bits: voxelize/line_places.glsl
    vec3 normal;   // unit
    vec3 position; // from the voxel's centre, in voxels
    float weight;  // of the surfaces, in units of 32
    bool emits;
};

const float VCT_SURFACE_WEIGHT = 32.0;
const float VCT_REFLECTANCE_ONE = 8191.0; // 13 bits

void vct_pack_sums(vct_sums s, out uvec4 first, out uvec4 second)
{
    precise vec3 normal = vec3(s.normal);
    precise float length2 = dot(normal, normal);
    precise vec3 unit = length2 > 0.0 ? normal * inversesqrt(length2) : vec3(0.0);
    precise float per_opaque = 1.0 / max(float(s.opacity), 1.0),
                  per_weight = 1.0 / max(float(s.weight), 1.0);
    precise vec3 reflectance = vec3(s.reflectance) * (per_opaque / VCT_COLOUR_ONE);
    precise vec3 position = vec3(s.position) * (per_weight / VCT_POSITION_ONE);
    precise float opacity = float(s.covered) / VCT_WEIGHT_ONE;
    precise vec3 emission = vec3(ivec3(s.emission)) * per_opaque;
    uvec3 place =
        uvec3(roundEven((clamp(position, -1.0, 1.0) * 0.5 + 0.5) * 1022.0)); // the centre is exact
    uint weight = min((s.weight + uint(VCT_SURFACE_WEIGHT) - 1u) / uint(VCT_SURFACE_WEIGHT), 127u);
    uvec3 colour = uvec3(roundEven(clamp(reflectance, 0.0, 1.0) * VCT_REFLECTANCE_ONE));
    first.x = colour.r | colour.g << 13 | colour.b << 26;
    first.y = s.lines | packUnorm4x8(vec4(0.0, 0.0, opacity, 0.0)) | colour.b >> 6 << 24;
    bool emits = any(notEqual(s.emission, uvec3(0u)));
    first.z = vct_pack_normal(unit) | weight << 24 | (emits ? 1u << 31 : 0u);
    first.w = place.x | place.y << 10 | place.z << 20 | (s.covered > 0u ? 1u << 30 : 0u);
    second = uvec4(packHalf2x16(emission.rg), packHalf2x16(vec2(emission.b, 0.0)), 0u, 0u);
}

vct_surface vct_unpack_surface(uvec4 first)
{
    vct_surface s;
    s.reflectance =
        vec3(first.x & 8191u, first.x >> 13 & 8191u, first.x >> 26 | first.y >> 24 << 6) /
        VCT_REFLECTANCE_ONE;
    s.lines = first.y & 0xffffu;
    s.opacity = unpackUnorm4x8(first.y).z;
    s.covers = (first.w & 1u << 30) != 0u;
    s.normal = vct_unpack_normal(first.z & 0xffffffu);
    s.position = vec3(uvec3(first.w) >> uvec3(0u, 10u, 20u) & 1023u) / 511.0 - 1.0;
    s.weight = float(first.z >> 24 & 127u);
    s.emits = (first.z & 1u << 31) != 0u;
    return s;
}

// Emission, in fixed point (VCT_EMISSION_ONE).
vec3 vct_unpack_emission(uvec4 second)
{
    return vec3(unpackHalf2x16(second.x), unpackHalf2x16(second.y).x);
}

#endif
