// Irradiance of a texel of a light map by a light of the frame, with its shadow. Include
// frame/light.glsl and frame/shadow/shadow.glsl first.
//
// A texel stands for its area A. A light of intensity I at distance d → 0 lights a wall by I/d²,
// but sends it 2πI only: with d² + A/2π, a texel never receives more than that flux.
#ifndef AG_TEXEL_LIGHT_GLSL
#define AG_TEXEL_LIGHT_GLSL

// normal: unit, of the surface, for the shadow; shading: unit, receives the light.
vec3 texel_irradiance(vec3 position, vec3 normal, vec3 shading, float area_m2, frame_light light,
                      int shadow_radius)
{
    vec3 to_light;
    float attenuation = light_attenuation(light, position, area_m2 / (2.0 * PI), 0.0, to_light);
    float cosine = dot(shading, to_light);
    if (cosine <= 0.0 || attenuation <= 0.0) return vec3(0.0);
    if (light.shadow_first >= 0)
        attenuation *= shadow_visibility(light, position, normal, to_light, true, shadow_radius);
    return light.intensity * (attenuation * cosine);
}

#endif
