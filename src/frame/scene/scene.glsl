// Vertex pulling: buffers and maps of the scene. Bindings: 0 frame_constants, 1…7 buffers, 8…11
// maps, 12 and up for the pass. Compute shaders include it through scene_triangles.glsl. The pass
// declares its push block, `push`, with a member scene_push `draw`.
#ifndef AG_FRAME_SCENE_GLSL
#define AG_FRAME_SCENE_GLSL

#include "frame/scene/scene_gpu_shared.h"

// Pipeline variants: one per set of maps that a material has.
layout(constant_id = SCENE_CONSTANT_BASE_COLOR_MAP) const bool HAS_BASE_COLOR_MAP = false;
layout(constant_id = SCENE_CONSTANT_METALLIC_ROUGHNESS_MAP) const
    bool HAS_METALLIC_ROUGHNESS_MAP = false;
layout(constant_id = SCENE_CONSTANT_NORMAL_MAP) const bool HAS_NORMAL_MAP = false;
layout(constant_id = SCENE_CONSTANT_EMISSIVE_MAP) const bool HAS_EMISSIVE_MAP = false;
layout(constant_id = SCENE_CONSTANT_MASKED) const bool IS_MASKED = false;

#ifdef SCENE_VERTEX

// Scalar layout: vec3 has a stride of 12 bytes.
layout(set = 0, binding = 1, scalar) readonly buffer scene_positions
{
    vec3 scene_position_table[];
};
layout(set = 0, binding = 4, scalar) readonly buffer scene_instances
{
    scene_instance scene_instance_table[];
};

vec3 scene_position(uint vertex)
{
    return scene_position_table[push.draw.vertex_base + vertex];
}

mat4 scene_world_from_instance()
{
    return scene_instance_table[push.draw.instance].world_from_instance;
}

#ifdef SCENE_VERTEX_SURFACE
layout(set = 0, binding = 3, scalar) readonly buffer scene_surfaces
{
    scene_surface scene_surface_table[];
};

scene_surface scene_surface_of(uint vertex)
{
    return scene_surface_table[push.draw.surface_base + vertex];
}

layout(set = 0, binding = 6, scalar) readonly buffer scene_materials
{
    scene_material scene_material_table[];
};

// Texture coordinates of a map. Computed in the vertex shader: buffer loads of helper invocations
// may return 0 on some drivers, which gives wrong derivatives and mips.
vec2 scene_map_uv(uint map, scene_surface surface)
{
    uint m = push.draw.material;
    vec3 uv =
        vec3((scene_material_table[m].flags >> map & 1u) != 0u ? surface.uv1 : surface.uv0, 1.0);
    return vec2(dot(scene_material_table[m].map_u[map], uv),
                dot(scene_material_table[m].map_v[map], uv));
}
#endif

#ifdef SCENE_VERTEX_FRAME
#include "frame/octahedral.glsl"
// x: octahedral normal; y: octahedral tangent, lowest bit 1: the bitangent is
// −cross(normal, tangent).
layout(set = 0, binding = 2, scalar) readonly buffer scene_frames
{
    uvec2 scene_frame_table[];
};

struct scene_frame {
    vec3 normal;
    vec4 tangent; // w = ±1 in world space, mirrored transforms included
};

// World-space normal and tangent. The cofactor matrix is the inverse transpose up to a factor.
scene_frame scene_frame_of(uint vertex, mat4 world_from_instance)
{
    uvec2 bits = scene_frame_table[push.draw.vertex_base + vertex];
    mat3 m = mat3(world_from_instance);
    mat3 cofactor = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    float side = dot(m[0], cofactor[0]) < 0.0 ? -1.0 : 1.0;
    scene_frame f;
    f.normal = normalize(cofactor * octahedral_decode(unpackSnorm2x16(bits.x))) * side;
    vec3 tangent = m * octahedral_decode(unpackSnorm2x16(bits.y & ~1u));
    float length2 = dot(tangent, tangent);
    f.tangent.xyz = length2 > 0.0 ? tangent * inversesqrt(length2) : vec3(0.0);
    f.tangent.w = (bits.y & 1u) != 0u ? -side : side;
    return f;
}
#endif

#ifdef SCENE_VERTEX_MOTION
layout(set = 0, binding = 5, scalar) readonly buffer scene_previous_positions
{
    vec3 scene_previous_table[];
};

vec3 scene_previous_position(uint vertex)
{
    return scene_previous_table[push.draw.vertex_base + vertex];
}

mat4 scene_previous_world_from_instance()
{
    return scene_instance_table[push.draw.instance].previous_world_from_instance;
}
#endif

#endif // SCENE_VERTEX

#ifdef SCENE_FRAGMENT

layout(set = 0, binding = 6, scalar) readonly buffer scene_materials
{
    scene_material scene_material_table[];
};
layout(set = 0, binding = 8) uniform sampler2D base_color_map;
layout(set = 0, binding = 9) uniform sampler2D metallic_roughness_map;

// Factor × vertex colour × map; discards fragments below the alpha cutoff.
vec4 scene_base_color(vec2 uv, vec4 color)
{
    vec4 base = scene_material_table[push.draw.material].base_color * color;
    if (HAS_BASE_COLOR_MAP) base *= texture(base_color_map, uv);
    if (IS_MASKED && base.a < scene_material_table[push.draw.material].alpha_cutoff) discard;
    return base;
}

// x: roughness, y: metallic. Unlit materials: see gbuffer_fragment.glsl.
vec2 scene_roughness_metallic(vec2 uv)
{
    uint m = push.draw.material;
    vec2 value = vec2(scene_material_table[m].roughness, scene_material_table[m].metallic);
    if (HAS_METALLIC_ROUGHNESS_MAP) value *= texture(metallic_roughness_map, uv).gb;
    return (scene_material_table[m].flags & SCENE_UNLIT) != 0u ? vec2(1.0, 0.0) : value;
}

#endif // SCENE_FRAGMENT

#endif
