// Rank 0 of a team. The calling thread takes messages and deals out tasks, from the same queue from
// which this process' threads take theirs.
#include "bake/lead.h"
#include "bake/membership.h"
#include "bake/message.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static const double TICK_S = 0.1, POLL_S = 2e-3;
// A rank holds tasks of this time beyond those that it runs, so that no thread waits for a message.
static const double AHEAD_S = 0.02;
// To send the inputs of a later wave to one rank: bytes per second of a network of 10 Gbit/s, and
// the time of the messages.
static const double BYTES_PER_S = 1.25e9, FETCH_S = 0.02;
// How long ranks have for their end, which their running tasks delay.
static const double END_S = 10.0;

enum member_state {
    MEMBER_AWAITED,  // it has not said that it takes part
    MEMBER_PREPARES, // it prepares, or waits for the start
    MEMBER_READY,
    MEMBER_ENDED
};

struct member {
    enum member_state state;
    int threads;
    struct queued_task *held; // dealt, without a result
    size_t held_count, capacity;
    size_t tasks; // with a result
};

struct lead {
    struct bake *bake;
    const struct bake_run_options *options;
    const struct bake_team *team;
    struct member *members; // [team->count]; that of rank 0 has ended
    int most_ranks;         // that run the wave, besides rank 0
    bool quits;             // a rank was asked to stop
    bool stopped;           // all were told to end
    double reported_s;      // while it waits for the others
};

static int count_in(const struct lead *lead, enum member_state state)
{
    int count = 0;
    for (int rank = 1; rank < lead->team->count; rank++)
        count += lead->members[rank].state == state;
    return count;
}

bool lead_has_others(const struct lead *lead)
{
    return count_in(lead, MEMBER_PREPARES) + count_in(lead, MEMBER_READY) > 0;
}

int lead_threads(const struct lead *lead)
{
    int threads = 0;
    for (int rank = 1; rank < lead->team->count; rank++)
        if (lead->members[rank].state == MEMBER_READY) threads += lead->members[rank].threads;
    return threads;
}

static void tell_all(struct lead *lead, enum stop why, const char *text)
{
    if (lead->stopped) return;
    lead->stopped = true;
    for (int rank = 1; rank < lead->team->count; rank++)
        message_send_text(lead->bake->host, lead->team, rank, MESSAGE_STOP, why, text);
}

// ---- the beginning

static bool refuse(struct lead *lead, const char *why)
{
    tell_all(lead, STOP_REFUSED, why);
    return host_fail(lead->bake->host, FAIL_ARGUMENT,
                     "cannot bake %s with %d ranks: %s; start all with the same program, files and "
                     "options",
                     lead->bake->identity.technique, lead->team->count, why);
}

static bool fail_awaited(struct lead *lead, int rank, const char *text, size_t size)
{
    const int length = (int)(size < RELAY_MESSAGE ? size : RELAY_MESSAGE);
    tell_all(lead, STOP_CANCELLED, "another rank has ended");
    return host_fail(lead->bake->host, FAIL_FILE, "cannot bake %s with %d ranks: rank %d: %.*s",
                     lead->bake->identity.technique, lead->team->count, rank,
                     length > 0 ? length : 13, length > 0 ? text : "it has ended.");
}

static bool welcome(struct lead *lead, int rank, const void *data, size_t size)
{
    struct message message;
    const char *text;
    size_t text_size;
    char why[RELAY_MESSAGE];
    if (!message_parse(data, size, &message, &text, &text_size) || message.kind != MESSAGE_HELLO)
        return true; // what an earlier bake left
    if (membership_difference(lead->bake, rank, text, text_size, why, sizeof why))
        return refuse(lead, why);
    lead->members[rank].state = MEMBER_PREPARES;
    lead->members[rank].threads = message.count > 0 ? (int)message.count : 1;
    return true;
}

static void nap(void)
{
    nanosleep(&(struct timespec){ .tv_nsec = (long)(1e9 * POLL_S) }, NULL);
}

// About ten times a second. False: the program asks to stop.
static bool report_waiting(struct lead *lead, const char *what, bool stopping)
{
    const struct bake_run_options *options = lead->options;
    if (!options->progress || run_now_s() - lead->reported_s < TICK_S) return true;
    lead->reported_s = run_now_s();
    return options->progress(options->user,
                             &(struct bake_progress){ .stage = what, .stopping = stopping });
}

static bool is_member(const struct lead *lead, int rank)
{
    return rank > 0 && rank < lead->team->count;
}

static bool meet(struct lead *lead)
{
    const struct bake_team *team = lead->team;
    while (count_in(lead, MEMBER_AWAITED) > 0) {
        int rank = 0;
        const void *data = NULL;
        size_t size = 0;
        const enum bake_news news = team->receive(team->user, &rank, &data, &size);
        if (news != BAKE_NOTHING && !is_member(lead, rank)) continue;
        if (news == BAKE_LOST) return fail_awaited(lead, rank, data, size);
        if (news == BAKE_MESSAGE && !welcome(lead, rank, data, size)) return false;
        if (news == BAKE_MESSAGE) continue;
        if (!report_waiting(lead, "waiting for ranks", false)) {
            tell_all(lead, STOP_CANCELLED, "interrupted");
            return host_fail(lead->bake->host, FAIL_CANCELLED, "cannot finish the bake: cancelled");
        }
        nap();
    }
    return true;
}

struct lead *lead_create(struct bake *bake, const struct bake_run_options *options)
{
    struct lead *lead = host_alloc(bake->host, 1, sizeof *lead);
    if (!lead) return NULL;
    *lead = (struct lead){ .bake = bake, .options = options, .team = options->team };
    lead->members = host_alloc(bake->host, (size_t)lead->team->count, sizeof *lead->members);
    if (lead->members && meet(lead)) return lead;
    lead_destroy(lead);
    return NULL;
}

void lead_destroy(struct lead *lead)
{
    if (!lead) return;
    for (int rank = 0; lead->members && rank < lead->team->count; rank++)
        host_free(lead->bake->host, lead->members[rank].held);
    host_free(lead->bake->host, lead->members);
    host_free(lead->bake->host, lead);
}

// ---- the journal

static bool some_task_is_done(const struct bake *bake)
{
    for (int s = 0; s < bake->plan.stage_count; s++)
        if (bake->plan.stages[s].done_count > 0) return true;
    return false;
}

// The checkpoint has all that is finished now, so that the journal may begin empty.
static bool begin_journal(struct bake_run *run)
{
    struct bake *bake = run->bake;
    const char *checkpoint = run->options->checkpoint;
    if (!checkpoint) return true;
    if (!some_task_is_done(bake))
        bake_forget_checkpoint(bake);
    else if (!run_checkpoint(bake->host, bake, checkpoint, bake->seconds))
        return false;
    return journal_begin(&run->journal, bake, checkpoint);
}

// Any thread. The run fails where a journal cannot be written.
static void keep(struct bake_run *run, const struct queued_task *task, void *const *out,
                 const size_t *bytes, double seconds)
{
    char text[RELAY_MESSAGE];
    (void)bytes;
    if (run->journal.file < 0) return;
    const struct journal_entry entry = { task->stage, task->index, seconds, run_seconds(run) };
    if (journal_add(&run->journal, run->bake, &entry, out)) return;
    snprintf(text, sizeof text,
             "cannot keep finished tasks in %.500s: %s; make room: the same command continues with "
             "those before",
             run->journal.path, strerror(run->journal.why));
    run_fail(run, FAIL_FILE, text);
}

bool lead_begin(struct bake_run *run)
{
    struct lead *lead = run->lead;
    run->calls.keep = keep;
    if (!begin_journal(run)) return false;
    for (int rank = 1; rank < lead->team->count; rank++)
        message_send(run->bake->host, lead->team, rank, &(struct message){ .kind = MESSAGE_START },
                     NULL, 0);
    return true;
}

// ---- dealing

static bool is_held(struct member *member, const struct planned_stage *stage, size_t index,
                    bool remove)
{
    for (size_t i = 0; i < member->held_count; i++) {
        if (member->held[i].stage != stage || member->held[i].index != index) continue;
        if (remove) member->held[i] = member->held[--member->held_count];
        return true;
    }
    return false;
}

static bool grow_held(struct bake_run *run, struct member *member)
{
    if (member->held_count < member->capacity) return true;
    const size_t capacity = member->capacity ? 2 * member->capacity : 64;
    struct queued_task *held = host_realloc(run->bake->host, member->held, capacity, sizeof *held);
    if (!held) return false;
    member->held = held;
    member->capacity = capacity;
    return true;
}

// Takes a task from the queue for another rank.
static bool take_for(struct bake_run *run, struct queued_task *out)
{
    bool some = false;
    pthread_mutex_lock(&run->bake->mutex);
    if (!atomic_load(&run->stop) && run->queue_next < run->queue_count) {
        *out = run->queue[run->queue_next++];
        run->newest = out->stage;
        run->remote++;
        some = true;
    }
    pthread_mutex_unlock(&run->bake->mutex);
    return some;
}

static bool deal_one(struct bake_run *run, int rank)
{
    struct member *member = &run->lead->members[rank];
    struct queued_task task;
    if (!grow_held(run, member) || !take_for(run, &task)) return false;
    member->held[member->held_count++] = task;
    const struct message message = { .kind = MESSAGE_TASK,
                                     .stage = (uint32_t)(task.stage - run->bake->plan.stages),
                                     .task = task.index };
    message_send(run->bake->host, run->lead->team, rank, &message, NULL, 0);
    return true;
}

// Tasks that a rank holds. The last ones of a wave go to threads that are free.
static size_t held_at_most(struct bake_run *run, const struct member *member, size_t all_threads)
{
    size_t ahead = 1;
    pthread_mutex_lock(&run->bake->mutex);
    const size_t left = run->queue_count - run->queue_next;
    const struct planned_stage *stage = left > 0 ? run->queue[run->queue_next].stage : NULL;
    if (stage && stage->done_count > 0) {
        const double mean = stage->seconds / (double)stage->done_count;
        const double wanted = ceil(AHEAD_S * member->threads / fmax(mean, 1e-6));
        ahead = wanted < 1000.0 ? (size_t)wanted : 1000;
    }
    pthread_mutex_unlock(&run->bake->mutex);
    return (size_t)member->threads + (left > 2 * all_threads * ahead ? ahead : 0);
}

// The ranks that run the wave are the first ones.
static void deal(struct bake_run *run)
{
    struct lead *lead = run->lead;
    const size_t all_threads = (size_t)(run->threads + lead_threads(lead));
    bool some = lead->most_ranks > 0;
    while (some) {
        int ranks = 0;
        some = false;
        for (int rank = 1; rank < lead->team->count && ranks < lead->most_ranks; rank++) {
            struct member *member = &lead->members[rank];
            if (member->state != MEMBER_READY) continue;
            ranks++;
            if (member->held_count < held_at_most(run, member, all_threads))
                some = deal_one(run, rank) || some;
        }
    }
}

// All tensors of earlier waves that are kept: which of them the wave reads is not known.
static double input_bytes(const struct bake_plan *plan)
{
    double bytes = 0.0;
    for (int s = 0; s < plan->stage_count; s++)
        for (int i = 0; i < plan->stages[s].what.output_count; i++)
            if (plan->stages[s].outputs[i].view.data)
                bytes += (double)plan->stages[s].outputs[i].bytes;
    return bytes;
}

// Rank 0 sends inputs to n ranks one after the other, which then share the work: n · send + work /
// n is least where n = √(work / send).
static int ranks_worth(const struct bake_run *run, int wave)
{
    const struct prediction speed = prediction_now(run->bake, run->per_flop_s);
    const double work = prediction_wave(run->bake, &speed, wave, run->options, run->threads);
    const double send = FETCH_S + input_bytes(&run->bake->plan) / BYTES_PER_S;
    return (int)fmin(sqrt(work / send), (double)run->lead->team->count);
}

// A wave of one task may use all threads here; its inputs are here, too.
void lead_begin_wave(struct bake_run *run)
{
    const int wave = run->bake->plan.waves_done;
    run->lead->most_ranks = run->queue_count < 2 ? 0
                            : wave == 0          ? run->lead->team->count
                                                 : ranks_worth(run, wave);
}

// ---- messages of a run

static void send_part(struct bake_run *run, int rank, const struct message *wanted)
{
    const struct bake_plan *plan = &run->bake->plan;
    struct message message = *wanted;
    const char *from = NULL;
    size_t size = 0;
    message.kind = MESSAGE_PART;
    message.size = UINT64_MAX;
    if (wanted->stage < (uint32_t)plan->stage_count &&
        wanted->task < (uint64_t)plan->stages[wanted->stage].what.output_count) {
        const struct tensor *view = &plan->stages[wanted->stage].outputs[wanted->task].view;
        if (view->data && wanted->count <= view->bytes) {
            message.size = view->bytes;
            from = (const char *)view->data + wanted->count;
            size = view->bytes - (size_t)wanted->count;
        }
    }
    if (size > MESSAGE_PART_BYTES) size = MESSAGE_PART_BYTES;
    message_send(run->bake->host, run->lead->team, rank, &message, from, size);
}

// Copies the blocks into the tensors; *out: where they are now. False: the message is wrong.
static bool take_blocks(struct planned_stage *stage, size_t task, const char *bytes, size_t size,
                        void **out)
{
    size_t sizes[BAKE_MAX_OUTPUTS];
    if (output_block_sizes(stage, task, sizes) != size) return false;
    for (int i = 0; i < stage->what.output_count; bytes += sizes[i++]) {
        out[i] = output_block(stage, &stage->outputs[i], task, &sizes[i]);
        if (sizes[i] > 0 && !out[i]) return false;
        if (sizes[i] > 0) memcpy(out[i], bytes, sizes[i]);
    }
    return true;
}

// Only the first result of a task counts: two are equal.
static void take_result(struct bake_run *run, int rank, const struct message *message,
                        const char *bytes, size_t size)
{
    struct bake_plan *plan = &run->bake->plan;
    struct member *member = &run->lead->members[rank];
    void *out[BAKE_MAX_OUTPUTS];
    if (message->stage >= (uint32_t)plan->stage_count) return;
    struct planned_stage *stage = &plan->stages[message->stage];
    const struct queued_task task = { stage, (size_t)message->task };
    if (!is_held(member, stage, task.index, true) || stage->done[task.index]) return;
    if (!take_blocks(stage, task.index, bytes, size, out)) {
        run_fail(run, FAIL_FORMAT, "a result of another rank has the wrong size");
        return;
    }
    keep(run, &task, out, NULL, message->seconds);
    member->tasks++;
    pthread_mutex_lock(&run->bake->mutex);
    run_mark_done(stage, task.index, message->seconds);
    run->remote--;
    pthread_cond_broadcast(&run->changed);
    pthread_mutex_unlock(&run->bake->mutex);
}

static void take_failure(struct bake_run *run, int rank, const struct message *message,
                         const char *text, size_t size)
{
    char all[RELAY_MESSAGE];
    snprintf(all, sizeof all, "rank %d: %.*s", rank, (int)(size < 900 ? size : 900), text);
    run_fail(run, (enum fail_kind)message->count, all);
}

static void describe_end(const struct bake_run *run, int rank, const struct message *message)
{
    host_log(run->bake->host, LOG_INFO,
             "rank %d: %zu tasks, %.1f s on its threads, at most %.0f MB of memory with the scene",
             rank, run->lead->members[rank].tasks, message->seconds, (double)message->count * 1e-6);
}

// Its tasks go back to the queue.
static void lose(struct bake_run *run, int rank)
{
    struct member *member = &run->lead->members[rank];
    const size_t count = member->held_count;
    if (member->state == MEMBER_ENDED) return;
    pthread_mutex_lock(&run->bake->mutex);
    while (member->held_count > 0)
        run->queue[--run->queue_next] = member->held[--member->held_count];
    run->remote -= count;
    pthread_cond_broadcast(&run->changed);
    pthread_mutex_unlock(&run->bake->mutex);
    member->state = MEMBER_ENDED;
    if (!run->lead->stopped)
        host_log(run->bake->host, LOG_WARNING,
                 "rank %d has ended: its %zu unfinished tasks run on other ranks", rank, count);
}

static void take_message(struct bake_run *run, int rank, const void *data, size_t size)
{
    struct member *member = &run->lead->members[rank];
    struct message message;
    const char *bytes;
    size_t count;
    if (!message_parse(data, size, &message, &bytes, &count)) return;
    switch (message.kind) {
    case MESSAGE_READY:
        member->state = MEMBER_READY;
        break;
    case MESSAGE_RESULT:
        take_result(run, rank, &message, bytes, count);
        break;
    case MESSAGE_WANT:
        send_part(run, rank, &message);
        break;
    case MESSAGE_FAIL:
        take_failure(run, rank, &message, bytes, count);
        break;
    case MESSAGE_QUIT:
        run->lead->quits = true;
        break;
    case MESSAGE_LOG:
        host_log(run->bake->host, (enum log_level)message.count, "rank %d: %.*s", rank, (int)count,
                 bytes);
        break;
    case MESSAGE_BYE:
        describe_end(run, rank, &message);
        lose(run, rank);
        break;
    default:
        break;
    }
}

bool lead_poll(struct bake_run *run)
{
    struct lead *lead = run->lead;
    const struct bake_team *team = lead->team;
    for (;;) {
        int rank = 0;
        const void *data = NULL;
        size_t size = 0;
        const enum bake_news news = team->receive(team->user, &rank, &data, &size);
        if (news == BAKE_NOTHING) break;
        if (!is_member(lead, rank)) continue;
        if (news == BAKE_LOST)
            lose(run, rank);
        else
            take_message(run, rank, data, size);
    }
    deal(run);
    return !lead->quits;
}

// ---- the end

void lead_stop(struct bake_run *run)
{
    tell_all(run->lead, STOP_CANCELLED, "rank 0 was asked to stop");
}

// Their last results are kept.
static void await_ends(struct bake_run *run)
{
    struct lead *lead = run->lead;
    const double begun = run_now_s();
    lead->most_ranks = 0;
    while (lead_has_others(lead) && run_now_s() - begun < END_S) {
        lead_poll(run);
        report_waiting(lead, "waiting for ranks", run->cancelled);
        nap();
    }
}

void lead_end(struct bake_run *run, bool ok)
{
    tell_all(run->lead, ok ? STOP_DONE : STOP_CANCELLED, ok ? "" : "rank 0 has failed");
    await_ends(run);
    journal_finish(&run->journal, run->bake->host);
}

bool lead_dismiss(struct lead *lead)
{
    struct bake_run run;
    const bool ok = run_init(&run, lead->bake, lead->options);
    run.lead = lead;
    if (ok) lead_end(&run, true);
    run_finish(&run);
    return ok;
}
