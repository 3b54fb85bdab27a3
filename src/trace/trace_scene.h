// A scene as the path tracer has it: every instance's triangles in world space, materials with their maps, lights.
#pragma once

#include "trace/embree.h"
#include "trace/light_sample.h"
#include "trace/texture.h"
#include "trace/trace.h"

struct trace_material {
    vec3s base_color, emission; // emission: cd/m²
    float alpha, alpha_cutoff, metallic, roughness, normal_scale;
    bool masked, double_sided, unlit, emissive;
    struct texture_map base_color_map, metallic_roughness_map, normal_map, emissive_map;
};

// One instance.
struct trace_mesh {
    const struct mesh *mesh;
    const struct trace_material *material;
    int instance;
    bool mirrored;     // its transform turns triangles over
    vec3s *positions;  // world space
    vec3s *normals;    // unit
    vec4s *tangents;   // NULL where the mesh has none
    uint32_t emitter_first; // of its triangles, see light_sample.h; NO_EMITTER where it does not glow
    struct embree_geometry geometry;
};

struct trace_scene {
    struct host *host;
    const struct scene *scene;
    struct embree *embree;
    struct trace_mesh *meshes; // [mesh_count]; the index is Embree's geometry
    uint32_t mesh_count;
    struct trace_material *materials; // [scene->material_count]
    struct texture *color_textures, *data_textures; // [scene->image_count], made where used
    struct light_table lights;
    uint64_t key; // of all that light depends on
};

// The corners of a triangle in the order that faces its front.
static inline void trace_corners(const struct trace_mesh *mesh, uint32_t triangle, uint32_t corner[3])
{
    const uint32_t *i = &mesh->mesh->indices[3 * (size_t)triangle];
    corner[0] = i[0];
    corner[1] = i[1];
    corner[2] = i[2];
}

// Twice the triangle's area along its front's normal, m².
static inline vec3s trace_area_normal(const struct trace_mesh *mesh, const uint32_t corner[3])
{
    vec3s p = mesh->positions[corner[0]];
    vec3s n = glms_vec3_cross(glms_vec3_sub(mesh->positions[corner[1]], p),
                              glms_vec3_sub(mesh->positions[corner[2]], p));
    return mesh->mirrored ? glms_vec3_negate(n) : n;
}
