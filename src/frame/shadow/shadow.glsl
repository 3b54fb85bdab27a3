// Reading shadow maps: which map of a light holds a point, how far the receiver is moved, how the map is filtered.
// Include after frame.glsl. Binding numbers: SHADOW_FACES_BINDING and SHADOW_MAPS_BINDING, 2 and 3 unless defined before.
#ifndef AG_FRAME_SHADOW_GLSL
#define AG_FRAME_SHADOW_GLSL

#include "frame/shadow/shadow_shared.h"

#ifndef SHADOW_FACES_BINDING
#define SHADOW_FACES_BINDING 2
#define SHADOW_MAPS_BINDING 3
#endif

layout(set = 0, binding = SHADOW_FACES_BINDING, scalar) readonly buffer shadow_faces { shadow_face shadow_face_table[]; };
layout(set = 0, binding = SHADOW_MAPS_BINDING) uniform sampler2DArrayShadow shadow_maps; // passes where the reference ≥ the texel

// The first, finest cascade that holds the point and the filter around it. The last one holds everything.
int shadow_cascade(frame_light light, vec3 world, float inside)
{
    int chosen = light.shadow_count - 1;
    for (int i = light.shadow_count - 2; i >= 0; i--) {
        vec2 clip = (shadow_face_table[light.shadow_first + i].clip_from_world * vec4(world, 1.0)).xy;
        if (max(abs(clip.x), abs(clip.y)) < inside) chosen = i;
    }
    return chosen;
}

// +x −x +y −y +z −z by the longest axis.
int shadow_cube_face(vec3 from_light)
{
    vec3 a = abs(from_light);
    if (a.x >= a.y && a.x >= a.z) return from_light.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z) return from_light.y >= 0.0 ? 2 : 3;
    return from_light.z >= 0.0 ? 4 : 5;
}

// The share of a box of (2·radius+1)² texels around `at` (in 0…1) that lets light through to `depth`. A texel's
// weight is its overlap with the box. Two neighbours are one bilinear fetch that stands between them
// where it weighs both right: (radius+1)² fetches in all. rows: 0 skips the fetches.
float shadow_filtered(vec2 at, int layer, float depth, float size, int radius, int rows)
{
    vec2 start = at * size - (float(radius) + 0.5);
    vec2 first = floor(start);
    vec2 f = start - first;
    float sum = 0.0;
    for (int y = 0; y < rows; y++) {
        float y0 = y == 0 ? 1.0 - f.y : 1.0, y1 = y == radius ? f.y : 1.0;
        float v = (first.y + float(2 * y) + y1 / (y0 + y1) + 0.5) / size;
        float row = 0.0;
        for (int x = 0; x <= radius; x++) {
            float x0 = x == 0 ? 1.0 - f.x : 1.0, x1 = x == radius ? f.x : 1.0;
            float u = (first.x + float(2 * x) + x1 / (x0 + x1) + 0.5) / size;
            row += (x0 + x1) * texture(shadow_maps, vec4(u, v, float(layer), depth));
        }
        sum += (y0 + y1) * row;
    }
    float width = float(2 * radius + 1);
    return sum / (width * width);
}

// 0 (in shadow) … 1. normal: unit; to_light: unit; facing: whether the light shines on the front at all.
//
// The receiver is moved along its normal by d·sin θ, where d is the reach of the filter: on a plane, the depth that
// the filter meets at distance d differs by d·tan θ, and a step o along the normal gains o/cos θ. So a plane never
// shadows itself, and the step is never longer than the filter is wide.
float shadow_of(frame_light light, vec3 world, vec3 normal, vec3 to_light, bool facing, float size, int radius)
{
    float reach = float(radius) + 1.5; // texels: the filter, half a texel of rasterisation, and the bilinear rim
    int face = 0;
    if (light.type == FRAME_LIGHT_SUN) face = shadow_cascade(light, world, 1.0 - 2.0 * (2.0 * reach + 1.0) / size);
    if (light.type == FRAME_LIGHT_POINT) face = shadow_cube_face(world - light.position);
    int layer = light.shadow_first + face;

    float texel = shadow_face_table[layer].texel_m;
    if (light.type != FRAME_LIGHT_SUN) {
        mat4 m = shadow_face_table[layer].clip_from_world;
        texel *= max(dot(vec4(m[0].w, m[1].w, m[2].w, m[3].w), vec4(world, 1.0)), 0.0);
    }
    float cosine = dot(normal, to_light);
    float offset = texel * reach * 1.41421356 * sqrt(max(1.0 - cosine * cosine, 0.0));
    vec4 clip = shadow_face_table[layer].clip_from_world * vec4(world + normal * offset, 1.0);
    vec3 at = clip.xyz / clip.w;
    float depth = at.z * shadow_face_table[layer].depth_scale + shadow_face_table[layer].depth_offset;
    return shadow_filtered(at.xy * 0.5 + 0.5, layer, depth, size, radius, facing ? radius + 1 : 0);
}

#endif
