// Self-transfer in an object's own pixels (Giuffrida 2016, appendix B.3), from points on its
// triangles, which pixels find by FRAME_ID.
#include "techniques/dnrt/dnrt_state.h"

#include "techniques/dnrt/dnrt_part.h"
#include "techniques/dnrt/dnrt_tensors.h"

#include <string.h>

// ---- from a bake, which is untrusted

struct part_of_bake {
    const float *corners;
    const uint32_t *patches; // [count][2]
    const uint16_t *self;
    uint64_t count, points;
};

// The tensor has this shape but for its first axis. An object without triangles has no tensors.
static bool find_tensor(struct dnrt *s, const struct tensors *bake, const char *format, int volume,
                        enum tensor_type type, int rank, uint64_t shape[3], const void **out)
{
    char name[DNRT_NAME_SIZE];
    dnrt_tensor_name(format, s->keys[volume], name);
    const struct tensor *tensor = tensors_find(bake, name);
    if (tensor) shape[0] = tensor->shape[0];
    *out = tensors_expect(s->host, bake, name, type, rank, shape);
    return *out != NULL;
}

static bool find_part(struct dnrt *s, const struct tensors *bake, int volume,
                      struct part_of_bake *out)
{
    const uint64_t coefficients = (uint64_t)dnrt_coefficients(&s->options);
    uint64_t corners[] = { 0, 3, 3 }, patches[] = { 0, 2, 0 }, self[] = { 0, coefficients, 4 };
    const void *data[3];
    *out = (struct part_of_bake){ .count = 0 };
    if (!(s->volumes[volume].radius > 0.0f)) return true;
    if (!find_tensor(s, bake, DNRT_CORNERS, volume, TENSOR_F32, 3, corners, &data[0]) ||
        !find_tensor(s, bake, DNRT_PATCHES, volume, TENSOR_U32, 2, patches, &data[1]) ||
        !find_tensor(s, bake, DNRT_SELF, volume, TENSOR_F16, 3, self, &data[2]))
        return false;
    *out = (struct part_of_bake){ data[0], data[1], data[2], corners[0], self[0] };
    bool ok = patches[0] == corners[0];
    for (uint64_t i = 0; i < out->count && ok; i++) {
        const uint64_t first = out->patches[2 * i], grid = out->patches[2 * i + 1];
        const uint64_t n = grid & DNRT_PATCH_STEPS;
        const uint64_t points = (n + 1) * (n + 2) / (grid & DNRT_PATCH_TWO_SIDES ? 1 : 2);
        ok = n > 0 && first + points <= out->points;
    }
    return ok || host_fail(s->host, FAIL_FORMAT,
                           "bake of dnrt: a triangle of volume %d has no points", volume);
}

static bool make(struct dnrt *s, const char *name, const void *items, size_t bytes, gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { name, bytes, GPU_BUFFER_STORAGE };
    const uint64_t most = gpu_limits(s->gpu)->max_storage_bytes;
    if (bytes > most)
        return host_fail(s->host, FAIL_UNSUPPORTED,
                         "dnrt: self-transfer has %.0f MB, above the limit of %s, %.0f MB: give "
                         "dnrt:self=false, or fewer dnrt:keys",
                         (double)bytes * 1e-6, gpu_info(s->gpu)->name, (double)most * 1e-6);
    return gpu_buffer_create(s->gpu, &desc, out) &&
           gpu_buffer_upload(s->gpu, *out, 0, items, bytes);
}

static void copy_patches(const struct part_of_bake *from, uint64_t first_point,
                         struct dnrt_gpu_patch *to)
{
    for (uint64_t i = 0; i < from->count; i++) {
        memcpy(to[i].corner, from->corners + 9 * i, sizeof to[i].corner);
        to[i].first = (uint32_t)(first_point + from->patches[2 * i]);
        to[i].grid = from->patches[2 * i + 1];
    }
}

static bool make_buffers(struct dnrt *s, const struct part_of_bake *parts, uint64_t count,
                         uint64_t points)
{
    const size_t point = (size_t)dnrt_coefficients(&s->options) * 4 * sizeof(uint16_t);
    struct dnrt_gpu_patch *patches = host_alloc(s->host, (size_t)count, sizeof *patches);
    uint8_t *self = host_alloc(s->host, (size_t)points, point);
    uint64_t first = 0, first_point = 0;
    bool ok = patches && self;
    for (int v = 0; v < s->baked.volume_count && ok; v++) {
        copy_patches(&parts[v], first_point, patches + first);
        if (parts[v].points > 0)
            memcpy(self + (size_t)first_point * point, parts[v].self,
                   (size_t)parts[v].points * point);
        s->patches[v] = (struct dnrt_patch_range){ (uint32_t)first, (uint32_t)parts[v].count };
        first += parts[v].count;
        first_point += parts[v].points;
    }
    ok = ok && make(s, "patches", patches, (size_t)count * sizeof *patches, &s->patch_buffer) &&
         make(s, "points", self, (size_t)points * point, &s->point_buffer);
    host_free(s->host, patches);
    host_free(s->host, self);
    return ok;
}

bool dnrt_upload_self(struct dnrt *s, const struct tensors *bake)
{
    const size_t volumes = (size_t)s->baked.volume_count;
    struct part_of_bake *parts = host_alloc(s->host, volumes, sizeof *parts);
    uint64_t count = 0, points = 0;
    s->patches = host_alloc(s->host, volumes, sizeof *s->patches);
    bool ok = parts && s->patches;
    for (size_t v = 0; v < volumes && ok; v++) {
        ok = find_part(s, bake, (int)v, &parts[v]);
        count += parts[v].count;
        points += parts[v].points;
    }
    if (ok && count > 0) ok = make_buffers(s, parts, count, points);
    host_free(s->host, parts);
    return ok;
}

// ---- frames

bool dnrt_make_own(struct dnrt *s, const struct scene *scene)
{
    const size_t count = (size_t)scene->instance_count;
    if (!s->options.self) return true;
    host_free(s->host, s->own);
    s->own_count = 0;
    s->own = host_alloc(s->host, count, sizeof *s->own);
    if (!s->own) return false;
    s->own_count = (uint32_t)count;
    return true;
}

static void place_own(struct dnrt *s, const struct scene *scene, int object)
{
    const struct dnrt_gpu_object *now = &s->gpu_objects[object];
    const struct dnrt_object *of = &s->objects.at[object];
    if (now->shape < 0) return;
    const struct dnrt_patch_range first = s->patches[now->shape], next = s->patches[now->next];
    const float radius = s->volumes[now->shape].radius +
                         now->part * (s->volumes[now->next].radius - s->volumes[now->shape].radius);
    uint32_t before = 0;
    for (int i = 0; i < of->count; i++) {
        const int instance = s->objects.instances[of->first + i];
        const uint32_t triangles = scene_mesh_of(scene, instance)->index_count / 3;
        if ((uint32_t)instance < s->own_count && before + triangles <= first.count &&
            before + triangles <= next.count)
            s->own[instance] =
                (struct dnrt_own_instance){ object, first.first + before, next.first + before,
                                            triangles, now->half_m / (s->options.reach * radius) };
        before += triangles;
    }
}

void dnrt_place_own(struct dnrt *s, const struct scene *scene)
{
    if (s->patch_buffer.id == 0) return;
    for (uint32_t i = 0; i < s->own_count; i++)
        s->own[i] = (struct dnrt_own_instance){ .object = -1 };
    for (int i = 0; i < s->objects.count; i++) place_own(s, scene, i);
}

void dnrt_record_self(const struct dnrt *s, struct gpu_cmd *cmd, const struct frame_view *view,
                      struct gpu_binding objects, struct gpu_binding tiles,
                      const struct dnrt_self_push *push, uint32_t tile_count)
{
    if (s->patch_buffer.id == 0 || view->layers[FRAME_ID].id == 0) return;
    gpu_scope_begin(cmd, "self");
    gpu_dispatch(cmd, s->self_pipeline,
                 GPU_BIND(view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "id", .image = view->layers[FRAME_ID] }, objects, tiles,
                          gpu_transient(cmd, "dnrt_own", s->own, s->own_count * sizeof *s->own),
                          { .name = "dnrt_patches", .buffer = s->patch_buffer },
                          { .name = "dnrt_points", .buffer = s->point_buffer },
                          { .name = "dnrt_light", .buffer = s->light },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] }),
                 push, sizeof *push, tile_count, 1, 1);
    gpu_scope_end(cmd);
}
