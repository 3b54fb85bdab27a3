// Filtered shadow map lookup: selects the map of a light, offsets the receiver, filters the
// comparison. Include after frame.glsl. Binding numbers: SHADOW_FACES_BINDING, SHADOW_MAPS_BINDING
// and SHADOW_SUN_MAPS_BINDING, 2, 3 and 12 unless defined before.
#ifndef AG_FRAME_SHADOW_GLSL
#define AG_FRAME_SHADOW_GLSL

#include "core/basis.glsl"
#include "frame/shadow/shadow_shared.h"

#ifndef SHADOW_FACES_BINDING
#define SHADOW_FACES_BINDING    2
#define SHADOW_MAPS_BINDING     3
#define SHADOW_SUN_MAPS_BINDING 12
#endif

layout(set = 0, binding = SHADOW_FACES_BINDING, scalar) readonly buffer shadow_faces
{
    shadow_face shadow_face_table[];
};
// Compares with ≥: 1 where the receiver's reversed depth is at least the texel's.
layout(set = 0, binding = SHADOW_MAPS_BINDING) uniform sampler2DArrayShadow shadow_maps;
layout(set = 0, binding = SHADOW_SUN_MAPS_BINDING) uniform sampler2DArrayShadow shadow_sun_maps;

// The finest cascade that contains the point and its filter footprint. The last cascade contains
// the whole scene.
// margin: of the footprint, texels.
int shadow_cascade(frame_light light, vec3 world, float margin)
{
    int chosen = light.shadow_count - 1;
    float inside = 1.0 - 2.0 * margin / shadow_face_table[light.shadow_first].size;
    for (int i = light.shadow_count - 2; i >= 0; i--) {
        vec2 clip =
            (shadow_face_table[light.shadow_first + i].clip_from_world * vec4(world, 1.0)).xy;
        if (max(abs(clip.x), abs(clip.y)) < inside) chosen = i;
    }
    return chosen;
}

// Cube face in the order +x −x +y −y +z −z.
int shadow_cube_face(vec3 from_light)
{
    vec3 a = abs(from_light);
    if (a.x >= a.y && a.x >= a.z) return from_light.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z) return from_light.y >= 0.0 ? 2 : 3;
    return from_light.z >= 0.0 ? 4 : 5;
}

// Percentage-closer filtering: the unoccluded fraction of a box of (2·radius+1)² texels around `at`
// (in 0…1). Texels are weighted by their overlap with the box; one bilinear fetch between two
// texels weights both, (radius+1)² fetches in all. rows: 0 skips the fetches. slope: gradient of
// the receiver's depth over map coordinates (receiver-plane depth bias).
float shadow_filtered(sampler2DArrayShadow maps, vec2 at, int layer, float depth, vec2 slope,
                      float size, int radius, int rows)
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
            float receiver = depth + dot(slope, vec2(u, v) - at);
            row += (x0 + x1) * texture(maps, vec4(u, v, float(layer), receiver));
        }
        sum += (y0 + y1) * row;
    }
    float width = float(2 * radius + 1);
    return sum / (width * width);
}

// Error of a stored depth in texels: rasterisation plus bilinear comparison.
const float SHADOW_TEXEL_ERROR = 1.5;
// Below this cosine to the light the receiver-plane slope is faded out: it grows without bound.
const float SHADOW_MIN_COSINE = 0.1;

// Gradient of NDC depth over NDC x and y on the plane with this normal.
vec2 shadow_slope(mat4 clip_from_world, vec3 ndc, vec3 normal)
{
    vec3 a = perpendicular_to(normal);
    vec4 ca = clip_from_world * vec4(a, 0.0), cb = clip_from_world * vec4(cross(normal, a), 0.0);
    // Tangents of the plane in NDC, up to a common factor.
    vec3 da = ca.xyz - ndc * ca.w, db = cb.xyz - ndc * cb.w;
    float area = da.x * db.y - da.y * db.x;
    if (abs(area) < 1e-20) return vec2(0.0);
    return vec2(da.z * db.y - db.z * da.y, da.x * db.z - db.x * da.z) / area;
}

// 0 (in shadow) … 1. normal: unit geometric normal of the receiver, on the viewer's side; to_light:
// unit vector; facing: false skips the lookup for surfaces that face away from the light.
//
// The remaining depth error is that of one texel, d: on a plane at angle θ to the light it changes
// depth by d·tan θ, and an offset o along the normal changes it by o/cos θ. The normal offset
// d·sin θ thus prevents self-shadowing, and moves shadow edges by less than two texels for any
// filter width.
float shadow_visibility(frame_light light, vec3 world, vec3 normal, vec3 to_light, bool facing,
                        int radius)
{
    // Texels: filter radius, half a texel of rasterisation, one of bilinear interpolation.
    float reach = float(radius) + 1.5;
    int face = 0;
    if (light.type == FRAME_LIGHT_SUN) face = shadow_cascade(light, world, 2.0 * reach + 1.0);
    if (light.type == FRAME_LIGHT_POINT) face = shadow_cube_face(world - light.position);
    int index = light.shadow_first + face;

    float texel = shadow_face_table[index].texel_m;
    if (light.type != FRAME_LIGHT_SUN) {
        mat4 m = shadow_face_table[index].clip_from_world;
        texel *= max(dot(vec4(m[0].w, m[1].w, m[2].w, m[3].w), vec4(world, 1.0)), 0.0);
    }
    float cosine = dot(normal, to_light);
    float offset = texel * SHADOW_TEXEL_ERROR * 1.41421356 * sqrt(max(1.0 - cosine * cosine, 0.0));
    mat4 clip_from_world = shadow_face_table[index].clip_from_world;
    vec4 clip = clip_from_world * vec4(world + normal * offset, 1.0);
    vec3 at = clip.xyz / clip.w;
    float depth_scale = shadow_face_table[index].depth_scale;
    float depth = at.z * depth_scale + shadow_face_table[index].depth_offset;
    float slope_fade = clamp(abs(cosine) / SHADOW_MIN_COSINE, 0.0, 1.0);
    vec2 slope = shadow_slope(clip_from_world, at, normal) *
                 (2.0 * depth_scale * slope_fade); // NDC has twice the extent of map coordinates
    int layer = shadow_face_table[index].layer, rows = facing ? radius + 1 : 0;
    float size = shadow_face_table[index].size;
    if (light.type == FRAME_LIGHT_SUN)
        return shadow_filtered(shadow_sun_maps, at.xy * 0.5 + 0.5, layer, depth, slope, size,
                               radius, rows);
    return shadow_filtered(shadow_maps, at.xy * 0.5 + 0.5, layer, depth, slope, size, radius, rows);
}

#endif
