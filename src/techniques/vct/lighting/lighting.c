#include "techniques/vct/lighting/lighting.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

#include "frame/scene/scene_gpu.h"

#include <string.h>

static void inject(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                   const struct frame_view *view, const struct vct_voxel_set *set)
{
    gpu_dispatch_indirect(cmd, vct->inject[vct->params.light_count > 0],
                          GPU_BIND(vct_grid_binding(vct, clip, cmd), FRAME_LIGHT_BINDINGS(view),
                                   { .name = "vct_list", .buffer = set->list },
                                   { .name = "vct_surfaces", .image = set->surfaces },
                                   { .name = "vct_lit_voxels", .image = set->lit_voxels },
                                   { .name = "vct_bounced", .image = set->bounced },
                                   { .name = "vct_part_of_face", .image = set->part_of_face },
                                   { .name = "vct_arguments", .buffer = set->arguments }),
                          NULL, 0, set->arguments, 0);
}

void vct_refill_volume(struct vct *vct, struct gpu_cmd *cmd)
{
    if (vct_has_svo(&vct->options))
        vct_octree_fill(vct, cmd);
    else
        vct_volume_fill(vct, cmd);
}

static void light_voxels(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_scope_begin(cmd, "inject");
    for (int i = 0; i < vct->clip_count; i++) {
        const struct vct_clip *clip = &vct->clips[i];
        inject(vct, clip, cmd, view, &clip->static_set);
        if (vct->moving_draws > 0) inject(vct, clip, cmd, view, &clip->dynamic_set);
    }
    gpu_scope_end(cmd);
    vct_refill_volume(vct, cmd);
}

// Whether the voxels have the light of the previous frame. Without lights opacity is all.
static bool same_light(const struct vct *vct, const struct frame_view *view)
{
    if (!view->keep || !vct->light_valid || vct->revoxelized) return false;
    return vct->options.occlusion || (vct->kept.same && view->maps_drawn == 0);
}

void vct_record_light(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                      bool bounced)
{
    if (bounced || !same_light(vct, view)) light_voxels(vct, cmd, view);
    vct->light_valid = true;
}

// ---- Bounced light ------------------------------------------------------------------------------

static void list_parts(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                       const struct vct_voxel_set *set)
{
    const size_t count = offsetof(struct vct_part_count, count);
    // At least one group each: a dispatch is never empty.
    gpu_fill_buffer(cmd, set->part_counts, 0, count, 1);
    gpu_fill_buffer(cmd, set->part_counts, count, sizeof(uint32_t), 0);
    gpu_dispatch_indirect(
        cmd, vct->parts,
        GPU_BIND(vct_grid_binding(vct, clip, cmd), { .name = "vct_texels", .buffer = clip->texels },
                 { .name = "vct_texel_counts", .buffer = clip->texel_counts },
                 { .name = "vct_mask", .buffer = set->mask },
                 { .name = "vct_word_offsets", .buffer = set->word_offsets },
                 { .name = "vct_surfaces", .image = set->surfaces },
                 { .name = "vct_parts", .image = set->parts },
                 { .name = "vct_part_of_face", .image = set->part_of_face },
                 { .name = "vct_part_counts", .buffer = set->part_counts }),
        NULL, 0, clip->texel_counts, offsetof(struct vct_texel_levels, block_groups));
}

void vct_list_parts(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    gpu_scope_begin(cmd, "parts");
    if (clip->new_statics) list_parts(vct, clip, cmd, &clip->static_set);
    list_parts(vct, clip, cmd, &clip->dynamic_set);
    gpu_scope_end(cmd);
}

static void bounce(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                   const struct frame_view *view, const struct vct_voxel_set *set,
                   struct gpu_binding cones, bool in_turns)
{
    gpu_dispatch_indirect(
        cmd, vct->bounce[vct_light_variant(vct, view)],
        GPU_BIND(vct_grid_binding(vct, clip, cmd), vct_lit_clipmap_binding(vct, cmd),
                 view->constants_binding, view->environment_binding, cones,
                 { .name = "light", .image = vct->light, .sampler = vct->linear },
                 { .name = "vct_parts", .image = set->parts },
                 { .name = "vct_part_counts", .buffer = set->part_counts },
                 { .name = "vct_bounced", .image = set->bounced },
                 VCT_RAY_BINDINGS(vct, &vct->clips[0]), vct_small_emitters_binding(vct, cmd),
                 vct_svo_binding(vct, cmd), { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
        NULL, 0, set->part_counts,
        in_turns ? offsetof(struct vct_part_count, turn_groups)
                 : offsetof(struct vct_part_count, groups));
}

// Static voxels gather in turns. Moving ones are new in each frame: they trace fewer rays.
enum { RAYS = 16, RAYS_COLUMNS = 4, RAYS_OF_MOVING = 4 };

struct bounce_how {
    uint32_t new_sets; // of voxels whose records are not of this frame
    bool in_turns;     // light changes as in the previous frame: a part of it now
};

static void bounce_all(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                       struct bounce_how how)
{
    struct vct_cone_params params = vct_voxel_cones(vct, view), moving;
    params.new_sets = how.new_sets;
    if (vct_has_rays(&vct->options)) {
        params.cone_count = RAYS;
        params.columns = RAYS_COLUMNS;
    }
    moving = params;
    if (how.in_turns && vct_has_rays(&vct->options)) {
        params.in_turns = (how.new_sets & 1u) == 0;
        params.frame = (uint32_t)view->index;
        moving.cone_count = RAYS_OF_MOVING;
        moving.columns = 2;
    }
    const struct gpu_binding cones[] = {
        gpu_transient(cmd, "vct_cones", &params, sizeof params),
        gpu_transient(cmd, "vct_cones", &moving, sizeof moving),
    };
    gpu_scope_begin(cmd, "bounce");
    for (int i = 0; i < vct->clip_count; i++) {
        const struct vct_clip *clip = &vct->clips[i];
        bounce(vct, clip, cmd, view, &clip->static_set, cones[0], params.in_turns);
        if (vct->moving_draws > 0)
            bounce(vct, clip, cmd, view, &clip->dynamic_set, cones[1], false);
    }
    gpu_scope_end(cmd);
    vct->params.bounced = true;
}

static bool has_sky(const struct frame_view *view)
{
    const vec3s sky = view->constants->sky;
    return sky.x > 0.0f || sky.y > 0.0f || sky.z > 0.0f;
}

// Emitters and sky cast the same light on the voxels as in the previous frame.
static bool same_inputs(const struct vct *vct, const struct vct_bounce_inputs *inputs)
{
    return vct->bounced_valid && !vct->revoxelized &&
           memcmp(inputs, &vct->bounce_inputs, sizeof *inputs) == 0;
}

// With a reflectance of 0.7 the 17th bounce has 0.3 % of the light of the first.
enum {
    BOUNCES_AT_ONCE = 8,       // without bounced light of a previous frame
    BOUNCES_OF_FRAME = 2,      // in the first frame of a change and after the last one
    BOUNCES_AFTER_CHANGE = 16, // until the light from before the change is gone
};

// Light changes after frames without a change: bounced light would keep what is gone, such as that
// of a light that is switched off. Later frames of a continuous change follow it.
static bool light_jumps(const struct vct *vct, const struct frame_view *view,
                        const struct vct_bounce_inputs *inputs)
{
    const bool other = memcmp(inputs, &vct->bounce_inputs, sizeof *inputs) != 0;
    return vct->options.bounces > 1 && vct->light_valid && vct->bounces_left == 0 &&
           (other || view->lights_changed);
}

// Bounces to trace in this frame. moves: whether light changes as in the previous frame.
static int bounces_now(struct vct *vct, const struct frame_view *view,
                       const struct vct_bounce_inputs *inputs, bool restart, bool *moves)
{
    const bool same = same_inputs(vct, inputs);
    if (vct->options.bounces == 1) return same ? 0 : 1;
    if (restart) {
        const bool jumps = light_jumps(vct, view, inputs);
        vct->bounces_left = vct->light_valid ? BOUNCES_AFTER_CHANGE : 0;
        return vct->light_valid && !jumps ? 1 : BOUNCES_AT_ONCE;
    }
    const bool changed = !same || view->lights_changed;
    *moves = changed && vct->bounces_left > 0;
    if (changed) vct->bounces_left = BOUNCES_AFTER_CHANGE;
    const int most = *moves ? 1 : BOUNCES_OF_FRAME;
    const int now = vct->bounces_left < most ? vct->bounces_left : most;
    vct->bounces_left -= now;
    return now;
}

// Fills the light volume without bounced light: direct light with `direct`, emission always.
static void restart_light(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                          bool direct)
{
    const uint32_t lights = vct->params.light_count;
    vct->params.bounced = false;
    if (!direct) vct->params.light_count = 0;
    light_voxels(vct, cmd, view);
    vct->params.light_count = lights;
}

// Moving voxels are new in each frame in which they move.
static uint32_t new_sets(const struct vct *vct)
{
    return (vct->clips[0].new_statics ? 1u : 0) | (vct->revoxelized ? 2u : 0);
}

bool vct_record_bounce(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const bool many = vct->options.bounces > 1;
    const struct vct_bounce_inputs inputs = { view->environment_key,
                                              (double)view->constants->radiance_scale };
    // The light volume of the previous frame cannot be used. Bricks change with their tree.
    const bool restart = !many || !vct->light_valid ||
                         (vct->revoxelized && vct_has_svo(&vct->options)) ||
                         light_jumps(vct, view, &inputs);
    vct->params.bounced = many || has_sky(view) || view->scene->max_emissive > 0.0f;
    bool moves = false;
    const int bounces = vct->params.bounced ? bounces_now(vct, view, &inputs, restart, &moves) : 0;
    if (bounces == 0) return false;
    vct->params.light_scale = restart ? 1.0f : view->constants->previous_scale_ratio;
    if (restart) restart_light(vct, cmd, view, many);
    // Bounced light of blocks whose turn is later has the scale of the frame that gathered it.
    const bool same_scale = view->constants->previous_scale_ratio == 1.0f;
    bounce_all(vct, cmd, view,
               (struct bounce_how){ restart ? 0 : new_sets(vct), moves && same_scale });
    vct->params.light_scale = 1.0f;
    for (int i = 1; i < bounces; i++) {
        light_voxels(vct, cmd, view);
        bounce_all(vct, cmd, view, (struct bounce_how){ 0 });
    }
    vct->bounce_inputs = inputs;
    vct->bounced_valid = true;
    return true;
}
