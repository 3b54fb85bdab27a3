// The scene on the GPU follows changes of the scene: what was added, removed or made movable. Parts
// are built beside the present ones and take their place when they are complete.
#include "frame/scene/scene_gpu_build.h"

#include <string.h>

// ---- Meshes, materials, images ------------------------------------------------------------------

static bool follow_streams(struct scene_gpu *s)
{
    struct scene_gpu made = { .host = s->host, .gpu = s->gpu, .scene = s->scene };
    if (!scene_gpu_make_streams(&made) || !scene_gpu_make_materials(&made)) {
        scene_gpu_finish_streams(&made);
        return false;
    }
    scene_gpu_finish_streams(s);
    s->positions = made.positions;
    s->frames = made.frames;
    s->surfaces = made.surfaces;
    s->indices = made.indices;
    s->materials = made.materials;
    s->index_offset = made.index_offset;
    return true;
}

static bool follow_resources(struct scene_gpu *s)
{
    const uint64_t now = s->scene->revisions.resources;
    if (s->followed.resources == now) return true;
    if (!scene_gpu_make_textures(s) || !follow_streams(s)) return false;
    s->followed.resources = now;
    return true;
}

// ---- Draws --------------------------------------------------------------------------------------

static void carry_deformed(const struct scene_gpu *old, const struct scene_draw *from,
                           struct scene_gpu *made, const struct scene_draw *to)
{
    const size_t bytes = made->scene->meshes[to->mesh].vertex_count * sizeof(vec3s);
    memcpy(&made->deformed_positions[to->push.vertex_base],
           &old->deformed_positions[from->push.vertex_base], bytes);
}

// A draw that was there before keeps its state.
static void carry(const struct scene_gpu *old, const struct scene_draw *from,
                  struct scene_gpu *made, struct scene_draw *to)
{
    const bool seen_moving = from->dynamic && !from->movable;
    if (seen_moving && !to->dynamic) made->dynamic_count++;
    to->dynamic = to->dynamic || seen_moving;
    to->bounds = from->bounds;
    to->seen = from->seen;
    made->instances[to->instance] = old->instances[from->instance];
    if (to->deformed) carry_deformed(old, from, made, to);
}

// Indices into draws by instance, -1: none.
static int *draws_by_instance(const struct scene_gpu *s, size_t count)
{
    int *out = host_alloc(s->host, count, sizeof *out);
    for (size_t i = 0; out && i < count; i++) out[i] = -1;
    for (int i = 0; out && i < s->draw_count; i++) out[s->draws[i].instance] = i;
    return out;
}

static void carry_draws(const struct scene_gpu *old, struct scene_gpu *made, int *old_of)
{
    for (int i = 0; i < made->draw_count; i++) {
        struct scene_draw *draw = &made->draws[i];
        const int at = old_of[draw->instance];
        const struct scene_draw *from = at < 0 ? NULL : &old->draws[at];
        const bool stays = from && from->added == draw->added;
        if (stays) carry(old, from, made, draw);
        if (stays ? from->dynamic != draw->dynamic : !draw->dynamic) made->static_set++;
        if (stays) old_of[draw->instance] = -1;
    }
}

// Those that no frame was without yet stay in the list.
static bool list_removed(const struct scene_gpu *old, struct scene_gpu *made, const int *old_of)
{
    const int waiting = old->removed_at == old->updates + 1 ? old->removed_count : 0;
    const size_t most = (size_t)old->draw_count + (size_t)waiting;
    made->removed_at = old->updates + 1;
    made->removed = host_alloc(old->host, most, sizeof *made->removed);
    if (!made->removed) return false;
    for (int i = 0; i < waiting; i++) made->removed[made->removed_count++] = old->removed[i];
    for (int i = 0; i < old->draw_count; i++) {
        const struct scene_draw *draw = &old->draws[i];
        if (old_of[draw->instance] != i) continue;
        made->static_set += !draw->dynamic;
        if (draw->seen) made->removed[made->removed_count++] = draw->bounds;
    }
    return true;
}

static bool follow_draws(struct scene_gpu *s)
{
    const uint64_t now = s->scene->revisions.instances;
    if (s->followed.instances == now) return true;
    struct scene_gpu made = {
        .host = s->host, .gpu = s->gpu, .scene = s->scene, .static_set = s->static_set
    };
    int *old_of = draws_by_instance(s, (size_t)s->scene->instance_count);
    bool ok = old_of && scene_gpu_make_draws(&made);
    if (ok) carry_draws(s, &made, old_of);
    ok = ok && list_removed(s, &made, old_of);
    host_free(s->host, old_of);
    scene_gpu_finish_draws(ok ? s : &made);
    if (!ok) return false;
    s->draws = made.draws;
    s->draw_count = made.draw_count;
    s->variants_used |= made.variants_used;
    s->instances = made.instances;
    s->deformed_vertex_count = made.deformed_vertex_count;
    s->deformed_positions = made.deformed_positions;
    s->deformed_previous = made.deformed_previous;
    s->deformed_frames = made.deformed_frames;
    s->dynamic_count = made.dynamic_count;
    s->static_set = made.static_set;
    s->removed = made.removed;
    s->removed_count = made.removed_count;
    s->removed_at = made.removed_at;
    s->draw_list++;
    s->followed.instances = now;
    return true;
}

// ---- Vertices -----------------------------------------------------------------------------------

static bool make_packed(struct scene_gpu *s, uint32_t count)
{
    size_t bytes;
    if (s->packed && s->packed->capacity >= count) return true;
    if (!size_mul(count, sizeof s->packed->frames[0], &bytes)) return false;
    host_free(s->host, s->packed);
    s->packed = host_alloc(s->host, 1, sizeof *s->packed + bytes);
    if (s->packed) s->packed->capacity = count;
    return s->packed != NULL;
}

static bool follow_vertices(struct scene_gpu *s)
{
    uint32_t most = 0;
    if (s->scene->revisions.vertices <= s->uploaded) return true;
    for (int m = 0; m < s->scene->mesh_count; m++) {
        const struct mesh *mesh = &s->scene->meshes[m];
        if (mesh->revision > s->uploaded && mesh->vertex_count > most) most = mesh->vertex_count;
    }
    const struct gpu_buffer_desc desc = { .name = "scene.previous_positions",
                                          .bytes = gpu_buffer_bytes(s->gpu, s->positions),
                                          .usage = GPU_BUFFER_STORAGE };
    return make_packed(s, most) &&
           (s->previous_positions.id || gpu_buffer_create(s->gpu, &desc, &s->previous_positions));
}

bool scene_gpu_follow(struct scene_gpu *s)
{
    const float strongest = s->max_emissive;
    if (s->scene->revisions.newest == s->uploaded) return true;
    if (!follow_resources(s) || !follow_draws(s) || !follow_vertices(s)) return false;
    scene_gpu_summarize_materials(s);
    // Techniques store emission relative to the strongest.
    if (s->max_emissive != strongest) s->static_set++;
    return true;
}
