// A bake by two processes, here two threads with a context each and a queue of messages between
// them.
#include "api/renderer_fixture.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RANKS = 2, GI_SIZE = 64 };

struct letter {
    struct letter *next;
    size_t bytes;
    char data[];
};

struct rank {
    struct ag_bake_team team;
    struct rank *other;
    pthread_mutex_t *mutex;
    struct letter *first, *open; // arrived; received last
    char gi[GI_SIZE];
    const char *path; // where the bake is saved; NULL: it is not
    enum ag_result result;
    char error[512];
    bool complete;
};

static bool send_letter(void *user, int to, const void *data, size_t bytes)
{
    struct rank *rank = user;
    struct letter *letter = calloc(1, sizeof *letter + bytes);
    if (!letter || to != rank->other->team.rank) return false;
    letter->bytes = bytes;
    memcpy(letter->data, data, bytes);
    pthread_mutex_lock(rank->mutex);
    struct letter **last = &rank->other->first;
    while (*last) last = &(*last)->next;
    *last = letter;
    pthread_mutex_unlock(rank->mutex);
    return true;
}

static enum ag_bake_news receive_letter(void *user, int *from, const void **data, size_t *bytes)
{
    struct rank *rank = user;
    free(rank->open);
    pthread_mutex_lock(rank->mutex);
    rank->open = rank->first;
    if (rank->open) rank->first = rank->open->next;
    pthread_mutex_unlock(rank->mutex);
    if (!rank->open) return AG_BAKE_NOTHING;
    *from = rank->other->team.rank;
    *data = rank->open->data;
    *bytes = rank->open->bytes;
    return AG_BAKE_MESSAGE;
}

static enum ag_result bake(struct rank *rank, struct ag_context *context)
{
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_info info = { 0 };
    enum ag_result result = ag_scene_load(context, "@cornell", &scene);
    if (result == AG_OK) result = ag_bake_create(scene, rank->gi, NULL, &bake);
    if (result == AG_OK) result = ag_bake_run_team(bake, &rank->team, NULL, NULL);
    if (bake) ag_bake_get_info(bake, &info);
    rank->complete = info.complete;
    if (result == AG_OK && rank->path) result = ag_bake_save(bake, rank->path, false);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    return result;
}

static void *run_rank(void *user)
{
    struct rank *rank = user;
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    ag_context_desc_default(&desc);
    rank->result = ag_context_create(&desc, &context);
    if (rank->result == AG_OK) rank->result = bake(rank, context);
    if (context) snprintf(rank->error, sizeof rank->error, "%s", ag_context_last_error(context));
    ag_context_destroy(context);
    return NULL;
}

static void begin_ranks(struct rank ranks[RANKS], pthread_mutex_t *mutex)
{
    for (int i = 0; i < RANKS; i++) {
        ranks[i] = (struct rank){ .other = &ranks[1 - i], .mutex = mutex };
        ag_bake_team_default(&ranks[i].team);
        ranks[i].team.rank = i;
        ranks[i].team.count = RANKS;
        ranks[i].team.send = send_letter;
        ranks[i].team.receive = receive_letter;
        ranks[i].team.user = &ranks[i];
        snprintf(ranks[i].gi, sizeof ranks[i].gi, "sample:rows=40");
    }
}

static void run_ranks(struct rank ranks[RANKS])
{
    pthread_t threads[RANKS];
    for (int i = 0; i < RANKS; i++)
        CHECK(pthread_create(&threads[i], NULL, run_rank, &ranks[i]) == 0);
    for (int i = 0; i < RANKS; i++) pthread_join(threads[i], NULL);
    for (int i = 0; i < RANKS; i++) {
        free(ranks[i].open);
        while (ranks[i].first) {
            struct letter *letter = ranks[i].first;
            ranks[i].first = letter->next;
            free(letter);
        }
    }
}

static void save_alone(const char *gi, const char *path)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    assert_int_equal(ag_bake_create(scene, gi, NULL, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(ag_bake_save(bake, path, false), AG_OK);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

static size_t read_file(const char *path, char *out, size_t size)
{
    FILE *file = fopen(path, "rb");
    CHECK(file != NULL);
    const size_t bytes = fread(out, 1, size, file);
    fclose(file);
    return bytes;
}

TEST(bake_team_of_two_contexts_writes_the_same_file_as_one)
{
    static char one[1 << 20], two[1 << 20];
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    struct rank ranks[RANKS];
    begin_ranks(ranks, &mutex);
    ranks[0].path = test_path("team.safetensors");
    run_ranks(ranks);
    assert_int_equal(ranks[0].result, AG_OK);
    assert_int_equal(ranks[1].result, AG_OK);
    CHECK(ranks[0].complete && !ranks[1].complete);
    const char *alone = test_path("alone.safetensors");
    save_alone(ranks[0].gi, alone);
    const size_t bytes = read_file(alone, one, sizeof one);
    CHECK(bytes > 0 && bytes == read_file(ranks[0].path, two, sizeof two));
    CHECK(memcmp(one, two, bytes) == 0);
}

TEST(bake_team_of_different_options_is_refused_on_both)
{
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    struct rank ranks[RANKS];
    begin_ranks(ranks, &mutex);
    snprintf(ranks[1].gi, sizeof ranks[1].gi, "sample:rows=41");
    run_ranks(ranks);
    for (int i = 0; i < RANKS; i++) {
        assert_int_equal(ranks[i].result, AG_ERROR_ARGUMENT);
        CHECK(strstr(ranks[i].error, "rank 1 has other options: rows is 41, not 40"));
    }
}

TEST(bake_team_that_is_wrong_is_refused)
{
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    struct rank ranks[RANKS];
    begin_ranks(ranks, &mutex);
    for (int i = 0; i < RANKS; i++) ranks[i].team.rank = 2;
    run_ranks(ranks);
    CHECK(ranks[0].result == AG_ERROR_ARGUMENT && strstr(ranks[0].error, "rank 2 is not one of 2"));
    begin_ranks(ranks, &mutex);
    for (int i = 0; i < RANKS; i++) ranks[i].team.send = NULL;
    run_ranks(ranks);
    CHECK(ranks[0].result == AG_ERROR_ARGUMENT &&
          strstr(ranks[0].error, "send or receive is NULL"));
}
