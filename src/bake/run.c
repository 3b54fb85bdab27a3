// Runs the tasks of a bake. A second thread drives the OpenMP loop over the tasks of a wave; the
// calling thread meanwhile reports progress, passes on messages and writes checkpoints.
#include "bake/lead.h"
#include "bake/run_state.h"

#include "core/parallel.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double TICK_S = 0.1;       // between two reports of progress
static const double TEAM_TICK_S = 2e-3; // between two looks for messages of other ranks

// ---- the calling thread

static void pass_on_messages(struct bake_run *run)
{
    struct run_message message;
    while (run_take_message(run, &message))
        host_log(run->bake->host, message.level, "%s", message.text);
}

// A checkpoint that cannot be written is not a reason to stop.
static void write_checkpoint(struct bake_run *run)
{
    struct bake *bake = run->bake;
    const char *path = run->options->checkpoint;
    if (!path || run->lead) return; // what a team finishes is in its journal
    struct relay_host quiet;
    relay_host_init(&quiet, bake->host, NULL);
    const double begun = run_now_s();
    if (run_checkpoint(&quiet.host, bake, path, run_seconds(run)))
        bake_forget_journal(bake->host, path);
    else
        host_log(bake->host, LOG_WARNING, "no checkpoint is kept: %s", quiet.error);
    run->checkpoint_s = run_now_s();
    run->checkpoint_cost_s = run->checkpoint_s - begun;
    host_log(bake->host, LOG_DEBUG, "checkpoint %s: %.2f s", path, run->checkpoint_cost_s);
}

static bool some_task_is_done(const struct bake *bake)
{
    for (int s = 0; s < bake->plan.stage_count; s++)
        if (bake->plan.stages[s].done_count > 0) return true;
    return false;
}

// More threads than processors are no faster.
static int run_useful_threads(const struct bake_run *run)
{
    const int most = parallel_threads();
    return (run->threads < most ? run->threads : most) + (run->lead ? lead_threads(run->lead) : 0);
}

// Before the first task ends the time left is a guess, and the share done 0.
static bool report_progress(struct bake_run *run)
{
    struct bake *bake = run->bake;
    if (!run->options->progress) return true;
    pthread_mutex_lock(&bake->mutex);
    const struct prediction speed = prediction_now(bake, run->per_flop_s);
    const double left = prediction_left(bake, &speed, run->options, run_useful_threads(run));
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
    return every > 0.0 &&
           run_now_s() - run->checkpoint_s > fmax(every, 20.0 * run->checkpoint_cost_s);
}

static void cancel(struct bake_run *run)
{
    run->cancelled = true;
    pthread_mutex_lock(&run->bake->mutex);
    atomic_store(&run->stop, true);
    pthread_cond_broadcast(&run->changed);
    pthread_mutex_unlock(&run->bake->mutex);
    if (run->lead) lead_stop(run);
    write_checkpoint(run);
    report_progress(run);
}

static void tick(struct bake_run *run)
{
    pass_on_messages(run);
    const bool go_on = !run->lead || lead_poll(run);
    const bool due = !run->lead || run_now_s() - run->reported_s >= TICK_S;
    if (due) run->reported_s = run_now_s();
    if ((!go_on || (due && !report_progress(run))) && !run->cancelled) cancel(run);
    if (!run->cancelled && checkpoint_is_due(run)) write_checkpoint(run);
}

static bool drive_queue(struct bake_run *run)
{
    pthread_t driver;
    run->has_ended = false;
    if (run->lead) lead_begin_wave(run);
    if (pthread_create(&driver, NULL, run_drive, run) != 0)
        return host_fail(run->bake->host, FAIL_MEMORY, "cannot bake: no thread could be started");
    do {
        pthread_mutex_lock(&run->bake->memory); // while it uses the program's host
        tick(run);
        pthread_mutex_unlock(&run->bake->memory);
    } while (!run_wait(run, run->lead && lead_has_others(run->lead) ? TEAM_TICK_S : TICK_S));
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
    run->queue_next = run->queue_count = 0;
    for (int s = 0; s < plan->stage_count; s++) {
        struct planned_stage *stage = &plan->stages[s];
        if (stage->what.wave == 0 && stage->done_count == 0 && !is_queued(run, stage))
            queue_probes(run, stage);
    }
}

static void fill_queue(struct bake_run *run, int wave)
{
    struct bake_plan *plan = &run->bake->plan;
    run->queue_next = run->queue_count = 0;
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
    const double begun = run_now_s();
    bool ok = !job->prepare || job->prepare(job->job, run->bake->host);
    run->bake->prepare_seconds = run_now_s() - begun;
    ok = ok && run_waves(run);
    if (job->finish) job->finish(job->job);
    return ok;
}

bool run_bake(struct bake *bake, const struct bake_run_options *options, bool probe)
{
    struct bake_run run;
    bool ok = run_init(&run, bake, options);
    run.probe = probe;
    ok = ok && run_job(&run);
    bake->seconds = run_seconds(&run);
    run_finish(&run);
    return ok;
}

bool run_bake_led(struct bake *bake, const struct bake_run_options *options, struct lead *lead)
{
    struct bake_run run;
    bool ok = run_init(&run, bake, options);
    run.lead = lead;
    ok = ok && lead_begin(&run) && run_job(&run);
    lead_end(&run, ok);
    bake->seconds = run_seconds(&run);
    run_finish(&run);
    return ok;
}
