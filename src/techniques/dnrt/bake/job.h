// Inputs that the stages of a bake share.
#pragma once

#include "core/rng.h"
#include "techniques/dnrt/dnrt_part.h"
#include "techniques/dnrt/bake/patches.h"
#include "techniques/dnrt/bake/transfer.h"
#include "techniques/dnrt/dnrt_bake.h"
#include "techniques/dnrt/dnrt_keys.h"
#include "techniques/dnrt/dnrt_options.h"

struct dnrt_shape_trace {
    struct dnrt_part part;
    struct trace_scene *trace;
    struct dnrt_patches patches; // of the first key frame of a shape, with `self`
};

// A volume in the plan, where it is the part of a mesh.
struct dnrt_baked {
    int part; // 0: an equal volume before it has the stages
    char key[HASH128_TEXT];
};

struct dnrt_job {
    struct dnrt_options options;
    const struct scene_pose *pose;
    const struct bake_plan *plan;
    bool all;                       // instances are objects
    const struct dnrt_baked *baked; // [objects.volume_count]
    struct dnrt_objects objects;
    struct dnrt_shape_trace *volumes; // [objects.volume_count]: shapes at key frames
    struct host *host;                // of `volumes`
};

// The object that stands for a volume's shape, at its key frame.
bool dnrt_part_of_volume(struct dnrt_part *out, struct host *host,
                         const struct dnrt_objects *objects, const struct dnrt_key_poses *keys,
                         int volume);
struct dnrt_sampling dnrt_sampling_of(const struct dnrt_job *job, int volume);

static inline int dnrt_first_volume(const struct dnrt_objects *objects, int volume)
{
    return objects->shapes[dnrt_shape_of_volume(objects, volume)].volume;
}

// "mesh 0123456789ab samples", and a tensor (dnrt_tensors.h). NULL: out of memory.
static inline char *dnrt_stage_name(struct bake_plan *plan, const struct dnrt_baked *of,
                                    const char *what)
{
    return bake_plan_name(plan, "mesh %.12s %s", of->key, what);
}

static inline uint32_t dnrt_seed_of(const struct bake_task *task, uint64_t index)
{
    return (uint32_t)rng_mix(task->bake_seed ^ index << 32) | 1u;
}

// With the option `self`: triangles and points of each shape; those of a volume are those of its
// first key frame.
bool dnrt_add_self_stages(struct bake_plan *plan, const struct dnrt_job *job,
                          const struct dnrt_objects *objects, const struct dnrt_key_poses *keys);
