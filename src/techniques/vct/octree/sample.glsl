// Sampling of the octree, with the interface of volume/sample.glsl: descends from the root to the
// node of the level that contains the position, and samples its brick. Empty where the tree has no
// node.
#ifndef AG_VCT_SVO_SAMPLE_GLSL
#define AG_VCT_SVO_SAMPLE_GLSL

#include "techniques/vct/volume/directions.glsl"

layout(set = 0, binding = 21, scalar) readonly buffer vct_svo_nodes
{
    uint nodes[];
};

#include "techniques/vct/octree/octree.glsl"

const float VCT_TEXEL_CENTRE = 0.0; // of point 0, point spacings

// As in volume/sample.glsl; the outermost points are on the border.
vec3 vct_within_volume(vec3 at, int level, out float weight)
{
    vec3 within = clamp(at, vec3(0.0), vec3(vct_cells() / 2));
    vec3 inside = clamp(2.0 - 2.0 * abs(at - within) / float(1 << level), 0.0, 1.0);
    weight = inside.x * inside.y * inside.z;
    return within;
}

vct_volume_sample vct_sample_volume(sampler3D light, vec3 at, vec3 direction, vec3 weights,
                                    int level)
{
    // A texel of level 0 is one point spacing; it doubles with each level.
    vec3 points = at / float(1 << level);
    ivec3 node = min(ivec3(0.5 * points), svo_nodes_in_use(level) - 1);
    uint brick = svo_find(node, svo.depths - 1u - uint(level));
    if (brick == SVO_NONE) return vct_volume_sample(vec4(0.0), vec3(0.0));
    vec3 size = vec3(3 * svo.row * ivec2(VCT_DIRECTIONS, 1), textureSize(light, 0).z);
    vec3 uv = (vec3(svo_brick_texel(brick)) + 0.5 + points - vec3(2 * node)) / size;
    if (!VCT_ANISOTROPIC) {
        vec4 all = textureLod(light, uv, 0.0);
        return vct_volume_sample(all, vec3(all.a));
    }
    vec3 share = abs(weights),
         volume_u = uv.x + (vec3(0.0, 2.0, 4.0) + vec3(lessThan(direction, vec3(0.0)))) / 6.0;
    vec4 x = textureLod(light, vec3(volume_u.x, uv.yz), 0.0);
    vec4 y = textureLod(light, vec3(volume_u.y, uv.yz), 0.0);
    vec4 z = textureLod(light, vec3(volume_u.z, uv.yz), 0.0);
    vec3 opacities = mix(vec3(0.0), vec3(x.a, y.a, z.a), greaterThan(share, vec3(0.0)));
    return vct_volume_sample(share.x * x + share.y * y + share.z * z, opacities);
}

#endif
