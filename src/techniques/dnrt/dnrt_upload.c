// From a bake, which is untrusted, to buffers on the GPU.
#include "techniques/dnrt/dnrt_state.h"

#include "techniques/dnrt/dnrt_part.h"
#include "techniques/dnrt/dnrt_tensors.h"

#include "scene/limits.h"

#include <math.h>
#include <string.h>

struct content {
    struct dnrt_gpu_shape *shapes;
    uint8_t *samples;
    size_t shape_bytes; // of the samples of one and a normal
};

static const void *expect(struct dnrt *s, const struct tensors *bake, const char *format, int shape,
                          enum tensor_type type, int rank, const uint64_t *extent)
{
    char name[DNRT_NAME_SIZE];
    dnrt_tensor_name(format, s->keys[shape], name);
    return tensors_expect(s->host, bake, name, type, rank, extent);
}

// The geometry of the scene is within its limits: so are bounds of it.
static bool is_near(const struct dnrt_volume *volume, const struct dnrt_frame *frame)
{
    const mat4s world_from_object = dnrt_world_from_object(frame);
    const vec3s half = glms_vec3_scale(volume->box_half, frame->scale);
    return limits_position(mat4_point(world_from_object, volume->centre)) &&
           limits_position(mat4_point(world_from_object, volume->box_centre)) &&
           limits_position(half) && volume->radius * frame->scale <= SCENE_MAX_DISTANCE_M;
}

static bool read_bounds(struct dnrt *s, int index, const float *sphere, const float *box)
{
    const struct dnrt_volume volume = { vec3_of(sphere[0], sphere[1], sphere[2]), sphere[3],
                                        vec3_of(box[0], box[1], box[2]),
                                        vec3_of(box[3], box[4], box[5]) };
    const char *fault = NULL;
    s->volumes[index] = volume;
    if (!(volume.radius >= 0.0f)) fault = "radius is negative";
    for (int i = 0; i < 3; i++)
        if (!(volume.box_half.raw[i] >= 0.0f)) fault = "box has a negative edge";
    if (!is_near(&volume, &s->frames[dnrt_shape_of_volume(&s->baked, index)]))
        fault = "bounds reach beyond the limits of a scene";
    return !fault || host_fail(s->host, FAIL_FORMAT, "bake of dnrt: shape %d: its %s; bake again",
                               index, fault);
}

static size_t planes_of(const struct dnrt_options *options)
{
    return (size_t)dnrt_planes(options) * (size_t)dnrt_coefficients(options);
}

static bool read_shape(struct dnrt *s, const struct tensors *bake, int shape, struct content *out)
{
    const uint64_t n = (uint64_t)dnrt_size(&s->options),
                   c = (uint64_t)dnrt_coefficients(&s->options),
                   normals = (uint64_t)dnrt_normals(&s->options),
                   of_coefficient = (uint64_t)dnrt_planes(&s->options);
    const enum tensor_type type = s->options.bits == DNRT_BITS_16 ? TENSOR_F16 : TENSOR_U8;
    const float *sphere = expect(s, bake, DNRT_SPHERE, shape, TENSOR_F32, 1, (uint64_t[]){ 4 });
    const float *box = expect(s, bake, DNRT_BOX, shape, TENSOR_F32, 2, (uint64_t[]){ 2, 3 });
    const float *scale = expect(s, bake, DNRT_SCALE, shape, TENSOR_F32, 3,
                                (uint64_t[]){ normals, c, of_coefficient });
    const uint8_t *volume = expect(s, bake, DNRT_VOLUME, shape, type, 6,
                                   (uint64_t[]){ normals, c, of_coefficient, n, n, n });
    if (!sphere || !box || !scale || !volume || !read_bounds(s, shape, sphere, box)) return false;
    const size_t first = (size_t)shape * normals, planes = planes_of(&s->options);
    for (size_t i = 0; i < normals; i++) {
        struct dnrt_gpu_shape *to = &out->shapes[first + i];
        to->first_word = (uint32_t)((first + i) * out->shape_bytes / 4);
        memcpy(to->scale, scale + planes * i, planes * sizeof *scale);
    }
    memcpy(out->samples + first * out->shape_bytes, volume, normals * out->shape_bytes);
    return true;
}

static bool make(struct dnrt *s, const char *name, const void *items, size_t bytes, gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { name, bytes, GPU_BUFFER_STORAGE };
    return gpu_buffer_create(s->gpu, &desc, out) &&
           gpu_buffer_upload(s->gpu, *out, 0, items, bytes);
}

static bool read_shapes(struct dnrt *s, const struct tensors *bake, struct content *content)
{
    const size_t count = (size_t)s->baked.volume_count * (size_t)dnrt_normals(&s->options);
    if (!content->shapes || !content->samples) return false;
    for (int i = 0; i < s->baked.volume_count; i++)
        if (!read_shape(s, bake, i, content)) return false;
    return make(s, "shapes", content->shapes, count * sizeof *content->shapes, &s->shapes) &&
           make(s, "samples", content->samples, count * content->shape_bytes, &s->samples);
}

static bool fits(struct dnrt *s, size_t bytes)
{
    const uint64_t most = gpu_limits(s->gpu)->max_storage_bytes;
    if (bytes <= most) return true;
    return host_fail(s->host, FAIL_UNSUPPORTED,
                     "dnrt: %d volumes have %.0f MB, above the limit of %s, %.0f MB: "
                     "give dnrt:size=16, dnrt:bits=8, or fewer dnrt:normals or dnrt:keys",
                     s->baked.volume_count, (double)bytes * 1e-6, gpu_info(s->gpu)->name,
                     (double)most * 1e-6);
}

// The number of workgroups for each object does not change.
static bool upload_changed(struct dnrt *s)
{
    enum { SAMPLES = 4 }; // of an invocation
    const uint32_t n = (uint32_t)dnrt_size(&s->options);
    const struct dnrt_changed changed = { .groups_x = gpu_groups(n * n * n / SAMPLES, DNRT_LOCAL),
                                          .groups_z = 1 };
    s->stale = true;
    return gpu_buffer_upload(s->gpu, s->changed, 0, &changed, sizeof changed);
}

bool dnrt_upload(struct dnrt *s, const struct tensors *bake)
{
    const size_t n = (size_t)dnrt_size(&s->options);
    const size_t count = (size_t)s->baked.volume_count * (size_t)dnrt_normals(&s->options);
    struct content content = { .shape_bytes = planes_of(&s->options) * n * n * n *
                                              (s->options.bits == DNRT_BITS_16 ? 2 : 1) };
    if (!fits(s, count * content.shape_bytes)) return false;
    content.shapes = host_alloc(s->host, count, sizeof *content.shapes);
    content.samples = host_alloc(s->host, count, content.shape_bytes);
    const bool ok = read_shapes(s, bake, &content) && upload_changed(s) &&
                    (!s->options.self || dnrt_upload_self(s, bake));
    host_free(s->host, content.shapes);
    host_free(s->host, content.samples);
    return ok;
}
