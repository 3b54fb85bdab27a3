#include "techniques/vct/lighting/lighting.h"

#include "techniques/vct/cones/cones.h"
#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

#include "frame/scene/scene_gpu.h"

#include <string.h>

static void inject(const struct vct_lighting *lighting, const struct vct_frame *frame, int level,
                   const struct vct_voxel_set *set, gpu_image lit_voxels)
{
    gpu_dispatch_indirect(frame->cmd, lighting->inject[frame->params.light_count > 0],
                          GPU_BIND(vct_grid_binding(frame, level),
                                   FRAME_LIGHT_BINDINGS(frame->view),
                                   { .name = "vct_list", .buffer = set->list },
                                   { .name = "vct_surfaces", .image = set->surfaces },
                                   { .name = "vct_lit_voxels", .image = lit_voxels },
                                   { .name = "vct_bounced", .image = set->bounced },
                                   { .name = "vct_part_of_face", .image = set->part_of_face },
                                   { .name = "vct_arguments", .buffer = set->arguments }),
                          NULL, 0, set->arguments, 0);
}

void vct_refill_volume(const struct vct_frame *frame)
{
    if (vct_has_svo(frame->options))
        vct_octree_fill(frame->svo, frame);
    else
        vct_volume_fill(frame->volume, frame);
    vct_clipmap_note_lit(frame->clipmap);
}

static void light_voxels(const struct vct_lighting *lighting, const struct vct_frame *frame)
{
    gpu_scope_begin(frame->cmd, "inject");
    for (int i = 0; i < frame->clipmap->count; i++) {
        const struct vct_level_voxels *voxels = &frame->voxels->levels[i];
        const gpu_image *lit = frame->voxels->lit_voxels;
        inject(lighting, frame, i, &voxels->static_set, lit[0]);
        if (vct_frame_moves(frame)) inject(lighting, frame, i, &voxels->dynamic_set, lit[1]);
    }
    gpu_scope_end(frame->cmd);
    vct_refill_volume(frame);
}

// Whether the voxels have the light of the previous frame. Without lights opacity is all.
static bool same_light(const struct vct_lighting *lighting, const struct vct_frame *frame,
                       bool same)
{
    if (!frame->view->keep || !lighting->lit || frame->voxels->revoxelized) return false;
    return frame->options->occlusion || (same && frame->view->maps_drawn == 0);
}

void vct_record_light(struct vct_lighting *lighting, const struct vct_frame *frame, bool bounced,
                      bool same)
{
    if (bounced || !same_light(lighting, frame, same)) light_voxels(lighting, frame);
    lighting->lit = true;
}

void vct_lighting_invalidate(struct vct_lighting *lighting)
{
    lighting->lit = lighting->bounced = false;
}

// ---- Bounced light ------------------------------------------------------------------------------

static void list_parts(const struct vct_lighting *lighting, const struct vct_frame *frame,
                       int level, const struct vct_voxel_set *set)
{
    const struct vct_level_texels *texels = &frame->volume->levels[level];
    struct gpu_cmd *cmd = frame->cmd;
    const size_t count = offsetof(struct vct_part_count, count);
    // At least one group each: a dispatch is never empty.
    gpu_fill_buffer(cmd, set->part_counts, 0, count, 1);
    gpu_fill_buffer(cmd, set->part_counts, count, sizeof(uint32_t), 0);
    gpu_dispatch_indirect(cmd, lighting->parts,
                          GPU_BIND(vct_grid_binding(frame, level),
                                   { .name = "vct_texels", .buffer = texels->list },
                                   { .name = "vct_texel_counts", .buffer = texels->counts },
                                   { .name = "vct_mask", .buffer = set->mask },
                                   { .name = "vct_word_offsets", .buffer = set->word_offsets },
                                   { .name = "vct_surfaces", .image = set->surfaces },
                                   { .name = "vct_parts", .image = set->parts },
                                   { .name = "vct_part_of_face", .image = set->part_of_face },
                                   { .name = "vct_part_counts", .buffer = set->part_counts }),
                          NULL, 0, texels->counts, offsetof(struct vct_texel_levels, block_groups));
}

void vct_list_parts(const struct vct_lighting *lighting, const struct vct_frame *frame, int level)
{
    const struct vct_level_voxels *voxels = &frame->voxels->levels[level];
    gpu_scope_begin(frame->cmd, "parts");
    if (voxels->new_statics) list_parts(lighting, frame, level, &voxels->static_set);
    list_parts(lighting, frame, level, &voxels->dynamic_set);
    gpu_scope_end(frame->cmd);
}

static void bounce(const struct vct_lighting *lighting, const struct vct_frame *frame, int level,
                   const struct vct_voxel_set *set, struct gpu_binding cones, bool in_turns)
{
    gpu_dispatch_indirect(frame->cmd, lighting->bounce[vct_light_variant(frame)],
                          GPU_BIND(vct_grid_binding(frame, level), vct_voxel_clipmap_binding(frame),
                                   frame->view->constants_binding, frame->view->environment_binding,
                                   cones, { .name = "vct_parts", .image = set->parts },
                                   { .name = "vct_part_counts", .buffer = set->part_counts },
                                   { .name = "vct_bounced", .image = set->bounced },
                                   VCT_TRACE_BINDINGS(frame), vct_small_emitters_binding(frame)),
                          NULL, 0, set->part_counts,
                          in_turns ? offsetof(struct vct_part_count, turn_groups)
                                   : offsetof(struct vct_part_count, groups));
}

// Static voxels gather in turns. Moving ones are new in each frame: they trace fewer rays.
enum { RAYS = 16, RAYS_COLUMNS = 4, RAYS_OF_MOVING = 4 };

struct bounce_how {
    uint32_t new_sets; // as vct_cone_params.new_sets
    bool in_turns;     // light changes as in the previous frame: a part of it now
};

// A set of a level in the bits of vct_cone_params.new_sets.
static uint32_t set_bit(const struct vct_frame *frame, int level, uint32_t set)
{
    return set << (2 * (frame->clipmap->count - 1 - level));
}

static void bounce_all(const struct vct_lighting *lighting, const struct vct_frame *frame,
                       struct bounce_how how)
{
    struct gpu_cmd *cmd = frame->cmd;
    struct vct_cone_params params = vct_voxel_cones(frame), turns, moving;
    params.new_sets = how.new_sets;
    if (vct_has_rays(frame->options)) {
        params.cone_count = RAYS;
        params.columns = RAYS_COLUMNS;
    }
    turns = moving = params;
    if (how.in_turns && vct_has_rays(frame->options)) {
        turns.in_turns = true;
        turns.frame = (uint32_t)frame->view->index;
        moving.cone_count = RAYS_OF_MOVING;
        moving.columns = 2;
    }
    const struct gpu_binding cones[] = {
        gpu_transient(cmd, "vct_cones", &params, sizeof params),
        gpu_transient(cmd, "vct_cones", &turns, sizeof turns),
        gpu_transient(cmd, "vct_cones", &moving, sizeof moving),
    };
    gpu_scope_begin(cmd, "bounce");
    for (int i = lighting->first_level; i < frame->clipmap->count; i++) {
        const struct vct_level_voxels *voxels = &frame->voxels->levels[i];
        const bool in_turns = turns.in_turns && (how.new_sets & set_bit(frame, i, 1)) == 0;
        bounce(lighting, frame, i, &voxels->static_set, cones[in_turns], in_turns);
        if (vct_frame_moves(frame))
            bounce(lighting, frame, i, &voxels->dynamic_set, cones[2], false);
    }
    gpu_scope_end(cmd);
}

static bool has_sky(const struct frame_view *view)
{
    const vec3s sky = view->constants->sky;
    return sky.x > 0.0f || sky.y > 0.0f || sky.z > 0.0f;
}

// Emitters and sky cast the same light on the voxels as in the previous frame.
static bool same_inputs(const struct vct_lighting *lighting, const struct vct_frame *frame,
                        const struct vct_bounce_inputs *inputs)
{
    return lighting->bounced && !frame->voxels->revoxelized &&
           memcmp(inputs, &lighting->inputs, sizeof *inputs) == 0;
}

// With a reflectance of 0.7 the 17th bounce has 0.3 % of the light of the first.
enum {
    BOUNCES_AT_ONCE = 8,       // without bounced light of a previous frame
    BOUNCES_OF_FRAME = 2,      // in the first frame of a change and after the last one
    BOUNCES_AFTER_CHANGE = 16, // until the light from before the change is gone
};

// Light changes after frames without a change: bounced light would keep what is gone, such as that
// of a light that is switched off. Later frames of a continuous change follow it.
static bool light_jumps(const struct vct_lighting *lighting, const struct vct_frame *frame,
                        const struct vct_bounce_inputs *inputs)
{
    const bool other = memcmp(inputs, &lighting->inputs, sizeof *inputs) != 0;
    return frame->options->bounces > 1 && lighting->lit && lighting->bounces_left == 0 &&
           (other || frame->view->lights_changed);
}

// Bounces to trace in this frame. moves: whether light changes as in the previous frame.
static int bounces_now(struct vct_lighting *lighting, const struct vct_frame *frame,
                       const struct vct_bounce_inputs *inputs, bool restart, bool *moves)
{
    const bool same = same_inputs(lighting, frame, inputs);
    if (frame->options->bounces == 1) return same ? 0 : 1;
    if (restart) {
        const bool jumps = light_jumps(lighting, frame, inputs);
        lighting->bounces_left = lighting->lit ? BOUNCES_AFTER_CHANGE : 0;
        return lighting->lit && !jumps ? 1 : BOUNCES_AT_ONCE;
    }
    const bool changed = !same || frame->view->lights_changed;
    *moves = changed && lighting->bounces_left > 0;
    if (changed) lighting->bounces_left = BOUNCES_AFTER_CHANGE;
    const int most = *moves ? 1 : BOUNCES_OF_FRAME;
    const int now = lighting->bounces_left < most ? lighting->bounces_left : most;
    lighting->bounces_left -= now;
    return now;
}

// Fills the light volume without bounced light: direct light with `direct`, emission always.
static void restart_light(const struct vct_lighting *lighting, const struct vct_frame *frame,
                          bool direct)
{
    struct vct_frame first = *frame;
    first.params.bounced = false;
    if (!direct) first.params.light_count = 0;
    light_voxels(lighting, &first);
}

// Moving voxels are new in each frame in which they move.
static uint32_t new_sets(const struct vct_frame *frame)
{
    uint32_t sets = 0;
    for (int i = 0; i < frame->clipmap->count; i++) {
        const struct vct_level_voxels *level = &frame->voxels->levels[i];
        if (level->new_statics) sets |= set_bit(frame, i, 1);
        if (level->revoxelized) sets |= set_bit(frame, i, 2);
    }
    return sets;
}

// The light of a level comes from it and from coarser ones: after a step of a level those keep
// theirs.
static int first_level(const struct vct_lighting *lighting, const struct vct_frame *frame,
                       const struct vct_bounce_inputs *inputs, bool restart)
{
    const bool other = memcmp(inputs, &lighting->inputs, sizeof *inputs) != 0;
    if (restart || other || !lighting->bounced || frame->view->lights_changed) return 0;
    const int before =
        lighting->bounces_left > 0 ? lighting->first_level : frame->clipmap->count - 1;
    for (int i = 0; i < before; i++)
        if (frame->voxels->levels[i].revoxelized) return i;
    return before;
}

bool vct_record_bounce(struct vct_lighting *lighting, struct vct_frame *frame)
{
    const struct frame_view *view = frame->view;
    const bool many = frame->options->bounces > 1;
    const struct vct_bounce_inputs inputs = { view->environment_key,
                                              (double)view->constants->radiance_scale };
    // The light volume of the previous frame cannot be used. Bricks change with their tree.
    const bool restart = !many || !lighting->lit ||
                         (frame->voxels->revoxelized && vct_has_svo(frame->options)) ||
                         light_jumps(lighting, frame, &inputs);
    frame->params.bounced = many || has_sky(view) || view->scene->max_emissive > 0.0f;
    lighting->first_level = first_level(lighting, frame, &inputs, restart);
    bool moves = false;
    const int bounces =
        frame->params.bounced ? bounces_now(lighting, frame, &inputs, restart, &moves) : 0;
    if (bounces == 0) return false;
    frame->params.light_scale = restart ? 1.0f : view->constants->previous_scale_ratio;
    if (restart) restart_light(lighting, frame, many);
    // Bounced light of blocks whose turn is later has the scale of the frame that gathered it.
    const bool same_scale = view->constants->previous_scale_ratio == 1.0f;
    bounce_all(lighting, frame,
               (struct bounce_how){ restart ? 0 : new_sets(frame), moves && same_scale });
    frame->params.light_scale = 1.0f;
    for (int i = 1; i < bounces; i++) {
        light_voxels(lighting, frame);
        bounce_all(lighting, frame, (struct bounce_how){ 0 });
    }
    lighting->inputs = inputs;
    lighting->bounced = true;
    return true;
}
