// Irradiance at each pixel from the accumulated intensity (Martin 2012, sec. 3.2.4, without the albedo of eq. 3.4).
//
// From intensity to irradiance. In one step the flux I(ω) dω crosses a cell; on its way it is in there for a mean chord of
// 4 V/S = 2/3 of the cell's side a (Cauchy). A flux density of paths per volume is radiance: L(ω) = I(ω) (2/3 a) / a³,
// and E = ∫ L(ω) (−n·ω)₊ dω. Hence irradiance_scale = 2/3 / a²; the tests print how near that comes to form factors.
//
// The window. Light with the mean direction m, |m| ≤ 1, has in two bands the irradiance ∝ 1 − 2 w (m·n) with w the weight of
// band 1: exact for w = 1, but beside a bright wall, whose light all leaves it, it is negative and takes other light away,
// in the wall's complementary colour. w = 1/2 is the largest weight with which no light of positive intensity becomes negative.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D normal;
layout(set = 0, binding = 4) uniform sampler3D light_red;
layout(set = 0, binding = 5) uniform sampler3D light_green;
layout(set = 0, binding = 6) uniform sampler3D light_blue;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D irradiance;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(lpv.width, lpv.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 result = vec3(0.0);
    if (z > 0.0) {
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z) + lpv.offset_m * n;
        vec3 at = clamp(lpv_cells_from_world(position), vec3(0.5), vec3(lpv_cells()) - 0.5) / float(lpv.dim);
        vec4 towards = sh4_clamped_cosine(-n) * vec4(1.0, vec3(lpv.window));
        result = vec3(dot(textureLod(light_red, at, 0.0), towards), dot(textureLod(light_green, at, 0.0), towards),
                      dot(textureLod(light_blue, at, 0.0), towards));
        // What steps of sharp lobes left negative behind a bright wall stays out.
        result = clamp(result * lpv.irradiance_scale, 0.0, HALF_MAX);
    }
    imageStore(irradiance, pixel, vec4(result, 1.0));
}
