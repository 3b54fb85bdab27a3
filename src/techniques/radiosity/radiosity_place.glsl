// Where a pixel is in the light map. Include frame/frame.glsl and frame/octahedral.glsl first.
#ifndef AG_RADIOSITY_PLACE_GLSL
#define AG_RADIOSITY_PLACE_GLSL

#include "techniques/radiosity/radiosity_table.glsl"

layout(constant_id = RADIOSITY_HAS_BACKS) const bool HAS_BACKS = true;
// First triangle, number; u and v of each triangle; fronts.
layout(set = 0, binding = RADIOSITY_INSTANCES_BINDING,
       rg32ui) uniform readonly uimage2D radiosity_instances;
layout(set = 0, binding = RADIOSITY_TRIANGLES_BINDING,
       rgba32f) uniform readonly image2D radiosity_triangles;
layout(set = 0, binding = RADIOSITY_FRONTS_BINDING,
       r32ui) uniform readonly uimage2D radiosity_fronts;

bool radiosity_is_back(uint triangle, vec3 position)
{
    uint front = imageLoad(radiosity_fronts, radiosity_at(triangle)).x;
    vec3 normal = octahedral_direction(unpackSnorm2x16(front));
    return front != RADIOSITY_ONE_SIDED && dot(normal, frame.camera_position - position) < 0.0;
}

// In texels; z: the side, 0 or 1, negative where there is none. ids: of FRAME_ID; instances: of the
// map.
vec3 radiosity_place_of(uvec2 ids, uint instances, vec3 position)
{
    if (ids.x == 0u || ids.x > instances) return vec3(-1.0);
    uvec2 instance = imageLoad(radiosity_instances, radiosity_at(ids.x - 1u)).xy;
    if (ids.y - 1u >= instance.y) return vec3(-1.0);
    uint triangle = instance.x + ids.y - 1u, first = RADIOSITY_TRIANGLE_PARTS * triangle;
    vec4 u = imageLoad(radiosity_triangles, radiosity_at(first));
    vec4 v = imageLoad(radiosity_triangles, radiosity_at(first + 1u));
    if (u == vec4(0.0, 0.0, 0.0, -1.0)) return vec3(-1.0);
    bool back = HAS_BACKS && radiosity_is_back(triangle, position);
    return vec3(dot(u, vec4(position, 1.0)), dot(v, vec4(position, 1.0)), back ? 1.0 : 0.0);
}

#endif
