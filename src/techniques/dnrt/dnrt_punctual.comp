// Light of punctual lights at each object: irradiance coefficients in the object's frame, times π.
// Irradiance E from direction ω adds E A_l Y_j(ω), A_l the bands' factors of the clamped cosine.
// The shadow is looked up on a disk before the bounding sphere, where the object itself occludes
// nothing. An object whose light differs from that of the last frame loses its shape in `changed`,
// so that the pass `light` lists it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define SHADOW_FACES_BINDING    4
#define SHADOW_MAPS_BINDING     5
#define SHADOW_SUN_MAPS_BINDING 6
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/light.glsl"
#include "frame/shadow/shadow.glsl"
// A struct and a block cannot share a name.
#define dnrt_changed dnrt_changed_data
#include "techniques/dnrt/dnrt_shared.h"
#undef dnrt_changed
#include "techniques/dnrt/dnrt_object.glsl"

layout(local_size_x = DNRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    dnrt_punctual_push push;
};
layout(set = 0, binding = 1, scalar) readonly buffer dnrt_objects
{
    dnrt_gpu_object object_table[];
};
layout(set = 0, binding = 2, scalar) buffer dnrt_light
{
    vec3 light_table[]; // [part][object][coefficient]
};
layout(set = 0, binding = 3, scalar) buffer dnrt_changed
{
    dnrt_changed_data changed;
};
layout(set = 0, binding = 7, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};

// Points of equal area on a disk, along a spiral of golden angles (Vogel 1979).
const int POINTS = 64;

vec2 disk_point(int i)
{
    float angle = 2.39996323 * float(i);
    return sqrt((float(i) + 0.5) / float(POINTS)) * vec2(cos(angle), sin(angle));
}

// Lit share of a disk of the sphere's radius, `distance` before the centre.
float lit_share(frame_light light, vec3 centre, vec3 to_light, float radius, float distance)
{
    if (light.shadow_first < 0) return 1.0;
    vec3 side = abs(to_light.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 u = normalize(cross(to_light, side)), v = cross(to_light, u);
    float lit = 0.0;
    for (int i = 0; i < POINTS; i++) {
        vec2 disk = radius * disk_point(i);
        vec3 at = centre + distance * to_light + disk.x * u + disk.y * v;
        lit += shadow_visibility(light, at, to_light, to_light, true, push.shadow_radius);
    }
    return lit / float(POINTS);
}

// Irradiance at the centre on a surface that faces the light; *to_light: its direction. A light
// within the bounding sphere is moved to its border.
vec3 irradiance_by(frame_light light, dnrt_gpu_object object, float radius, out vec3 to_light)
{
    const float MARGIN = 1.25; // radii: farther than a texel of the shadow map before the sphere
    float attenuation =
        light_attenuation(light, object.centre, 0.0, max(radius * radius, 1e-12), to_light);
    if (attenuation <= 0.0) return vec3(0.0);
    float before = MARGIN * radius;
    if (light.type != FRAME_LIGHT_SUN)
        before = min(before, 0.5 * (radius + distance(light.position, object.centre)));
    return light.intensity *
           (attenuation * lit_share(light, object.centre, to_light, radius, before));
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.objects) return;
    dnrt_gpu_object object = object_table[index];
    float radius = object.half_m / push.reach;
    vec3 sum[9];
    for (int j = 0; j < 9; j++) sum[j] = vec3(0.0);
    for (uint k = 0; k < frame.light_count && object.shape >= 0; k++) {
        float basis[9];
        vec3 to_light, irradiance = irradiance_by(frame_light_table[k], object, radius, to_light);
        sh9_eval(dnrt_object_from_world(object, to_light), basis);
        for (int j = 0; j < 9; j++)
            sum[j] += (j == 0  ? SH_COSINE_0
                       : j < 4 ? SH_COSINE_1
                               : SH_COSINE_2) *
                      basis[j] * irradiance;
    }
    bool differs = false;
    for (uint j = 0; j < DNRT_COEFFICIENTS; j++) {
        uint to = push.to + index * DNRT_COEFFICIENTS + j;
        differs = differs || light_table[to] != PI * sum[j];
        light_table[to] = PI * sum[j];
    }
    if (differs) changed.shape[index] = DNRT_NO_SHAPE;
}
