// Host code of the G-buffer pass. Back faces of single-sided materials are culled.
#include "frame/gbuffer/gbuffer.h"

#include "frame/projection.h"

#include "frame_shaders.h"

enum { BASE_COLORS = 4 }; // normal, albedo, material, emissive

struct gpu_graphics_desc gbuffer_pipeline_desc(uint32_t layers)
{
    struct gpu_graphics_desc desc = {
        .color_formats = { GPU_RG16F, GPU_RGBA8_SRGB, GPU_RG8, GPU_RGBA16F },
        .depth_format = GPU_D32F,
        .depth_compare = GPU_GREATER,
        .depth_write = true,
    };
    int count = BASE_COLORS;
    if (layers & GBUFFER_DIELECTRIC) desc.color_formats[count++] = GPU_RGBA8;
    if (layers & GBUFFER_MOTION) desc.color_formats[count++] = GPU_RGBA16F;
    if (layers & GBUFFER_ID) desc.color_formats[count++] = GPU_RG32U;
    return desc;
}

static bool make_pipeline(struct gbuffer *g, uint32_t variant, uint32_t layers)
{
    static const struct gpu_shader *const vertex[GBUFFER_LAYER_SETS] = {
        &shader_gbuffer_still_vert,
        &shader_gbuffer_motion_vert,
        &shader_gbuffer_dielectric_vert,
        &shader_gbuffer_dielectric_motion_vert,
        &shader_gbuffer_id_vert,
        &shader_gbuffer_motion_id_vert,
        &shader_gbuffer_dielectric_id_vert,
        &shader_gbuffer_dielectric_motion_id_vert,
    };
    static const struct gpu_shader *const fragment[GBUFFER_LAYER_SETS] = {
        &shader_gbuffer_still_frag,
        &shader_gbuffer_motion_frag,
        &shader_gbuffer_dielectric_frag,
        &shader_gbuffer_dielectric_motion_frag,
        &shader_gbuffer_id_frag,
        &shader_gbuffer_motion_id_frag,
        &shader_gbuffer_dielectric_id_frag,
        &shader_gbuffer_dielectric_motion_id_frag,
    };
    struct gpu_constant constants[SCENE_CONSTANT_COUNT];
    gpu_constants_of_bits(variant, constants, SCENE_CONSTANT_COUNT);
    struct gpu_graphics_desc desc = gbuffer_pipeline_desc(layers);
    desc.name = "frame.gbuffer";
    desc.vertex = vertex[layers];
    desc.fragment = fragment[layers];
    desc.constants = constants;
    desc.constant_count = SCENE_CONSTANT_COUNT;
    return gpu_graphics_pipeline_create(g->gpu, &desc, &g->pipelines[layers][variant]);
}

bool gbuffer_prepare(struct gbuffer *g, struct gpu *gpu, uint32_t variants, uint32_t layers)
{
    g->gpu = gpu;
    for (uint32_t v = 0; v < VARIANT_COUNT; v++) {
        if (!(variants >> v & 1u) || g->pipelines[layers][v].id) continue;
        if (!make_pipeline(g, v, layers)) return false;
    }
    return true;
}

void gbuffer_begin(struct gpu_cmd *cmd, const struct gbuffer_targets *t,
                   const struct gpu_binding *reads, int read_count)
{
    struct gpu_render_desc desc = {
        .color = { { .image = t->normal },
                   { .image = t->albedo },
                   { .image = t->material },
                   { .image = t->emissive } },
        .color_count = BASE_COLORS,
        .depth = { .image = t->depth },
        .width = t->width,
        .height = t->height,
        .reads = reads,
        .read_count = read_count,
    };
    if (t->dielectric.id) desc.color[desc.color_count++].image = t->dielectric;
    if (t->motion.id) desc.color[desc.color_count++].image = t->motion;
    if (t->id.id) desc.color[desc.color_count++].image = t->id;
    gpu_render_begin(cmd, &desc);
}

struct id_push {
    struct scene_push draw;
    uint32_t first_index, first_triangle;
};

// Not indexed, so that the vertex shader knows the triangle.
static void draw_with_ids(struct gpu_cmd *cmd, const struct scene_gpu *scene,
                          struct scene_draw_call *call)
{
    struct id_push push;
    call->push = &push;
    call->push_bytes = sizeof push;
    for (struct scene_triangle_range range = { 0 };
         scene_gpu_next_range(scene, call->draw, &range);) {
        push.first_index = range.first_index;
        push.first_triangle = range.first_triangle;
        call->range = &range;
        scene_gpu_draw(scene, cmd, call);
    }
}

static void record_draw(const struct gbuffer *g, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                        const struct scene_draw *draw, uint32_t layers,
                        const struct gpu_binding *constants)
{
    const bool double_sided = scene->scene->materials[draw->material].double_sided;
    struct scene_push push;
    struct scene_draw_call call = {
        .pipeline = g->pipelines[layers][draw->variant],
        .draw = draw,
        .push = &push,
        .push_bytes = sizeof push,
        .cull = double_sided ? GPU_CULL_NONE : GPU_CULL_BACK,
        .bindings = constants,
        .binding_count = 1,
    };
    if (layers & GBUFFER_ID)
        draw_with_ids(cmd, scene, &call);
    else
        scene_gpu_draw(scene, cmd, &call);
}

uint32_t gbuffer_layers_of(const struct gbuffer_targets *targets)
{
    return (targets->motion.id ? GBUFFER_MOTION : 0) |
           (targets->dielectric.id ? GBUFFER_DIELECTRIC : 0) | (targets->id.id ? GBUFFER_ID : 0);
}

void gbuffer_record(const struct gbuffer *g, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                    const struct gbuffer_targets *targets, mat4s clip_from_world,
                    struct gpu_binding constants)
{
    const uint32_t layers = gbuffer_layers_of(targets);
    gpu_scope_begin(cmd, "gbuffer");
    gbuffer_begin(cmd, targets, scene->reads, scene->read_count);
    for (int i = 0; i < scene->draw_count; i++) {
        const struct scene_draw *draw = &scene->draws[i];
        if (projection_may_see(clip_from_world, draw->bounds))
            record_draw(g, cmd, scene, draw, layers, &constants);
    }
    gpu_render_end(cmd);
    gpu_scope_end(cmd);
}

void gbuffer_finish(struct gbuffer *g)
{
    if (!g->gpu) return;
    for (int m = 0; m < GBUFFER_LAYER_SETS; m++) {
        for (int v = 0; v < VARIANT_COUNT; v++) gpu_pipeline_destroy(g->gpu, &g->pipelines[m][v]);
    }
    *g = (struct gbuffer){ 0 };
}
