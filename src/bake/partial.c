// Partial files: checkpoints and shards. A safetensors file with the metadata of the bake and
//   tasks/STAGE           U32, indices of finished tasks, ascending
//   seconds/STAGE         F32, sum of their times
//   results/OUTPUT/FIRST  U8, the blocks of a run of consecutive finished tasks
//   sum/OUTPUT            U8, the tensor of a BAKE_SUM once all its tasks are added up
// Tensors that no wave needs any more are absent.
#include "bake/bake_state.h"
#include "bake/relay_host.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char KIND[] = "partial";

// ---- writing

struct list {
    struct host *host;
    struct arena arena; // names and lists of tasks
    struct tensor *at;
    size_t count, capacity;
};

static bool add(struct list *list, const char *name, enum tensor_type type, const void *data,
                size_t count)
{
    if (list->count == list->capacity) {
        const size_t capacity = list->capacity ? 2 * list->capacity : 64;
        struct tensor *at = host_realloc(list->host, list->at, capacity, sizeof *at);
        if (!at) return false;
        list->at = at;
        list->capacity = capacity;
    }
    struct tensor *tensor = &list->at[list->count++];
    *tensor = (struct tensor){ .name = arena_strdup(&list->arena, name),
                               .type = type,
                               .rank = 1,
                               .shape = { count },
                               .data = data,
                               .bytes = count * tensor_type_bytes(type) };
    return tensor->name != NULL;
}

static bool add_named(struct list *list, const char *folder, const char *name,
                      enum tensor_type type, const void *data, size_t count)
{
    char *path = host_sprintf(list->host, "%s/%s", folder, name);
    const bool ok = path && add(list, path, type, data, count);
    host_free(list->host, path);
    return ok;
}

static bool add_tasks(struct list *list, const struct planned_stage *stage,
                      const struct finished_tasks *finished)
{
    const size_t count = stage->what.task_count;
    uint32_t *indices = arena_alloc(&list->arena, count, sizeof *indices);
    float *time = arena_alloc(&list->arena, 1, sizeof *time);
    size_t used = 0;
    if (!indices || !time) return false;
    for (size_t i = 0; i < count; i++)
        if (finished->done[i]) indices[used++] = (uint32_t)i;
    *time = (float)finished->seconds;
    return used == 0 || (add_named(list, "tasks", stage->what.name, TENSOR_U32, indices, used) &&
                         add_named(list, "seconds", stage->what.name, TENSOR_F32, time, 1));
}

static bool add_run(struct list *list, const struct planned_stage *stage,
                    const struct planned_output *output, size_t first, size_t end)
{
    size_t bytes = 0;
    char number[32];
    char *begin = output_block(stage, output, first, &bytes);
    const char *last = output_block(stage, output, end - 1, &bytes);
    snprintf(number, sizeof number, "/%zu", first);
    char *name = host_sprintf(list->host, "%s%s", output->what.name, number);
    const bool ok =
        name && add_named(list, "results", name, TENSOR_U8, begin, (size_t)(last - begin) + bytes);
    host_free(list->host, name);
    return ok;
}

static bool add_output(struct list *list, const struct planned_stage *stage,
                       const struct planned_output *output, const bool *done)
{
    const bool sum = output->what.reduction == BAKE_SUM;
    if (sum && output->data)
        return add_named(list, "sum", output->what.name, TENSOR_U8, output->data, output->bytes);
    if (sum ? !output->parts : !output->data) return true;
    for (size_t i = 0; i < stage->what.task_count; i++) {
        if (!done[i]) continue;
        const size_t first = i;
        while (i < stage->what.task_count && done[i]) i++;
        if (!add_run(list, stage, output, first, i)) return false;
    }
    return true;
}

static bool add_stages(struct list *list, const struct bake *bake,
                       const struct finished_tasks *stages)
{
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        if (results_are_loaded(bake, stage)) continue; // again, next time
        if (!add_tasks(list, stage, &stages[s])) return false;
        for (int i = 0; i < stage->what.output_count; i++)
            if (!add_output(list, stage, &stage->outputs[i], stages[s].done)) return false;
    }
    return true;
}

bool partial_write(struct host *host, const struct bake *bake, const char *path,
                   const struct finished_tasks *stages, double seconds)
{
    struct list list = { .host = host };
    struct identity_text text;
    arena_init(&list.arena, host);
    identity_print(bake, KIND, seconds, &text);
    const bool ok =
        add_stages(&list, bake, stages) && identity_write(host, path, &text, list.at, list.count);
    arena_finish(&list.arena);
    host_free(host, list.at);
    return ok;
}

// ---- reading

struct reading {
    struct host *host;
    struct bake *bake;
    const char *path;
    const struct tensors *set;
    bool commit; // false: only check
};

static bool fail_part(const struct reading *r, const char *name)
{
    return host_fail(r->host, FAIL_FORMAT, "cannot use %s: %s does not fit the bake", r->path,
                     name);
}

static const struct tensor *find_in(const struct reading *r, const char *folder, const char *name)
{
    char *path = host_sprintf(r->host, "%s/%s", folder, name);
    const struct tensor *tensor = path ? tensors_find(r->set, path) : NULL;
    host_free(r->host, path);
    return tensor;
}

static bool tasks_are_ascending(const struct tensor *tasks, size_t task_count)
{
    const uint32_t *index = tasks->data;
    const size_t count = tasks->bytes / sizeof *index;
    if (tasks->type != TENSOR_U32 || count == 0) return false;
    for (size_t i = 0; i < count; i++)
        if (index[i] >= task_count || (i > 0 && index[i] <= index[i - 1])) return false;
    return true;
}

// Copies a run of blocks. *used: the number of tasks in it.
static bool read_run(const struct reading *r, const struct planned_stage *stage,
                     const struct planned_output *output, const uint32_t *index, size_t count,
                     size_t *used)
{
    size_t bytes = 0, total = 0, n = 0;
    for (; n < count && index[n] == index[0] + n; n++) {
        output_block(stage, output, index[n], &bytes);
        if (!size_add(total, bytes, &total)) return false;
    }
    *used = n;
    char number[32];
    snprintf(number, sizeof number, "/%u", (unsigned)index[0]);
    char *name = host_sprintf(r->host, "%s%s", output->what.name, number);
    const struct tensor *blocks = name ? find_in(r, "results", name) : NULL;
    host_free(r->host, name);
    if (!blocks || blocks->bytes != total) return fail_part(r, output->what.name);
    if (r->commit && total > 0)
        memcpy(output_block(stage, output, index[0], &bytes), blocks->data, total);
    return true;
}

static bool read_sum(const struct reading *r, struct planned_output *output,
                     const struct tensor *sum)
{
    if (sum->bytes != output->bytes) return fail_part(r, output->what.name);
    if (!r->commit || output->data) return true;
    output->data = host_alloc(r->host, output->bytes, 1);
    if (!output->data) return false;
    memcpy(output->data, sum->data, sum->bytes);
    return true;
}

static bool has_blocks(const struct reading *r, const struct planned_output *output, uint32_t first)
{
    char *name = host_sprintf(r->host, "%s/%u", output->what.name, (unsigned)first);
    const bool has = name && find_in(r, "results", name);
    host_free(r->host, name);
    return has;
}

// Whether the file's last complete wave is beyond the output's: then the tensor may be absent.
static bool may_be_absent(const struct reading *r, const struct planned_output *output)
{
    const struct bake_plan *plan = &r->bake->plan;
    for (int s = 0; s < plan->stage_count; s++) {
        const struct planned_stage *stage = &plan->stages[s];
        if (stage->what.wave > output->what.keep || results_are_loaded(r->bake, stage)) continue;
        const struct tensor *tasks = find_in(r, "tasks", stage->what.name);
        if (!tasks || tasks->bytes / sizeof(uint32_t) != stage->what.task_count) return false;
    }
    return true;
}

static bool read_output(const struct reading *r, const struct planned_stage *stage,
                        struct planned_output *output, const struct tensor *tasks)
{
    const uint32_t *index = tasks->data;
    const size_t count = tasks->bytes / sizeof *index;
    const struct tensor *sum = find_in(r, "sum", output->what.name);
    if (output->what.reduction == BAKE_SUM && sum && count == stage->what.task_count)
        return read_sum(r, output, sum);
    if (!has_blocks(r, output, index[0]) && may_be_absent(r, output)) return true;
    for (size_t i = 0, used = 0; i < count; i += used)
        if (!read_run(r, stage, output, index + i, count - i, &used)) return false;
    return true;
}

static void mark_done(const struct reading *r, struct planned_stage *stage,
                      const struct tensor *tasks)
{
    const uint32_t *index = tasks->data;
    const struct tensor *time = find_in(r, "seconds", stage->what.name);
    const bool has_time = time && time->type == TENSOR_F32 && time->bytes == sizeof(float);
    const double seconds = has_time ? (double)*(const float *)time->data : 0.0;
    for (size_t i = 0; i < tasks->bytes / sizeof *index; i++) {
        stage->done_count += !stage->done[index[i]];
        stage->done[index[i]] = true;
    }
    if (isfinite(seconds) && seconds > 0.0) stage->seconds += seconds;
}

static bool read_stage(const struct reading *r, struct planned_stage *stage)
{
    const struct tensor *tasks = find_in(r, "tasks", stage->what.name);
    if (!tasks) return true;
    if (!tasks_are_ascending(tasks, stage->what.task_count)) return fail_part(r, stage->what.name);
    // Its results are complete: reduced, and freed where no later wave reads them.
    if (stage->what.wave < r->bake->plan.waves_done || results_are_loaded(r->bake, stage))
        return true;
    for (int i = 0; i < stage->what.output_count; i++)
        if (!read_output(r, stage, &stage->outputs[i], tasks)) return false;
    if (r->commit) mark_done(r, stage, tasks);
    return true;
}

// Stages of a wave have results only if those of all waves before are complete.
static bool waves_fit(const struct reading *r)
{
    const struct bake_plan *plan = &r->bake->plan;
    int last = -1, complete = plan->waves;
    for (int s = 0; s < plan->stage_count; s++) {
        const struct planned_stage *stage = &plan->stages[s];
        if (results_are_loaded(r->bake, stage)) continue;
        const struct tensor *tasks = find_in(r, "tasks", stage->what.name);
        const size_t count = tasks ? tasks->bytes / sizeof(uint32_t) : 0;
        if (tasks) last = stage->what.wave;
        if (count < stage->what.task_count && stage->what.wave < complete)
            complete = stage->what.wave;
    }
    return last <= complete || fail_part(r, "the order of its stages");
}

static bool read_stages(const struct reading *r)
{
    for (int s = 0; s < r->bake->plan.stage_count; s++)
        if (!read_stage(r, &r->bake->plan.stages[s])) return false;
    return true;
}

static bool begin_waves(const struct reading *r)
{
    const struct bake_plan *plan = &r->bake->plan;
    int last = -1;
    for (int s = 0; s < plan->stage_count; s++)
        if (find_in(r, "tasks", plan->stages[s].what.name)) last = plan->stages[s].what.wave;
    for (int wave = plan->waves_done; wave <= last; wave++)
        if (!results_begin(r->bake, wave)) return false;
    return true;
}

static bool restore(struct host *host, struct bake *bake, const char *path,
                    const struct tensors *set)
{
    struct reading r = { .host = host, .bake = bake, .path = path, .set = set };
    const double seconds = identity_seconds(set);
    if (!identity_check(host, bake, KIND, path, set) || !waves_fit(&r) || !read_stages(&r))
        return false;
    r.commit = true;
    if (!begin_waves(&r) || !read_stages(&r) || !results_complete_waves(bake)) return false;
    if (isfinite(seconds)) bake->seconds += seconds;
    return true;
}

bool partial_read(struct host *host, struct bake *bake, const char *path)
{
    struct safetensors file;
    if (!safetensors_read(host, path, &file)) return false;
    const bool ok = restore(host, bake, path, &file.set);
    safetensors_finish(host, &file);
    return ok;
}

// Tasks of an incomplete wave of which the files have some.
static void count_missing(struct bake *bake)
{
    struct merged *merged = &bake->merged;
    *merged = (struct merged){ .some = true, .waves = bake->plan.waves_done };
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        if (stage->what.wave != merged->waves) continue;
        merged->expected += stage->what.task_count;
        merged->missing += stage->what.task_count - stage->done_count;
    }
    if (merged->missing == merged->expected) merged->missing = 0; // the wave has not begun
}

bool bake_merge(struct bake *bake, const char *path)
{
    if (bake_is_complete(bake)) return true;
    if (!partial_read(bake->host, bake, path)) return false;
    count_missing(bake);
    return true;
}
