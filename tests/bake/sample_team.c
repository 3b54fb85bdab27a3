#include "bake/sample_team.h"

#include "bake/message.h"
#include "framework/test.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct letter {
    struct letter *next;
    int from;
    enum bake_news news;
    size_t size;
    char bytes[];
};

struct rank {
    struct world *world;
    int number, results_sent;
    struct letter *first, **last; // under the world's mutex
    struct letter *open;          // received last
    struct host host;
    struct bake_sample sample;
    struct bake_team team;
    bool lost;
};

struct world {
    const struct team_plan *plan;
    struct team_result *out;
    pthread_mutex_t mutex;
    struct rank ranks[TEAM_MOST];
};

struct team_plan team_plan_default(int ranks)
{
    return (struct team_plan){
        .ranks = ranks, .sample = bake_sample_default(), .quitting_rank = -1, .failing_rank = -1
    };
}

// ---- messages

static void post(struct world *world, int from, int to, enum bake_news news, const void *data,
                 size_t size)
{
    struct letter *letter = calloc(1, sizeof *letter + size);
    if (!letter) abort();
    letter->from = from;
    letter->news = news;
    letter->size = size;
    if (size > 0) memcpy(letter->bytes, data, size);
    pthread_mutex_lock(&world->mutex);
    *world->ranks[to].last = letter;
    world->ranks[to].last = &letter->next;
    pthread_mutex_unlock(&world->mutex);
}

// As a process that is killed: it sends nothing more, and its messages to itself end.
static void lose(struct rank *rank)
{
    rank->lost = true;
    post(rank->world, rank->number, 0, BAKE_LOST, NULL, 0);
    post(rank->world, 0, rank->number, BAKE_LOST, NULL, 0);
}

static bool send_to(void *user, int to, const void *data, size_t size)
{
    struct rank *rank = user;
    const struct team_plan *plan = rank->world->plan;
    struct message message;
    if (rank->lost) return false;
    memcpy(&message, data, sizeof message);
    if (message.kind == MESSAGE_RESULT) rank->results_sent++;
    if (message.kind == MESSAGE_RESULT && rank->number > 0 && rank->number == plan->lost_rank &&
        rank->results_sent > plan->lost_after) {
        lose(rank);
        return false;
    }
    post(rank->world, rank->number, to, BAKE_MESSAGE, data, size);
    return true;
}

static enum bake_news receive_from(void *user, int *from, const void **data, size_t *size)
{
    struct rank *rank = user;
    free(rank->open);
    pthread_mutex_lock(&rank->world->mutex);
    struct letter *letter = rank->open = rank->first;
    if (letter) rank->first = letter->next;
    if (!rank->first) rank->last = &rank->first;
    pthread_mutex_unlock(&rank->world->mutex);
    if (!letter) return BAKE_NOTHING;
    *from = letter->from;
    *data = letter->bytes;
    *size = letter->size;
    return letter->news;
}

// ---- a rank

static void keep_message(void *user, enum log_level level, const char *text)
{
    struct rank *rank = user;
    struct team_result *out = rank->world->out;
    if (level == LOG_ERROR) snprintf(out->error[rank->number], TEAM_TEXT, "%s", text);
    if (level == LOG_WARNING) snprintf(out->warning[rank->number], TEAM_TEXT, "%s", text);
}

static bool go_on(void *user, const struct bake_progress *progress)
{
    const struct rank *rank = user;
    if (rank->number != rank->world->plan->quitting_rank) return true;
    return rank->number == 0 ? progress->done <= 0.0 : rank->results_sent == 0;
}

static void *run_rank(void *user)
{
    struct rank *rank = user;
    const struct team_plan *plan = rank->world->plan;
    struct team_result *out = rank->world->out;
    struct bake_identity identity = bake_sample_identity();
    if (rank->number > 0 && plan->other_seed_of == (uint64_t)rank->number) identity.seed++;
    struct bake *bake = bake_sample_create_for(&rank->host, &rank->sample, &identity);
    const struct bake_run_options options = { .threads = plan->threads > 0 ? plan->threads : 1,
                                              .checkpoint =
                                                  rank->number == 0 ? plan->checkpoint : NULL,
                                              .progress = go_on,
                                              .user = rank,
                                              .team = &rank->team };
    bool ok = bake && bake_run(bake, &options);
    out->failure[rank->number] = rank->host.failure;
    if (rank->number == 0) out->complete = bake && bake_is_complete(bake);
    if (ok && rank->number == 0 && plan->path) ok = bake_save(bake, plan->path, false);
    out->ok[rank->number] = ok;
    out->runs[rank->number] = rank->sample.runs;
    bake_destroy(bake);
    return NULL;
}

static void begin_rank(struct world *world, int number)
{
    struct rank *rank = &world->ranks[number];
    *rank = (struct rank){ .world = world, .number = number, .host = host_default() };
    rank->last = &rank->first;
    rank->host.log = keep_message;
    rank->host.log_up_to = LOG_WARNING;
    rank->host.user = rank;
    rank->sample = world->plan->sample;
    if (number == world->plan->failing_rank) rank->sample.fail_prepare = true;
    rank->team = (struct bake_team){ .rank = number,
                                     .count = world->plan->ranks,
                                     .send = send_to,
                                     .receive = receive_from,
                                     .user = rank };
}

static void end_rank(struct rank *rank)
{
    free(rank->open);
    while (rank->first) {
        struct letter *letter = rank->first;
        rank->first = letter->next;
        free(letter);
    }
}

void team_run(const struct team_plan *plan, struct team_result *out)
{
    struct world world = { .plan = plan, .out = out };
    pthread_t threads[TEAM_MOST];
    *out = (struct team_result){ 0 };
    pthread_mutex_init(&world.mutex, NULL);
    for (int i = 0; i < plan->ranks; i++) begin_rank(&world, i);
    for (int i = 0; i < plan->ranks; i++)
        CHECK(pthread_create(&threads[i], NULL, run_rank, &world.ranks[i]) == 0);
    for (int i = 0; i < plan->ranks; i++) pthread_join(threads[i], NULL);
    for (int i = 0; i < plan->ranks; i++) end_rank(&world.ranks[i]);
    pthread_mutex_destroy(&world.mutex);
}
