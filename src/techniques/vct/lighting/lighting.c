// Light: on the voxels, into the light volume, and up its levels.
#include "techniques/vct/vct_state.h"

#include "frame/scene_gpu.h"

#include <string.h>

static void inject(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                   const struct frame_view *view, const struct vct_set *set)
{
    gpu_dispatch_indirect(
        cmd, vct->inject[vct->params.light_count > 0],
        GPU_BIND(
            vct_grid_binding(vct, clip, cmd), view->constants_binding, view->lights_binding,
            view->shadow_faces_binding,
            { .name = "shadow_maps", .image = view->shadow_maps, .sampler = view->shadow_sampler },
            { .name = "vct_list", .buffer = set->list },
            { .name = "vct_surfaces", .image = set->surfaces },
            { .name = "vct_records", .image = set->records },
            { .name = "vct_brought", .image = set->brought },
            { .name = "vct_arguments", .buffer = set->arguments }),
        NULL, 0, set->arguments, 0);
}

static void fill(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    gpu_dispatch_indirect(cmd, vct->fill[vct->moving_draws > 0],
                          GPU_BIND(vct_grid_binding(vct, clip, cmd), VCT_BOTH_SETS(clip),
                                   { .name = "light", .image = vct->light },
                                   { .name = "vct_texels", .buffer = clip->texels },
                                   { .name = "vct_texel_state", .buffer = clip->texel_state }),
                          NULL, 0, clip->texel_state, vct_level_groups(0));
}

static int32_t level_size(int32_t cells, uint32_t level)
{
    const int32_t size = (cells / 2 + (1 << level) - 1) >> level; // what is in use, rounded up
    return size > 1 ? size : 1;
}

static void filter(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    const struct vct_texels_push lists =
        vct_texels_push(&vct->options, vct_volume_mips(&vct->options));
    const int32_t dim = (int32_t)vct_volume_dim(&vct->options), *cells = clip->grid.cells;
    for (uint32_t level = 1; level < lists.levels; level++) {
        const struct vct_mip_push push = {
            .source_x = level_size(cells[0], level - 1),
            .source_y = level_size(cells[1], level - 1),
            .source_z = level_size(cells[2], level - 1),
            .source_tile = dim >> (level - 1),
            .target_tile = dim >> level,
            .level = level,
            .first = lists.first[level],
        };
        gpu_dispatch_indirect(
            cmd, vct->mip,
            GPU_BIND({ .name = "source", .image = vct->light, .mip = level - 1, .one_mip = true },
                     { .name = "target", .image = vct->light, .mip = level },
                     { .name = "vct_texels", .buffer = clip->texels },
                     { .name = "vct_texel_state", .buffer = clip->texel_state },
                     vct_grid_binding(vct, clip, cmd)),
            &push, sizeof push, clip->texel_state, vct_level_groups(level));
    }
}

void vct_record_fill(struct vct *vct, struct gpu_cmd *cmd)
{
    if (vct_has_svo(&vct->options)) {
        vct_svo_record_light(vct, cmd);
        return;
    }
    vct_pass_begin(vct->name, cmd, "fill");
    // Only what holds something is filled. Until here the last frame's light was there to be
    // brought.
    if (vct->light_outdated)
        gpu_clear_image(cmd, vct->light, (const float[4]){ 0.0f, 0.0f, 0.0f, 0.0f });
    vct->light_outdated = false;
    for (int i = 0; i < vct->clip_count; i++) fill(vct, &vct->clips[i], cmd);
    for (int i = 0; i < vct->clip_count; i++) vct->clips[i].lit = vct->clips[i].grid;
    gpu_scope_end(cmd);
    vct_pass_begin(vct->name, cmd, "mips");
    filter(vct, &vct->clips[0], cmd);
    gpu_scope_end(cmd);
}

static void put_light(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    vct_pass_begin(vct->name, cmd, "inject");
    for (int i = 0; i < vct->clip_count; i++) {
        const struct vct_clip *clip = &vct->clips[i];
        inject(vct, clip, cmd, view, &clip->rest);
        if (vct->moving_draws > 0) inject(vct, clip, cmd, view, &clip->moving);
    }
    gpu_scope_end(cmd);
    vct_record_fill(vct, cmd);
}

static void bring(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                  const struct frame_view *view, const struct vct_set *set,
                  struct gpu_binding cones)
{
    gpu_dispatch_indirect(
        cmd, vct->bounce[vct->lamps.count > 0],
        GPU_BIND(vct_grid_binding(vct, clip, cmd), vct_lit_clipmap_binding(vct, cmd),
                 view->constants_binding, cones,
                 { .name = "light", .image = vct->light, .sampler = vct->linear },
                 { .name = "vct_texels", .buffer = clip->texels },
                 { .name = "vct_texel_state", .buffer = clip->texel_state },
                 { .name = "vct_mask", .buffer = set->mask },
                 { .name = "vct_before", .buffer = set->before },
                 { .name = "vct_surfaces", .image = set->surfaces },
                 { .name = "vct_brought", .image = set->brought },
                 vct_lamps_binding(&vct->lamps, cmd), vct_svo_binding(vct, cmd),
                 { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
        NULL, 0, clip->texel_state, offsetof(struct vct_texel_levels, block_groups));
}

static bool has_sky(const struct frame_view *view)
{
    const vec3s sky = view->constants->sky;
    return sky.x > 0.0f || sky.y > 0.0f || sky.z > 0.0f;
}

// Whether what glows brings the same to the voxels as in the last frame.
static bool brings_the_same(const struct vct *vct, const struct vct_brought_by *by)
{
    return vct->brought_valid && !vct->remade && memcmp(by, &vct->brought_by, sizeof *by) == 0;
}

// Rounds of light from voxel to voxel. Of a surface that reflects 0.7 a 17th bounce is 0.3 % of the
// first.
enum {
    ROUNDS_AT_ONCE = 8,       // where there is no light yet
    ROUNDS_AFTER_CHANGE = 16, // one in each frame: as many until what was there before is gone
};

// How often light goes from voxel to voxel in this frame.
static int rounds_now(struct vct *vct, const struct frame_view *view,
                      const struct vct_brought_by *by, bool anew)
{
    const bool same = brings_the_same(vct, by);
    if (vct->options.bounces == 1) return same ? 0 : 1;
    if (anew) {
        vct->rounds_left = vct->light_valid ? ROUNDS_AFTER_CHANGE : 0;
        return vct->light_valid ? 1 : ROUNDS_AT_ONCE;
    }
    if (!same || view->lights_changed) vct->rounds_left = ROUNDS_AFTER_CHANGE;
    return vct->rounds_left > 0 ? (vct->rounds_left--, 1) : 0;
}

static void bring_to_all(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                         struct gpu_binding cones)
{
    vct_pass_begin(vct->name, cmd, "bounce");
    for (int i = 0; i < vct->clip_count; i++) {
        const struct vct_clip *clip = &vct->clips[i];
        bring(vct, clip, cmd, view, &clip->rest, cones);
        if (vct->moving_draws > 0) bring(vct, clip, cmd, view, &clip->moving, cones);
    }
    gpu_scope_end(cmd);
    vct->params.brought = true;
}

void vct_record_bounce(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const bool more = vct->options.bounces > 1;
    const struct vct_brought_by by = { view->constants->sky, view->constants->radiance_scale };
    const uint32_t lights = vct->params.light_count;
    // Nothing from the last frame can be used: what goes straight comes first. Bricks come with
    // their tree.
    const bool anew = !more || !vct->light_valid || (vct->remade && vct_has_svo(&vct->options));
    vct->params.brought = more || has_sky(view) || view->scene->max_emissive > 0.0f;
    const int rounds = vct->params.brought ? rounds_now(vct, view, &by, anew) : 0;
    if (rounds == 0) return;
    const struct vct_cone_params params = vct_voxel_cones(vct, view);
    const struct gpu_binding cones = gpu_transient(cmd, "vct_cones", &params, sizeof params);
    vct->params.light_scale = anew ? 1.0f : view->constants->previous_scale_ratio;
    if (anew) {
        vct->params.brought = false;
        vct->params.light_count = more ? lights : 0;
        put_light(vct, cmd, view);
        vct->params.light_count = lights;
    }
    bring_to_all(vct, cmd, view, cones);
    vct->params.light_scale = 1.0f;
    for (int i = 1; i < rounds; i++) {
        put_light(vct, cmd, view);
        bring_to_all(vct, cmd, view, cones);
    }
    vct->brought_by = by;
    vct->brought_valid = true;
}

void vct_record_light(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    // What surfaces cover changes with them alone.
    if (vct->options.occlusion && vct->light_valid && !vct->remade) return;
    put_light(vct, cmd, view);
    vct->light_valid = true;
}
