// Parts of a bake that bakes of other scenes share, as those of meshes: each is a file of a cache.
// Their tensors have names of their own, so that files are found to have a part whatever else they
// have.
#include "bake/bake_state.h"

#include <math.h>
#include <string.h>

static bool is_saved(const struct planned_output *output)
{
    return output->what.keep == BAKE_SAVED;
}

// ---- of other bakes

bool part_is_in(const struct bake *bake, int part, const struct tensors *set)
{
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        if (part > 0 && stage->what.part != part) continue;
        for (int i = 0; i < stage->what.output_count; i++)
            if (is_saved(&stage->outputs[i]) &&
                !tensor_is_same(tensors_find(set, stage->outputs[i].what.name),
                                &stage->outputs[i].view))
                return false;
    }
    return true;
}

bool parts_fit(const struct bake *bake, const struct bake *wanted)
{
    const struct tensors *tensors = bake_tensors(bake);
    return tensors && part_is_in(wanted, 0, tensors);
}

static bool take_stage(struct bake *bake, struct planned_stage *stage, const struct tensors *set)
{
    for (int i = 0; i < stage->what.output_count; i++) {
        struct planned_output *output = &stage->outputs[i];
        if (!is_saved(output)) continue;
        if (!output->data) output->data = host_alloc(bake->host, output->bytes, 1);
        if (!output->data) return false;
        if (output->bytes > 0)
            memcpy(output->data, tensors_find(set, output->what.name)->data, output->bytes);
    }
    memset(stage->done, 1, stage->what.task_count * sizeof *stage->done);
    stage->done_count = stage->what.task_count;
    stage->seconds = identity_stage_seconds(set, stage->what.name);
    return true;
}

static bool take_part(struct bake *bake, int part, const struct tensors *set)
{
    for (int s = 0; s < bake->plan.stage_count; s++)
        if (bake->plan.stages[s].what.part == part && !take_stage(bake, &bake->plan.stages[s], set))
            return false;
    bake->plan.parts[part - 1].loaded = true;
    return true;
}

// NaN where a file does not state its own.
static void add_seconds(struct bake *bake, const struct tensors *set)
{
    const double seconds = identity_seconds(set);
    if (isfinite(seconds)) bake->seconds += seconds;
    if (!bake_is_complete(bake)) return;
    for (int s = 0; s < bake->plan.stage_count; s++)
        if (isnan(bake->plan.stages[s].seconds)) bake->seconds = (double)NAN;
}

static int missing_parts(const struct bake *bake)
{
    int missing = 0;
    for (int p = 0; p < bake_part_count(bake); p++) missing += !bake_part_is_complete(bake, p);
    return missing;
}

bool parts_take(struct bake *bake, const struct tensors *set)
{
    bool any = false;
    for (int part = 1; part <= bake->plan.part_count; part++) {
        if (bake_part_is_complete(bake, part - 1) || !part_is_in(bake, part, set)) continue;
        if (!take_part(bake, part, set)) return false;
        any = true;
    }
    if (missing_parts(bake) == 0 && !results_complete_waves(bake)) return false;
    if (any) add_seconds(bake, set);
    return true;
}

// ---- facts

int bake_part_count(const struct bake *bake)
{
    return bake->plan.part_count > 0 ? bake->plan.part_count : 1;
}

void bake_part_key(const struct bake *bake, int part, char out[HASH128_TEXT])
{
    struct identity_text text;
    if (bake->plan.part_count == 0) {
        bake_key(bake, out);
        return;
    }
    identity_print_part(bake, part + 1, (double)NAN, &text);
    identity_key(&text, out);
}

bool bake_part_is_complete(const struct bake *bake, int part)
{
    if (bake_is_complete(bake)) return true;
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        if (bake->plan.part_count > 0 && stage->what.part != part + 1) continue;
        if (stage->done_count < stage->what.task_count) return false;
    }
    return bake->plan.part_count > 0;
}

bool bake_part_is_loaded(const struct bake *bake, int part)
{
    return bake->plan.part_count > 0 ? bake->plan.parts[part].loaded : bake->file.memory != NULL;
}

// ---- for files

double part_seconds(const struct bake *bake, int part)
{
    double all = 0.0, of_part = 0.0;
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        all += stage->seconds;
        if (stage->what.part == part) of_part += stage->seconds;
    }
    return all > 0.0 ? bake->seconds * of_part / all : (double)NAN;
}

struct tensor *part_tensors(const struct bake *bake, int part, size_t *count)
{
    struct tensor *out = host_alloc(bake->host, bake->saved_count, sizeof *out);
    *count = 0;
    for (int s = 0; out && s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        for (int i = 0; stage->what.part == part && i < stage->what.output_count; i++)
            if (is_saved(&stage->outputs[i])) out[(*count)++] = stage->outputs[i].view;
    }
    return out;
}
