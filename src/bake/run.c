// Runs the tasks of a bake. A second thread drives the OpenMP loop over the tasks of a wave; the
// calling thread meanwhile reports progress, passes on messages and writes checkpoints.
#include "bake/bake_state.h"
#include "bake/relay_host.h"

#include "core/parallel.h"
#include "core/rng.h"

#include <errno.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { MAX_MESSAGES = 64 };
static const long TICK_NS = 100 * 1000 * 1000;

struct queued_task {
    struct planned_stage *stage;
    size_t index;
};

struct message {
    enum log_level level;
    char text[RELAY_MESSAGE];
};

struct bake_run {
    struct bake *bake;
    const struct bake_run_options *options;
    bool probe; // only a few tasks
    int threads;
    struct queued_task *queue; // of the wave
    size_t queue_count;
    atomic_bool stop; // cancelled, or a task failed
    bool cancelled;   // calling thread only
    double begun_s, per_flop_s;
    double checkpoint_s, checkpoint_cost_s; // when the last one ended, how long it took
    // Under bake->mutex.
    pthread_cond_t ended;
    bool has_ended;
    const struct planned_stage *newest; // stage of the task that began last
    bool failed;
    enum fail_kind failure;
    char failure_text[RELAY_MESSAGE];
    struct message *messages; // [MAX_MESSAGES], not yet passed on
    int message_count;
};

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void queue_message(void *user, enum log_level level, const char *text)
{
    struct bake_run *run = user;
    pthread_mutex_lock(&run->bake->mutex);
    if (run->message_count < MAX_MESSAGES) {
        struct message *message = &run->messages[run->message_count++];
        message->level = level;
        snprintf(message->text, sizeof message->text, "%s", text);
    }
    pthread_mutex_unlock(&run->bake->mutex);
}

// ---- a task

static void clear_blocks(struct planned_stage *stage, size_t index, void **out)
{
    for (int i = 0; i < stage->what.output_count; i++) {
        size_t bytes = 0;
        out[i] = output_block(stage, &stage->outputs[i], index, &bytes);
        if (out[i]) memset(out[i], 0, bytes);
    }
}

static uint64_t task_seed(const struct bake *bake, const struct planned_stage *stage, size_t index)
{
    const char *name = stage->what.name;
    return rng_mix(hash_bytes(name, strlen(name), bake->identity.seed) + index);
}

static void task_ended(struct bake_run *run, const struct queued_task *at, struct relay_host *own,
                       bool ok, double seconds)
{
    pthread_mutex_lock(&run->bake->mutex);
    if (ok) {
        at->stage->done[at->index] = true;
        at->stage->done_count++;
        at->stage->seconds += seconds;
    } else if (!run->failed && !atomic_load(&run->stop)) {
        run->failed = true;
        run->failure = own->host.failure != FAIL_NONE ? own->host.failure : FAIL_ARGUMENT;
        snprintf(run->failure_text, sizeof run->failure_text, "%s",
                 own->error[0] ? own->error : "a task failed without a message");
        atomic_store(&run->stop, true);
    }
    pthread_mutex_unlock(&run->bake->mutex);
}

static void run_task(void *user, size_t i)
{
    struct bake_run *run = user;
    const struct queued_task *at = &run->queue[i];
    struct bake_output outputs[BAKE_MAX_OUTPUTS];
    void *out[BAKE_MAX_OUTPUTS];
    struct relay_host own;
    if (atomic_load(&run->stop)) return;
    pthread_mutex_lock(&run->bake->mutex);
    run->newest = at->stage;
    pthread_mutex_unlock(&run->bake->mutex);
    relay_host_init(&own, run->bake->host, &run->bake->memory);
    own.message = queue_message;
    own.user = run;
    clear_blocks(at->stage, at->index, out);
    for (int k = 0; k < at->stage->what.output_count; k++) outputs[k] = at->stage->outputs[k].what;
    const struct bake_task task = { .host = &own.host,
                                    .argument = at->stage->what.argument,
                                    .job = run->bake->plan.job.job,
                                    .index = at->index,
                                    .count = at->stage->what.task_count,
                                    .seed = task_seed(run->bake, at->stage, at->index),
                                    .bake_seed = run->bake->identity.seed,
                                    .out = out,
                                    .outputs = outputs,
                                    .run = run };
    const double begun = now_s();
    const bool ok = at->stage->what.run(&task);
    task_ended(run, at, &own, ok, now_s() - begun);
}

uint64_t bake_task_rows(const struct bake_task *task, int output, uint64_t *rows)
{
    return bake_rows(output_rows(&task->outputs[output]), task->index, task->count, rows);
}

void *bake_row(const struct bake_task *task, int output, uint64_t row)
{
    const struct bake_output *of = &task->outputs[output];
    size_t bytes = tensor_type_bytes(of->type);
    for (int axis = 1; axis < of->rank; axis++) bytes *= (size_t)of->shape[axis];
    return (uint8_t *)task->out[output] + row * bytes;
}

bool bake_task_cancelled(const struct bake_task *task)
{
    return atomic_load(&task->run->stop);
}

const struct tensor *bake_task_input(const struct bake_task *task, const char *name)
{
    const struct tensor *tensor = results_find(task->run->bake, name);
    if (!tensor)
        host_fail(task->host, FAIL_ARGUMENT,
                  "cannot bake: no earlier wave has made the tensor %s, or it is not kept", name);
    return tensor;
}

// ---- the calling thread

static void pass_on_messages(struct bake_run *run)
{
    struct message copy;
    for (;;) {
        pthread_mutex_lock(&run->bake->mutex);
        const bool some = run->message_count > 0;
        if (some) {
            copy = run->messages[0];
            memmove(run->messages, run->messages + 1,
                    (size_t)--run->message_count * sizeof *run->messages);
        }
        pthread_mutex_unlock(&run->bake->mutex);
        if (!some) return;
        host_log(run->bake->host, copy.level, "%s", copy.text);
    }
}

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

static bool write_now(struct host *host, struct bake *bake, const char *path, double seconds)
{
    struct finished_tasks *stages = copy_finished(host, bake);
    const bool ok = stages && partial_write(host, bake, path, stages, seconds);
    host_free(host, stages);
    return ok;
}

static double run_seconds(const struct bake_run *run)
{
    return run->bake->seconds + now_s() - run->begun_s;
}

// A checkpoint that cannot be written is not a reason to stop.
static void write_checkpoint(struct bake_run *run)
{
    struct bake *bake = run->bake;
    const char *path = run->options->checkpoint;
    if (!path) return;
    struct relay_host quiet;
    relay_host_init(&quiet, bake->host, NULL);
    const double begun = now_s();
    if (!write_now(&quiet.host, bake, path, run_seconds(run)))
        host_log(bake->host, LOG_WARNING, "no checkpoint is kept: %s", quiet.error);
    run->checkpoint_s = now_s();
    run->checkpoint_cost_s = run->checkpoint_s - begun;
    host_log(bake->host, LOG_DEBUG, "checkpoint %s: %.2f s", path, run->checkpoint_cost_s);
}

static bool some_task_is_done(const struct bake *bake)
{
    for (int s = 0; s < bake->plan.stage_count; s++)
        if (bake->plan.stages[s].done_count > 0) return true;
    return false;
}

// Before the first task ends the time left is a guess, and the share done 0.
static bool report_progress(struct bake_run *run)
{
    struct bake *bake = run->bake;
    if (!run->options->progress) return true;
    pthread_mutex_lock(&bake->mutex);
    const struct prediction speed = prediction_now(bake, run->per_flop_s);
    const double left = prediction_left(bake, &speed, run->options, run->threads);
    const char *stage = run->newest ? run->newest->what.name : "";
    const bool some = some_task_is_done(bake);
    pthread_mutex_unlock(&bake->mutex);
    const double passed = run_seconds(run);
    const struct bake_progress progress = { .stage = stage,
                                            .done = some ? passed / fmax(passed + left, 1e-9) : 0.0,
                                            .seconds_left = left,
                                            .stopping = run->cancelled };
    return run->options->progress(run->options->user, &progress);
}

// Large ones are rarer, so that they take at most a twentieth of the time.
static bool checkpoint_is_due(const struct bake_run *run)
{
    const double every = run->options->checkpoint_every_s;
    return every > 0.0 && now_s() - run->checkpoint_s > fmax(every, 20.0 * run->checkpoint_cost_s);
}

static void tick(struct bake_run *run)
{
    pass_on_messages(run);
    if (!report_progress(run) && !run->cancelled) {
        run->cancelled = true;
        atomic_store(&run->stop, true);
        write_checkpoint(run);
        report_progress(run);
    }
    if (!run->cancelled && checkpoint_is_due(run)) write_checkpoint(run);
}

static void *drive(void *user)
{
    struct bake_run *run = user;
    parallel_for_on(run->threads, run->queue_count, 1, run_task, run);
    pthread_mutex_lock(&run->bake->mutex);
    run->has_ended = true;
    pthread_cond_signal(&run->ended);
    pthread_mutex_unlock(&run->bake->mutex);
    return NULL;
}

// Waits for the end of the tasks, at most until the next tick.
static bool wait_for_end(struct bake_run *run)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += TICK_NS;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_mutex_lock(&run->bake->mutex);
    int waited = 0;
    while (!run->has_ended && waited != ETIMEDOUT)
        waited = pthread_cond_timedwait(&run->ended, &run->bake->mutex, &until);
    const bool ended = run->has_ended;
    pthread_mutex_unlock(&run->bake->mutex);
    return ended;
}

static bool drive_queue(struct bake_run *run)
{
    pthread_t driver;
    run->has_ended = false;
    if (pthread_create(&driver, NULL, drive, run) != 0)
        return host_fail(run->bake->host, FAIL_MEMORY, "cannot bake: no thread could be started");
    do {
        pthread_mutex_lock(&run->bake->memory); // while it uses the program's host
        tick(run);
        pthread_mutex_unlock(&run->bake->memory);
    } while (!wait_for_end(run));
    pthread_join(driver, NULL);
    pass_on_messages(run);
    if (run->failed) return host_fail(run->bake->host, run->failure, "%s", run->failure_text);
    if (run->cancelled)
        return host_fail(run->bake->host, FAIL_CANCELLED, "cannot finish the bake: cancelled");
    return true;
}

// ---- waves

static bool is_queued(const struct bake_run *run, const struct planned_stage *stage)
{
    for (size_t i = 0; i < run->queue_count; i++)
        if (run->queue[i].stage->what.run == stage->what.run) return true;
    return false;
}

// Rays traced to measure their time, approximately. Tasks of few rays have other work; one task
// must be enough to measure that.
static const double PROBE_RAYS = 1e6, FEW_RAYS = 1e4;

// Tasks over all of the stage: rays of its first part may be the shortest.
static void queue_probes(struct bake_run *run, struct planned_stage *stage)
{
    const size_t count = stage->what.task_count;
    size_t probes = stage->what.rays > FEW_RAYS ? (size_t)(PROBE_RAYS / stage->what.rays) : 1;
    if (probes > count) probes = count;
    if (probes == 0) probes = 1;
    for (size_t i = 0; i < probes; i++)
        run->queue[run->queue_count++] = (struct queued_task){ stage, i * count / probes };
}

// A few tasks of each kind.
static void fill_probe(struct bake_run *run)
{
    struct bake_plan *plan = &run->bake->plan;
    run->queue_count = 0;
    for (int s = 0; s < plan->stage_count; s++) {
        struct planned_stage *stage = &plan->stages[s];
        if (stage->what.wave == 0 && stage->done_count == 0 && !is_queued(run, stage))
            queue_probes(run, stage);
    }
}

static void fill_queue(struct bake_run *run, int wave)
{
    struct bake_plan *plan = &run->bake->plan;
    run->queue_count = 0;
    for (int s = 0; s < plan->stage_count; s++) {
        struct planned_stage *stage = &plan->stages[s];
        size_t count = 0;
        if (stage->what.wave != wave) continue;
        const size_t first = run_tasks(run->bake, &stage->what, run->options, &count);
        for (size_t i = first; i < first + count; i++)
            if (!stage->done[i]) run->queue[run->queue_count++] = (struct queued_task){ stage, i };
    }
}

static bool run_wave(struct bake_run *run, int wave)
{
    struct bake *bake = run->bake;
    if (!results_begin(bake, wave)) return false;
    if (run->probe)
        fill_probe(run);
    else
        fill_queue(run, wave);
    if (run->queue_count > 0 && !drive_queue(run)) return false;
    if (!results_wave_is_done(bake, wave)) return true; // a shard or a probe
    if (!results_reduce(bake, wave)) return false;
    bake->plan.waves_done = wave + 1;
    return true;
}

// The waves of this run end before this one.
static int end_of_run(const struct bake_run *run)
{
    const int waves = run->bake->plan.waves, split = split_wave(run->bake);
    if (run->probe) return 1;
    return run->options->shard_count > 0 && split < waves ? split + 1 : waves;
}

static bool run_waves(struct bake_run *run)
{
    struct bake_plan *plan = &run->bake->plan;
    const int end = end_of_run(run);
    for (int wave = plan->waves_done; wave < end; wave++)
        if (!run_wave(run, wave)) return false;
    return plan->waves_done < plan->waves || run->bake->tensors || results_collect(run->bake);
}

static bool run_job(struct bake_run *run)
{
    const struct bake_job *job = &run->bake->plan.job;
    const double begun = now_s();
    bool ok = !job->prepare || job->prepare(job->job, run->bake->host);
    run->bake->prepare_seconds = now_s() - begun;
    ok = ok && run_waves(run);
    if (job->finish) job->finish(job->job);
    return ok;
}

static bool allocate_run(struct bake_run *run)
{
    size_t tasks = 0;
    for (int s = 0; s < run->bake->plan.stage_count; s++)
        tasks += run->bake->plan.stages[s].what.task_count;
    run->queue = host_alloc(run->bake->host, tasks, sizeof *run->queue);
    run->messages = host_alloc(run->bake->host, MAX_MESSAGES, sizeof *run->messages);
    return run->queue && run->messages;
}

bool run_bake(struct bake *bake, const struct bake_run_options *options, bool probe)
{
    struct bake_run run = { .bake = bake,
                            .options = options,
                            .probe = probe,
                            .threads = options->threads > 0 ? options->threads : parallel_threads(),
                            .begun_s = now_s(),
                            .per_flop_s = prediction_flop_seconds(bake->host) };
    run.checkpoint_s = run.begun_s;
    pthread_cond_init(&run.ended, NULL);
    const bool ok = allocate_run(&run) && run_job(&run);
    bake->seconds = run_seconds(&run);
    pthread_cond_destroy(&run.ended);
    host_free(bake->host, run.queue);
    host_free(bake->host, run.messages);
    return ok;
}

bool bake_save_partial(struct bake *bake, const char *path)
{
    if (!write_now(bake->host, bake, path, bake->seconds)) return false;
    if (bake->checkpoint) remove(bake->checkpoint); // the file has its tasks
    return true;
}
