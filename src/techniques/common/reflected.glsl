// Light that the specular lobe of a pixel's surface reflects. Declare the samplers `albedo`,
// `material` and `dielectric` of FRAME_ALBEDO, FRAME_MATERIAL and FRAME_DIELECTRIC, and include
// core/half.glsl and frame/brdf.glsl with GGX_ALBEDO_BINDING first.
#ifndef AG_TECHNIQUES_REFLECTED_GLSL
#define AG_TECHNIQUES_REFLECTED_GLSL

// has_dielectric: without FRAME_DIELECTRIC another image of the frame is bound in its place, which
// is fetched for nothing: a branch around the fetch costs software drivers up to 17 ms at 640x360.
brdf_material pixel_material(ivec2 pixel, bool has_dielectric)
{
    vec4 fetched = texelFetch(dielectric, pixel, 0);
    vec4 lobe = has_dielectric ? fetched : BRDF_DEFAULT_DIELECTRIC;
    return brdf_material_of(texelFetch(albedo, pixel, 0).rgb, texelFetch(material, pixel, 0).rg,
                            lobe);
}

// radiance: mean over the lobe. n and to_viewer are unit vectors.
vec3 pixel_reflected(brdf_material m, vec3 n, vec3 to_viewer, vec3 radiance)
{
    return brdf_lobes_at(m, brdf_cosine(n, to_viewer)).specular_albedo *
           clamp(radiance, vec3(0.0), vec3(HALF_MAX));
}

#endif
