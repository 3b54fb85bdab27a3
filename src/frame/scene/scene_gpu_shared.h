// Data of the scene on the GPU, C and GLSL. Scalar layout.
#ifndef AG_FRAME_SCENE_GPU_SHARED_H
#define AG_FRAME_SCENE_GPU_SHARED_H

#include "core/shared.h"

// Vertex attributes other than position, normal and tangent.
struct scene_surface {
    vec2s uv0, uv1;
    uint32_t color; // linear RGBA, 8 bits each, red in the lowest byte
};

#define SCENE_MAP_BASE_COLOR         0
#define SCENE_MAP_METALLIC_ROUGHNESS 1
#define SCENE_MAP_NORMAL             2
#define SCENE_MAP_EMISSIVE           3
#define SCENE_MAP_SPECULAR           4 // these two are read where FRAME_DIELECTRIC is written
#define SCENE_MAP_SPECULAR_COLOR     5
#define SCENE_MAP_COUNT              6

// Specialization constants of shaders that read materials (scene.glsl).
#define SCENE_CONSTANT_BASE_COLOR_MAP         0
#define SCENE_CONSTANT_METALLIC_ROUGHNESS_MAP 1
#define SCENE_CONSTANT_NORMAL_MAP             2
#define SCENE_CONSTANT_EMISSIVE_MAP           3
#define SCENE_CONSTANT_MASKED                 4
#define SCENE_CONSTANT_COUNT                  5

// Bits of scene_material.flags; bit m (m < SCENE_MAP_COUNT): map m uses texture coordinate set 1.
#define SCENE_DOUBLE_SIDED 64
#define SCENE_UNLIT        128

struct scene_material {
    vec4s base_color;
    vec3s emissive; // cd/m²
    float alpha_cutoff;
    float metallic, roughness, normal_scale;
    uint32_t flags;
    vec3s specular_f0; // before the clamp to 1 and the weight
    float specular;    // weight
    // For each map, uv' = (row_u · (u, v, 1), row_v · (u, v, 1)): KHR_texture_transform.
    vec3s map_u[6], map_v[6];
};

struct scene_instance {
    mat4s world_from_instance;
    mat4s previous_world_from_instance; // of the previous frame
};

// Push constants of every draw; passes append theirs.
struct scene_push {
    uint32_t instance, material;
    uint32_t vertex_base;  // into positions, previous positions and tangent frames
    uint32_t surface_base; // into surfaces
};

// Work group size of dispatches over triangles, one invocation per triangle.
#define SCENE_TRIANGLES_LOCAL 64

#ifndef AG_GLSL
_Static_assert(sizeof(struct scene_surface) == 20, "layout is shared with GLSL");
_Static_assert(sizeof(struct scene_material) == 64 + 6 * 24, "layout is shared with GLSL");
_Static_assert(sizeof(struct scene_instance) == 128, "layout is shared with GLSL");
_Static_assert(sizeof(struct scene_push) == 16, "layout is shared with GLSL");
#endif

#endif
