#include "techniques/vct/vct_resources.h"

#include "techniques/vct/vct_state.h"

// ---- Voxels -------------------------------------------------------------------------------------

// An image of the faces of sets, `texels` texels for each; unused images of a shader are bound,
// too, with one row.
static struct gpu_image_desc faces_of(const struct vct_options *o, uint32_t sets, uint32_t texels,
                                      enum gpu_format format, bool used)
{
    return (struct gpu_image_desc){ .format = format,
                                    .width = texels * VCT_VOXEL_ROW,
                                    .height = used ? sets * vct_level_faces(o) / VCT_VOXEL_ROW : 1,
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

static struct gpu_image_desc faces(const struct vct_options *o, uint32_t texels,
                                   enum gpu_format format, bool used)
{
    return faces_of(o, 1, texels, format, used);
}

static void add_set(const struct vct_options *o, bool dynamic, size_t base, struct gpu_objects *out)
{
    const size_t list = 4 * (size_t)vct_capacity(o), mask = 4 * vct_mask_words(o);
    const bool lit = !o->occlusion;
#define SET(thing)                                                                                 \
    dynamic ? "dynamic_" #thing : "static_" #thing, offsetof(struct vct_voxel_set, thing)
    GPU_ADD(out, base, { GPU_BUFFER, SET(mask), .bytes = mask },
            { GPU_BUFFER, SET(word_offsets), .bytes = mask },
            { GPU_BUFFER, SET(blocks), .bytes = 4 * vct_block_count(o) },
            { GPU_BUFFER, SET(list), .bytes = list },
            { GPU_BUFFER, SET(accumulated), .bytes = mask },
            { GPU_BUFFER, SET(accumulated_list), .bytes = list },
            { GPU_BUFFER, SET(arguments), .bytes = sizeof(struct vct_voxel_counts),
              .usage = GPU_BUFFER_INDIRECT },
            { GPU_BUFFER, SET(part_counts), .bytes = sizeof(struct vct_part_count),
              .usage = GPU_BUFFER_INDIRECT },
            { GPU_IMAGE, SET(surfaces), .image = faces(o, 2, GPU_RGBA32U, true) },
            { GPU_IMAGE, SET(parts), .image = faces(o, 1, GPU_RGBA32U, lit) },
            { GPU_IMAGE, SET(bounced), .image = faces(o, 1, GPU_RGBA16F, lit) },
            { GPU_IMAGE, SET(part_of_face), .image = faces(o, 1, GPU_R32U, lit) });
}

#define VCT(thing) offsetof(struct vct, thing)

static void add_level(const struct vct_options *o, size_t level, struct gpu_objects *out)
{
    const size_t voxels = VCT(voxels.levels) + level * sizeof(struct vct_level_voxels),
                 texels = VCT(volume.levels) + level * sizeof(struct vct_level_texels);
    add_set(o, false, voxels + offsetof(struct vct_level_voxels, static_set), out);
    add_set(o, true, voxels + offsetof(struct vct_level_voxels, dynamic_set), out);
#define TEXELS(thing) offsetof(struct vct_level_texels, thing)
    GPU_ADD(out, texels, { GPU_BUFFER, "texels", TEXELS(list), .bytes = 4 * vct_texel_words(o) },
            { GPU_BUFFER, "texel_mask", TEXELS(mask), .bytes = 4 * vct_texel_mask_words(o) },
            { GPU_BUFFER, "texel_counts", TEXELS(counts), .bytes = sizeof(struct vct_texel_levels),
              .usage = GPU_BUFFER_INDIRECT });
}

// Images with the faces of all levels.
static void add_faces(const struct vct_options *o, struct gpu_objects *out)
{
    const uint32_t levels = (uint32_t)vct_clip_count(o);
    const struct gpu_image_desc lit = faces_of(o, levels, 1, GPU_RGBA32U, true),
                                planes = faces_of(o, levels, 1, GPU_RG32U, vct_has_rays(o));
    GPU_ADD(out, 0, { GPU_IMAGE, "static_lit_voxels", VCT(voxels.lit_voxels[0]), .image = lit },
            { GPU_IMAGE, "dynamic_lit_voxels", VCT(voxels.lit_voxels[1]), .image = lit },
            { GPU_IMAGE, "static_planes", VCT(voxels.planes[0]), .image = planes },
            { GPU_IMAGE, "dynamic_planes", VCT(voxels.planes[1]), .image = planes });
}

static void add_svo(const struct vct_options *o, struct gpu_objects *out)
{
    const struct vct_svo_params params = vct_svo_params(o);
    const size_t nodes = vct_svo_nodes(o);
    GPU_ADD(out, 0, { GPU_BUFFER, "svo_nodes", VCT(svo.nodes), .bytes = 4 * nodes },
            { GPU_BUFFER, "svo_brick_coords", VCT(svo.brick_coords),
              .bytes = 4 * (size_t)params.bricks },
            { GPU_BUFFER, "svo_blocks", VCT(svo.blocks),
              .bytes = (nodes + VCT_SVO_BLOCK - 1) / VCT_SVO_BLOCK * 4 },
            { GPU_BUFFER, "svo_levels", VCT(svo.levels),
              .bytes = params.depths * sizeof(struct vct_svo_level),
              .usage = GPU_BUFFER_INDIRECT });
}

void vct_add_volumes(const struct vct_options *o, struct gpu_objects *out)
{
    const struct gpu_image_desc light = vct_light_desc(o), blocks = vct_blocks_desc(o, GPU_RGBA32U),
                                slots = vct_blocks_desc(o, GPU_R32U);
    for (int i = 0; i < vct_clip_count(o); i++) add_level(o, (size_t)i, out);
    add_faces(o, out);
    if (vct_has_svo(o)) add_svo(o, out);
    GPU_ADD(out, 0, { GPU_BUFFER, "queue", VCT(voxels.queue), .bytes = 8 * VCT_QUEUE },
            { GPU_BUFFER, "queue_state", VCT(voxels.queue_state), .bytes = 16,
              .usage = GPU_BUFFER_INDIRECT },
            { GPU_BUFFER, "sums", VCT(voxels.sums),
              .bytes = 4 * (size_t)vct_capacity(o) * VCT_SUM_WORDS },
            { GPU_READBACK, "overflow", VCT(overflow.readback), .bytes = 8 * VCT_MAX_CLIPS },
            { GPU_SAMPLER, "linear", .member = VCT(volume.linear) },
            { GPU_IMAGE, light.name, VCT(volume.light), .image = light },
            { GPU_IMAGE, "blocks", VCT(rays.block_image), .image = blocks },
            { GPU_IMAGE, "blocks", VCT(rays.first_slots[0]), .image = slots },
            { GPU_IMAGE, "blocks", VCT(rays.first_slots[1]), .image = slots });
}

// ---- Pixels -------------------------------------------------------------------------------------

static struct gpu_image_desc pixels(enum gpu_format format, uint32_t width, uint32_t height,
                                    const char *alias)
{
    return (struct gpu_image_desc){ .format = format,
                                    .width = width,
                                    .height = height,
                                    .usage = GPU_SAMPLED | GPU_STORAGE,
                                    .alias = alias };
}

// Used while a view is recorded: views share the memory, but for the history.
void vct_add_pixels(const struct vct_options *o, int view, uint32_t width, uint32_t height,
                    struct gpu_objects *out)
{
    const size_t base = VCT(views) + (size_t)view * sizeof(struct vct_view);
    const uint32_t w = gpu_groups(width, vct_step(o)), h = gpu_groups(height, vct_step(o));
#define VIEW(thing) offsetof(struct vct_view, thing), .of_view = true
#define CONES(name, thing)                                                                         \
    { GPU_IMAGE, name, VIEW(pixels.thing), .image = pixels(GPU_RGBA16F, w, h, name) }
    GPU_ADD(out, base,
            { GPU_IMAGE, "edges", VIEW(pixels.edge_image), .image = pixels(GPU_R8, w, h, "edges") },
            { GPU_IMAGE, "cone_normal", VIEW(pixels.cone_normal_image),
              .image = pixels(GPU_RG16F, w, h, "cone_normal") },
            CONES("gathered_irradiance", gathered_irradiance), CONES("traced_red", traced[0]),
            CONES("traced_green", traced[1]), CONES("traced_blue", traced[2]),
            CONES("gathered_red", gathered[0]), CONES("gathered_green", gathered[1]),
            CONES("gathered_blue", gathered[2]));
    if (o->specular == VCT_SPECULAR_TRACED)
        GPU_ADD(out, base,
                { GPU_IMAGE, "arriving", VIEW(reflections.arriving),
                  .image = pixels(GPU_RGBA16F, width, height, "arriving") },
                { GPU_IMAGE, "averaged", VIEW(reflections.averaged[0]),
                  .image = pixels(GPU_RGBA16F, width, height, o->temporal ? NULL : "averaged") });
    if (o->specular == VCT_SPECULAR_TRACED && o->temporal)
        GPU_ADD(out, base,
                { GPU_IMAGE, "averaged", VIEW(reflections.averaged[1]),
                  .image = pixels(GPU_RGBA16F, width, height, NULL) });
#define HISTORY(name, thing, format)                                                               \
    {                                                                                              \
        GPU_IMAGE, name, VIEW(temporal.thing), .image = pixels(format, width, height, NULL)        \
    }
    for (size_t i = 0; o->temporal && i < 2; i++)
        GPU_ADD(out, base + i * sizeof(gpu_image), HISTORY("history", light, GPU_RGBA32F),
                HISTORY("history_surface", surface, GPU_RGBA32F), HISTORY("now", now, GPU_RGBA16F),
                HISTORY("change", change, GPU_RGBA16F));
}
