// Where a pixel is in the light map. Include frame/frame.glsl first.
#ifndef AG_RADIOSITY_PLACE_GLSL
#define AG_RADIOSITY_PLACE_GLSL

#include "techniques/radiosity/radiosity_shared.h"

layout(set = 0, binding = RADIOSITY_INSTANCES_BINDING, scalar) readonly buffer radiosity_instances
{
    uint first_table[]; // [instances + 1] first triangle
};
layout(set = 0, binding = RADIOSITY_TRIANGLES_BINDING, scalar) readonly buffer radiosity_triangles
{
    radiosity_gpu_triangle triangle_table[];
};

// In texels; z: the side, 0 or 1, negative where there is none. ids: of FRAME_ID; instances: of the
// map.
vec3 radiosity_place_of(uvec2 ids, uint instances, vec3 position)
{
    if (ids.x == 0u || ids.x > instances) return vec3(-1.0);
    uint triangle = first_table[ids.x - 1u] + ids.y - 1u;
    if (triangle >= first_table[ids.x]) return vec3(-1.0);
    radiosity_gpu_triangle t = triangle_table[triangle];
    if (t.sides == 0u) return vec3(-1.0);
    bool back = t.sides == 2u && dot(t.normal, frame.camera_position - position) < 0.0;
    return vec3(dot(t.u, vec4(position, 1.0)), dot(t.v, vec4(position, 1.0)), back ? 1.0 : 0.0);
}

#endif
