// BRDF of glTF 2.0's metallic-roughness material: a Lambert lobe plus a GGX lobe.
//
// D: Trowbridge & Reitz 1975 (GGX, Walter et al. 2007, eq. 33). V = G / (4 n·l n·v): Heitz 2014
// (height-correlated Smith, eq. 99). F: Schlick 1994. alpha = roughness². The Lambert lobe is not
// scaled by 1 − F, so that direct and indirect light see the same albedo·(1−metallic)/π.
#ifndef AG_FRAME_BRDF_GLSL
#define AG_FRAME_BRDF_GLSL

const float BRDF_INV_PI = 0.31830988618;
// Keeps alpha² a normal float and a highlight at least about one pixel wide.
const float BRDF_MIN_ROUGHNESS = 0.045;

float brdf_alpha(float roughness)
{
    float r = max(roughness, BRDF_MIN_ROUGHNESS);
    return r * r;
}

// Reflectance at normal incidence; 4 % for dielectrics.
vec3 brdf_f0(vec3 albedo, float metallic)
{
    return mix(vec3(0.04), albedo, metallic);
}

vec3 brdf_diffuse(vec3 albedo, float metallic)
{
    return albedo * ((1.0 - metallic) * BRDF_INV_PI);
}

// D·V·F in 1/sr, without the cosine. n, v (outgoing), l (incident) are unit vectors away from the
// surface; alpha comes from brdf_alpha.
vec3 brdf_specular(vec3 n, vec3 v, vec3 l, float alpha, vec3 f0)
{
    vec3 h = normalize(v + l);
    float n_l = clamp(dot(n, l), 1e-4, 1.0);
    float n_v = clamp(abs(dot(n, v)), 1e-4, 1.0);
    float n_h = clamp(dot(n, h), 0.0, 1.0);
    float v_h = clamp(dot(v, h), 0.0, 1.0);
    float a2 = alpha * alpha;

    // sin² from the cross product: 1 − n_h² cancels within the narrow lobe of a smooth surface.
    vec3 n_x_h = cross(n, h);
    float d_base = dot(n_x_h, n_x_h) + n_h * n_h * a2;
    float d = a2 * BRDF_INV_PI / (d_base * d_base);
    float smith_v = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2);
    float smith_l = n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    float visibility = 0.5 / (smith_v + smith_l);
    float m = 1.0 - v_h;
    float m2 = m * m;
    vec3 f = f0 + (1.0 - f0) * (m2 * m2 * m);
    return f * (d * visibility);
}

#endif
