// A rank of a team other than 0. The calling thread has the messages; tasks run on threads of their
// own, which wait for it where they need a tensor.
#include "bake/follow.h"
#include "bake/membership.h"
#include "bake/message.h"

#include "core/parallel.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

static const double TICK_S = 0.1, POLL_S = 2e-3;

// A result on its way.
struct parcel {
    struct parcel *next;
    struct message message;
    size_t size;
    char bytes[];
};

// A tensor of an earlier wave, fetched part by part.
struct fetch {
    bool wanted, asked, absent; // asked: for a part that has not come
    char *data;
    size_t have;
};

struct follow {
    struct bake *bake;
    const struct bake_run_options *options;
    const struct bake_team *team;
    struct bake_run run;
    // Under bake->mutex.
    struct parcel *first, **last; // finished results, in their order
    struct fetch *fetches;        // of all outputs of the plan
    bool wants;                   // one of them has not been asked for
    // For the calling thread alone.
    bool started, ended, quits, told_failure;
    enum stop why;
    char text[RELAY_MESSAGE]; // why
    int wave;                 // of the newest task
    double reported_s, busy_s;
};

static bool has_news(const struct bake_run *run)
{
    const struct follow *f = run->follow;
    return f->first || f->wants || f->run.message_count > 0;
}

// ---- on the threads of tasks

static void send_later(struct bake_run *run, const struct queued_task *task, void *const *out,
                       const size_t *bytes, double seconds)
{
    struct follow *f = run->follow;
    struct relay_host own;
    size_t size = 0;
    for (int i = 0; i < task->stage->what.output_count; i++) size += bytes[i];
    relay_host_init(&own, f->bake->host, &f->bake->memory);
    struct parcel *parcel = host_alloc(&own.host, 1, sizeof *parcel + size);
    if (!parcel) {
        run_fail(&f->run, FAIL_MEMORY, own.error);
        return;
    }
    parcel->message = (struct message){ .kind = MESSAGE_RESULT,
                                        .stage = (uint32_t)(task->stage - f->bake->plan.stages),
                                        .task = task->index,
                                        .seconds = seconds };
    parcel->size = size;
    char *to = parcel->bytes;
    for (int i = 0; i < task->stage->what.output_count; to += bytes[i++])
        if (bytes[i] > 0) memcpy(to, out[i], bytes[i]);
    pthread_mutex_lock(&f->bake->mutex);
    *f->last = parcel;
    f->last = &parcel->next;
    pthread_cond_signal(&f->run.ended);
    pthread_mutex_unlock(&f->bake->mutex);
}

static struct planned_output *find_output(const struct bake_plan *plan, const char *name,
                                          size_t *index)
{
    size_t i = 0;
    for (int s = 0; s < plan->stage_count; s++)
        for (int k = 0; k < plan->stages[s].what.output_count; k++, i++) {
            *index = i;
            if (strcmp(plan->stages[s].outputs[k].what.name, name) == 0)
                return &plan->stages[s].outputs[k];
        }
    return NULL;
}

static const struct tensor *fetch_input(struct bake_run *run, const char *name)
{
    struct follow *f = run->follow;
    size_t index = 0;
    struct planned_output *output = find_output(&f->bake->plan, name, &index);
    if (!output) return NULL;
    struct fetch *fetch = &f->fetches[index];
    pthread_mutex_lock(&f->bake->mutex);
    while (!output->view.data && !fetch->absent && !atomic_load(&f->run.stop)) {
        f->wants = f->wants || !fetch->wanted;
        fetch->wanted = true;
        pthread_cond_signal(&f->run.ended);
        pthread_cond_wait(&f->run.changed, &f->bake->mutex);
    }
    const struct tensor *view = output->view.data ? &output->view : NULL;
    pthread_mutex_unlock(&f->bake->mutex);
    return view;
}

// ---- sending

static void send_results(struct follow *f)
{
    pthread_mutex_lock(&f->bake->mutex);
    struct parcel *next = f->first;
    f->first = NULL;
    f->last = &f->first;
    pthread_mutex_unlock(&f->bake->mutex);
    while (next) {
        struct parcel *parcel = next;
        next = parcel->next;
        f->busy_s += parcel->message.seconds;
        message_send(f->bake->host, f->team, 0, &parcel->message, parcel->bytes, parcel->size);
        host_free(f->bake->host, parcel);
    }
}

static void ask(struct follow *f, int stage, int output, struct fetch *fetch)
{
    if (!fetch->wanted || fetch->asked || fetch->absent) return;
    fetch->asked = true;
    message_send(f->bake->host, f->team, 0,
                 &(struct message){ .kind = MESSAGE_WANT,
                                    .stage = (uint32_t)stage,
                                    .task = (uint64_t)output,
                                    .count = fetch->have },
                 NULL, 0);
}

static void send_wants(struct follow *f)
{
    const struct bake_plan *plan = &f->bake->plan;
    struct fetch *fetch = f->fetches;
    pthread_mutex_lock(&f->bake->mutex);
    for (int s = 0; s < plan->stage_count; s++)
        for (int k = 0; k < plan->stages[s].what.output_count; k++, fetch++)
            if (!plan->stages[s].outputs[k].view.data) ask(f, s, k, fetch);
    f->wants = false;
    pthread_mutex_unlock(&f->bake->mutex);
}

static void send_messages(struct follow *f)
{
    struct run_message message;
    while (run_take_message(&f->run, &message))
        message_send_text(f->bake->host, f->team, 0, MESSAGE_LOG, (uint64_t)message.level,
                          message.text);
    pthread_mutex_lock(&f->bake->mutex);
    const bool failed = f->run.failed;
    pthread_mutex_unlock(&f->bake->mutex);
    if (!failed || f->told_failure) return;
    f->told_failure = true;
    message_send_text(f->bake->host, f->team, 0, MESSAGE_FAIL, (uint64_t)f->run.failure,
                      f->run.failure_text);
}

static void send_quit(struct follow *f)
{
    const struct bake_run_options *options = f->options;
    if (!options->progress || run_now_s() - f->reported_s < TICK_S) return;
    f->reported_s = run_now_s();
    const bool go_on = options->progress(
        options->user, &(struct bake_progress){ .stage = "", .stopping = f->quits });
    if (go_on || f->quits) return;
    f->quits = true;
    message_send(f->bake->host, f->team, 0, &(struct message){ .kind = MESSAGE_QUIT }, NULL, 0);
}

// ---- receiving

// Tensors that no wave from this one on reads.
static void free_before(struct follow *f, int wave)
{
    for (int s = 0; s < f->bake->plan.stage_count; s++)
        for (int k = 0; k < f->bake->plan.stages[s].what.output_count; k++) {
            struct planned_output *output = &f->bake->plan.stages[s].outputs[k];
            if (output->what.keep >= wave) continue;
            host_free(f->bake->host, output->data);
            output->view.data = output->data = NULL;
        }
    f->wave = wave;
}

static void take_task(struct follow *f, const struct message *message)
{
    struct bake_run *run = &f->run;
    const struct bake_plan *plan = &f->bake->plan;
    if (message->stage >= (uint32_t)plan->stage_count ||
        message->task >= plan->stages[message->stage].what.task_count)
        return;
    struct planned_stage *stage = &plan->stages[message->stage];
    if (stage->what.wave > f->wave) free_before(f, stage->what.wave);
    pthread_mutex_lock(&f->bake->mutex);
    run->queue_count -= run->queue_next;
    memmove(run->queue, run->queue + run->queue_next, run->queue_count * sizeof *run->queue);
    run->queue_next = 0;
    run->queue[run->queue_count++] = (struct queued_task){ stage, (size_t)message->task };
    pthread_cond_signal(&run->changed);
    pthread_mutex_unlock(&f->bake->mutex);
}

static void publish(struct follow *f, struct planned_output *output, struct fetch *fetch)
{
    pthread_mutex_lock(&f->bake->mutex);
    output->data = fetch->data;
    output->view.data = fetch->data;
    *fetch = (struct fetch){ 0 };
    pthread_cond_broadcast(&f->run.changed);
    pthread_mutex_unlock(&f->bake->mutex);
}

static void mark_absent(struct follow *f, struct fetch *fetch)
{
    pthread_mutex_lock(&f->bake->mutex);
    fetch->absent = true;
    pthread_cond_broadcast(&f->run.changed);
    pthread_mutex_unlock(&f->bake->mutex);
}

static void take_part(struct follow *f, const struct message *message, const char *bytes,
                      size_t size)
{
    const struct bake_plan *plan = &f->bake->plan;
    if (message->stage >= (uint32_t)plan->stage_count ||
        message->task >= (uint64_t)plan->stages[message->stage].what.output_count)
        return;
    struct planned_output *output = &plan->stages[message->stage].outputs[message->task];
    size_t index = 0;
    find_output(plan, output->what.name, &index);
    struct fetch *fetch = &f->fetches[index];
    if (!fetch->asked || message->count != fetch->have) return;
    if (!fetch->data) fetch->data = host_alloc(f->bake->host, output->bytes, 1);
    if (!fetch->data || message->size != output->bytes || size > output->bytes - fetch->have) {
        mark_absent(f, fetch);
        return;
    }
    if (size > 0) memcpy(fetch->data + fetch->have, bytes, size);
    fetch->have += size;
    fetch->asked = false;
    if (fetch->have == output->bytes) publish(f, output, fetch);
}

static void end(struct follow *f, enum stop why, const char *text, size_t size)
{
    f->ended = true;
    f->why = why;
    snprintf(f->text, sizeof f->text, "%.*s", (int)(size < RELAY_MESSAGE ? size : RELAY_MESSAGE),
             text ? text : "");
}

static void take_message(struct follow *f, const void *data, size_t size)
{
    struct message message;
    const char *bytes;
    size_t count;
    if (!message_parse(data, size, &message, &bytes, &count)) return;
    if (message.kind == MESSAGE_START) f->started = true;
    if (message.kind == MESSAGE_TASK) take_task(f, &message);
    if (message.kind == MESSAGE_PART) take_part(f, &message, bytes, count);
    if (message.kind == MESSAGE_STOP) end(f, (enum stop)message.count, bytes, count);
}

static void receive(struct follow *f)
{
    while (!f->ended) {
        int rank = 0;
        const void *data = NULL;
        size_t size = 0;
        const enum bake_news news = f->team->receive(f->team->user, &rank, &data, &size);
        if (news == BAKE_NOTHING) return;
        if (rank != 0) continue;
        if (news == BAKE_LOST)
            end(f, STOP_CANCELLED, "rank 0 has ended", sizeof "rank 0 has ended");
        else
            take_message(f, data, size);
    }
}

// ---- the run

static void nap(void)
{
    nanosleep(&(struct timespec){ .tv_nsec = (long)(1e9 * POLL_S) }, NULL);
}

static void await_start(struct follow *f)
{
    for (;;) {
        receive(f);
        if (f->started || f->ended) return;
        send_quit(f);
        nap();
    }
}

static void exchange(struct follow *f)
{
    while (!f->ended) {
        pthread_mutex_lock(&f->bake->memory); // while it uses the program's host
        receive(f);
        send_results(f);
        send_wants(f);
        send_messages(f);
        send_quit(f);
        pthread_mutex_unlock(&f->bake->memory);
        if (!f->ended && run_wait(&f->run, POLL_S)) nap(); // they have failed
    }
}

static void stop_tasks(struct follow *f)
{
    pthread_mutex_lock(&f->bake->mutex);
    f->run.closed = true;
    atomic_store(&f->run.stop, true);
    pthread_cond_broadcast(&f->run.changed);
    pthread_mutex_unlock(&f->bake->mutex);
}

static bool run_tasks_dealt(struct follow *f)
{
    const struct bake_job *job = &f->bake->plan.job;
    pthread_t driver;
    bool ok = !job->prepare || job->prepare(job->job, f->bake->host);
    if (ok && pthread_create(&driver, NULL, run_drive, &f->run) != 0)
        ok = host_fail(f->bake->host, FAIL_MEMORY, "cannot bake: no thread could be started");
    if (ok) {
        message_send(f->bake->host, f->team, 0, &(struct message){ .kind = MESSAGE_READY }, NULL,
                     0);
        exchange(f);
        stop_tasks(f);
        pthread_join(driver, NULL);
        send_results(f);
    }
    if (job->finish) job->finish(job->job);
    return ok;
}

// The last message that could not be sent as one of a task.
static void tell_failure(struct follow *f)
{
    message_send_text(f->bake->host, f->team, 0, MESSAGE_FAIL, (uint64_t)f->bake->host->failure,
                      "it could not prepare the bake");
}

static void say_bye(struct follow *f)
{
    struct rusage usage = { 0 };
    getrusage(RUSAGE_SELF, &usage);
    message_send(f->bake->host, f->team, 0,
                 &(struct message){ .kind = MESSAGE_BYE,
                                    .count = (uint64_t)usage.ru_maxrss << 10,
                                    .seconds = f->busy_s },
                 NULL, 0);
}

static bool say_hello(struct follow *f)
{
    const int most = parallel_threads();
    const int threads = f->run.threads < most ? f->run.threads : most;
    const struct message message = { .kind = MESSAGE_HELLO, .count = (uint64_t)threads };
    size_t size = 0;
    char *text = membership_print(f->bake->host, f->bake, &size);
    const bool ok = text && message_send(f->bake->host, f->team, 0, &message, text, size);
    host_free(f->bake->host, text);
    return ok;
}

static bool fail_end(const struct follow *f)
{
    return host_fail(f->bake->host, f->why == STOP_REFUSED ? FAIL_ARGUMENT : FAIL_CANCELLED,
                     "cannot finish the bake as rank %d: %s", f->team->rank, f->text);
}

static bool take_part_in(struct follow *f)
{
    if (!say_hello(f)) return false;
    await_start(f);
    const bool ok = f->ended || run_tasks_dealt(f);
    if (!ok) tell_failure(f);
    say_bye(f);
    return ok && (f->why == STOP_DONE || fail_end(f));
}

static size_t count_outputs(const struct bake_plan *plan)
{
    size_t count = 0;
    for (int s = 0; s < plan->stage_count; s++) count += (size_t)plan->stages[s].what.output_count;
    return count;
}

static void free_fetches(struct follow *f)
{
    const size_t count = f->fetches ? count_outputs(&f->bake->plan) : 0;
    for (size_t i = 0; i < count; i++) host_free(f->bake->host, f->fetches[i].data);
    host_free(f->bake->host, f->fetches);
}

bool follow_run(struct bake *bake, const struct bake_run_options *options)
{
    struct follow *f = host_alloc(bake->host, 1, sizeof *f);
    if (!f) return false;
    *f = (struct follow){ .bake = bake, .options = options, .team = options->team };
    f->last = &f->first;
    bool ok = run_init(&f->run, bake, options);
    f->run.follow = f;
    f->run.calls = (struct run_calls){ send_later, fetch_input, has_news };
    f->fetches = host_alloc(bake->host, count_outputs(&bake->plan), sizeof *f->fetches);
    ok = ok && f->fetches && take_part_in(f);
    free_fetches(f);
    run_finish(&f->run);
    host_free(bake->host, f);
    return ok;
}
