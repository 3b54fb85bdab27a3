// Surface attributes of a voxel, averaged over its triangles and packed into two RGBA32U texels.
// The second one holds emission, where the voxel emits.
#ifndef AG_VCT_SURFACE_GLSL
#define AG_VCT_SURFACE_GLSL

#include "techniques/vct/vct_voxel_images.glsl"
#include "techniques/vct/voxelize/voxelize_shared.h"

// Sums in fixed point, so that results do not depend on the order of triangles. Triangles are
// weighted with the area that they cover.
struct vct_sums {
    uint weight, opacity;
    uvec3 reflectance;  // × opacity
    ivec3 normal;       // of the front
    ivec3 position;     // from the voxel's centre
    uvec3 front, back;  // emission of both sides × opacity; negative for small emitters
    uint fronts, backs; // covered weight of front faces, of back faces
};

struct vct_surface {
    vec3 reflectance;
    vec2 opacity;  // seen from the front, from the back
    bvec2 covers;  // whether there is a front, a back
    vec3 normal;   // unit, of the front; 0 where the sides are ambiguous
    vec3 position; // from the voxel's centre, in voxels
    float weight;  // of the surfaces, in units of 32
    bool emits;
};

const float VCT_SURFACE_WEIGHT = 32.0;

void vct_pack_sums(vct_sums s, out uvec4 first, out uvec4 second)
{
    precise vec3 normal = vec3(s.normal);
    precise float length2 = dot(normal, normal);
    precise vec3 unit = length2 > 0.0 ? normal * inversesqrt(length2) : vec3(0.0);
    precise float per_opaque = 1.0 / max(float(s.opacity), 1.0),
                  per_weight = 1.0 / max(float(s.weight), 1.0);
    precise vec3 reflectance = vec3(s.reflectance) * (per_opaque / VCT_COLOUR_ONE);
    precise vec3 position = vec3(s.position) * (per_weight / VCT_POSITION_ONE);
    precise vec2 opacity = vec2(s.fronts, s.backs) / VCT_WEIGHT_ONE;
    precise vec3 front = vec3(ivec3(s.front)) * per_opaque, back = vec3(ivec3(s.back)) * per_opaque;
    uvec3 place =
        uvec3(roundEven((clamp(position, -1.0, 1.0) * 0.5 + 0.5) * 1022.0)); // the centre is exact
    uint weight = min((s.weight + uint(VCT_SURFACE_WEIGHT) - 1u) / uint(VCT_SURFACE_WEIGHT), 127u);
    first.x = packUnorm2x16(reflectance.rg);
    first.y = packUnorm2x16(vec2(reflectance.b, 0.0)) | packUnorm4x8(vec4(0.0, 0.0, opacity));
    bool emits = any(notEqual(s.front | s.back, uvec3(0u)));
    first.z = vct_pack_normal(unit) | weight << 24 | (emits ? 1u << 31 : 0u);
    first.w = place.x | place.y << 10 | place.z << 20 | (s.fronts > 0u ? 1u << 30 : 0u) |
              (s.backs > 0u ? 1u << 31 : 0u);
    second = uvec4(packHalf2x16(front.rg), packHalf2x16(vec2(front.b, back.r)),
                   packHalf2x16(back.gb), 0u);
}

vct_surface vct_unpack_surface(uvec4 first)
{
    vct_surface s;
    s.reflectance = vec3(unpackUnorm2x16(first.x), unpackUnorm2x16(first.y).x);
    s.opacity = unpackUnorm4x8(first.y).zw;
    s.covers = bvec2((first.w & 1u << 30) != 0u, (first.w & 1u << 31) != 0u);
    s.normal = vct_unpack_normal(first.z & 0xffffffu);
    s.position = vec3(uvec3(first.w) >> uvec3(0u, 10u, 20u) & 1023u) / 511.0 - 1.0;
    s.weight = float(first.z >> 24 & 127u);
    s.emits = (first.z & 1u << 31) != 0u;
    return s;
}

// Emission of both sides, in fixed point (VCT_EMISSION_ONE).
void vct_unpack_emission(uvec4 second, out vec3 front, out vec3 back)
{
    vec2 middle = unpackHalf2x16(second.y);
    front = vec3(unpackHalf2x16(second.x), middle.x);
    back = vec3(middle.y, unpackHalf2x16(second.z));
}

#endif
