// From a bake, which is untrusted, to buffers on the GPU.
#include "techniques/dnrt/dnrt_state.h"

#include "techniques/dnrt/dnrt_tensors.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 32 };

struct content {
    struct dnrt_gpu_shape *shapes;
    uint8_t *samples;
    size_t shape_bytes; // of the samples of one
};

static const void *expect(struct dnrt *s, const struct tensors *bake, const char *format, int shape,
                          enum tensor_type type, int rank, const uint64_t *extent)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, format, shape);
    return tensors_expect(s->host, bake, name, type, rank, extent);
}

static bool take_sphere(struct dnrt *s, int shape, const float *sphere)
{
    s->volumes[shape] = (struct dnrt_volume){ vec3_of(sphere[0], sphere[1], sphere[2]), sphere[3] };
    if (sphere[3] >= 0.0f) return true;
    return host_fail(s->host, FAIL_FORMAT, "bake of dnrt: the radius of shape %d is negative",
                     shape);
}

static bool take_shape(struct dnrt *s, const struct tensors *bake, int shape, struct content *out)
{
    const uint64_t n = (uint64_t)dnrt_size(&s->options),
                   c = (uint64_t)dnrt_coefficients(&s->options);
    const bool half = s->options.bits == DNRT_BITS_16;
    const float *sphere = expect(s, bake, DNRT_SPHERE, shape, TENSOR_F32, 1, (uint64_t[]){ 4 });
    const float *scale = expect(s, bake, DNRT_SCALE, shape, TENSOR_F32, 2, (uint64_t[]){ c, 3 });
    const void *volume = expect(s, bake, DNRT_VOLUME, shape, half ? TENSOR_F16 : TENSOR_U8, 5,
                                (uint64_t[]){ c, 3, n, n, n });
    if (!sphere || !scale || !volume || !take_sphere(s, shape, sphere)) return false;
    struct dnrt_gpu_shape *to = &out->shapes[shape];
    to->first_word = (uint32_t)((size_t)shape * out->shape_bytes / 4);
    memcpy(to->scale, scale, 3 * (size_t)c * sizeof *scale);
    memcpy(out->samples + (size_t)shape * out->shape_bytes, volume, out->shape_bytes);
    return true;
}

static bool make(struct dnrt *s, const char *name, const void *items, size_t bytes, gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { name, bytes, GPU_BUFFER_STORAGE };
    return gpu_buffer_create(s->gpu, &desc, out) &&
           gpu_buffer_upload(s->gpu, *out, 0, items, bytes);
}

static bool take_shapes(struct dnrt *s, const struct tensors *bake, struct content *content)
{
    const size_t count = (size_t)s->baked.shape_count;
    if (!content->shapes || !content->samples) return false;
    for (int i = 0; i < s->baked.shape_count; i++)
        if (!take_shape(s, bake, i, content)) return false;
    return make(s, "shapes", content->shapes, count * sizeof *content->shapes, &s->shapes) &&
           make(s, "samples", content->samples, count * content->shape_bytes, &s->samples);
}

static bool fits(struct dnrt *s, size_t bytes)
{
    const uint64_t most = gpu_limits(s->gpu)->max_storage_bytes;
    if (bytes <= most) return true;
    return host_fail(s->host, FAIL_UNSUPPORTED,
                     "dnrt: volumes of %d objects have %.0f MB, above the limit of %s, %.0f MB: "
                     "give dnrt:size=16 or dnrt:bits=8",
                     s->baked.shape_count, (double)bytes * 1e-6, gpu_info(s->gpu)->name,
                     (double)most * 1e-6);
}

bool dnrt_upload(struct dnrt *s, const struct tensors *bake)
{
    const size_t n = (size_t)dnrt_size(&s->options), count = (size_t)s->baked.shape_count;
    struct content content = { .shape_bytes = 3 * (size_t)dnrt_coefficients(&s->options) * n * n *
                                              n * (s->options.bits == DNRT_BITS_16 ? 2 : 1) };
    if (!fits(s, count * content.shape_bytes)) return false;
    content.shapes = host_alloc(s->host, count, sizeof *content.shapes);
    content.samples = host_alloc(s->host, count, content.shape_bytes);
    const bool ok = take_shapes(s, bake, &content);
    host_free(s->host, content.shapes);
    host_free(s->host, content.samples);
    return ok;
}
