// The specular light of each pixel: the mean of what arrives by the rays of pixels around it,
// beside E/π of the diffuse cones for the wide part of the lobe (frame/lobe.glsl), times the
// directional albedo of the GGX BRDF. Of rougher surfaces E/π is all of it, and of metals where
// nothing is traced.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define GGX_ALBEDO_BINDING      9
#include "core/half.glsl"
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/lobe.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = VCT_CONSTANT_RAYS) const bool VCT_RAYS = false;
layout(set = 0, binding = 2, scalar) uniform vct_specular
{
    vct_specular_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D arriving;
layout(set = 0, binding = 6) uniform sampler2D albedo;
layout(set = 0, binding = 7) uniform sampler2D material;
layout(set = 0, binding = 10) uniform sampler2D dielectric; // FRAME_DIELECTRIC if `has_dielectric`
layout(set = 0, binding = 11) uniform sampler2D irradiance; // of the diffuse cones, scaled lux
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D specular;
#include "techniques/common/reflected.glsl"
#include "techniques/vct/cones/lobe_mean.glsl"

const float FROM = 0.15, TO = 0.4; // roughness: no neighbours, all of them

// 3 x 3 means, each of 4 x 4 pixels, with binomial weights, and 1; 0: no ray is near.
vec4 mean_arriving(ivec2 pixel, lobe_pixel p)
{
    vec4 own = texelFetch(arriving, pixel, 0);
    vec4 sum = vec4(own.rgb, 1.0) * (own.a > 0.0 ? 4.0 : 0.0);
    float reach = VCT_RAYS ? smoothstep(FROM, TO, p.roughness) : 0.0;
    for (int i = 0; i < 9 && reach > 0.0; i++) {
        ivec2 step = ivec2(i % 3, i / 3) - 1;
        if (step == ivec2(0)) continue;
        float weight = reach * float((2 - abs(step.x)) * (2 - abs(step.y)));
        sum += lobe_neighbour(p, pixel + VCT_REFLECT_SIDE * step, weight);
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}

vec3 reflected_radiance(ivec2 pixel, float z)
{
    brdf_material m = pixel_material(pixel, set.has_dielectric != 0u);
    lobe_pixel p = lobe_pixel_at(pixel, z);
    bool traced = set.traced != 0u;
    float tail = set.tan_half > 0.0 ? 0.0 : lobe_tail(brdf_alpha(m.roughness));
    vec3 radiance = texelFetch(irradiance, pixel, 0).rgb / PI;
    if (traced && tail < 1.0) {
        vec4 mean = mean_arriving(pixel, p);
        radiance = mix(radiance, set.gain * mean.rgb, mean.a * (1.0 - tail));
    }
    return (traced ? 1.0 : m.metallic) *
           pixel_reflected(m, p.normal, normalize(frame_to_viewer(p.position)), radiance);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 radiance = z > 0.0 ? reflected_radiance(pixel, z) : vec3(0.0);
    imageStore(specular, pixel, vec4(clamp(radiance, 0.0, HALF_MAX), 1.0));
}
