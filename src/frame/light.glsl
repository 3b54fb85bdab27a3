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

// Factor on a light's intensity at a position, and the unit direction to the light. d² has
// `added_m2` and is at least `least_m2`: near a light the size of the receiver counts.
float light_attenuation(frame_light light, vec3 position, float added_m2, float least_m2,
                        out vec3 to_light)
{
    to_light = -light.direction;
    if (light.type == FRAME_LIGHT_SUN) return 1.0;
    to_light = light.position - position;
    float distance2 = dot(to_light, to_light);
    to_light *= inversesqrt(max(distance2, 1e-12));
    return light_cone(light, -to_light) * light_window(light, distance2) /
           max(distance2 + added_m2, least_m2);
}

#endif
