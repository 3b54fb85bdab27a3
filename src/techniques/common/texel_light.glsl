// Irradiance of a texel of a light map by a light of the frame, with its shadow. Include
// frame/light.glsl and frame/shadow/shadow.glsl first.
//
// A texel stands for its area A. A light of intensity I at distance d → 0 lights a wall by I/d²,
// but sends it 2πI only: with d² + A/2π, a texel never receives more than that flux.
#ifndef AG_TEXEL_LIGHT_GLSL
#define AG_TEXEL_LIGHT_GLSL

vec3 texel_irradiance(vec3 position, vec3 normal, float area_m2, frame_light light,
                      int shadow_radius)
{
    const float TWO_PI = 6.28318531;
    vec3 to_light = -light.direction;
    float attenuation = 1.0;
    if (light.type != FRAME_LIGHT_SUN) {
        to_light = light.position - position;
        float distance2 = dot(to_light, to_light);
        to_light *= inversesqrt(max(distance2, 1e-12));
        attenuation = light_cone(light, -to_light) * light_window(light, distance2) /
                      (distance2 + area_m2 / TWO_PI);
    }
    float cosine = dot(normal, to_light);
    if (cosine <= 0.0 || attenuation <= 0.0) return vec3(0.0);
    if (light.shadow_first >= 0)
        attenuation *= shadow_visibility(light, position, normal, to_light, true, shadow_radius);
    return light.intensity * (attenuation * cosine);
}

#endif
