// Samples the mips of the light volume.
#ifndef AG_VCT_SAMPLE_GLSL
#define AG_VCT_SAMPLE_GLSL

#include "techniques/vct/volume/directions.glsl"

const float VCT_TEXEL_CENTRE = 0.5; // of texel 0, texels

// Nearest position that the texels of a level filter without a border, in texels of level 0.
// weight: 1 within the volume, 0 from half a texel beyond it on: the scene has empty space around
// it.
vec3 vct_within_volume(vec3 at, int level, out float weight)
{
    int grid = min(level, VCT_CLIPS - 1);
    float texel = float(1 << level);
    vec3 low = VCT_CLIPS > 1 ? clips.levels[grid].corner : vec3(0.0),
         size = ceil(clips.levels[grid].size * float(1 << grid) / texel) * texel;
    vec3 within = clamp(at, low + 0.5 * texel, low + size - 0.5 * texel);
    vec3 inside = clamp(2.0 - 2.0 * abs(at - within) / texel, 0.0, 1.0);
    weight = inside.x * inside.y * inside.z;
    return within;
}

// Radiance against `direction` and opacity, at a position of vct_within_volume. `weights`: the
// components of the direction to weight with. Six volumes lie side by side along x, clip-map levels
// along z: filtering stays half a texel away from the next one. The isotropic volume ignores the
// direction.
vct_volume_sample vct_sample_volume(sampler3D light, vec3 at, vec3 direction, vec3 weights,
                                    int level)
{
    vec3 share = abs(weights);
    int grid = min(level, VCT_CLIPS - 1),
        mip = level - grid; // only the coarsest level has mips
    vec3 own = VCT_CLIPS > 1 ? (at - clips.levels[grid].corner) / float(1 << grid) : at;
    vec3 uv = own / float(vct.volume_dim);
    uv.z = (uv.z + float(VCT_CLIPS - 1 - grid)) / float(VCT_CLIPS);
    if (!VCT_ANISOTROPIC) {
        vec4 all = textureLod(light, uv, float(mip));
        if (VCT_OCCLUSION) all = all.rrrr;
        return vct_volume_sample(all, vec3(all.a));
    }
    vec3 volume_u = (vec3(0.0, 2.0, 4.0) + vec3(lessThan(direction, vec3(0.0))) + uv.x) / 6.0;
    vec4 x = textureLod(light, vec3(volume_u.x, uv.yz), float(mip));
    vec4 y = textureLod(light, vec3(volume_u.y, uv.yz), float(mip));
    vec4 z = textureLod(light, vec3(volume_u.z, uv.yz), float(mip));
    if (VCT_OCCLUSION) {
        x = x.rrrr;
        y = y.rrrr;
        z = z.rrrr;
    }
    vec3 opacities = mix(vec3(0.0), vec3(x.a, y.a, z.a), greaterThan(share, vec3(0.0)));
    return vct_volume_sample(share.x * x + share.y * y + share.z * z, opacities);
}

#endif
