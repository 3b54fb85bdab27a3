// Interpolants and bindings of the reflective shadow map shaders. VARY: `in` or `out`.
#include "frame/scene/scene_gpu_shared.h"

#ifdef RSM_FRAGMENT
#define VARY in
#else
#define VARY out
#endif

layout(location = 0) VARY vec3 vary_world;
layout(location = 1) VARY vec3 vary_normal;
layout(location = 2) VARY vec2 vary_base_color_uv;
layout(location = 3) VARY vec2 vary_metallic_roughness_uv;
layout(location = 4) VARY vec4 vary_color;

layout(push_constant, scalar) uniform push_block
{
    scene_push draw;
    uint face; // index in rsm_faces
    float reflects;
}
push;

layout(set = 0, binding = 12, scalar) readonly buffer rsm_faces
{
    rsm_face rsm_face_table[];
};
