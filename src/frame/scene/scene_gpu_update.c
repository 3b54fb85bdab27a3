// Per-frame update of the scene on the GPU, and recording of its draws and dispatches.
#include "frame/scene/scene_gpu_build.h"

#include "frame/octahedral.h"
#include "frame/projection.h"

#include <assert.h>
#include <string.h>

static void mark_moved(struct scene_gpu *s, struct scene_draw *draw)
{
    s->moved = draw->moved = true;
    if (draw->dynamic || !draw->seen) return; // the first frame has no movement
    draw->dynamic = true;
    s->dynamic_count++;
    s->static_set++;
}

// ---- Vertices and materials that changed --------------------------------------------------------

static void copy_in(struct gpu_cmd *cmd, gpu_buffer to, size_t first, size_t count, size_t size,
                    const void *data)
{
    const struct gpu_binding from = gpu_transient(cmd, "scene.changes", data, count * size);
    gpu_copy_buffer(cmd, to, first * size, from.buffer, from.offset, count * size);
}

static void upload_mesh(struct scene_gpu *s, struct gpu_cmd *cmd, const struct mesh *mesh,
                        size_t first)
{
    const size_t count = mesh->vertex_count, size = sizeof *mesh->positions;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        scene_gpu_pack_frame(mesh->normals[v], mesh->tangents ? &mesh->tangents[v] : NULL,
                             s->packed->frames[v]);
    gpu_copy_buffer(cmd, s->previous_positions, first * size, s->positions, first * size,
                    count * size);
    copy_in(cmd, s->positions, first, count, size, mesh->positions);
    copy_in(cmd, s->frames, first, count, sizeof *s->packed->frames, s->packed->frames);
}

static void upload_meshes(struct scene_gpu *s, struct gpu_cmd *cmd)
{
    size_t first = 0;
    if (s->scene->revisions.vertices <= s->uploaded) return;
    for (int m = 0; m < s->scene->mesh_count; m++) {
        const struct mesh *mesh = &s->scene->meshes[m];
        if (mesh->revision > s->uploaded && mesh->vertex_count > 0)
            upload_mesh(s, cmd, mesh, first);
        first += mesh->vertex_count;
    }
}

static void upload_materials(struct scene_gpu *s, struct gpu_cmd *cmd)
{
    if (s->scene->revisions.materials <= s->uploaded) return;
    for (int m = 0; m < s->scene->material_count; m++) {
        if (s->scene->materials[m].revision <= s->uploaded) continue;
        const struct scene_material packed = scene_gpu_pack_material(&s->scene->materials[m]);
        copy_in(cmd, s->materials, (size_t)m, 1, sizeof packed, &packed);
    }
}

static void mark_changes(struct scene_gpu *s)
{
    s->recolored = false;
    for (int i = 0; i < s->draw_count; i++) {
        struct scene_draw *draw = &s->draws[i];
        draw->moved = false;
        draw->reshaped = s->scene->meshes[draw->mesh].revision > s->uploaded;
        draw->recolored = s->scene->materials[draw->material].revision > s->uploaded;
        const bool left = s->leaves_dynamic && draw->movable;
        if (draw->reshaped || left != draw->left) mark_moved(s, draw);
        draw->left = left;
        if (!draw->recolored) continue;
        s->recolored = true;
        s->static_set += !draw->dynamic;
    }
}

// ---- The pose -----------------------------------------------------------------------------------

// Copies a deformed instance's vertices and computes the draw's bounds.
static void copy_deformed(struct scene_gpu *s, const struct deformed_mesh *from,
                          const struct mesh *mesh, struct scene_draw *draw)
{
    uint32_t base = draw->push.vertex_base;
    draw->bounds = box3_empty();
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        vec3s p = from->positions[v];
        if (memcmp(&s->deformed_positions[base + v], &p, sizeof p) != 0) mark_moved(s, draw);
        s->deformed_positions[base + v] = p;
        draw->bounds = box3_add_point(draw->bounds, p);
        uint32_t *frame = s->deformed_frames[base + v];
        frame[0] = octahedral_pack(from->normals[v]);
        frame[1] = from->tangents ? octahedral_pack(vec3_xyz(from->tangents[v])) & ~1u : 0;
        // In world space a mirrored instance has the opposite bitangent sign.
        if (from->tangents && (from->tangents[v].w < 0.0f) != draw->mirrored) frame[1] |= 1u;
    }
}

static void update_draw(struct scene_gpu *s, const struct scene_pose *pose, struct scene_draw *draw)
{
    const struct mesh *mesh = &s->scene->meshes[draw->mesh];
    const struct deformed_mesh *deformed = &pose->deformed[draw->instance];
    draw->mirrored = pose_is_mirrored(pose, draw->instance);
    if (draw->deformed) {
        copy_deformed(s, deformed, mesh, draw);
        s->instances[draw->instance].world_from_instance = glms_mat4_identity();
        return;
    }
    mat4s m = pose_world_from_instance(pose, draw->instance);
    struct scene_instance *instance = &s->instances[draw->instance];
    if (memcmp(&instance->world_from_instance, &m, sizeof m) != 0) mark_moved(s, draw);
    instance->world_from_instance = m;
    draw->bounds = box3_transform(m, mesh->bounds);
}

static void upload_deformed(struct scene_gpu *s, struct gpu_cmd *cmd)
{
    size_t n = s->deformed_vertex_count;
    if (n == 0) return;
    s->deformed_positions_binding = gpu_transient(cmd, "scene_positions", s->deformed_positions,
                                                  n * sizeof *s->deformed_positions);
    s->deformed_previous_binding = gpu_transient(
        cmd, "scene_previous_positions", s->deformed_previous, n * sizeof *s->deformed_previous);
    s->deformed_frames_binding =
        gpu_transient(cmd, "scene_frames", s->deformed_frames, n * sizeof *s->deformed_frames);
}

// Without a previous position: it does not move on the screen.
static void rest(struct scene_gpu *s, struct scene_draw *draw)
{
    struct scene_instance *instance = &s->instances[draw->instance];
    const uint32_t base = draw->push.vertex_base;
    instance->previous_world_from_instance = instance->world_from_instance;
    draw->reshaped = false;
    for (uint32_t v = 0; draw->deformed && v < s->scene->meshes[draw->mesh].vertex_count; v++)
        s->deformed_previous[base + v] = s->deformed_positions[base + v];
}

void scene_gpu_update(struct scene_gpu *s, struct gpu_cmd *cmd, const struct scene_pose *pose,
                      bool reset_motion)
{
    size_t n = (size_t)s->scene->instance_count, v = s->deformed_vertex_count;
    memcpy(s->deformed_previous, s->deformed_positions, v * sizeof *s->deformed_previous);
    for (size_t i = 0; i < n; i++)
        s->instances[i].previous_world_from_instance = s->instances[i].world_from_instance;
    s->moved = s->removed_count > 0 && s->removed_at == s->updates + 1;
    mark_changes(s);
    upload_meshes(s, cmd);
    upload_materials(s, cmd);
    for (int i = 0; i < s->draw_count; i++) {
        struct scene_draw *draw = &s->draws[i];
        const struct box3 before = draw->seen ? draw->bounds : box3_empty();
        update_draw(s, pose, draw);
        draw->swept = box3_union(before, draw->bounds);
        if (!draw->seen) rest(s, draw);
        draw->seen = true;
    }
    s->updates++;
    s->uploaded = s->scene->revisions.newest;
    if (reset_motion || !s->has_previous) {
        s->moved = s->moved || !s->has_previous;
        for (int i = 0; i < s->draw_count; i++) rest(s, &s->draws[i]);
    }
    s->has_previous = true;
    if (n)
        s->instances_binding =
            gpu_transient(cmd, "scene_instances", s->instances, n * sizeof *s->instances);
    upload_deformed(s, cmd);
}

static bool has_changed(const struct scene_draw *draw, bool materials)
{
    if (draw->moved) return true;
    return draw->recolored && (materials || draw->variant & VARIANT_MASKED);
}

bool scene_gpu_unchanged_in(const struct scene_gpu *s, mat4s clip_from_world, bool materials)
{
    for (int i = 0; i < s->removed_count && s->removed_at == s->updates; i++)
        if (projection_may_see(clip_from_world, s->removed[i])) return false;
    for (int i = 0; i < s->draw_count && (s->moved || s->recolored); i++)
        if (has_changed(&s->draws[i], materials) &&
            projection_may_see(clip_from_world, s->draws[i].swept))
            return false;
    return true;
}

bool scene_gpu_unchanged_around(const struct scene_gpu *s, struct box3 box, uint32_t first,
                                uint32_t count)
{
    for (int i = 0; i < s->removed_count && s->removed_at == s->updates; i++)
        if (box3_intersects(box, s->removed[i])) return false;
    for (int i = 0; i < s->draw_count && (s->moved || s->recolored); i++) {
        const struct scene_draw *draw = &s->draws[i];
        if ((uint32_t)draw->instance - first < count) continue;
        if (has_changed(draw, false) && box3_intersects(box, draw->swept)) return false;
    }
    return true;
}

// Maximum of a single dispatch: work group counts and index bytes stay within every device's
// limits.
static const uint32_t RANGE_TRIANGLES = 1u << 21;
// Upper bound of minStorageBufferOffsetAlignment in the specification.
static const size_t MAX_OFFSET_ALIGNMENT = 256;

bool scene_gpu_next_range(const struct scene_gpu *s, const struct scene_draw *draw,
                          struct scene_triangle_range *range)
{
    const uint32_t triangles = s->scene->meshes[draw->mesh].index_count / 3;
    const uint32_t first = range->first_triangle + range->triangle_count;
    if (first >= triangles) return false;
    const uint32_t count =
        triangles - first < RANGE_TRIANGLES ? triangles - first : RANGE_TRIANGLES;
    const size_t begin = s->index_offset[draw->mesh] + (size_t)first * 3 * sizeof(uint32_t);
    const size_t end = begin + (size_t)count * 3 * sizeof(uint32_t);
    const size_t aligned = begin / MAX_OFFSET_ALIGNMENT * MAX_OFFSET_ALIGNMENT;
    *range = (struct scene_triangle_range){
        .first_triangle = first,
        .triangle_count = count,
        .first_index = (uint32_t)((begin - aligned) / sizeof(uint32_t)),
        .indices = { .name = "scene_indices",
                     .buffer = s->indices,
                     .offset = aligned,
                     .bytes = end - aligned },
    };
    return true;
}

// Bindings that every draw and dispatch of the scene may read; returns the count.
enum { SCENE_BINDINGS = 12 };
static int scene_bindings(const struct scene_gpu *s, const struct scene_draw *draw,
                          struct gpu_binding out[SCENE_BINDINGS])
{
    const struct gpu_binding *maps = s->maps[draw->material];
    const struct gpu_binding bindings[SCENE_BINDINGS] = {
        draw->deformed ? s->deformed_positions_binding
                       : (struct gpu_binding){ .name = "scene_positions", .buffer = s->positions },
        draw->deformed ? s->deformed_frames_binding
                       : (struct gpu_binding){ .name = "scene_frames", .buffer = s->frames },
        { .name = "scene_surfaces", .buffer = s->surfaces },
        s->instances_binding,
        draw->deformed ? s->deformed_previous_binding
                       : (struct gpu_binding){ .name = "scene_previous_positions",
                                               .buffer = draw->reshaped ? s->previous_positions
                                                                        : s->positions },
        { .name = "scene_materials", .buffer = s->materials },
        maps[0],
        maps[1],
        maps[2],
        maps[3],
        maps[4],
        maps[5],
    };
    memcpy(out, bindings, sizeof bindings);
    return SCENE_BINDINGS;
}

void scene_gpu_draw(const struct scene_gpu *s, struct gpu_cmd *cmd,
                    const struct scene_draw_call *call)
{
    const struct scene_draw *draw = call->draw;
    struct gpu_binding bindings[SCENE_BINDINGS + 8];
    int count = scene_bindings(s, draw, bindings);
    for (int i = 0; i < call->binding_count; i++) bindings[count++] = call->bindings[i];
    if (call->range) bindings[count++] = call->range->indices;
    memcpy(call->push, &draw->push, sizeof draw->push);
    gpu_draw(cmd, &(struct gpu_draw_desc){
                      .pipeline = call->pipeline,
                      .bindings = bindings,
                      .binding_count = count,
                      .push = call->push,
                      .push_bytes = call->push_bytes,
                      .indices = call->range ? (gpu_buffer){ 0 } : s->indices,
                      .index_offset = s->index_offset[draw->mesh],
                      .count = call->range ? 3 * call->range->triangle_count
                                           : s->scene->meshes[draw->mesh].index_count,
                      .cull = call->cull,
                      .flip_front = draw->mirrored,
                  });
}

void scene_gpu_dispatch(const struct scene_gpu *s, struct gpu_cmd *cmd,
                        const struct scene_dispatch_call *call)
{
    const struct scene_draw *draw = call->draw;
    struct gpu_binding bindings[SCENE_BINDINGS + 8 + 1];
    assert(call->binding_count <= 8);
    int count = scene_bindings(s, draw, bindings);
    for (int i = 0; i < call->binding_count; i++) bindings[count++] = call->bindings[i];
    struct gpu_binding *indices = &bindings[count++];
    for (struct scene_triangle_range range = { 0 }; scene_gpu_next_range(s, draw, &range);) {
        const struct {
            struct scene_push draw;
            uint32_t first_index, triangle_count, mirrored;
        } push = { draw->push, range.first_index, range.triangle_count, draw->mirrored };
        *indices = range.indices;
        if (call->rasterize) {
            gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = call->pipeline,
                                                   .bindings = bindings,
                                                   .binding_count = count,
                                                   .push = &push,
                                                   .push_bytes = sizeof push,
                                                   .count = 3 * range.triangle_count });
            continue;
        }
        if (call->deferred.id) {
            gpu_fill_buffer(cmd, call->deferred_groups, 0, 4 * sizeof(uint32_t), 0);
            gpu_fill_buffer(cmd, call->deferred_groups, sizeof(uint32_t), 2 * sizeof(uint32_t), 1);
        }
        gpu_dispatch(cmd, call->pipeline, bindings, count, &push, sizeof push,
                     gpu_groups(range.triangle_count, SCENE_TRIANGLES_LOCAL), 1, 1);
        if (call->deferred.id)
            gpu_dispatch_indirect(cmd, call->deferred, bindings, count, &push, sizeof push,
                                  call->deferred_groups, 0);
    }
}
