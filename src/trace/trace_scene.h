// A scene as the path tracer has it: every instance's triangles in world space, materials with
// their maps, lights.
#pragma once

#include "trace/embree.h"
#include "trace/light_sample.h"
#include "trace/texture.h"
#include "trace/trace.h"

struct trace_material {
    vec3s base_color, emission; // emission: cd/m²
    float alpha, alpha_cutoff, metallic, roughness, normal_scale;
    bool masked, double_sided, unlit, emissive, mapped; // mapped: has a map
    struct texture_map base_color_map, metallic_roughness_map, normal_map, emissive_map;
};

// A corner of triangles, in world space. What a hit asks for lies side by side: a few cache lines,
// not one per attribute.
struct trace_vertex {
    vec3s position, normal; // normal: unit
    vec4s tangent;          // as glTF's; 0 where the mesh has none
    vec2s uv;               // of the first set; 0 where there is none
};

// The plane of a triangle.
struct trace_facet {
    vec3s normal; // unit, of the front
    float reach;  // how far to leave the triangle by, so that a ray does not meet it again, m
};

// One instance.
struct trace_mesh {
    const struct mesh *mesh;
    const struct trace_material *material;
    int instance;
    bool mirrored; // its transform turns triangles over
    bool has_tangents;
    struct trace_vertex *vertices; // [mesh->vertex_count]
    struct trace_facet *facets;    // [mesh->index_count / 3]
    uint32_t
        emitter_first; // of its triangles, see light_sample.h; NO_EMITTER where it does not glow
    struct embree_geometry geometry;
};

struct trace_scene {
    struct host *host;
    const struct scene *scene;
    struct embree *embree;
    struct trace_mesh *meshes; // [mesh_count]; the index is Embree's geometry
    uint32_t mesh_count;
    struct trace_material *materials;               // [scene->material_count]
    struct texture *color_textures, *data_textures; // [scene->image_count], made where used
    struct light_table lights;
    uint64_t key; // of all that light depends on
};

// The corners of a triangle in the order that faces its front.
static inline void trace_corners(const struct trace_mesh *mesh, uint32_t triangle,
                                 uint32_t corner[3])
{
    const uint32_t *i = &mesh->mesh->indices[3 * (size_t)triangle];
    corner[0] = i[0];
    corner[1] = i[1];
    corner[2] = i[2];
}

// The point of a triangle with the weights u and v of its second and third corner.
static inline vec3s trace_point(const struct trace_mesh *mesh, const uint32_t corner[3], float u,
                                float v)
{
    vec3s p = glms_vec3_scale(mesh->vertices[corner[0]].position, 1.0f - u - v);
    p = glms_vec3_muladds(mesh->vertices[corner[1]].position, u, p);
    return glms_vec3_muladds(mesh->vertices[corner[2]].position, v, p);
}

// Twice the triangle's area along its front's normal, m².
static inline vec3s trace_area_normal(const struct trace_mesh *mesh, const uint32_t corner[3])
{
    vec3s p = mesh->vertices[corner[0]].position;
    vec3s n = glms_vec3_cross(glms_vec3_sub(mesh->vertices[corner[1]].position, p),
                              glms_vec3_sub(mesh->vertices[corner[2]].position, p));
    return mesh->mirrored ? glms_vec3_negate(n) : n;
}
