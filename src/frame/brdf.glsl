// BRDF of glTF 2.0's metallic-roughness material with energy conservation; bsdf.h of the reference
// has the same formulas and docs/materials.md their derivation.
//
// D: Trowbridge & Reitz 1975 (GGX, Walter et al. 2007, eq. 33). V = G / (4 n·l n·v): Heitz 2014
// (height-correlated Smith, eq. 99). F: Schlick 1994. alpha = roughness². Multiple scattering:
// Turquin 2019. The diffuse lobe is scaled by 1 − E(n·v), E the directional albedo of the
// dielectric lobe; it does not depend on the light, so that irradiance stays separable.
//
// A shader that reflects light towards the viewer defines GGX_ALBEDO_BINDING before.
#ifndef AG_FRAME_BRDF_GLSL
#define AG_FRAME_BRDF_GLSL

#include "core/ggx_albedo.glsl"
#include "core/math.glsl"

// 0…1 each. The dielectric's reflectance at normal and at grazing incidence: 0.04 and 1 by default.
struct brdf_material {
    vec3 albedo;
    float metallic, roughness;
    vec3 dielectric_f0;
    float dielectric_f90;
};

// The dielectric as the G-buffer has it (FRAME_DIELECTRIC): √F0 and F90. Of ior 1.5:
const vec4 BRDF_DEFAULT_DIELECTRIC = vec4(0.2, 0.2, 0.2, 1.0);

brdf_material brdf_material_of(vec3 albedo, vec2 roughness_metallic, vec4 dielectric)
{
    return brdf_material(albedo, roughness_metallic.y, roughness_metallic.x,
                         dielectric.rgb * dielectric.rgb, dielectric.a);
}

// D of GGX, 1/sr. a2: alpha². sin² is that of the cross product: 1 − n_h² cancels within the narrow
// lobe of a smooth surface.
float brdf_distribution(vec3 n, vec3 h, float a2)
{
    vec3 n_x_h = cross(n, h);
    float n_h = clamp(dot(n, h), 0.0, 1.0);
    float base = dot(n_x_h, n_x_h) + n_h * n_h * a2;
    return a2 * INV_PI / (base * base);
}

// V = G / (4 n·l n·v).
float brdf_visibility(float n_v, float n_l, float a2)
{
    float smith_v = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2);
    float smith_l = n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    return 0.5 / (smith_v + smith_l);
}

// Both lobes for one outgoing direction.
struct brdf_lobes {
    vec3 diffuse;         // 1/sr
    float diffuse_share;  // of albedo/π: what the specular lobe transmits, without metals
    vec3 f0, f90;         // of the specular lobe, with compensation: may exceed 1
    vec3 specular_albedo; // directional, 0…1
    float alpha;
};

float brdf_roughness(float roughness)
{
    return clamp(roughness, GGX_MIN_ROUGHNESS, 1.0);
}

float brdf_alpha(float roughness)
{
    float r = brdf_roughness(roughness);
    return r * r;
}

// Energy that single scattering loses, relative to its reflection without Fresnel losses.
float brdf_loss(vec2 ab)
{
    float ess = ab.x + ab.y;
    return (1.0 - ess) / ess;
}

// Albedo of the dielectric's specular lobe from the table's A and B.
vec3 brdf_dielectric_albedo(brdf_material m, vec2 ab)
{
    return (m.dielectric_f0 * ab.x + m.dielectric_f90 * ab.y) *
           (1.0 + m.dielectric_f0 * brdf_loss(ab));
}

// Share of light that the lobe transmits to the base: by the channel that reflects most
// (KHR_materials_specular), so that a coloured lobe does not tint the base.
float brdf_transmitted(vec3 lobe_albedo)
{
    float most = max(lobe_albedo.r, max(lobe_albedo.g, lobe_albedo.b));
    return clamp(1.0 - most, 0.0, 1.0);
}

// Hemispherical reflectance, for bounces, which are diffuse. It contains the specular lobes, of
// dielectrics and of metals: without the former a closed room of default materials is 7 to 34 % too
// dark after all bounces, with it 0.5 to 10 % too bright (docs/materials.md).
vec3 brdf_bounce_reflectance(brdf_material m)
{
    vec2 ab = ggx_albedo_mean(brdf_roughness(m.roughness));
    vec3 lobe = brdf_dielectric_albedo(m, ab);
    vec3 metal = (m.albedo * ab.x + ab.y) * (1.0 + m.albedo * brdf_loss(ab));
    return mix(m.albedo * brdf_transmitted(lobe) + lobe, metal, m.metallic);
}

float brdf_cosine(vec3 n, vec3 v)
{
    return clamp(abs(dot(n, v)), 1e-4, 1.0);
}

#ifdef GGX_ALBEDO_BINDING
brdf_lobes brdf_lobes_at(brdf_material m, float n_v)
{
    vec2 ab = ggx_albedo_at(n_v, brdf_roughness(m.roughness));
    float loss = brdf_loss(ab);
    vec3 dielectric = (1.0 - m.metallic) * (1.0 + m.dielectric_f0 * loss);
    vec3 metal = m.metallic * (1.0 + m.albedo * loss);
    brdf_lobes lobes;
    lobes.diffuse_share = (1.0 - m.metallic) * brdf_transmitted(brdf_dielectric_albedo(m, ab));
    lobes.diffuse = m.albedo * (lobes.diffuse_share * INV_PI);
    lobes.f0 = dielectric * m.dielectric_f0 + metal * m.albedo;
    lobes.f90 = dielectric * m.dielectric_f90 + metal;
    lobes.specular_albedo = lobes.f0 * ab.x + lobes.f90 * ab.y;
    lobes.alpha = brdf_alpha(m.roughness);
    return lobes;
}

// D·V·F in 1/sr, without the cosine. n, v (outgoing), l (incident) are unit vectors away from the
// surface.
vec3 brdf_specular(brdf_lobes lobes, vec3 n, vec3 v, vec3 l)
{
    vec3 h = normalize(v + l);
    float n_l = clamp(dot(n, l), 1e-4, 1.0);
    float n_v = brdf_cosine(n, v);
    float v_h = clamp(dot(v, h), 0.0, 1.0);
    float a2 = lobes.alpha * lobes.alpha;

    float d = brdf_distribution(n, h, a2), visibility = brdf_visibility(n_v, n_l, a2);
    float m = 1.0 - v_h;
    float m2 = m * m;
    vec3 f = lobes.f0 + (lobes.f90 - lobes.f0) * (m2 * m2 * m);
    return f * (d * visibility);
}
#endif

#endif
