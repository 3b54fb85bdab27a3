#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Normal and reflectance of a reflective shadow map texel (formats: frame.h). Normals are
// interpolated vertex normals: a texel covers many texels of a normal map.
#define RSM_FRAGMENT
#define SCENE_FRAGMENT
#include "frame/frame.glsl"
#include "frame/light.glsl"
#include "frame/octahedral.glsl"
#include "frame/rsm/rsm_varyings.glsl"
#include "frame/scene/scene.glsl"
#include "frame/scene/scene_reflectance.glsl"

layout(set = 0, binding = 13, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};

layout(location = 0) out vec2 out_normal;
layout(location = 1) out vec4 out_flux;

void main()
{
    vec3 base = scene_base_color(vary_base_color_uv, vary_color).rgb;
    vec2 material = scene_roughness_metallic(vary_metallic_roughness_uv);

    frame_light light = frame_light_table[rsm_face_table[push.face].light];
    vec3 from_light = light.type == FRAME_LIGHT_SUN ? light.direction : vary_world - light.position;
    float distance2 = dot(from_light, from_light);
    float falloff = 1.0;
    if (light.type != FRAME_LIGHT_SUN)
        falloff = light_window(light, distance2) *
                  light_cone(light, from_light * inversesqrt(max(distance2, 1e-12)));

    float length2 = dot(vary_normal, vary_normal);
    vec3 n = length2 > 1e-12 ? vary_normal * inversesqrt(length2) : -from_light;
    out_normal = octahedral_encode(dot(n, from_light) > 0.0 ? -n : n);
    vec3 reflectance = scene_reflectance(push.draw.material, base, material);
    out_flux = vec4(reflectance * (falloff * push.reflects), 1.0);
}
