// Running the tasks of a queue, on threads of their own.
#include "bake/run_state.h"

#include "core/parallel.h"
#include "core/rng.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

// ---- a run

double run_now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double run_seconds(const struct bake_run *run)
{
    return run->bake->seconds + run_now_s() - run->begun_s;
}

bool run_init(struct bake_run *run, struct bake *bake, const struct bake_run_options *options)
{
    size_t tasks = 0;
    for (int s = 0; s < bake->plan.stage_count; s++) tasks += bake->plan.stages[s].what.task_count;
    *run =
        (struct bake_run){ .bake = bake,
                           .options = options,
                           .threads = options->threads > 0 ? options->threads : parallel_threads(),
                           .begun_s = run_now_s(),
                           .per_flop_s = prediction_flop_seconds(bake->host) };
    run->journal.file = -1;
    run->checkpoint_s = run->begun_s;
    pthread_cond_init(&run->changed, NULL);
    pthread_cond_init(&run->ended, NULL);
    run->queue = host_alloc(bake->host, tasks, sizeof *run->queue);
    run->messages = host_alloc(bake->host, RUN_MESSAGES, sizeof *run->messages);
    return run->queue && run->messages;
}

void run_finish(struct bake_run *run)
{
    pthread_cond_destroy(&run->changed);
    pthread_cond_destroy(&run->ended);
    host_free(run->bake->host, run->queue);
    host_free(run->bake->host, run->messages);
}

// ---- messages and failures

bool run_take_message(struct bake_run *run, struct run_message *out)
{
    pthread_mutex_lock(&run->bake->mutex);
    const bool some = run->message_count > 0;
    if (some) {
        *out = run->messages[0];
        memmove(run->messages, run->messages + 1,
                (size_t)--run->message_count * sizeof *run->messages);
    }
    pthread_mutex_unlock(&run->bake->mutex);
    return some;
}

static void queue_message(void *user, enum log_level level, const char *text)
{
    struct bake_run *run = user;
    pthread_mutex_lock(&run->bake->mutex);
    if (run->message_count < RUN_MESSAGES) {
        struct run_message *message = &run->messages[run->message_count++];
        message->level = level;
        snprintf(message->text, sizeof message->text, "%s", text);
    }
    pthread_mutex_unlock(&run->bake->mutex);
}

void run_fail(struct bake_run *run, enum fail_kind kind, const char *text)
{
    pthread_mutex_lock(&run->bake->mutex);
    if (!run->failed && !atomic_load(&run->stop)) {
        run->failed = true;
        run->failure = kind;
        snprintf(run->failure_text, sizeof run->failure_text, "%s", text);
        atomic_store(&run->stop, true);
        pthread_cond_broadcast(&run->changed);
    }
    pthread_mutex_unlock(&run->bake->mutex);
}

// ---- a task

// The blocks that a task writes: of the tensors, or of a follower, which sends them, memory of
// their own.
struct blocks {
    void *out[BAKE_MAX_OUTPUTS];
    size_t bytes[BAKE_MAX_OUTPUTS];
    struct arena own;
};

static bool begin_blocks(struct bake_run *run, const struct queued_task *at, struct host *host,
                         struct blocks *blocks)
{
    struct planned_stage *stage = at->stage;
    output_block_sizes(stage, at->index, blocks->bytes);
    arena_init(&blocks->own, host);
    for (int i = 0; i < stage->what.output_count; i++) {
        size_t bytes = 0;
        blocks->out[i] = run->calls.input
                             ? arena_alloc(&blocks->own, blocks->bytes[i] + 1, 1)
                             : output_block(stage, &stage->outputs[i], at->index, &bytes);
        if (run->calls.input && !blocks->out[i]) return false;
        if (blocks->out[i]) memset(blocks->out[i], 0, blocks->bytes[i]);
    }
    return true;
}

static uint64_t task_seed(const struct bake *bake, const struct planned_stage *stage, size_t index)
{
    const char *name = stage->what.name;
    return rng_mix(hash_bytes(name, strlen(name), bake->identity.seed) + index);
}

void run_mark_done(struct planned_stage *stage, size_t index, double seconds)
{
    stage->done[index] = true;
    stage->done_count++;
    stage->seconds += seconds;
    stage->task_seconds[index] = (float)seconds;
}

static void keep_results(struct bake_run *run, const struct queued_task *at,
                         const struct blocks *blocks, double seconds)
{
    if (run->calls.keep) run->calls.keep(run, at, blocks->out, blocks->bytes, seconds);
    if (run->calls.input) return; // they are those of another process
    pthread_mutex_lock(&run->bake->mutex);
    run_mark_done(at->stage, at->index, seconds);
    pthread_mutex_unlock(&run->bake->mutex);
}

static bool call_task(struct bake_run *run, const struct queued_task *at, struct host *host,
                      struct blocks *blocks)
{
    struct bake_output outputs[BAKE_MAX_OUTPUTS];
    for (int k = 0; k < at->stage->what.output_count; k++) outputs[k] = at->stage->outputs[k].what;
    const struct bake_task task = { .host = host,
                                    .argument = at->stage->what.argument,
                                    .job = run->bake->plan.job.job,
                                    .index = at->index,
                                    .count = at->stage->what.task_count,
                                    .seed = task_seed(run->bake, at->stage, at->index),
                                    .bake_seed = run->bake->identity.seed,
                                    .out = blocks->out,
                                    .outputs = outputs,
                                    .rows_together = at->stage->what.rows_together,
                                    .run = run };
    return at->stage->what.run(&task);
}

static void run_task(struct bake_run *run, const struct queued_task *at)
{
    struct blocks blocks;
    struct relay_host own;
    relay_host_init(&own, run->bake->host, &run->bake->memory);
    own.message = queue_message;
    own.user = run;
    const double begun = run_now_s();
    const bool ok =
        begin_blocks(run, at, &own.host, &blocks) && call_task(run, at, &own.host, &blocks);
    if (ok)
        keep_results(run, at, &blocks, run_now_s() - begun);
    else
        run_fail(run, own.host.failure != FAIL_NONE ? own.host.failure : FAIL_ARGUMENT,
                 own.error[0] ? own.error : "a task failed without a message");
    arena_finish(&blocks.own);
}

// The next task of the queue; false: there is none, and none will come.
static bool take_task(struct bake_run *run, struct queued_task *out)
{
    bool some = false;
    pthread_mutex_lock(&run->bake->mutex);
    while (!atomic_load(&run->stop) && run->queue_next == run->queue_count &&
           (run->remote > 0 || (run->calls.input && !run->closed)))
        pthread_cond_wait(&run->changed, &run->bake->mutex);
    if (!atomic_load(&run->stop) && run->queue_next < run->queue_count) {
        *out = run->queue[run->queue_next++];
        run->newest = out->stage;
        some = true;
    }
    pthread_mutex_unlock(&run->bake->mutex);
    return some;
}

static void run_tasks_of_queue(void *user, size_t thread)
{
    struct bake_run *run = user;
    struct queued_task task;
    (void)thread;
    while (take_task(run, &task)) run_task(run, &task);
}

uint64_t bake_task_rows(const struct bake_task *task, int output, uint64_t *rows)
{
    return bake_rows_together(output_rows(&task->outputs[output]), task->rows_together, task->index,
                              task->count, rows);
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

// The bytes that each other rank of a team would fetch in this wave.
static void count_input(struct bake_run *run, const char *name)
{
    struct bake_plan *plan = &run->bake->plan;
    struct planned_stage *of_wave = NULL;
    pthread_mutex_lock(&run->bake->mutex);
    for (int s = 0; s < plan->stage_count && !of_wave; s++)
        if (plan->stages[s].what.wave == plan->waves_done) of_wave = &plan->stages[s];
    for (int s = 0; of_wave && s < plan->stage_count; s++)
        for (int i = 0; i < plan->stages[s].what.output_count; i++) {
            struct planned_output *output = &plan->stages[s].outputs[i];
            if (output->read_by_wave == plan->waves_done || strcmp(output->what.name, name) != 0)
                continue;
            output->read_by_wave = plan->waves_done;
            of_wave->input_bytes += output->bytes;
        }
    pthread_mutex_unlock(&run->bake->mutex);
}

const struct tensor *bake_task_input(const struct bake_task *task, const char *name)
{
    struct bake_run *run = task->run;
    const struct tensor *tensor =
        run->calls.input ? run->calls.input(run, name) : results_find(run->bake, name);
    if (tensor && !run->calls.input) count_input(run, name);
    if (!tensor && !atomic_load(&run->stop))
        host_fail(task->host, FAIL_ARGUMENT,
                  "cannot bake: no earlier wave has made the tensor %s, or it is not kept", name);
    return tensor;
}

void *run_drive(void *user)
{
    struct bake_run *run = user;
    // A single task may use all threads itself.
    const size_t most = run->calls.input ? (size_t)run->threads : run->queue_count;
    const size_t threads = most < (size_t)run->threads ? most : (size_t)run->threads;
    parallel_for_on((int)threads, threads, 1, run_tasks_of_queue, run);
    pthread_mutex_lock(&run->bake->mutex);
    run->has_ended = true;
    pthread_cond_signal(&run->ended);
    pthread_mutex_unlock(&run->bake->mutex);
    return NULL;
}

bool run_wait(struct bake_run *run, double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += (long)(1e9 * seconds);
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_mutex_lock(&run->bake->mutex);
    int waited = 0;
    while (!run->has_ended && waited != ETIMEDOUT &&
           !(run->calls.has_news && run->calls.has_news(run)))
        waited = pthread_cond_timedwait(&run->ended, &run->bake->mutex, &until);
    const bool ended = run->has_ended;
    pthread_mutex_unlock(&run->bake->mutex);
    return ended;
}
