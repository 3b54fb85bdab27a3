// The radiance that the specular lobe of each texel reflects towards the camera: Σ y_k(ω) (M L)_k,
// in the frame of its normal, with the texel's transfer matrix M and distant light L (Sloan, Kautz
// & Snyder 2002; Hong 2015, section 2.5.1.4), and that of emissive surfaces, of first order.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/basis.glsl"
#include "core/half.glsl"
#include "core/math.glsl"
#include "core/sh.glsl"
#define FRAME_CONSTANTS_BINDING 6
#define ENVIRONMENT_MAP_BINDING 7
#include "frame/brdf.glsl"
#include "frame/environment_map.glsl"
#include "frame/lobe.glsl"
#include "techniques/common/light_map/lookup.glsl"
#if PRT_COMPRESSED
#include "techniques/prt/prt_clusters.glsl"
layout(set = 0, binding = 5, scalar) uniform prt_light_block
{
    prt_light light;
};
#else
#include "techniques/prt/prt_transfer.glsl"
#endif

layout(local_size_x = PRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    prt_reflect_push push;
};
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D prt_texels;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D texel_radiance;

vec4 texel_part(uint texel, int part)
{
    return imageLoad(prt_texels, light_map_at(part * push.texels + texel));
}

// Radiance that a texel reflects; alpha: of the visible part of a sky of radiance 1.
#if PRT_COMPRESSED
vec4 row_radiance(uint row, float basis[PRT_OUTGOING])
{
    vec4 sum = vec4(0.0);
    for (uint k = 0; k < PRT_OUTGOING; k++)
        sum += basis[k] * imageLoad(prt_row_light, light_map_at(k * push.rows + row));
    return sum;
}

vec4 texel_reflected(uint texel, float basis[PRT_OUTGOING])
{
    uint row = imageLoad(prt_clusters, light_map_at(texel)).x * (1u + VECTORS);
    vec4 sum = row_radiance(row, basis);
    for (uint k = 0; k < VECTORS; k += PRT_ROW_HALVES) {
        vec4 w = light_map_unpack(
            imageLoad(prt_weights, light_map_at(k / PRT_ROW_HALVES * push.texels + texel)).xy);
        for (uint j = 0; j < min(PRT_ROW_HALVES, VECTORS - k); j++)
            sum += w[j] * row_radiance(row + 1u + k + j, basis);
    }
    return sum;
}
#else
vec4 texel_reflected(uint texel, float basis[PRT_OUTGOING])
{
    vec4 sum = vec4(0.0);
    for (uint k = 0; k < PRT_OUTGOING; k++) {
        uint row = k * push.texels + texel;
        sum +=
            basis[k] * vec4(prt_row_irradiance(row, PRT_OUTGOING * push.texels), prt_row_sky(row));
    }
    return sum;
}
#endif

// Mean of the projected environment over a lobe of this deviation: a lobe by diffusion on the
// sphere has the zonal factors exp(−l (l + 1) σ²/2).
vec3 projected_lobe(vec3 direction, float sigma)
{
    float basis[25];
    vec3 sum = vec3(0.0);
    sh25_eval(direction, basis);
    for (uint i = 0u; i < push.coefficients; i++) {
        float band = floor(sqrt(float(i) + 0.5));
        sum += exp(-0.5 * band * (band + 1.0) * sigma * sigma) * basis[i] * light.direct[i].rgb;
    }
    return sum;
}

// The detail of the environment's map that its few coefficients do not have, in the mean over the
// lobe.
vec3 detail(vec3 normal, vec3 to_viewer, float roughness)
{
    if (frame.environment_scale == 0.0) return vec3(0.0);
    float alpha = brdf_alpha(roughness), of_rows = brdf_alpha(max(roughness, PRT_LEAST_ROUGHNESS));
    vec3 direction = normalize(lobe_mean(normal, to_viewer, alpha));
    return (1.0 - lobe_roughness(roughness)) * (environment_lobe(direction, lobe_deviation(alpha)) -
                                                projected_lobe(direction, lobe_deviation(of_rows)));
}

vec3 emitted(uint texel, vec3 normal, vec3 to_viewer, float roughness)
{
    light_map_light light;
    for (int c = 0; c < 3; c++) {
        vec4 part = texel_part(texel, TEXEL_EMITTED_0 + c) * push.emitters;
        light.irradiance[c] = 0.5 * (part.x + dot(part.yzw, normal));
        light.vector[c] = part.yzw;
    }
    return light_map_radiance(light, normal, to_viewer, roughness * roughness);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    vec4 normal = texel_part(i, TEXEL_NORMAL);
    vec3 shading = texel_part(i, TEXEL_SHADING).xyz;
    vec3 to_viewer = normalize(frame_to_viewer(texel_part(i, TEXEL_POSITION).xyz));
    float basis[PRT_OUTGOING];
    sh25_eval(to_viewer * basis_of(shading), basis);
    vec4 reflected = texel_reflected(i, basis);
    reflected.rgb += clamp(reflected.a, 0.0, 1.0) * detail(shading, to_viewer, normal.w);
    // Sums of few bands ring below 0.
    vec3 radiance =
        max(reflected.rgb, vec3(0.0)) + max(emitted(i, normal.xyz, to_viewer, normal.w), vec3(0.0));
    imageStore(texel_radiance, light_map_at(i), uvec4(light_map_pack(vec4(radiance, 0.0)), 0u, 0u));
}
