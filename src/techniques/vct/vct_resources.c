#include "techniques/vct/vct_resources.h"

#include "techniques/vct/vct_state.h"

#include <string.h>

struct buffer_plan {
    const char *name;
    gpu_buffer *out;
    size_t words;
    uint32_t usage;
};

// ---- Plans
// -----------------------------------------------------------------------------------------

enum { SET_BUFFERS = 8 };

static void plan_set(const struct vct_options *options, bool dynamic, struct vct_voxel_set *set,
                     struct buffer_plan out[SET_BUFFERS])
{
    const size_t capacity = vct_capacity(options);
#define NAME(thing) (dynamic ? "dynamic_" thing : "static_" thing)
    const struct buffer_plan plan[SET_BUFFERS] = {
        { NAME("mask"), &set->mask, vct_mask_words(options), 0 },
        { NAME("word_offsets"), &set->word_offsets, vct_mask_words(options), 0 },
        { NAME("blocks"), &set->blocks, vct_block_count(options), 0 },
        { NAME("list"), &set->list, capacity, 0 },
        { NAME("accumulated"), &set->accumulated, vct_mask_words(options), 0 },
        { NAME("accumulated_list"), &set->accumulated_list, capacity, 0 },
        { NAME("arguments"), &set->arguments, sizeof(struct vct_voxel_counts) / sizeof(uint32_t),
          GPU_BUFFER_INDIRECT },
        { NAME("part_counts"), &set->part_counts, sizeof(struct vct_part_count) / sizeof(uint32_t),
          GPU_BUFFER_INDIRECT },
    };
#undef NAME
    memcpy(out, plan, sizeof plan);
}

enum {
    SVO_BUFFERS = 4,
    CLIP_BUFFERS = 2 * SET_BUFFERS + 3,
    SHARED_BUFFERS = 3,
    MOST_BUFFERS = VCT_MAX_CLIPS * CLIP_BUFFERS + SHARED_BUFFERS + SVO_BUFFERS
};

static void plan_clip(const struct vct_options *options, struct vct_clip *clip,
                      struct buffer_plan out[CLIP_BUFFERS])
{
    const struct buffer_plan lists[] = {
        { "texels", &clip->texels, vct_texel_words(options), 0 },
        { "texel_mask", &clip->texel_mask, vct_texel_mask_words(options), 0 },
        { "texel_counts", &clip->texel_counts, sizeof(struct vct_texel_levels) / sizeof(uint32_t),
          GPU_BUFFER_INDIRECT },
    };
    plan_set(options, false, &clip->static_set, out);
    plan_set(options, true, &clip->dynamic_set, out + SET_BUFFERS);
    memcpy(out + 2 * SET_BUFFERS, lists, sizeof lists);
}

static void plan_svo(const struct vct_options *options, struct vct_svo *svo,
                     struct buffer_plan out[SVO_BUFFERS])
{
    const struct vct_svo_params params = vct_svo_params(options);
    const size_t nodes = vct_svo_nodes(options);
    const struct buffer_plan plan[SVO_BUFFERS] = {
        { "svo_nodes", &svo->nodes, nodes, 0 },
        { "svo_brick_coords", &svo->brick_coords, params.bricks, 0 },
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
    const struct buffer_plan shared[SHARED_BUFFERS] = {
        { "queue", &vct->queue, 2 * (size_t)VCT_QUEUE, 0 },
        { "queue_state", &vct->queue_state, 4, GPU_BUFFER_INDIRECT },
        { "sums", &vct->sums, (size_t)vct_capacity(options) * VCT_SUM_WORDS, 0 },
    };
    memcpy(out + count, shared, sizeof shared);
    count += SHARED_BUFFERS;
    if (!vct_has_svo(options)) return count;
    plan_svo(options, &vct->svo, out + count);
    return count + SVO_BUFFERS;
}

enum image_use { USED, USED_BY_LIGHT, USED_BY_RAYS };

// Images that store the faces of a set, with `texels` texels for each.
struct image_plan {
    const char *name;
    gpu_image *out;
    uint32_t texels;
    enum gpu_format format;
    enum image_use use;
};

enum { CLIP_IMAGES = 12 };

static void plan_images(struct vct_clip *clip, struct image_plan out[CLIP_IMAGES])
{
    const struct image_plan plan[CLIP_IMAGES] = {
        { "static_surfaces", &clip->static_set.surfaces, 2, GPU_RGBA32U, USED },
        { "static_lit_voxels", &clip->static_set.lit_voxels, 1, GPU_RGBA32U, USED },
        { "static_parts", &clip->static_set.parts, 1, GPU_RGBA32U, USED_BY_LIGHT },
        { "static_bounced", &clip->static_set.bounced, 1, GPU_RGBA16F, USED_BY_LIGHT },
        { "static_part_of_face", &clip->static_set.part_of_face, 1, GPU_R32U, USED_BY_LIGHT },
        { "static_planes", &clip->static_set.planes, 1, GPU_R32U, USED_BY_RAYS },
        { "dynamic_surfaces", &clip->dynamic_set.surfaces, 2, GPU_RGBA32U, USED },
        { "dynamic_lit_voxels", &clip->dynamic_set.lit_voxels, 1, GPU_RGBA32U, USED },
        { "dynamic_parts", &clip->dynamic_set.parts, 1, GPU_RGBA32U, USED_BY_LIGHT },
        { "dynamic_bounced", &clip->dynamic_set.bounced, 1, GPU_RGBA16F, USED_BY_LIGHT },
        { "dynamic_part_of_face", &clip->dynamic_set.part_of_face, 1, GPU_R32U, USED_BY_LIGHT },
        { "dynamic_planes", &clip->dynamic_set.planes, 1, GPU_R32U, USED_BY_RAYS },
    };
    memcpy(out, plan, sizeof plan);
}

static struct gpu_image_desc image_desc(const struct vct_options *options,
                                        const struct image_plan *plan)
{
    const bool none = (options->occlusion && plan->use == USED_BY_LIGHT) ||
                      (!vct_has_rays(options) && plan->use == USED_BY_RAYS);
    const uint32_t rows = gpu_groups(vct_capacity(options), VCT_VOXEL_ROW);
    return (struct gpu_image_desc){ .name = plan->name,
                                    .format = plan->format,
                                    .width = plan->texels * VCT_VOXEL_ROW,
                                    .height = none ? 1 : rows,
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

// ---- Creation -----------------------------------------------------------------------------------

// In use while a view is recorded: views share the memory.
static bool create_image_2d(struct vct *vct, const struct vct_pixels *pixels, const char *name,
                            enum gpu_format format, gpu_image *out)
{
    const struct gpu_image_desc desc = { .name = name,
                                         .format = format,
                                         .width = pixels->width,
                                         .height = pixels->height,
                                         .usage = GPU_SAMPLED | GPU_STORAGE,
                                         .alias = name };
    return gpu_image_create(vct->gpu, &desc, out);
}

static bool create_cone_sums(struct vct *vct, const struct vct_pixels *pixels,
                             const char *const names[3], gpu_image out[3])
{
    for (int i = 0; i < 3; i++)
        if (!create_image_2d(vct, pixels, names[i], GPU_RGBA16F, &out[i])) return false;
    return true;
}

static void destroy_pixels(struct vct *vct, struct vct_pixels *pixels)
{
    gpu_image_destroy(vct->gpu, &pixels->edge_image);
    gpu_image_destroy(vct->gpu, &pixels->cone_normal_image);
    gpu_image_destroy(vct->gpu, &pixels->gathered_irradiance);
    for (int i = 0; i < 3; i++) {
        gpu_image_destroy(vct->gpu, &pixels->traced[i]);
        gpu_image_destroy(vct->gpu, &pixels->gathered[i]);
    }
    *pixels = (struct vct_pixels){ 0 };
}

bool vct_create_images(struct vct *vct, int number, uint32_t width, uint32_t height)
{
    static const char *const traced[] = { "traced_red", "traced_green", "traced_blue" };
    static const char *const gathered[] = { "gathered_red", "gathered_green", "gathered_blue" };
    struct vct_pixels *out = &vct->views[number].pixels;
    destroy_pixels(vct, out);
    if (width == 0) return true;
    out->width = gpu_groups(width, vct_step(&vct->options));
    out->height = gpu_groups(height, vct_step(&vct->options));
    return create_image_2d(vct, out, "edges", GPU_R8, &out->edge_image) &&
           create_image_2d(vct, out, "cone_normal", GPU_RG16F, &out->cone_normal_image) &&
           create_image_2d(vct, out, "gathered_irradiance", GPU_RGBA16F,
                           &out->gathered_irradiance) &&
           create_cone_sums(vct, out, traced, out->traced) &&
           create_cone_sums(vct, out, gathered, out->gathered);
}

static bool create_voxel_image(struct vct *vct, const struct image_plan *plan)
{
    const struct gpu_image_desc desc = image_desc(&vct->options, plan);
    return gpu_image_create(vct->gpu, &desc, plan->out);
}

static bool create_voxel_images(struct vct *vct, struct vct_clip *clip)
{
    struct image_plan plan[CLIP_IMAGES];
    plan_images(clip, plan);
    for (int i = 0; i < CLIP_IMAGES; i++)
        if (!create_voxel_image(vct, &plan[i])) return false;
    return true;
}

bool vct_create_resources(struct vct *vct)
{
    struct buffer_plan plan[MOST_BUFFERS];
    const int count = plan_buffers(&vct->options, vct, plan);
    for (int i = 0; i < count; i++) {
        const struct gpu_buffer_desc desc = { .name = plan[i].name,
                                              .bytes = plan[i].words * sizeof(uint32_t),
                                              .usage = GPU_BUFFER_STORAGE | plan[i].usage };
        if (!gpu_buffer_create(vct->gpu, &desc, plan[i].out)) return false;
    }
    vct->svo.params = vct_svo_params(&vct->options);
    const struct gpu_image_desc light = vct_light_desc(&vct->options);
    const struct gpu_image_desc blocks = vct_blocks_desc(&vct->options, GPU_RGBA32U),
                                slots = vct_blocks_desc(&vct->options, GPU_R32U);
    const struct gpu_sampler_desc linear = { .name = "vct.linear",
                                             .filter = GPU_LINEAR,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    for (int i = 0; i < vct->clip_count; i++)
        if (!create_voxel_images(vct, &vct->clips[i])) return false;
    return gpu_readback_create(vct->gpu, "overflow", sizeof(uint32_t) * 2 * VCT_MAX_CLIPS,
                               &vct->overflow.readback) &&
           gpu_sampler_get(vct->gpu, &linear, &vct->linear) &&
           gpu_image_create(vct->gpu, &light, &vct->light) &&
           gpu_image_create(vct->gpu, &blocks, &vct->block_image) &&
           gpu_image_create(vct->gpu, &slots, &vct->first_slots[0]) &&
           gpu_image_create(vct->gpu, &slots, &vct->first_slots[1]);
}

// ---- Destruction and sizes ----------------------------------------------------------------------

void vct_destroy_resources(struct vct *vct)
{
    struct buffer_plan buffers[MOST_BUFFERS];
    const int count = plan_buffers(&vct->options, vct, buffers);
    for (int i = 0; i < count; i++) gpu_buffer_destroy(vct->gpu, buffers[i].out);
    gpu_readback_destroy(vct->gpu, &vct->overflow.readback);
    gpu_image_destroy(vct->gpu, &vct->light);
    gpu_image_destroy(vct->gpu, &vct->block_image);
    for (int i = 0; i < 2; i++) gpu_image_destroy(vct->gpu, &vct->first_slots[i]);
    for (int i = 0; i < vct->clip_count; i++) {
        struct image_plan images[CLIP_IMAGES];
        plan_images(&vct->clips[i], images);
        for (int k = 0; k < CLIP_IMAGES; k++) gpu_image_destroy(vct->gpu, images[k].out);
    }
    for (int i = 0; i < FRAME_MAX_VIEWS; i++) destroy_pixels(vct, &vct->views[i].pixels);
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
    const struct gpu_image_desc blocks = vct_blocks_desc(options, GPU_RGBA32U);
    bytes += (uint64_t)blocks.width * blocks.height * blocks.depth *
             (uint64_t)(gpu_format_bytes(GPU_RGBA32U) + 2 * gpu_format_bytes(GPU_R32U));
    struct image_plan images[CLIP_IMAGES];
    plan_images(&none.clips[0], images);
    for (int i = 0; i < CLIP_IMAGES; i++) {
        const struct gpu_image_desc desc = image_desc(options, &images[i]);
        bytes += (uint64_t)vct_clip_count(options) * desc.width * desc.height *
                 (uint64_t)gpu_format_bytes(desc.format);
    }
    const int pixel =
        gpu_format_bytes(GPU_R8) + gpu_format_bytes(GPU_RG16F) + 7 * gpu_format_bytes(GPU_RGBA16F);
    const uint32_t step = vct_step(options);
    return bytes + (uint64_t)gpu_groups(width, step) * gpu_groups(height, step) * (uint64_t)pixel;
}
