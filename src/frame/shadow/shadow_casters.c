#include "frame/shadow/shadow_casters.h"

#include "frame/projection.h"

#include "frame_shaders.h"

struct push {
    struct scene_push draw;
    mat4s clip_from_world;
};

bool shadow_casters_init(struct shadow_casters *s, struct gpu *gpu)
{
    struct gpu_graphics_desc desc = {
        .name = "frame.shadow",
        .vertex = &shader_shadow_vert,
        .depth_format = GPU_D32F,
        .depth_compare = GPU_GREATER,
        .depth_write = true,
        .depth_clamp = true,
    };
    *s = (struct shadow_casters){ .gpu = gpu };
    if (!gpu_graphics_pipeline_create(gpu, &desc, &s->opaque)) return false;
    desc.name = "frame.shadow_masked";
    desc.vertex = &shader_shadow_masked_vert;
    desc.fragment = &shader_shadow_masked_frag;
    for (uint32_t map = 0; map < 2; map++) {
        struct gpu_constant constants[] = { { SCENE_CONSTANT_BASE_COLOR_MAP, map },
                                            { SCENE_CONSTANT_MASKED, true } };
        desc.constants = constants;
        desc.constant_count = 2;
        if (!gpu_graphics_pipeline_create(gpu, &desc, &s->masked[map])) return false;
    }
    return true;
}

void shadow_casters_finish(struct shadow_casters *s)
{
    if (!s->gpu) return;
    gpu_pipeline_destroy(s->gpu, &s->opaque);
    for (int i = 0; i < 2; i++) gpu_pipeline_destroy(s->gpu, &s->masked[i]);
}

static bool casts(const struct scene_draw *draw, const struct shadow_map_target *target)
{
    const uint32_t of_skipped = (uint32_t)draw->instance - target->first_instance;
    if (of_skipped < target->instance_count) return false;
    if (!box3_is_empty(target->bounds) && !box3_intersects(draw->bounds, target->bounds))
        return false;
    return projection_may_see(target->clip_from_world, draw->bounds);
}

void shadow_casters_record(const struct shadow_casters *s, struct gpu_cmd *cmd,
                           const struct scene_gpu *scene, const struct shadow_map_target *target)
{
    struct push push = { .clip_from_world = target->clip_from_world };
    gpu_render_begin(cmd, &(struct gpu_render_desc){
                              .depth = { .image = target->maps, .layer = target->layer },
                              .width = target->size,
                              .height = target->size,
                              .reads = scene->reads,
                              .read_count = scene->read_count,
                          });
    for (int i = 0; i < scene->draw_count; i++) {
        const struct scene_draw *draw = &scene->draws[i];
        if (!casts(draw, target)) continue;
        gpu_pipeline pipeline = draw->variant & VARIANT_MASKED
                                    ? s->masked[draw->variant & VARIANT_BASE_COLOR_MAP]
                                    : s->opaque;
        scene_gpu_draw(scene, cmd,
                       &(struct scene_draw_call){
                           .pipeline = pipeline,
                           .draw = draw,
                           .push = &push,
                           .push_bytes = sizeof push,
                           .cull = GPU_CULL_NONE,
                       });
    }
    gpu_render_end(cmd);
}
