// Bake files: the whole bake, or one of its parts.
#include "bake/bake_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- writing

bool bake_save(struct bake *bake, const char *path, bool record_run)
{
    struct identity_text text;
    const struct tensors *tensors = bake_tensors(bake);
    if (!tensors)
        return host_fail(bake->host, FAIL_ARGUMENT,
                         "cannot write %s: the bake is incomplete; run it first", path);
    identity_print(bake, IDENTITY_BAKE, record_run ? bake->seconds : (double)NAN, &text);
    if (record_run && !identity_add_run(bake, 0, &text)) return false;
    const size_t count = bake->file.memory ? tensors->count : bake->saved_count;
    if (!identity_write(bake->host, path, &text, tensors->at, count)) return false;
    bake_forget_checkpoint(bake);
    return true;
}

bool bake_save_part(struct bake *bake, int part, const char *path, bool record_run)
{
    struct identity_text text;
    size_t count = 0;
    if (bake->plan.part_count == 0 || !bake_is_complete(bake))
        return bake_save(bake, path, record_run);
    identity_print_part(bake, part + 1, record_run ? part_seconds(bake, part + 1) : (double)NAN,
                        &text);
    if (record_run && !identity_add_run(bake, part + 1, &text)) return false;
    struct tensor *tensors = part_tensors(bake, part + 1, &count);
    const bool ok = tensors && identity_write(bake->host, path, &text, tensors, count);
    host_free(bake->host, tensors);
    if (ok) bake_forget_checkpoint(bake);
    return ok;
}

// ---- reading

bool bake_fits(const struct bake *bake, const struct bake *wanted)
{
    const struct bake_identity *is = &bake->identity, *want = &wanted->identity;
    if (strcmp(is->technique, want->technique) != 0 || is->version != want->version ||
        strcmp(is->options, want->options) != 0)
        return false;
    if (wanted->plan.part_count > 0) return parts_fit(bake, wanted);
    return bake->plan.depends_on_scene == wanted->plan.depends_on_scene &&
           hash128_same(bake->plan.scene, wanted->plan.scene);
}

static void read_seconds(struct bake *bake, const struct tensors *set)
{
    bake->seconds = identity_seconds(set);
    for (int s = 0; s < bake->plan.stage_count; s++)
        bake->plan.stages[s].seconds = identity_stage_seconds(set, bake->plan.stages[s].what.name);
}

// The file has exactly the tensors that the plan saves.
static bool check_tensors(const struct bake *bake, const char *path, const struct tensors *set)
{
    size_t count = 0;
    for (int s = 0; s < bake->plan.stage_count; s++)
        for (int i = 0; i < bake->plan.stages[s].what.output_count; i++) {
            const struct planned_output *output = &bake->plan.stages[s].outputs[i];
            if (output->what.keep != BAKE_SAVED) continue;
            count++;
            if (!tensor_is_same(tensors_find(set, output->what.name), &output->view))
                return host_fail(bake->host, FAIL_FORMAT,
                                 "cannot use %s: it lacks the tensor %s, or its shape differs",
                                 path, output->what.name);
        }
    return count == set->count || identity_fail(bake->host, path, "it has tensors of no stage");
}

static bool take_all(struct bake *bake, const char *path, const struct tensors *set)
{
    if (!parts_take(bake, set)) return false;
    int missing = 0;
    for (int p = 0; p < bake->plan.part_count; p++) missing += !bake_part_is_complete(bake, p);
    return missing == 0 ||
           host_fail(bake->host, FAIL_FORMAT,
                     "cannot use %s alone: of the scene's %d objects, %d are in no file that was "
                     "read; bake them",
                     path, bake->plan.part_count, missing);
}

bool bake_load(struct bake *bake, const char *path)
{
    struct safetensors file;
    if (!safetensors_read(bake->host, path, &file)) return false;
    bool ok = identity_check(bake->host, bake, IDENTITY_BAKE, path, &file.set);
    const bool of_parts = bake->plan.part_count > 0;
    if (ok) ok = of_parts ? take_all(bake, path, &file.set) : check_tensors(bake, path, &file.set);
    if (!ok || of_parts) {
        safetensors_finish(bake->host, &file);
        return ok;
    }
    safetensors_finish(bake->host, &bake->file);
    bake->file = file;
    read_seconds(bake, &bake->file.set);
    return true;
}

static bool take_part(struct bake *bake, int part, const char *path, const struct tensors *set)
{
    if (!identity_check(bake->host, bake, IDENTITY_BAKE, path, set)) return false;
    return part_is_in(bake, part, set) ? parts_take(bake, set)
                                       : identity_fail(bake->host, path, "it is of another object");
}

bool bake_load_part(struct bake *bake, int part, const char *path)
{
    struct safetensors file;
    if (bake->plan.part_count == 0) return bake_load(bake, path);
    if (!safetensors_read(bake->host, path, &file)) return false;
    const bool ok = take_part(bake, part + 1, path, &file.set);
    safetensors_finish(bake->host, &file);
    return ok;
}
