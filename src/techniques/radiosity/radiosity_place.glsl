// Where a pixel is in the light map. Include frame/frame.glsl first.
#ifndef AG_RADIOSITY_PLACE_GLSL
#define AG_RADIOSITY_PLACE_GLSL

#include "techniques/radiosity/radiosity_table.glsl"

// First triangle, number; u, v, normal and sides of each triangle.
layout(set = 0, binding = RADIOSITY_INSTANCES_BINDING) uniform usampler2D radiosity_instances;
layout(set = 0, binding = RADIOSITY_TRIANGLES_BINDING,
       rgba32f) uniform readonly image2D radiosity_triangles;

// In texels; z: the side, 0 or 1, negative where there is none. ids: of FRAME_ID; instances: of the
// map.
vec3 radiosity_place_of(uvec2 ids, uint instances, vec3 position)
{
    if (ids.x == 0u || ids.x > instances) return vec3(-1.0);
    uvec2 instance = texelFetch(radiosity_instances, radiosity_at(ids.x - 1u), 0).xy;
    if (ids.y - 1u >= instance.y) return vec3(-1.0);
    uint first = RADIOSITY_TRIANGLE_PARTS * (instance.x + ids.y - 1u);
    vec4 u = imageLoad(radiosity_triangles, radiosity_at(first));
    vec4 v = imageLoad(radiosity_triangles, radiosity_at(first + 1u));
    vec4 front = imageLoad(radiosity_triangles, radiosity_at(first + 2u)); // w: sides
    if (front.w == 0.0) return vec3(-1.0);
    bool back = front.w == 2.0 && dot(front.xyz, frame.camera_position - position) < 0.0;
    return vec3(dot(u, vec4(position, 1.0)), dot(v, vec4(position, 1.0)), back ? 1.0 : 0.0);
}

#endif
