// Mean and variance of depth over squares of pixels, level by level (Loos 2015, sec. 6.3.2).
#include "techniques/vo/vo_state.h"

#include "technique_shaders.h"

#include <math.h>
#include <stddef.h>

enum { LOCAL = 8 };

static uint32_t half_of(uint32_t size)
{
    return size > 1 ? size / 2 : 1;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

// Down to the level whose shorter side is one texel.
static uint32_t levels_of(uint32_t width, uint32_t height)
{
    uint32_t levels = 1;
    while (half_of(width < height ? width : height) >> levels) levels++;
    return levels;
}

void vo_pyramid_objects(const struct vo_options *options, uint32_t width, uint32_t height,
                        struct gpu_objects *out)
{
    const struct gpu_image_desc moments = { .format = GPU_RG32F,
                                            .width = width > 0 ? half_of(width) : 0,
                                            .height = half_of(height),
                                            .mips = levels_of(width, height),
                                            .usage = GPU_SAMPLED | GPU_STORAGE,
                                            .alias = "vo.moments" };
    if (options->mode == VO_MODE_AREAS)
        GPU_ADD(out, 0,
                { GPU_IMAGE, "moments", offsetof(struct vo, moments), .of_view = true,
                  .image = moments },
                { GPU_PIPELINE, "pyramid", offsetof(struct vo, pyramid),
                  .shader = &shader_vo_pyramid_comp });
}

void vo_record_pyramid(struct vo *vo, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const uint32_t width = half_of(view->width), height = half_of(view->height);
    const int levels = (int)levels_of(view->width, view->height);
    // A single area sample covers the whole disk, π radius².
    const float widest_px = vo->ao.params.max_radius_px * sqrtf(GLM_PIf);
    const int needed = (int)ceilf(log2f(fmaxf(widest_px, 2.0f)));
    vo->table.level_count = needed < levels ? needed : levels;
    gpu_scope_begin(cmd, "pyramid");
    for (int i = 0; i < vo->table.level_count; i++) {
        struct gpu_binding source = { .name = "source", .image = view->layers[FRAME_DEPTH] };
        if (i > 0)
            source = (struct gpu_binding){
                .name = "source", .image = vo->moments, .mip = (uint32_t)i - 1, .one_mip = true
            };
        gpu_dispatch(
            cmd, vo->pyramid,
            GPU_BIND(source, { .name = "target", .image = vo->moments, .mip = (uint32_t)i }), NULL,
            0, gpu_groups(level_size(width, (uint32_t)i), LOCAL),
            gpu_groups(level_size(height, (uint32_t)i), LOCAL), 1);
    }
    gpu_scope_end(cmd);
}
