// The cones of each pixel, or its part of them: radiance × solid angle × cosine, and the sum of the latter two.
//
// Pixels that share a set of cones are one sub-image (Hong 2015, sec. 4.2): every workgroup takes pixels of one alone,
// so that all its invocations go the same way through the volume. That is what the paper's splitting and translation
// of blocks is for; in compute the addresses are enough, and nothing is copied.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/vct_axes.glsl"
#include "techniques/vct/vct_trace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler3D light;
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D gathered;

void main()
{
    uint side = set.interleave, part = gl_GlobalInvocationID.z;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy * side + uvec2(part % side, part / side));
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, uvec2(set.sub_width, set.sub_height))) ||
        any(greaterThanEqual(pixel, ivec2(set.width, set.height))))
        return;
    float z = texelFetch(depth, pixel, 0).r;
    vec4 sum = vec4(0.0);
    if (z > 0.0) {
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        mat3 world_from_local = vct_axes_about(n);
        vec3 from = (frame_world_position(frame_uv(uvec2(pixel)), z) - vct.origin_m) / set.texel_m + set.offset * n;
        // Parts that neighbours have are far apart in the set: 7 has no factor in common with 4, 9, 16 and 25.
        uint first = part * 7u % (side * side) % set.cone_count;
        for (uint i = first; i < set.cone_count; i += side * side) {
            vec3 direction = world_from_local * set.cones[i].xyz;
            vec4 met = vct_trace(light, from, n, direction, set.width_per_m, set.last_mip);
            sum += set.cones[i].w * vec4(met.rgb + (1.0 - met.a) * frame.sky, 1.0);
        }
    }
    imageStore(gathered, pixel, min(sum, vec4(HALF_MAX)));
}
