// Vertex streams, materials and draws of a new scene.
#include "frame/scene/scene_gpu_build.h"

#include "frame/octahedral.h"
#include "scene/statics.h"

#include <math.h>
#include <stdlib.h>

static const float BLEND_CUTOFF = 0.5f; // blended materials are rendered as masks
// Interpolation of an alpha of 1, or of the cutoff, may be less by rounding.
static const float ALPHA_SLACK = 1.0f / 4096.0f;

static bool is_deformed(const struct scene *scene, int instance)
{
    return scene->instances[instance].skin >= 0 || scene_mesh_of(scene, instance)->morph_count > 0;
}

// ---- Vertex streams -----------------------------------------------------------------------------

struct stream_sizes {
    size_t vertices, indices;
};

// Sizes are limited by 32-bit vertex indices and by the device's storage buffer range.
static bool measure(const struct scene_gpu *s, struct stream_sizes *out)
{
    *out = (struct stream_sizes){ 0 };
    for (int m = 0; m < s->scene->mesh_count; m++) {
        if (!size_add(out->vertices, s->scene->meshes[m].vertex_count, &out->vertices) ||
            !size_add(out->indices, s->scene->meshes[m].index_count, &out->indices)) {
            return host_fail(s->host, FAIL_MEMORY, "scene %s: too many vertices", s->scene->name);
        }
    }
    size_t most = gpu_limits(s->gpu)->max_storage_bytes / sizeof(struct scene_surface);
    if (out->vertices <= most && out->vertices < INT32_MAX && out->indices < INT32_MAX) return true;
    return host_fail(s->host, FAIL_UNSUPPORTED,
                     "scene %s: %zu vertices and %zu indices are more than device %s can bind",
                     s->scene->name, out->vertices, out->indices, gpu_info(s->gpu)->name);
}

static uint32_t pack_unorm8(float v)
{
    return (uint32_t)lrintf(fminf(fmaxf(v, 0.0f), 1.0f) * 255.0f);
}

static struct scene_surface surface_of(const struct mesh *mesh, uint32_t v)
{
    struct scene_surface s = { .color = 0xffffffffu };
    if (mesh->uv[0]) s.uv0 = mesh->uv[0][v];
    s.uv1 = mesh->uv[1] ? mesh->uv[1][v] : s.uv0;
    if (mesh->colors) {
        vec4s c = mesh->colors[v];
        s.color = pack_unorm8(c.x) | pack_unorm8(c.y) << 8 | pack_unorm8(c.z) << 16 |
                  pack_unorm8(c.w) << 24;
    }
    return s;
}

// Normal and tangent; the sign of the bitangent replaces the tangent's lowest bit, worth 3·10⁻⁵.
void scene_gpu_pack_frame(vec3s normal, const vec4s *tangent, uint32_t out[2])
{
    out[0] = octahedral_pack(normal);
    out[1] = 0;
    if (!tangent) return;
    out[1] = octahedral_pack(vec3_xyz(*tangent)) & ~1u;
    if (tangent->w < 0.0f) out[1] |= 1u;
}

struct streams {
    vec3s *positions;
    uint32_t (*frames)[2];
    struct scene_surface *surfaces;
    uint32_t *indices;
};

static void fill_streams(const struct scene_gpu *s, struct streams *out)
{
    size_t vertex = 0, index = 0;
    for (int m = 0; m < s->scene->mesh_count; m++) {
        const struct mesh *mesh = &s->scene->meshes[m];
        s->index_offset[m] = index * sizeof(uint32_t);
        for (uint32_t v = 0; v < mesh->vertex_count; v++, vertex++) {
            out->positions[vertex] = mesh->positions[v];
            scene_gpu_pack_frame(mesh->normals[v], mesh->tangents ? &mesh->tangents[v] : NULL,
                                 out->frames[vertex]);
            out->surfaces[vertex] = surface_of(mesh, v);
        }
        for (uint32_t i = 0; i < mesh->index_count; i++) out->indices[index++] = mesh->indices[i];
    }
}

static bool upload(struct scene_gpu *s, const char *name, uint32_t usage, const void *data,
                   size_t count, size_t size, gpu_buffer *out)
{
    size_t bytes;
    if (!size_mul(count, size, &bytes))
        return host_fail(s->host, FAIL_MEMORY, "%s: too large", name);
    struct gpu_buffer_desc desc = { .name = name, .bytes = bytes ? bytes : size, .usage = usage };
    if (!gpu_buffer_create(s->gpu, &desc, out)) return false;
    return !bytes || gpu_buffer_upload(s->gpu, *out, 0, data, bytes);
}

bool scene_gpu_make_streams(struct scene_gpu *s)
{
    struct stream_sizes n;
    if (!measure(s, &n)) return false;
    bool ok = false;
    struct streams t = {
        .positions = host_alloc(s->host, n.vertices, sizeof *t.positions),
        .frames = host_alloc(s->host, n.vertices, sizeof *t.frames),
        .surfaces = host_alloc(s->host, n.vertices, sizeof *t.surfaces),
        .indices = host_alloc(s->host, n.indices, sizeof *t.indices),
    };
    s->index_offset = host_alloc(s->host, (size_t)s->scene->mesh_count, sizeof *s->index_offset);
    if (!t.positions || !t.frames || !t.surfaces || !t.indices || !s->index_offset) goto done;
    fill_streams(s, &t);
    ok = upload(s, "scene.positions", GPU_BUFFER_STORAGE, t.positions, n.vertices,
                sizeof *t.positions, &s->positions) &&
         upload(s, "scene.frames", GPU_BUFFER_STORAGE, t.frames, n.vertices, sizeof *t.frames,
                &s->frames) &&
         upload(s, "scene.surfaces", GPU_BUFFER_STORAGE, t.surfaces, n.vertices, sizeof *t.surfaces,
                &s->surfaces) &&
         upload(s, "scene.indices", GPU_BUFFER_INDEX | GPU_BUFFER_STORAGE, t.indices, n.indices,
                sizeof *t.indices, &s->indices);
done:
    host_free(s->host, t.positions);
    host_free(s->host, t.frames);
    host_free(s->host, t.surfaces);
    host_free(s->host, t.indices);
    return ok;
}

// ---- Materials ----------------------------------------------------------------------------------

static const struct texture_use *map_of(const struct material *m, int map)
{
    const struct texture_use *maps[SCENE_MAP_COUNT] = {
        [SCENE_MAP_BASE_COLOR] = &m->base_color_map,
        [SCENE_MAP_METALLIC_ROUGHNESS] = &m->metallic_roughness_map,
        [SCENE_MAP_NORMAL] = &m->normal_map,
        [SCENE_MAP_EMISSIVE] = &m->emissive_map,
        [SCENE_MAP_SPECULAR] = &m->specular_map,
        [SCENE_MAP_SPECULAR_COLOR] = &m->specular_color_map,
    };
    return maps[map];
}

struct scene_material scene_gpu_pack_material(const struct material *m)
{
    struct scene_material out = {
        .base_color = m->base_color,
        .emissive = m->emissive,
        .alpha_cutoff =
            (m->alpha_mode == ALPHA_BLEND ? BLEND_CUTOFF : m->alpha_cutoff) - ALPHA_SLACK,
        .metallic = m->metallic,
        .roughness = m->roughness,
        .normal_scale = m->normal_scale,
        .specular_f0 = material_specular_f0(m),
        .specular = m->specular,
        .flags = (m->double_sided ? SCENE_DOUBLE_SIDED : 0) | (m->unlit ? SCENE_UNLIT : 0),
    };
    for (int i = 0; i < SCENE_MAP_COUNT; i++) {
        const struct texture_use *t = map_of(m, i);
        if (t->uv_set == 1) out.flags |= 1u << i;
        // offset + rotation · scale · uv, the rotation counter-clockwise in the image (v down).
        float c = cosf(t->uv_rotation_rad), s = sinf(t->uv_rotation_rad);
        out.map_u[i] = vec3_of(c * t->uv_scale[0], s * t->uv_scale[1], t->uv_offset[0]);
        out.map_v[i] = vec3_of(-s * t->uv_scale[0], c * t->uv_scale[1], t->uv_offset[1]);
    }
    return out;
}

bool scene_gpu_make_materials(struct scene_gpu *s)
{
    size_t count = (size_t)s->scene->material_count;
    struct scene_material *packed = host_alloc(s->host, count, sizeof *packed);
    if (!packed) return false;
    for (size_t i = 0; i < count; i++) packed[i] = scene_gpu_pack_material(&s->scene->materials[i]);
    bool ok = upload(s, "scene.materials", GPU_BUFFER_STORAGE, packed, count, sizeof *packed,
                     &s->materials);
    host_free(s->host, packed);
    return ok;
}

// ---- Draws --------------------------------------------------------------------------------------

static uint32_t variant_of(const struct mesh *mesh, const struct material *m)
{
    uint32_t variant = 0;
    if (m->base_color_map.image >= 0) variant |= VARIANT_BASE_COLOR_MAP;
    if (m->metallic_roughness_map.image >= 0) variant |= VARIANT_METALLIC_ROUGHNESS_MAP;
    if (m->normal_map.image >= 0 && mesh->tangents) variant |= VARIANT_NORMAL_MAP;
    if (m->emissive_map.image >= 0) variant |= VARIANT_EMISSIVE_MAP;
    if (m->alpha_mode != ALPHA_OPAQUE) variant |= VARIANT_MASKED;
    return variant;
}

static int compare_draws(const void *left, const void *right)
{
    const struct scene_draw *a = left, *b = right;
    if (a->variant != b->variant) return a->variant < b->variant ? -1 : 1; // masked is the top bit
    if (a->material != b->material) return a->material < b->material ? -1 : 1;
    return a->instance < b->instance ? -1 : a->instance > b->instance;
}

static struct scene_draw draw_of(const struct scene_gpu *s, int instance, bool movable,
                                 const uint32_t *vertex_base, uint32_t deformed_base)
{
    const struct instance *from = &s->scene->instances[instance];
    const struct mesh *mesh = &s->scene->meshes[from->mesh];
    bool deformed = is_deformed(s->scene, instance);
    return (struct scene_draw){
        .instance = instance,
        .mesh = from->mesh,
        .material = mesh->material,
        .variant = variant_of(mesh, &s->scene->materials[mesh->material]),
        .deformed = deformed,
        .dynamic = movable,
        .movable = movable,
        .added = from->added,
        .bounds = box3_empty(),
        .push = { .instance = (uint32_t)instance,
                  .material = (uint32_t)mesh->material,
                  .vertex_base = deformed ? deformed_base : vertex_base[from->mesh],
                  .surface_base = vertex_base[from->mesh] },
    };
}

static float strongest(vec3s v)
{
    return fmaxf(v.x, fmaxf(v.y, v.z));
}

void scene_gpu_summarize_materials(struct scene_gpu *s)
{
    s->max_emissive = 0.0f;
    s->has_unlit = s->has_dielectrics = false;
    for (int i = 0; i < s->draw_count; i++) {
        const struct material *m = &s->scene->materials[s->draws[i].material];
        s->max_emissive = fmaxf(s->max_emissive, strongest(m->emissive));
        if (m->unlit) s->has_unlit = true;
        if (!material_has_default_specular(m)) s->has_dielectrics = true;
    }
}

static bool list_draws(struct scene_gpu *s, const uint32_t *vertex_base)
{
    bool *movable = scene_dynamic_instances(s->host, s->scene);
    if (!movable) return false;
    for (int i = 0; i < s->scene->instance_count; i++) {
        if (scene_mesh_of(s->scene, i)->index_count == 0) continue;
        struct scene_draw draw = draw_of(s, i, movable[i], vertex_base, s->deformed_vertex_count);
        if (draw.deformed) s->deformed_vertex_count += s->scene->meshes[draw.mesh].vertex_count;
        s->variants_used |= 1u << draw.variant;
        s->dynamic_count += draw.dynamic;
        s->draws[s->draw_count++] = draw;
    }
    host_free(s->host, movable);
    qsort(s->draws, (size_t)s->draw_count, sizeof *s->draws, compare_draws);
    return true;
}

// Arrays that scene_gpu_update fills, so that frames allocate nothing.
static bool make_frame_arrays(struct scene_gpu *s)
{
    size_t n = (size_t)s->scene->instance_count, v = s->deformed_vertex_count;
    s->instances = host_alloc(s->host, n, sizeof *s->instances);
    s->deformed_positions = host_alloc(s->host, v, sizeof *s->deformed_positions);
    s->deformed_previous = host_alloc(s->host, v, sizeof *s->deformed_previous);
    s->deformed_frames = host_alloc(s->host, v, sizeof *s->deformed_frames);
    return s->instances && s->deformed_positions && s->deformed_previous && s->deformed_frames;
}

bool scene_gpu_make_draws(struct scene_gpu *s)
{
    size_t meshes = (size_t)s->scene->mesh_count, count = (size_t)s->scene->instance_count;
    uint32_t *vertex_base = host_alloc(s->host, meshes, sizeof *vertex_base);
    s->draws = host_alloc(s->host, count, sizeof *s->draws);
    bool ok = vertex_base && s->draws;
    for (size_t m = 1; ok && m < meshes; m++)
        vertex_base[m] = vertex_base[m - 1] + s->scene->meshes[m - 1].vertex_count;
    ok = ok && list_draws(s, vertex_base);
    host_free(s->host, vertex_base);
    scene_gpu_summarize_materials(s);
    return ok && make_frame_arrays(s);
}

bool scene_gpu_init(struct scene_gpu *out, struct host *host, struct gpu *gpu,
                    const struct scene *scene)
{
    *out = (struct scene_gpu){ .host = host,
                               .gpu = gpu,
                               .scene = scene,
                               .followed = scene->revisions,
                               .uploaded = scene->revisions.newest };
    return scene_gpu_make_streams(out) && scene_gpu_make_materials(out) &&
           scene_gpu_make_draws(out) && scene_gpu_make_textures(out);
}

void scene_gpu_finish_streams(struct scene_gpu *s)
{
    gpu_buffer *buffers[] = { &s->positions, &s->frames,    &s->surfaces,
                              &s->indices,   &s->materials, &s->previous_positions };
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        gpu_buffer_destroy(s->gpu, buffers[i]);
    host_free(s->host, s->index_offset);
}

void scene_gpu_finish_draws(struct scene_gpu *s)
{
    host_free(s->host, s->draws);
    host_free(s->host, s->removed);
    host_free(s->host, s->instances);
    host_free(s->host, s->deformed_positions);
    host_free(s->host, s->deformed_previous);
    host_free(s->host, s->deformed_frames);
}

void scene_gpu_finish(struct scene_gpu *s)
{
    if (!s->gpu) return;
    scene_gpu_finish_streams(s);
    scene_gpu_destroy_textures(s);
    scene_gpu_finish_draws(s);
    host_free(s->host, s->packed);
    *s = (struct scene_gpu){ 0 };
}
