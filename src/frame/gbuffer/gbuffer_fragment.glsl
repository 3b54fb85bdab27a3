// Fragment shader of the G-buffer. Formats: frame.h.
//
// Unlit materials (KHR_materials_unlit) have the radiance base colour × unlit_white in the emissive
// layer and the alpha ½ in the albedo layer: they reflect nothing.
#define GBUFFER_FRAGMENT
#define SCENE_FRAGMENT
#include "frame/frame.glsl"
#include "frame/gbuffer/gbuffer_targets.glsl"
#include "frame/gbuffer/gbuffer_varyings.glsl"
#include "frame/octahedral.glsl"
#include "frame/scene/scene.glsl"

layout(set = 0, binding = 10) uniform sampler2D normal_map;
layout(set = 0, binding = 11) uniform sampler2D emissive_map;

#ifdef GBUFFER_DIELECTRIC
layout(set = 0, binding = 12) uniform sampler2D specular_map;
layout(set = 0, binding = 13) uniform sampler2D specular_color_map;
#endif

// glTF 2.0, sec. 3.9.3: the bitangent is cross(normal, tangent) · w. Back faces of double-sided
// materials reverse the normal after normal mapping.
vec3 shading_normal()
{
    vec3 n = vary_normal;
    if (HAS_NORMAL_MAP) {
        vec3 local = texture(normal_map, vary_normal_uv).xyz * 2.0 - 1.0;
        local.xy *= scene_material_table[push.draw.material].normal_scale;
        n = vary_tangent.xyz * local.x + cross(n, vary_tangent.xyz) * (vary_tangent.w * local.y) +
            n * local.z;
    }
    float length2 = dot(n, n);
    n = length2 > 1e-12 ? n * inversesqrt(length2) : vec3(0.0, 1.0, 0.0);
    return gl_FrontFacing ? n : -n;
}

vec3 emitted_radiance()
{
    vec3 radiance = scene_material_table[push.draw.material].emissive;
    if (HAS_EMISSIVE_MAP) radiance *= texture(emissive_map, vary_emissive_uv).rgb;
    return min(radiance * frame.radiance_scale, vec3(HALF_MAX));
}

#ifdef GBUFFER_DIELECTRIC
// √F0 and F90.
vec4 dielectric()
{
    uint m = push.draw.material;
    vec3 f0 = scene_material_table[m].specular_f0 *
              texture(specular_color_map, vary_specular_color_uv).rgb;
    float weight = scene_material_table[m].specular * texture(specular_map, vary_specular_uv).a;
    return vec4(sqrt(min(f0, 1.0) * weight), weight);
}
#endif

void main()
{
    bool unlit = (scene_material_table[push.draw.material].flags & SCENE_UNLIT) != 0u;
    out_albedo = vec4(scene_base_color(vary_base_color_uv, vary_color).rgb, unlit ? 0.5 : 1.0);
    out_normal = octahedral_encode(shading_normal());
    out_material = scene_roughness_metallic(vary_metallic_roughness_uv);
    vec3 emitted =
        unlit ? min(out_albedo.rgb * frame.unlit_white, vec3(HALF_MAX)) : emitted_radiance();
    out_emissive = vec4(emitted, 0.0);
#ifdef GBUFFER_DIELECTRIC
    out_dielectric = dielectric();
#endif
#ifdef GBUFFER_ID
    out_id = uvec2(push.draw.instance, vary_triangle) + 1u;
#endif
#ifdef GBUFFER_MOTION
    // Precise, so that equal positions have a difference of exactly 0.
    precise vec2 current = vary_current.xy / mix(1.0, vary_current.z, frame.viewer.w);
    precise vec2 previous = vary_previous.xy / mix(1.0, vary_previous.z, frame.viewer.w);
    // A point behind the previous camera has no previous position: the largest motion marks it.
    if (vary_previous.z <= 0.0) previous = vec2(-HALF_MAX);
    precise vec3 moved = vec3((current - previous) * 0.5,
                              (max(vary_previous.z, 0.0) - vary_current.z) / vary_current.z);
    out_motion = vec4(clamp(moved, -HALF_MAX, HALF_MAX), 1.0);
#endif
}
