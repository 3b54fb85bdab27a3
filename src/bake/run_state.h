// A run while it lasts. tasks.c runs its tasks; run.c, lead.c and follow.c drive it.
#pragma once

#include "bake/bake_state.h"
#include "bake/journal.h"
#include "bake/relay_host.h"

#include <stdatomic.h>

struct bake_run;
struct lead;
struct follow;

struct queued_task {
    struct planned_stage *stage;
    size_t index;
};

// How a rank of a team treats its tasks. Each may be NULL.
struct run_calls {
    // Keeps the results of a task. On its thread.
    void (*keep)(struct bake_run *run, const struct queued_task *task, void *const *out,
                 const size_t *bytes, double seconds);
    // A tensor of an earlier wave, fetched. With it results are not the tensors of this process.
    const struct tensor *(*input)(struct bake_run *run, const char *name);
    // Whether something waits to be sent. Under bake->mutex.
    bool (*has_news)(const struct bake_run *run);
};

struct run_message {
    enum log_level level;
    char text[RELAY_MESSAGE];
};

struct bake_run {
    struct bake *bake;
    const struct bake_run_options *options;
    bool probe;                             // only a few tasks
    int threads;                            // of this process
    double begun_s;                         // when it began
    double per_flop_s;                      // see prediction_flop_seconds
    struct run_calls calls;                 // of a team
    struct lead *lead;                      // of rank 0 of a team; NULL: none
    struct follow *follow;                  // of its other ranks; NULL: none
    struct journal journal;                 // of a team
    atomic_bool stop;                       // cancelled, or a task failed
    bool cancelled;                         // calling thread only
    double checkpoint_s, checkpoint_cost_s; // when the last one ended, how long it took
    double reported_s;                      // when progress was last reported

    // Under bake->mutex.
    struct queued_task *queue; // of the wave; of a follower those that it was given
    size_t queue_next, queue_count;
    size_t remote;          // tasks of the wave that other ranks have
    bool closed;            // of a follower: no more tasks will come
    pthread_cond_t changed; // the queue, `remote`, `stop`, an input of a follower
    pthread_cond_t ended;   // has_ended, or something to send
    bool has_ended;
    const struct planned_stage *newest; // stage of the task that began last
    bool failed;
    enum fail_kind failure;
    char failure_text[RELAY_MESSAGE];
    struct run_message *messages; // [RUN_MESSAGES], not yet passed on
    int message_count;
};
enum { RUN_MESSAGES = 64 };

double run_now_s(void);
// Wall time of this run and of those before.
double run_seconds(const struct bake_run *run);
bool run_init(struct bake_run *run, struct bake *bake, const struct bake_run_options *options);
void run_finish(struct bake_run *run);
// Takes tasks of the queue on run->threads threads until there are none: on a thread of its own.
void *run_drive(void *run);
// Waits for the end of the tasks or for something to send, at most `seconds`. Whether they ended.
bool run_wait(struct bake_run *run, double seconds);
// Stops the run with this failure, unless it has failed or stopped before.
void run_fail(struct bake_run *run, enum fail_kind kind, const char *text);
// Moves the oldest message to *out. False: there is none.
bool run_take_message(struct bake_run *run, struct run_message *out);
// A task is done; its results are in its block. Under bake->mutex.
void run_mark_done(struct planned_stage *stage, size_t index, double seconds);
// Writes the checkpoint of what is finished; messages and memory by `host`.
bool run_checkpoint(struct host *host, struct bake *bake, const char *path, double seconds);
