// World-space triangles of a posed scene, and the ray queries of other modules.
#include "trace/trace_scene.h"

#include "trace/reflectance.h"
#include "trace/surface.h"

#include "core/hash.h"

#include <math.h>
#include <string.h>

static const float BLEND_CUTOFF = 0.5f; // alpha blending is treated as masking, as in the frame

// ---- materials

static void texture_of(struct trace_scene *s, const struct texture_use *use, bool srgb,
                       struct texture_map *out)
{
    struct texture *texture = NULL;
    if (use->image >= 0) {
        srgb = srgb && !s->scene->images[use->image].linear;
        texture = srgb ? &s->color_textures[use->image] : &s->data_textures[use->image];
        if (texture->levels == 0) texture_init(texture, &s->scene->images[use->image], srgb);
    }
    *out = texture_map_of(use, texture);
}

static void create_material(struct trace_scene *s, const struct material *m,
                            struct trace_material *out)
{
    *out = (struct trace_material){
        .base_color = vec3_xyz(m->base_color),
        .emission = m->emissive,
        .alpha = m->base_color.w,
        .alpha_cutoff = m->alpha_mode == ALPHA_BLEND ? BLEND_CUTOFF : m->alpha_cutoff,
        .metallic = m->metallic,
        .roughness = m->roughness,
        .normal_scale = m->normal_scale,
        .specular_f0 = material_specular_f0(m),
        .specular = m->specular,
        .masked = m->alpha_mode != ALPHA_OPAQUE,
        .double_sided = m->double_sided,
        .unlit = m->unlit,
        .emissive = m->emissive.x > 0.0f || m->emissive.y > 0.0f || m->emissive.z > 0.0f,
    };
    out->textured = m->base_color_map.image >= 0 || m->metallic_roughness_map.image >= 0 ||
                    m->normal_map.image >= 0 || m->emissive_map.image >= 0 ||
                    m->specular_map.image >= 0 || m->specular_color_map.image >= 0;
    texture_of(s, &m->base_color_map, true, &out->base_color_map);
    texture_of(s, &m->metallic_roughness_map, false, &out->metallic_roughness_map);
    texture_of(s, &m->normal_map, false, &out->normal_map);
    texture_of(s, &m->emissive_map, true, &out->emissive_map);
    texture_of(s, &m->specular_map, false, &out->specular_map);
    texture_of(s, &m->specular_color_map, true, &out->specular_color_map);
}

static bool create_materials(struct trace_scene *s)
{
    size_t images = (size_t)s->scene->image_count, materials = (size_t)s->scene->material_count;
    s->color_textures = host_alloc(s->host, images, sizeof *s->color_textures);
    s->data_textures = host_alloc(s->host, images, sizeof *s->data_textures);
    s->materials = host_alloc(s->host, materials, sizeof *s->materials);
    if (!s->color_textures || !s->data_textures || !s->materials) return false;
    for (size_t i = 0; i < materials; i++)
        create_material(s, &s->scene->materials[i], &s->materials[i]);
    return true;
}

// ---- meshes

static vec3s unit_or_zero(vec3s v)
{
    float length2 = glms_vec3_norm2(v);
    return length2 > 0.0f ? glms_vec3_scale(v, 1.0f / sqrtf(length2)) : v;
}

// scene.glsl: scene_frame_of. Normals go through the cofactor matrix.
static void transform_vertices(struct trace_mesh *out, mat4s m)
{
    vec3s c0 = vec3_xyz(m.col[0]), c1 = vec3_xyz(m.col[1]), c2 = vec3_xyz(m.col[2]);
    vec3s k0 = glms_vec3_cross(c1, c2), k1 = glms_vec3_cross(c2, c0), k2 = glms_vec3_cross(c0, c1);
    float side = out->mirrored ? -1.0f : 1.0f;
    for (uint32_t v = 0; v < out->mesh->vertex_count; v++) {
        struct trace_vertex *vertex = &out->vertices[v];
        vertex->position = mat4_point(m, out->mesh->positions[v]);
        vec3s n = out->mesh->normals[v];
        vec3s transformed = glms_vec3_scale(k0, n.x);
        transformed = glms_vec3_muladds(k1, n.y, transformed);
        transformed = glms_vec3_muladds(k2, n.z, transformed);
        vertex->normal = glms_vec3_scale(unit_or_zero(transformed), side);
        if (!out->has_tangents) continue;
        vec4s t = out->mesh->tangents[v];
        vec3s tangent = unit_or_zero(mat4_direction(m, vec3_xyz(t)));
        vertex->tangent = vec4_of(tangent, t.w * side);
    }
}

static void copy_deformed(struct trace_mesh *out, const struct deformed_mesh *from)
{
    for (uint32_t v = 0; v < out->mesh->vertex_count; v++) {
        struct trace_vertex *vertex = &out->vertices[v];
        vertex->position = from->positions[v];
        vertex->normal = from->normals[v];
        if (!out->has_tangents) continue;
        vertex->tangent = from->tangents[v];
        if (out->mirrored) vertex->tangent.w = -vertex->tangent.w;
    }
}

// The rounding error of an interpolated position is a few ulp (2⁻²⁴) of its corners.
static float reach_of(const struct trace_mesh *mesh, const uint32_t corner[3])
{
    static const float REACH = 0x1p-19f;
    float size = 0.0f;
    for (int i = 0; i < 3; i++)
        size = fmaxf(size, glms_vec3_max(glms_vec3_abs(mesh->vertices[corner[i]].position)));
    return REACH * size + 1e-9f;
}

static void compute_facets(struct trace_mesh *out)
{
    for (uint32_t i = 0; i < out->mesh->index_count / 3; i++) {
        uint32_t corner[3];
        trace_corners(out, i, corner);
        out->facets[i] = (struct trace_facet){
            .normal = glms_vec3_normalize(trace_area_normal(out, corner)),
            .reach = reach_of(out, corner),
        };
    }
}

static bool create_mesh(struct trace_scene *s, const struct scene_pose *pose, int instance,
                        struct trace_mesh *out)
{
    const struct mesh *mesh = scene_mesh_of(s->scene, instance);
    const struct deformed_mesh *deformed = &pose->deformed[instance];
    *out = (struct trace_mesh){ .mesh = mesh,
                                .material = &s->materials[mesh->material],
                                .instance = instance,
                                .mirrored = pose_is_mirrored(pose, instance),
                                .emitter_first = NO_EMITTER };
    out->has_tangents = mesh->tangents && (!deformed->positions || deformed->tangents);
    out->vertices = host_alloc(s->host, mesh->vertex_count, sizeof *out->vertices);
    out->facets = host_alloc(s->host, mesh->index_count / 3, sizeof *out->facets);
    if (!out->vertices || !out->facets) return false;
    if (deformed->positions)
        copy_deformed(out, deformed);
    else
        transform_vertices(out, pose_world_from_instance(pose, instance));
    for (uint32_t v = 0; mesh->uv[0] && v < mesh->vertex_count; v++)
        out->vertices[v].uv = mesh->uv[0][v];
    compute_facets(out);
    out->geometry = (struct embree_geometry){
        .positions = &out->vertices->position,
        .stride = sizeof *out->vertices,
        .vertex_count = mesh->vertex_count,
        .indices = mesh->indices,
        .triangle_count = mesh->index_count / 3,
        .solid = out->material->masked ? surface_is_solid : NULL,
        .user = out,
    };
    return true;
}

static bool create_meshes(struct trace_scene *s, const struct scene_pose *pose)
{
    const size_t instances = (size_t)s->scene->instance_count;
    s->meshes = host_alloc(s->host, instances, sizeof *s->meshes);
    s->mesh_of = host_alloc(s->host, instances, sizeof *s->mesh_of);
    s->embree = embree_create(s->host);
    if (!s->meshes || !s->mesh_of || !s->embree) return false;
    for (int i = 0; i < s->scene->instance_count; i++) {
        s->mesh_of[i] = UINT32_MAX;
        if (scene_mesh_of(s->scene, i)->index_count == 0) continue;
        s->mesh_of[i] = s->mesh_count;
        struct trace_mesh *mesh = &s->meshes[s->mesh_count++];
        if (!create_mesh(s, pose, i, mesh) || !embree_add(s->embree, &mesh->geometry)) return false;
    }
    return embree_commit(s->embree);
}

// ---- hash key

static uint64_t add(uint64_t key, const void *data, size_t count, size_t size)
{
    return data ? hash_bytes(data, count * size, key) : key;
}

static uint64_t add_floats(uint64_t key, const float *values, size_t count)
{
    return add(key, values, count, sizeof *values);
}

static uint64_t add_map(uint64_t key, const struct texture_map *map)
{
    if (!map->texture) return add_floats(key, (float[1]){ 0 }, 1);
    const int words[] = { map->uv_set,  (int)map->wrap_u,    (int)map->wrap_v,
                          map->nearest, map->texture->width, map->texture->height };
    key = add(key, words, 6, sizeof *words);
    key = add_floats(add_floats(key, map->row_u.raw, 3), map->row_v.raw, 3);
    return add(key, map->texture->texels[0],
               (size_t)map->texture->width * (size_t)map->texture->height, 4);
}

static uint64_t add_material(uint64_t key, const struct trace_material *m)
{
    const float values[] = { m->specular_f0.x, m->specular_f0.y, m->specular_f0.z, m->specular,
                             m->base_color.x,  m->base_color.y,  m->base_color.z,  m->alpha,
                             m->emission.x,    m->emission.y,    m->emission.z,    m->alpha_cutoff,
                             m->metallic,      m->roughness,     m->normal_scale };
    const int flags[] = { m->masked, m->double_sided, m->unlit };
    key = add_floats(key, values, sizeof values / sizeof *values);
    key = add(key, flags, 3, sizeof *flags);
    key = add_map(add_map(key, &m->base_color_map), &m->metallic_roughness_map);
    key = add_map(add_map(key, &m->normal_map), &m->emissive_map);
    return add_map(add_map(key, &m->specular_map), &m->specular_color_map);
}

static uint64_t add_mesh(uint64_t key, const struct trace_mesh *m)
{
    const struct mesh *mesh = m->mesh;
    size_t count = mesh->vertex_count;
    key = add(key, &mesh->index_count, 1, sizeof mesh->index_count);
    key = add(key, mesh->indices, mesh->index_count, sizeof *mesh->indices);
    key = add(key, m->vertices, count, sizeof *m->vertices);
    key = add(key, mesh->uv[1], count, sizeof *mesh->uv[1]);
    key = add(key, mesh->colors, count, sizeof *mesh->colors);
    return add_material(key, m->material);
}

static uint64_t add_light(uint64_t key, const struct world_light *l)
{
    const float values[] = { (float)l->type, l->position.x,  l->position.y,  l->position.z,
                             l->direction.x, l->direction.y, l->direction.z, l->intensity.x,
                             l->intensity.y, l->intensity.z, l->cos_inner,   l->cos_outer,
                             l->range_m };
    return add_floats(key, values, sizeof values / sizeof *values);
}

static uint64_t key_of(const struct trace_scene *s)
{
    uint64_t key = environment_key(&s->lights.environment);
    for (uint32_t i = 0; i < s->mesh_count; i++) key = add_mesh(key, &s->meshes[i]);
    for (int i = 0; i < s->lights.punctual_count; i++) key = add_light(key, &s->lights.punctual[i]);
    return key;
}

// ---- creation and destruction

struct trace_scene *trace_scene_create(struct host *host, const struct scene_pose *pose)
{
    struct trace_scene *s = host_alloc(host, 1, sizeof *s);
    if (!s) return NULL;
    s->host = host;
    s->scene = pose->scene;
    if (!create_materials(s) || !create_meshes(s, pose) || !light_table_init(s, pose)) {
        trace_scene_destroy(s);
        return NULL;
    }
    s->key = key_of(s);
    return s;
}

bool trace_scene_add_levels(struct trace_scene *s)
{
    bool ok = true;
    for (int i = 0; ok && i < s->scene->image_count; i++)
        ok = (s->color_textures[i].levels == 0 ||
              texture_add_levels(&s->color_textures[i], s->host)) &&
             (s->data_textures[i].levels == 0 || texture_add_levels(&s->data_textures[i], s->host));
    return ok;
}

void trace_scene_destroy(struct trace_scene *s)
{
    if (!s) return;
    embree_destroy(s->embree);
    light_table_finish(s);
    for (uint32_t i = 0; i < s->mesh_count; i++) {
        host_free(s->host, s->meshes[i].vertices);
        host_free(s->host, s->meshes[i].facets);
    }
    for (int i = 0; i < s->scene->image_count; i++) {
        if (s->color_textures) texture_finish(&s->color_textures[i], s->host);
        if (s->data_textures) texture_finish(&s->data_textures[i], s->host);
    }
    host_free(s->host, s->color_textures);
    host_free(s->host, s->data_textures);
    host_free(s->host, s->materials);
    host_free(s->host, s->meshes);
    host_free(s->host, s->mesh_of);
    host_free(s->host, s);
}

// ---- rays

bool trace_closest(const struct trace_scene *scene, vec3s origin, vec3s direction,
                   float max_distance, struct trace_hit *hit)
{
    struct ray ray = { origin, direction, 0.0f, max_distance };
    struct ray_hit first;
    if (!embree_closest(scene->embree, &ray, NULL, false, &first)) return false;
    if (!hit) return true;
    struct surface s;
    surface_at(scene, &ray, &first, NULL, &s);
    *hit = (struct trace_hit){
        .distance = first.distance,
        .instance = scene->meshes[first.geometry].instance,
        .triangle = first.triangle,
        .u = first.u,
        .v = first.v,
        .position = s.position,
        .geometric = s.front ? s.geometric : glms_vec3_negate(s.geometric),
        .normal = s.normal,
        .front = s.front,
        .albedo = s.material.albedo,
        .metallic = s.material.metallic,
        .roughness = s.material.roughness,
        .emission = s.emission,
    };
    return true;
}

vec3s trace_reflectance(const struct trace_scene *scene, vec3s direction,
                        const struct trace_hit *hit)
{
    const struct ray_hit at = { .geometry = scene->mesh_of[hit->instance],
                                .triangle = hit->triangle,
                                .u = hit->u,
                                .v = hit->v };
    const struct ray ray = { .direction = direction };
    struct surface s;
    surface_at(scene, &ray, &at, NULL, &s);
    return surface_reflectance(&s);
}

bool trace_occluded(const struct trace_scene *scene, vec3s origin, vec3s direction,
                    float max_distance)
{
    struct ray ray = { origin, direction, 0.0f, max_distance };
    return embree_occluded(scene->embree, &ray);
}
