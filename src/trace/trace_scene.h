// The scene of the path tracer: world-space triangles per instance, materials with maps, lights.
#pragma once

#include "trace/embree.h"
#include "trace/light_sample.h"
#include "trace/ray_watch.h"
#include "trace/texture.h"
#include "trace/trace.h"

struct trace_material {
    vec3s base_color, emission; // emission: cd/m²
    float alpha, alpha_cutoff, metallic, roughness, normal_scale;
    vec3s specular_f0; // before the clamp to 1 and the weight
    float specular;    // weight
    bool masked, double_sided, unlit, emissive, textured;
    struct texture_map base_color_map, metallic_roughness_map, normal_map, emissive_map;
    struct texture_map specular_map, specular_color_map;
};

// A vertex in world space. Interleaved, so that a hit touches few cache lines.
struct trace_vertex {
    vec3s position, normal; // normal: unit
    vec4s tangent;          // as in glTF; 0 without tangents
    vec2s uv;               // first set; 0 without uv
};

// The plane of a triangle.
struct trace_facet {
    vec3s normal; // unit, of the front
    float reach;  // offset of rays that leave the triangle, against self-intersection, m
};

// One instance.
struct trace_mesh {
    const struct mesh *mesh;
    const struct trace_material *material;
    int instance;
    bool mirrored; // the transform reverses the winding
    bool has_tangents;
    struct trace_vertex *vertices; // [mesh->vertex_count]
    struct trace_facet *facets;    // [mesh->index_count / 3]
    uint32_t emitter_first;        // index of its first emitter; NO_EMITTER if not emissive
    struct embree_geometry geometry;
};

struct trace_scene {
    struct host *host;
    const struct scene *scene;
    struct embree *embree;
    struct trace_mesh *meshes; // [mesh_count]; the index is Embree's geometry
    uint32_t mesh_count;
    uint32_t *mesh_of; // [scene->instance_count] in `meshes`; UINT32_MAX: without triangles
    struct trace_material *materials;               // [scene->material_count]
    struct texture *color_textures, *data_textures; // [scene->image_count], created on use
    struct light_table lights;
    uint64_t key;            // hash of everything that affects the light
    struct ray_watch *watch; // of paths in a view for one thread; NULL: none
};

// Makes the mip levels of all textures, for hits of rays with a footprint.
bool trace_scene_add_levels(struct trace_scene *scene);

static inline const struct trace_mesh *trace_mesh_of(const struct trace_scene *scene, int instance)
{
    return &scene->meshes[scene->mesh_of[instance]];
}

// A ray of a path that ends at `far`, in lengths of its direction.
static inline void trace_watch(const struct trace_scene *scene, const struct ray *ray, float far)
{
    if (scene->watch) ray_watch_segment(scene->watch, ray->origin, ray->direction, far);
}

// The vertex indices of a triangle, counter-clockwise from the front.
static inline void trace_corners(const struct trace_mesh *mesh, uint32_t triangle,
                                 uint32_t corner[3])
{
    const uint32_t *i = &mesh->mesh->indices[3 * (size_t)triangle];
    corner[0] = i[0];
    corner[1] = i[1];
    corner[2] = i[2];
}

// The point with the barycentric weights u and v of the second and third corner.
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
