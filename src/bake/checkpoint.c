// Checkpoints: the tasks of a run that are finished, in a file that the next run resumes.
#include "bake/journal.h"
#include "bake/relay_host.h"
#include "bake/run_state.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

// The finished tasks, whose blocks are complete and no longer written. NULL: no memory.
static struct finished_tasks *copy_finished(struct host *host, struct bake *bake)
{
    const struct bake_plan *plan = &bake->plan;
    size_t total = 0;
    for (int s = 0; s < plan->stage_count; s++) total += plan->stages[s].what.task_count;
    const size_t table = (size_t)plan->stage_count * sizeof(struct finished_tasks);
    char *memory = host_alloc(host, table + total, 1);
    if (!memory) return NULL;
    struct finished_tasks *stages = (struct finished_tasks *)(void *)memory;
    bool *next = (bool *)(memory + table);
    pthread_mutex_lock(&bake->mutex);
    for (int s = 0; s < plan->stage_count; s++) {
        const size_t count = plan->stages[s].what.task_count;
        stages[s].done = memcpy(next, plan->stages[s].done, count * sizeof *next);
        stages[s].seconds = plan->stages[s].seconds;
        next += count;
    }
    pthread_mutex_unlock(&bake->mutex);
    return stages;
}

bool run_checkpoint(struct host *host, struct bake *bake, const char *path, double seconds)
{
    struct finished_tasks *stages = copy_finished(host, bake);
    const bool ok = stages && partial_write(host, bake, path, stages, seconds);
    host_free(host, stages);
    return ok;
}

// ---- resuming

// A checkpoint that cannot be used costs time; it is not an error.
static void warn_ignored(struct bake *bake, const struct relay_host *quiet)
{
    host_log(bake->host, LOG_WARNING, "the checkpoint is ignored: %s", quiet->error);
}

static void describe_finished(const struct bake *bake)
{
    size_t done = 0, all = 0;
    for (int s = 0; s < bake->plan.stage_count; s++) {
        done += bake->plan.stages[s].done_count;
        all += bake->plan.stages[s].what.task_count;
    }
    if (done > 0)
        host_log(bake->host, LOG_INFO, "%s: %zu of %zu tasks are finished", bake->checkpoint, done,
                 all);
}

static void read_checkpoint(struct bake *bake)
{
    struct relay_host quiet;
    relay_host_init(&quiet, bake->host, NULL);
    if (access(bake->checkpoint, F_OK) == 0 && !partial_read(&quiet.host, bake, bake->checkpoint))
        warn_ignored(bake, &quiet);
    relay_host_init(&quiet, bake->host, NULL);
    if (!bake_is_complete(bake) && !journal_read(&quiet.host, bake, bake->checkpoint))
        warn_ignored(bake, &quiet);
}

bool bake_resume(struct bake *bake, const char *path)
{
    if (!path || (bake->checkpoint && strcmp(bake->checkpoint, path) == 0)) return true;
    host_free(bake->host, bake->checkpoint);
    bake->checkpoint = host_strdup(bake->host, path);
    if (!bake->checkpoint) return false;
    read_checkpoint(bake);
    describe_finished(bake);
    return true;
}

void bake_forget_journal(struct host *host, const char *checkpoint)
{
    char *path = journal_path(host, checkpoint);
    if (path) remove(path);
    host_free(host, path);
}

void bake_forget_checkpoint(struct bake *bake)
{
    if (!bake->checkpoint) return;
    remove(bake->checkpoint);
    bake_forget_journal(bake->host, bake->checkpoint);
}

bool bake_save_partial(struct bake *bake, const char *path)
{
    if (!run_checkpoint(bake->host, bake, path, bake->seconds)) return false;
    bake_forget_checkpoint(bake); // the file has its tasks
    return true;
}
