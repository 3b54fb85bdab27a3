// Reflected light in the specular layer of the source. Needs frame/brdf.glsl with
// GGX_ALBEDO_BINDING, and the bindings of the surface.
#ifndef AG_SSR_APPLY_GLSL
#define AG_SSR_APPLY_GLSL

#include "techniques/common/reflected.glsl"

const float SSR_FADE_FROM = 2.0 / 3.0; // of max_roughness

struct ssr_surface {
    bool reflects;
    vec3 position, n, to_viewer;
    brdf_material material;
};

ssr_surface ssr_surface_at(ivec2 pixel)
{
    float z = texelFetch(depth, pixel, 0).r;
    ssr_surface s;
    s.material = pixel_material(pixel, ssr_of.has_dielectric != 0u);
    s.reflects = z > 0.0 && s.material.roughness < ssr_of.max_roughness &&
                 frame_is_lit(texelFetch(albedo, pixel, 0).a);
    s.position = frame_world_position(frame_uv(uvec2(pixel)), max(z, 1.0e-12));
    s.n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    s.to_viewer = normalize(frame_to_viewer(s.position));
    return s;
}

// light: radiance times confidence, confidence. At confidence 0 the layer keeps the source's
// radiance.
void ssr_apply(ssr_surface s, ivec2 pixel, vec4 light)
{
    float fade = 1.0 - smoothstep(SSR_FADE_FROM * ssr_of.max_roughness, ssr_of.max_roughness,
                                  s.material.roughness);
    vec3 radiance = light.rgb / max(light.a, 1.0e-6);
    vec3 reflected = pixel_reflected(s.material, s.n, s.to_viewer, radiance);
    vec4 before = imageLoad(specular, pixel);
    vec3 after = mix(before.rgb, reflected, clamp(fade * light.a, 0.0, 1.0));
    if (s.reflects && light.a > 0.0) imageStore(specular, pixel, vec4(after, before.a));
}

#endif
