// Host code of the G-buffer pass. Back faces of single-sided materials are culled.
#include "frame/gbuffer/gbuffer.h"

#include "frame/projection.h"

#include "frame_shaders.h"

static bool make_pipeline(struct gbuffer *g, uint32_t variant, bool motion)
{
    struct gpu_constant constants[SCENE_CONSTANT_COUNT];
    gpu_constants_of_bits(variant, constants, SCENE_CONSTANT_COUNT);
    struct gpu_graphics_desc desc = {
        .name = "frame.gbuffer",
        .vertex = motion ? &shader_gbuffer_motion_vert : &shader_gbuffer_vert,
        .fragment = motion ? &shader_gbuffer_motion_frag : &shader_gbuffer_frag,
        .constants = constants,
        .constant_count = SCENE_CONSTANT_COUNT,
        .color_formats = { GPU_RG16F, GPU_RGBA8_SRGB, GPU_RG8, GPU_RGBA16F,
                           motion ? GPU_RGBA16F : GPU_FORMAT_NONE },
        .depth_format = GPU_D32F,
        .depth_compare = GPU_GREATER,
        .depth_write = true,
    };
    return gpu_graphics_pipeline_create(g->gpu, &desc, &g->pipelines[motion][variant]);
}

bool gbuffer_prepare(struct gbuffer *g, struct gpu *gpu, uint32_t variants, bool motion)
{
    g->gpu = gpu;
    for (uint32_t v = 0; v < VARIANT_COUNT; v++) {
        if (!(variants >> v & 1u) || g->pipelines[motion][v].id) continue;
        if (!make_pipeline(g, v, motion)) return false;
    }
    return true;
}

static void begin(struct gpu_cmd *cmd, const struct scene_gpu *scene,
                  const struct gbuffer_targets *t)
{
    bool motion = t->motion.id != 0;
    gpu_render_begin(cmd, &(struct gpu_render_desc){
                              .color = { { .image = t->normal },
                                         { .image = t->albedo },
                                         { .image = t->material },
                                         { .image = t->emissive },
                                         { .image = t->motion } },
                              .color_count = motion ? 5 : 4,
                              .depth = { .image = t->depth },
                              .width = t->width,
                              .height = t->height,
                              .reads = scene->reads,
                              .read_count = scene->read_count,
                          });
}

void gbuffer_record(const struct gbuffer *g, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                    const struct gbuffer_targets *targets, mat4s clip_from_world,
                    struct gpu_binding constants)
{
    bool motion = targets->motion.id != 0;
    gpu_scope_begin(cmd, "gbuffer");
    begin(cmd, scene, targets);
    for (int i = 0; i < scene->draw_count; i++) {
        const struct scene_draw *draw = &scene->draws[i];
        if (!projection_may_see(clip_from_world, draw->bounds)) continue;
        struct scene_push push;
        bool double_sided = scene->scene->materials[draw->material].double_sided;
        scene_gpu_draw(scene, cmd,
                       &(struct scene_draw_call){
                           .pipeline = g->pipelines[motion][draw->variant],
                           .draw = draw,
                           .push = &push,
                           .push_bytes = sizeof push,
                           .cull = double_sided ? GPU_CULL_NONE : GPU_CULL_BACK,
                           .bindings = &constants,
                           .binding_count = 1,
                       });
    }
    gpu_render_end(cmd);
    gpu_scope_end(cmd);
}

void gbuffer_finish(struct gbuffer *g)
{
    if (!g->gpu) return;
    for (int m = 0; m < 2; m++) {
        for (int v = 0; v < VARIANT_COUNT; v++) gpu_pipeline_destroy(g->gpu, &g->pipelines[m][v]);
    }
    *g = (struct gbuffer){ 0 };
}
