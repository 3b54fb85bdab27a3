#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Direct light: emission plus reflected light of all punctual lights with shadows. Pixels without a
// surface get the sky radiance. Alpha: the diffuse lobe over albedo/π, for the composite's indirect
// light; 0 for unlit materials and without a surface. A variant also writes the irradiance that the
// diffuse lobe reflects.
#define GGX_ALBEDO_BINDING 10
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/direct/direct_shared.h"
layout(constant_id = DIRECT_CONSTANT_MAP) const bool HAS_MAP = false;
#define ENVIRONMENT_MAP_BINDING 19
#define ENVIRONMENT_HAS_MAP     HAS_MAP
#include "frame/environment_map.glsl"
#include "frame/light.glsl"
#include "frame/octahedral.glsl"
#include "frame/shadow/shadow.glsl"
#include "frame/shadow/shadow_resolved.glsl"
#include "frame/direct/direct_sun.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Uniform blocks: loads at constant offsets are one scalar load for all pixels. In the profile of a
// software driver, loads from storage blocks took two thirds of this pass.
layout(set = 0, binding = 1, scalar) uniform frame_lights
{
    frame_light frame_light_table[FRAME_MAX_LIGHTS];
};
// The maps of shadow.glsl without comparison.
layout(set = 0, binding = 14) uniform sampler2DArray shadow_depths;
layout(set = 0, binding = 4) uniform sampler2D depth_layer;
layout(set = 0, binding = 5) uniform sampler2D normal_layer;
layout(set = 0, binding = 6) uniform sampler2D albedo_layer;
layout(set = 0, binding = 7) uniform sampler2D material_layer;
layout(set = 0, binding = 8) uniform sampler2D emissive_layer;
layout(set = 0, binding = 11) uniform sampler2D dielectric_layer;
layout(set = 0, binding = 9, rgba16f) uniform writeonly image2D direct_layer;
#if DIRECT_IRRADIANCE
layout(set = 0, binding = 18, rgba16f) uniform writeonly image2D direct_irradiance_layer;

vec4 irradiance = vec4(0.0); // scaled, of the lights so far with their shadows; 1: a lit surface
#endif

layout(set = 0, binding = 17, scalar) buffer direct_list
{
    direct_list_header list;
    uint list_pixels[]; // y << 16 | x
};

layout(push_constant, scalar) uniform push_block
{
    direct_push push;
};

// Variants for what a frame has: software drivers execute both sides of a branch, and a loop body
// once even for zero iterations.
layout(constant_id = DIRECT_CONSTANT_SUNS) const bool HAS_SUNS = true;
layout(constant_id = DIRECT_CONSTANT_LOCALS) const bool HAS_LOCALS = true;
layout(constant_id = DIRECT_CONSTANT_ONE_SUN) const bool ONE_SUN = false;
layout(constant_id = DIRECT_CONSTANT_DIELECTRIC) const bool HAS_DIELECTRIC = false;
layout(constant_id = DIRECT_CONSTANT_FILTERED) const bool FILTERED = false;
layout(constant_id = DIRECT_CONSTANT_BLOCKS) const bool BLOCKS = false;
layout(constant_id = DIRECT_CONSTANT_EMISSION) const bool HAS_EMISSION = true;

frame_light only_sun; // with ONE_SUN, loaded as FRAME_CONSTANTS_COPIED

struct surface {
    vec3 position, normal, to_viewer;
    vec3 ray;              // frame_view_ray
    float view_distance;   // m
    vec3 geometric_normal; // of the triangle, on the viewer's side; with FILTERED
    brdf_lobes lobes;
};

// Depth at a pixel, clamped to the image.
float depth_at(ivec2 pixel)
{
    return texelFetch(depth_layer, clamp(pixel, ivec2(0), ivec2(frame.width, frame.height) - 1), 0)
        .r;
}

// Position of the neighbour along `axis` that lies on the same plane as the pixel. Reversed depth
// is affine in screen space on a plane: the side whose two pixels extrapolate to this depth with
// the smaller error is taken, so that creases are not crossed.
vec3 neighbour_on_plane(ivec2 pixel, ivec2 axis, float depth)
{
    float before = depth_at(pixel - axis), after = depth_at(pixel + axis);
    float error_before = abs(2.0 * before - depth_at(pixel - 2 * axis) - depth);
    float error_after = abs(2.0 * after - depth_at(pixel + 2 * axis) - depth);
    float side = error_before < error_after ? -1.0 : 1.0;
    // Clamped depths at the image border are invalid: take the other side.
    ivec2 end = ivec2(frame.width, frame.height) - 1;
    if (any(lessThan(pixel - 2 * axis, ivec2(0)))) side = 1.0;
    if (any(greaterThan(pixel + 2 * axis, end))) side = -1.0;
    vec2 uv = frame_uv(uvec2(pixel)) + side * vec2(axis) / vec2(frame.width, frame.height);
    return frame_world_position(uv, max(side < 0.0 ? before : after, 1e-12));
}

// Unit normal of the triangle in the pixel, on the viewer's side, from neighbouring depths.
vec3 geometric_normal(ivec2 pixel, float depth, vec3 position, vec3 to_viewer)
{
    vec3 across = neighbour_on_plane(pixel, ivec2(1, 0), depth) - position;
    vec3 down = neighbour_on_plane(pixel, ivec2(0, 1), depth) - position;
    vec3 n = cross(across, down);
    float length2 = dot(n, n);
    if (!(length2 > 0.0)) return to_viewer;
    n *= inversesqrt(length2);
    return dot(n, to_viewer) < 0.0 ? -n : n;
}

surface read_surface(ivec2 pixel, float depth, vec3 albedo)
{
    surface s;
    s.ray = frame_view_ray(frame_uv(uvec2(pixel)));
    s.view_distance = frame_view_distance(depth);
    s.position = frame_ray_origin(frame_uv(uvec2(pixel))) + s.view_distance * s.ray;
    s.normal = octahedral_decode(texelFetch(normal_layer, pixel, 0).rg);
    s.to_viewer = -normalize(s.ray);
    if (FILTERED) s.geometric_normal = geometric_normal(pixel, depth, s.position, s.to_viewer);
    vec2 material = texelFetch(material_layer, pixel, 0).rg;
    vec4 dielectric =
        HAS_DIELECTRIC ? texelFetch(dielectric_layer, pixel, 0) : BRDF_DEFAULT_DIELECTRIC;
    s.lobes = brdf_lobes_at(brdf_material_of(albedo, material, dielectric),
                            brdf_cosine(s.normal, s.to_viewer));
    return s;
}

// The receiver in the finest cascade that contains it.
shadow_receiver receiver_of_sun(surface s, frame_light light)
{
    if (ONE_SUN) return sun_receiver(s.ray, s.view_distance, s.normal);
    shadow_receiver chosen;
    for (int i = CASCADES - 1; i >= 0; i--) {
        shadow_receiver r = shadow_receiver_in(shadow_face_table[light.shadow_first + i],
                                               s.position, s.normal, s.to_viewer);
        if (i == CASCADES - 1 || shadow_contains(r.position, r.size)) chosen = r;
    }
    return chosen;
}

// With BLOCKS: the pixel is stored as lit until direct_undecided.comp has made the shadow test.
bool undecided = false;

// The shadow test of a light, 0…1.
float visibility(surface s, frame_light light, vec3 to_light, bool facing)
{
    if (FILTERED)
        return shadow_visibility(light, s.position, s.geometric_normal, to_light, facing,
                                 push.shadow_radius);
    if (BLOCKS) {
        int known = shadow_known(shadow_blocks, receiver_of_sun(s, light));
        undecided = facing && known == SHADOW_UNKNOWN;
        return known == SHADOW_KNOWN_SHADOW ? 0.0 : 1.0;
    }
    if (HAS_SUNS && (!HAS_LOCALS || light.type == FRAME_LIGHT_SUN))
        return shadow_resolved(shadow_sun_depths, receiver_of_sun(s, light), facing);
    int face = light.type == FRAME_LIGHT_POINT ? shadow_cube_face(s.position - light.position) : 0;
    return shadow_resolved(shadow_depths,
                           shadow_receiver_in(shadow_face_table[light.shadow_first + face],
                                              s.position, s.normal, s.to_viewer),
                           facing);
}

// Radiance of one light that the surface reflects to the viewer.
vec3 reflected_radiance(surface s, frame_light light)
{
    vec3 to_light = -light.direction;
    float attenuation = 1.0;
    if (HAS_LOCALS)
        attenuation = light_attenuation(light, s.position, 0.0,
                                        LIGHT_MIN_DISTANCE_M * LIGHT_MIN_DISTANCE_M, to_light);
    float cosine = dot(s.normal, to_light);
    bool facing = cosine > 0.0 && attenuation > 0.0;
    if (light.shadow_first >= 0) attenuation *= visibility(s, light, to_light, facing);
    if (!facing) return vec3(0.0);
#if DIRECT_IRRADIANCE
    irradiance.rgb += light.intensity * (attenuation * cosine);
#endif
    vec3 brdf = s.lobes.diffuse + brdf_specular(s.lobes, s.normal, s.to_viewer, to_light);
    return brdf * light.intensity * (attenuation * cosine);
}

// Reflected radiance of all lights.
vec3 reflected_by(surface s)
{
    if (ONE_SUN) return reflected_radiance(s, only_sun);
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < frame.light_count; i++) sum += reflected_radiance(s, frame_light_table[i]);
    return sum;
}

void append(ivec2 pixel)
{
    uint to = atomicAdd(list.count, 1u);
    if (to % DIRECT_LIST_GROUP == 0) atomicAdd(list.groups[0], 1u);
    list_pixels[to] = uint(pixel.y) << 16 | uint(pixel.x);
}

void main()
{
    frame = frame_block;
    if (ONE_SUN) {
        sun = sun_block;
        only_sun = frame_light_table[0];
    }
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
    float depth = texelFetch(depth_layer, pixel, 0).r;
    vec3 radiance;
    float diffuse = 0.0;
    if (depth <= 0.0) {
        radiance = environment_radiance(frame_view_ray(frame_uv(uvec2(pixel))));
    } else {
        radiance = HAS_EMISSION ? texelFetch(emissive_layer, pixel, 0).rgb * frame.emissive_scale
                                : vec3(0.0);
        vec4 albedo = texelFetch(albedo_layer, pixel, 0);
        if (frame_is_lit(albedo.a)) {
            surface s = read_surface(pixel, depth, albedo.rgb);
            diffuse = s.lobes.diffuse_share;
#if DIRECT_IRRADIANCE
            irradiance.a = 1.0;
#endif
            if (HAS_SUNS || HAS_LOCALS) radiance += reflected_by(s);
        }
    }
    imageStore(direct_layer, pixel, vec4(min(radiance, vec3(HALF_MAX)), diffuse));
#if DIRECT_IRRADIANCE
    imageStore(direct_irradiance_layer, pixel, min(irradiance, vec4(HALF_MAX)));
#endif
    if (BLOCKS && undecided) append(pixel);
}
