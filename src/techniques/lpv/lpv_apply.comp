// Irradiance at each pixel from the accumulated intensity (Martin 2012, sec. 3.2.4, without the albedo of eq. 3.4).
//
// From intensity to irradiance. The flux I(ω) dω that a step finds in a cell of side a goes a way w a in that step, w = 2/3
// with six neighbours and 1.203 with 26 (lpv_mean_way). A flux density of paths per volume is radiance: L(ω) = I(ω) (w a) / a³,
// and E = ∫ L(ω) (−n·ω)₊ dω. Hence irradiance_scale = w / a²; the tests print how near that comes to form factors.
//
// The window. Light with the direction ω, c = −n·ω, has the irradiance ∝ 1 + w 2 c in two bands and ∝ 1 + w (2 c + 5/4 P2(c))
// in three, w being the weight of the bands above the first: exact for w = 1, but it comes out negative behind the surface (−1
// at c = −1; −0.158 at c = −8/15), and beside a bright wall, whose light all leaves it, it takes other light away, in the
// wall's complementary colour. 1/2 in two bands and 0.863 in three are the largest weights with which no light of positive
// intensity becomes negative.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform push_block
{
    lpv_apply_push push;
};
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D normal;
layout(set = 0, binding = 4) uniform sampler3D light;
layout(set = 0, binding = 5, rgba16f) uniform image2D irradiance;

// ∫ I(ω) (−n·ω)₊ dω in the bands of I, weighted with the window.
vec3 irradiance_of(lpv_light light, vec3 n)
{
    vec3 sum = SH_COSINE_0 * SH_Y0 * light.mean, band_1 = vec3(0.0), band_2 = vec3(0.0);
    vec3 products = n.yzx * n.zxy;
    for (int a = 0; a < 3; a++) {
        band_1 -= SH_Y1 * n[a] * light.along[a];
        band_2 += n[a] * n[a] * light.square[a] + SH_Y2_XY * products[a] * light.product[a];
    }
    return sum + lpv.window * (SH_COSINE_1 * band_1 + SH_COSINE_2 * band_2);
}

bool covered_by_finer(vec3 surface)
{
    if (push.finer_cell_m == 0.0) return false;
    ivec3 cells = ivec3(push.finer_cells_x, push.finer_cells_y, push.finer_cells_z);
    return lpv_cascade_weight((surface - push.finer_origin_m) / push.finer_cell_m, cells, push.finer_open) == 1.0;
}

vec3 lit(vec3 surface, vec3 n)
{
    vec3 sum = irradiance_of(lpv_sample(light, lpv_cells_from_world(surface + lpv.offset_m * n)), n);
    // What steps of sharp lobes left negative behind a bright wall stays out.
    return clamp(sum * lpv.irradiance_scale, 0.0, HALF_MAX);
}

// From the coarsest cascade to the finest, each over what the one before left. Outside of the coarsest there is no light.
void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(lpv.width, lpv.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 result = vec3(0.0);
    if (z > 0.0) {
        vec3 surface = frame_world_position(frame_uv(uvec2(pixel)), z);
        float weight = lpv_cascade_weight(lpv_cells_from_world(surface), lpv_cells(), push.open);
        if (covered_by_finer(surface) || (weight == 0.0 && push.coarsest == 0u)) return;
        if (weight > 0.0) result = lit(surface, octahedral_decode(texelFetch(normal, pixel, 0).rg));
        if (weight < 1.0) result = mix(push.coarsest != 0u ? vec3(0.0) : imageLoad(irradiance, pixel).rgb, result, weight);
    }
    imageStore(irradiance, pixel, vec4(result, 1.0));
}
