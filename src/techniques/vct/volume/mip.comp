// The next mip of the light volume. In each of the six volumes 2 × 2 × 2 texels make one: pairs
// along the volume's direction are composited front to back, the four pairs are averaged. The
// isotropic volume averages all eight. Unlisted texels are empty and stay 0.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/volume/volume_shared.h"
#include "techniques/vct/volume/over.glsl"
#include "techniques/vct/volume/directions.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    vct_mip_push push;
};
layout(set = 0, binding = 1) uniform sampler3D source;
layout(set = 0, binding = 2) uniform writeonly image3D target;
layout(set = 0, binding = 3, scalar) readonly buffer vct_texels
{
    uint texels[];
};
layout(set = 0, binding = 4, scalar) readonly buffer vct_texel_counts
{
    vct_texel_levels state;
};

void main()
{
    uint i = gl_GlobalInvocationID.x / uint(VCT_DIRECTIONS);
    int direction = int(gl_GlobalInvocationID.x % uint(VCT_DIRECTIONS));
    if (i >= state.count[push.level]) return;
    ivec3 texel = vct_unpack_texel(texels[push.first + i]);
    ivec3 from = 2 * texel + ivec3(direction * push.source_tile, 0, 0);
    ivec3 along = direction < 2 ? ivec3(1, 0, 0) : direction < 4 ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
    ivec3 size = ivec3(push.source_x, push.source_y, push.source_z);
    // Texels outside of the grid do not count.
    vec4 sum = vec4(0.0);
    float columns = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec3 side = (direction < 2   ? ivec3(0, i & 1, i >> 1)
                      : direction < 4 ? ivec3(i & 1, 0, i >> 1)
                                      : ivec3(i & 1, i >> 1, 0));
        if (any(greaterThanEqual(2 * texel + side, size))) continue;
        bool whole = all(lessThan(2 * texel + side + along, size));
        ivec3 at = from + side;
        vec4 first = texelFetch(source, at, 0),
             second = whole ? texelFetch(source, at + along, 0) : vec4(0.0);
        if (VCT_OCCLUSION) {
            first = first.rrrr;
            second = second.rrrr;
        }
        if (VCT_ANISOTROPIC)
            sum += (direction & 1) == 0 ? vct_over(first, second) : vct_over(second, first);
        else
            sum += whole ? 0.5 * (first + second) : first;
        columns++;
    }
    imageStore(target, texel + ivec3(direction * push.target_tile, 0, 0), sum / columns);
}
