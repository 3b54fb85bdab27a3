// The specular lobe of a pixel's surface, and what it reflects. Include lobe.glsl and level.glsl
// first. Bindings 14 to 18.
#ifndef AG_MRT_REFLECTED_GLSL
#define AG_MRT_REFLECTED_GLSL

#define GGX_ALBEDO_BINDING 14
#include "frame/brdf.glsl"

layout(set = 0, binding = 15) uniform sampler2D albedo;
layout(set = 0, binding = 16) uniform sampler2D material;
layout(set = 0, binding = 17) uniform sampler2D dielectric;
layout(set = 0, binding = 18, rgba16f) uniform writeonly image2D specular;
#include "techniques/common/reflected.glsl"

struct mrt_reflection {
    brdf_material material;
    vec3 normal, to_viewer;
    mrt_lobe lobe;
};

mrt_reflection reflection_of(ivec2 pixel, vec3 normal, vec3 to_viewer)
{
    brdf_material m = pixel_material(pixel, level.has_dielectric != 0u);
    vec3 v = normalize(to_viewer);
    return mrt_reflection(m, normal, v, mrt_lobe_of(normal, v, brdf_alpha(m.roughness)));
}

void store_reflected(ivec2 pixel, mrt_reflection r, vec3 radiance)
{
    vec3 result = pixel_reflected(r.material, r.normal, r.to_viewer, radiance);
    imageStore(specular, pixel, vec4(min(level.gain * result, vec3(HALF_MAX)), 1.0));
}

#endif
