// What voxel cone tracing keeps on the GPU: sizes, buffers, images, and their bytes before they
// are there.
#include "techniques/vct/vct_state.h"

#include <string.h>

// ---- Sizes --------------------------------------------------------------------------------------

int vct_clip_count(const struct vct_options *options)
{
    return options->levels;
}

static uint32_t voxel_count(const struct vct_options *options)
{
    const uint32_t dim = (uint32_t)options->resolution;
    return dim * dim * dim;
}

// A scene's surfaces fill some multiple of the squares that the grid's faces are: 6 for an empty
// room. 20 of them leave room for much furniture.
uint32_t vct_capacity(const struct vct_options *options)
{
    const uint32_t dim = (uint32_t)options->resolution, most = 20 * dim * dim;
    return most < voxel_count(options) ? most : voxel_count(options);
}

uint32_t vct_volume_dim(const struct vct_options *options)
{
    return (uint32_t)options->resolution / 2;
}

// Down to texels of which no side of the volume has more than a few, and as long as sides can be
// halved.
uint32_t vct_volume_mips(const struct vct_options *options)
{
    uint32_t mips = 1;
    for (uint32_t dim = vct_volume_dim(options); dim % 2 == 0 && dim > 2; dim /= 2) mips++;
    return mips;
}

uint32_t vct_step(const struct vct_options *options)
{
    return options->half ? 2 : 1;
}

uint32_t vct_ways(const struct vct_options *options)
{
    return options->anisotropic ? 6 : 1;
}

static size_t mask_words(const struct vct_options *options)
{
    return voxel_count(options) / 32;
}

static size_t block_count(const struct vct_options *options)
{
    return (mask_words(options) + VCT_BLOCK_WORDS - 1) / VCT_BLOCK_WORDS;
}

struct buffer_plan {
    const char *name;
    gpu_buffer *out;
    size_t words;
    uint32_t usage;
};

enum { SET_BUFFERS = 8 };

static void plan_set(const struct vct_options *options, bool moving, struct vct_set *set,
                     struct buffer_plan out[SET_BUFFERS])
{
    const size_t capacity = vct_capacity(options);
#define NAME(thing) (moving ? "moving_" thing : "rest_" thing)
    const struct buffer_plan plan[SET_BUFFERS] = {
        { NAME("mask"), &set->mask, mask_words(options), 0 },
        { NAME("before"), &set->before, mask_words(options), 0 },
        { NAME("blocks"), &set->blocks, block_count(options), 0 },
        { NAME("list"), &set->list, capacity, 0 },
        { NAME("again"), &set->again, mask_words(options), 0 },
        { NAME("again_list"), &set->again_list, capacity, 0 },
        { NAME("sums"), &set->sums, capacity * VCT_SUM_WORDS, 0 },
        { NAME("arguments"), &set->arguments, sizeof(struct vct_voxel_counts) / sizeof(uint32_t),
          GPU_BUFFER_INDIRECT },
    };
#undef NAME
    memcpy(out, plan, sizeof plan);
}

enum {
    SVO_BUFFERS = 4,
    CLIP_BUFFERS = 2 * SET_BUFFERS + 3,
    MOST_BUFFERS = VCT_MAX_CLIPS * CLIP_BUFFERS + 2 + SVO_BUFFERS
};

static void plan_clip(const struct vct_options *options, struct vct_clip *clip,
                      struct buffer_plan out[CLIP_BUFFERS])
{
    const struct buffer_plan lists[] = {
        { "texels", &clip->texels, vct_texel_words(options), 0 },
        { "texel_mask", &clip->texel_mask, vct_texel_mask_words(options), 0 },
        { "texel_state", &clip->texel_state, sizeof(struct vct_texel_levels) / sizeof(uint32_t),
          GPU_BUFFER_INDIRECT },
    };
    plan_set(options, false, &clip->rest, out);
    plan_set(options, true, &clip->moving, out + SET_BUFFERS);
    memcpy(out + 2 * SET_BUFFERS, lists, sizeof lists);
}

static void plan_svo(const struct vct_options *options, struct vct_svo *svo,
                     struct buffer_plan out[SVO_BUFFERS])
{
    const struct vct_svo_params params = vct_svo_params(options);
    const size_t nodes = vct_svo_nodes(options);
    const struct buffer_plan plan[SVO_BUFFERS] = {
        { "svo_nodes", &svo->nodes, nodes, 0 },
        { "svo_places", &svo->places, params.bricks, 0 },
        { "svo_blocks", &svo->blocks, (nodes + VCT_SVO_BLOCK - 1) / VCT_SVO_BLOCK, 0 },
        { "svo_levels", &svo->levels,
          params.depths * sizeof(struct vct_svo_level) / sizeof(uint32_t), GPU_BUFFER_INDIRECT },
    };
    memcpy(out, plan, sizeof plan);
}

// Returns how many.
static int plan_buffers(const struct vct_options *options, struct vct *vct,
                        struct buffer_plan out[MOST_BUFFERS])
{
    int count = 0;
    for (int i = 0; i < vct_clip_count(options); i++, count += CLIP_BUFFERS)
        plan_clip(options, &vct->clips[i], out + count);
    const struct buffer_plan queue[] = {
        { "queue", &vct->queue, 2 * (size_t)VCT_QUEUE, 0 },
        { "queue_state", &vct->queue_state, 4, GPU_BUFFER_INDIRECT },
    };
    memcpy(out + count, queue, sizeof queue);
    count += 2;
    if (!vct_has_svo(options)) return count;
    plan_svo(options, &vct->svo, out + count);
    return count + SVO_BUFFERS;
}

struct gpu_image_desc vct_light_desc(const struct vct_options *options)
{
    if (vct_has_svo(options)) return vct_svo_pool(options);
    const uint32_t dim = vct_volume_dim(options);
    return (struct gpu_image_desc){ .name = "light",
                                    .dimension = GPU_3D,
                                    .format = options->occlusion ? GPU_R16F : GPU_RGBA16F,
                                    .width = vct_ways(options) * dim,
                                    .height = dim,
                                    .depth = (uint32_t)vct_clip_count(options) * dim,
                                    .mips = vct_volume_mips(options),
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

// What is kept of a set's voxels in images: so many texels for each.
struct image_plan {
    const char *name;
    gpu_image *out;
    uint32_t texels;
};

enum { CLIP_IMAGES = 6 };

static void plan_images(struct vct_clip *clip, struct image_plan out[CLIP_IMAGES])
{
    const struct image_plan plan[CLIP_IMAGES] = {
        { "rest_surfaces", &clip->rest.surfaces, 2 },
        { "rest_records", &clip->rest.records, 2 },
        { "rest_brought", &clip->rest.brought, 1 },
        { "moving_surfaces", &clip->moving.surfaces, 2 },
        { "moving_records", &clip->moving.records, 2 },
        { "moving_brought", &clip->moving.brought, 1 },
    };
    memcpy(out, plan, sizeof plan);
}

static struct gpu_image_desc image_desc(const struct vct_options *options,
                                        const struct image_plan *plan)
{
    // Without light there is none that voxels could bring to each other.
    const bool none = options->occlusion && plan->texels == 1;
    const uint32_t rows = gpu_groups(vct_capacity(options), VCT_RECORD_ROW);
    return (struct gpu_image_desc){ .name = plan->name,
                                    .format = GPU_RGBA32U,
                                    .width = plan->texels * VCT_RECORD_ROW,
                                    .height = none ? 1 : rows,
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

// ---- Images and buffers -------------------------------------------------------------------------

static bool create_image_2d(struct vct *vct, const char *name, enum gpu_format format,
                            gpu_image *out)
{
    const struct gpu_image_desc desc = { .name = name,
                                         .format = format,
                                         .width = vct->width,
                                         .height = vct->height,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return vct_create_image(vct->name, vct->gpu, desc, out);
}

static bool create_vectors(struct vct *vct, const char *name, gpu_image out[3])
{
    for (int i = 0; i < 3; i++)
        if (!create_image_2d(vct, name, GPU_RGBA16F, &out[i])) return false;
    return true;
}

bool vct_create_images(struct vct *vct, uint32_t width, uint32_t height)
{
    vct->width = gpu_groups(width, vct_step(&vct->options));
    vct->height = gpu_groups(height, vct_step(&vct->options));
    return create_image_2d(vct, "edges", GPU_R8, &vct->edge_image) &&
           create_image_2d(vct, "start", GPU_RG16F, &vct->start_image) &&
           create_image_2d(vct, "found", GPU_RGBA16F, &vct->found) &&
           create_vectors(vct, "traced", vct->traced) &&
           create_vectors(vct, "gathered", vct->gathered);
}

static bool create_voxel_images(struct vct *vct, struct vct_clip *clip)
{
    struct image_plan plan[CLIP_IMAGES];
    plan_images(clip, plan);
    for (int i = 0; i < CLIP_IMAGES; i++)
        if (!vct_create_image(vct->name, vct->gpu, image_desc(&vct->options, &plan[i]),
                              plan[i].out))
            return false;
    return true;
}

bool vct_create_resources(struct vct *vct)
{
    struct buffer_plan plan[MOST_BUFFERS];
    const int count = plan_buffers(&vct->options, vct, plan);
    for (int i = 0; i < count; i++) {
        char name[VCT_NAME_SIZE];
        const struct gpu_buffer_desc desc = { .name = vct_name(vct->name, plan[i].name, name),
                                              .bytes = plan[i].words * sizeof(uint32_t),
                                              .usage = GPU_BUFFER_STORAGE | plan[i].usage };
        if (!gpu_buffer_create(vct->gpu, &desc, plan[i].out)) return false;
    }
    vct->svo.params = vct_svo_params(&vct->options);
    const struct gpu_sampler_desc linear = { .name = "vct.linear",
                                             .filter = GPU_LINEAR,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    for (int i = 0; i < vct->clip_count; i++)
        if (!create_voxel_images(vct, &vct->clips[i])) return false;
    return gpu_sampler_get(vct->gpu, &linear, &vct->linear) &&
           vct_create_image(vct->name, vct->gpu, vct_light_desc(&vct->options), &vct->light);
}

// ---- End and bytes ------------------------------------------------------------------------------

void vct_destroy_resources(struct vct *vct)
{
    struct buffer_plan buffers[MOST_BUFFERS];
    const int count = plan_buffers(&vct->options, vct, buffers);
    for (int i = 0; i < count; i++) gpu_buffer_destroy(vct->gpu, buffers[i].out);
    gpu_image_destroy(vct->gpu, &vct->light);
    for (int i = 0; i < vct->clip_count; i++) {
        struct image_plan images[CLIP_IMAGES];
        plan_images(&vct->clips[i], images);
        for (int k = 0; k < CLIP_IMAGES; k++) gpu_image_destroy(vct->gpu, images[k].out);
    }
    gpu_image_destroy(vct->gpu, &vct->edge_image);
    gpu_image_destroy(vct->gpu, &vct->start_image);
    gpu_image_destroy(vct->gpu, &vct->found);
    for (int i = 0; i < 3; i++) {
        gpu_image_destroy(vct->gpu, &vct->traced[i]);
        gpu_image_destroy(vct->gpu, &vct->gathered[i]);
    }
}

uint64_t vct_resource_bytes(const struct vct_options *options, uint32_t width, uint32_t height)
{
    struct vct none = { 0 };
    struct buffer_plan plan[MOST_BUFFERS];
    const int count = plan_buffers(options, &none, plan);
    uint64_t bytes = 0;
    for (int i = 0; i < count; i++) bytes += plan[i].words * sizeof(uint32_t);
    const struct gpu_image_desc light = vct_light_desc(options);
    for (uint32_t mip = 0; mip < light.mips; mip++)
        bytes += (uint64_t)(light.width >> mip) * (light.height >> mip) * (light.depth >> mip) *
                 (uint64_t)gpu_format_bytes(light.format);
    struct image_plan images[CLIP_IMAGES];
    plan_images(&none.clips[0], images);
    for (int i = 0; i < CLIP_IMAGES; i++) {
        const struct gpu_image_desc desc = image_desc(options, &images[i]);
        bytes += (uint64_t)vct_clip_count(options) * desc.width * desc.height *
                 (uint64_t)gpu_format_bytes(GPU_RGBA32U);
    }
    const int pixel =
        gpu_format_bytes(GPU_R8) + gpu_format_bytes(GPU_RG16F) + 7 * gpu_format_bytes(GPU_RGBA16F);
    const uint32_t step = vct_step(options);
    return bytes + (uint64_t)gpu_groups(width, step) * gpu_groups(height, step) * (uint64_t)pixel;
}
