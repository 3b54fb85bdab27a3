// One cone per pixel along the mirror direction, with the width of the specular lobe (Hong 2015,
// sec. 2.5.3.3.7; Crassin et al. 2011), times the directional albedo of the GGX BRDF.
//
// Differs from the paper: the lobe is glTF's GGX, not Phong's (frame/lobe.glsl). A rough surface
// needs no cone: its radiance is E/π of the diffuse cones. In between both are blended.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define GGX_ALBEDO_BINDING      9
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/lobe.glsl"
#include "techniques/vct/vct_constants.h"
layout(constant_id = VCT_CONSTANT_MAP) const bool VCT_HAS_MAP = false;
#define ENVIRONMENT_MAP_BINDING 19
#define ENVIRONMENT_HAS_MAP     VCT_HAS_MAP
#include "frame/environment_map.glsl"
#include "frame/octahedral.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/trace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_specular
{
    vct_specular_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler3D light;
layout(set = 0, binding = 6) uniform sampler2D albedo;
layout(set = 0, binding = 7) uniform sampler2D material;
layout(set = 0, binding = 10) uniform sampler2D dielectric; // FRAME_DIELECTRIC if `has_dielectric`
layout(set = 0, binding = 11) uniform sampler2D irradiance; // of the diffuse cones, scaled lux
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D specular;
#include "techniques/common/reflected.glsl"

// Tangent of the half-angle: a cone wider than 45° is no better resolved by the texels.
const float WIDEST = 1.0;

float tan_half_angle(float alpha)
{
    if (set.tan_half > 0.0) return min(set.tan_half, WIDEST);
    return lobe_tan_half_angle(alpha, WIDEST);
}

// Mirror direction, lifted to the horizon where a normal map bends it below the surface.
vec3 mirror_direction(vec3 to_viewer, vec3 n)
{
    vec3 r = reflect(-to_viewer, n);
    return normalize(r + max(0.0, 0.01 - dot(r, n)) * n);
}

vec3 reflected_radiance(ivec2 pixel, float z)
{
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg),
         to_viewer = normalize(frame_to_viewer(position));
    brdf_material m = pixel_material(pixel, set.has_dielectric != 0u);
    vec3 at = (position - clips.origin_m) / set.texel_m;
    float tan_half = tan_half_angle(brdf_alpha(m.roughness));
    float width = 2.0 * set.step_size * tan_half;
    float rough = lobe_roughness(m.roughness);
    if (set.tan_half > 0.0) rough = 0.0;
    vec3 radiance = texelFetch(irradiance, pixel, 0).rgb / PI;
    if (rough < 1.0) {
        vec3 direction = mirror_direction(to_viewer, n);
        vec4 traced =
            vct_cone(light, at, n, direction, set.offset, width, set.last_mip, vct_start_at(at));
        vec3 arriving = traced.rgb + (1.0 - traced.a) * environment_cone(direction, atan(tan_half));
        radiance = mix(set.gain * arriving, radiance, rough);
    }
    return pixel_reflected(m, n, to_viewer, radiance);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 radiance = z > 0.0 ? reflected_radiance(pixel, z) : vec3(0.0);
    imageStore(specular, pixel, vec4(clamp(radiance, 0.0, HALF_MAX), 1.0));
}
