#include "frame/gbuffer/convert.h"

#include "frame_shaders.h"

bool gbuffer_convert_prepare(struct gbuffer_convert *c, struct gpu *gpu, uint32_t layers)
{
    static const struct gpu_shader *const fragment[GBUFFER_LAYER_SETS] = {
        [0] = &shader_gbuffer_convert_still_frag,
        [GBUFFER_MOTION] = &shader_gbuffer_convert_motion_frag,
        [GBUFFER_DIELECTRIC] = &shader_gbuffer_convert_dielectric_frag,
        [GBUFFER_DIELECTRIC | GBUFFER_MOTION] = &shader_gbuffer_convert_dielectric_motion_frag,
    };
    c->gpu = gpu;
    if (c->pipelines[layers].id) return true;
    struct gpu_graphics_desc desc = gbuffer_pipeline_desc(layers);
    desc.name = "frame.gbuffer_convert";
    desc.vertex = &shader_gbuffer_convert_vert;
    desc.fragment = fragment[layers];
    return gpu_graphics_pipeline_create(gpu, &desc, &c->pipelines[layers]);
}

void gbuffer_convert_record(const struct gbuffer_convert *c, struct gpu_cmd *cmd,
                            const struct gbuffer_sources *s,
                            const struct gbuffer_encoding *encoding,
                            const struct gbuffer_targets *targets, struct gpu_binding constants)
{
    struct gbuffer_encoding from = *encoding;
    from.has_material = s->material.id != 0;
    from.has_emissive = s->emissive.id != 0;
    const struct gpu_binding bindings[] = {
        constants,
        gpu_transient(cmd, "gbuffer_encoding", &from, sizeof from),
        { .name = "depth", .image = s->depth },
        { .name = "normal", .image = s->normal },
        { .name = "albedo", .image = s->albedo },
        { .name = "material", .image = s->material.id ? s->material : s->albedo },
        { .name = "emissive", .image = s->emissive.id ? s->emissive : s->albedo },
        { .name = "dielectric", .image = s->dielectric.id ? s->dielectric : s->albedo },
        { .name = "motion", .image = s->motion.id ? s->motion : s->albedo },
    };
    const int count = sizeof bindings / sizeof *bindings;
    gpu_scope_begin(cmd, "gbuffer_convert");
    gbuffer_begin(cmd, targets, bindings, count);
    gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = c->pipelines[gbuffer_layers_of(targets)],
                                           .bindings = bindings,
                                           .binding_count = count,
                                           .count = 3,
                                           .cull = GPU_CULL_NONE });
    gpu_render_end(cmd);
    gpu_scope_end(cmd);
}

void gbuffer_convert_finish(struct gbuffer_convert *c)
{
    for (int i = 0; c->gpu && i < GBUFFER_LAYER_SETS; i++)
        gpu_pipeline_destroy(c->gpu, &c->pipelines[i]);
    *c = (struct gbuffer_convert){ 0 };
}
