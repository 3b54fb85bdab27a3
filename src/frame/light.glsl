// Falloff of punctual lights, as KHR_lights_punctual recommends. Include after frame.glsl.
#ifndef AG_FRAME_LIGHT_GLSL
#define AG_FRAME_LIGHT_GLSL

const float LIGHT_MIN_DISTANCE_M = 0.01; // 1/r² is clamped below this distance

// Angular attenuation of spots in the direction `from_light` (unit); 1 for other lights.
float light_cone(frame_light light, vec3 from_light)
{
    if (light.type != FRAME_LIGHT_SPOT) return 1.0;
    float scale = 1.0 / max(light.cos_inner - light.cos_outer, 1e-3);
    float t = clamp((dot(light.direction, from_light) - light.cos_outer) * scale, 0.0, 1.0);
    return t * t;
}

// Window function of a light with limited range: 1 − (d/range)⁴; 1 for unlimited lights.
float light_window(frame_light light, float distance2_m2)
{
    if (light.range_m <= 0.0) return 1.0;
    float ratio2 = distance2_m2 / (light.range_m * light.range_m);
    return clamp(1.0 - ratio2 * ratio2, 0.0, 1.0);
}

#endif
