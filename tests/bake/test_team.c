// A bake by several ranks: the same bytes as by one, whatever becomes of the ranks.
#include "bake/sample_team.h"

#include "core/files/file.h"
#include "framework/test.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { TASKS = 7 + 5 + 1 + 4, FIRST_WAVE = 12 };

static struct file_bytes bake_alone(int rows)
{
    struct bake_sample sample = bake_sample_default();
    sample.rows = rows;
    struct bake *bake = bake_sample_create(&sample, NULL);
    const char *path = test_path("alone.safetensors");
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2 }));
    CHECK(bake_save(bake, path, false));
    bake_destroy(bake);
    return bake_sample_bytes(path);
}

static void check_same_as_alone(const char *path, int rows)
{
    struct file_bytes wanted = bake_alone(rows), got = bake_sample_bytes(path);
    CHECK(got.size == wanted.size && memcmp(got.data, wanted.data, got.size) == 0);
    file_bytes_finish(test_host(), &wanted);
    file_bytes_finish(test_host(), &got);
}

static int sum_of(const int *runs, int ranks)
{
    int sum = 0;
    for (int i = 0; i < ranks; i++) sum += runs[i];
    return sum;
}

TEST(team_of_1_to_4_ranks_gives_the_same_bytes_and_runs_each_task_once)
{
    for (int ranks = 1; ranks <= 4; ranks++) {
        struct team_plan plan = team_plan_default(ranks);
        struct team_result result;
        plan.path = test_path("team.safetensors");
        plan.sample.task_s = 0.02;
        team_run(&plan, &result);
        for (int i = 0; i < ranks; i++) CHECK(result.ok[i] && result.runs[i] > 0);
        assert_int_equal(sum_of(result.runs, ranks), TASKS);
        check_same_as_alone(plan.path, 23);
    }
}

TEST(team_runs_tasks_on_several_threads_of_each_rank)
{
    struct team_plan plan = team_plan_default(3);
    struct team_result result;
    plan.path = test_path("threads.safetensors");
    plan.threads = 3;
    plan.sample.task_s = 0.02;
    team_run(&plan, &result);
    assert_int_equal(sum_of(result.runs, 3), TASKS);
    check_same_as_alone(plan.path, 23);
}

// Its last wave reads a matrix that is sent in several parts.
TEST(team_sends_tensors_of_earlier_waves_to_the_ranks_that_read_them)
{
    enum { ROWS = 400000 };
    struct team_plan plan = team_plan_default(3);
    struct team_result result;
    plan.path = test_path("inputs.safetensors");
    plan.sample.rows = ROWS;
    plan.sample.task_s = plan.sample.last_s = 0.05;
    plan.sample.last_flops = 1e12; // a wave that is worth it
    team_run(&plan, &result);
    CHECK(result.ok[0] && result.ok[1] && result.ok[2]);
    assert_int_equal(sum_of(result.runs, 3), TASKS);
    check_same_as_alone(plan.path, ROWS);
}

TEST(team_that_loses_a_rank_runs_its_tasks_on_others)
{
    for (int after = 0; after < 3; after++) {
        struct team_plan plan = team_plan_default(3);
        struct team_result result;
        plan.path = test_path("lost.safetensors");
        plan.sample.task_s = 0.03;
        plan.lost_rank = 2;
        plan.lost_after = after;
        team_run(&plan, &result);
        CHECK(result.ok[0] && result.ok[1] && !result.ok[2]);
        CHECK(strstr(result.warning[0], "rank 2 has ended"));
        CHECK(sum_of(result.runs, 3) > TASKS); // those that it did not give back
        check_same_as_alone(plan.path, 23);
    }
}

TEST(team_goes_on_alone_without_the_other_rank)
{
    struct team_plan plan = team_plan_default(2);
    struct team_result result;
    plan.path = test_path("left.safetensors");
    plan.sample.task_s = 0.03;
    plan.lost_rank = 1;
    team_run(&plan, &result);
    CHECK(result.ok[0] && result.complete);
    check_same_as_alone(plan.path, 23);
}

TEST(team_refuses_a_rank_that_bakes_something_else)
{
    struct team_plan plan = team_plan_default(3);
    struct team_result result;
    plan.other_seed_of = 2;
    team_run(&plan, &result);
    for (int i = 0; i < 3; i++)
        CHECK(!result.ok[i] && result.failure[i] == FAIL_ARGUMENT && result.runs[i] == 0);
    CHECK(strstr(result.error[0], "rank 2 has another --seed: 6, not 5"));
    CHECK(strstr(result.error[1], "rank 2 has another --seed"));
}

TEST(team_whose_rank_cannot_prepare_fails_and_names_it)
{
    struct team_plan plan = team_plan_default(3);
    struct team_result result;
    plan.failing_rank = 1;
    plan.sample.task_s = 0.2;
    team_run(&plan, &result);
    CHECK(!result.ok[0] && !result.ok[1] && !result.ok[2]);
    CHECK(strstr(result.error[0], "rank 1: ") && result.failure[0] == FAIL_MEMORY);
}

TEST(team_whose_task_fails_gives_its_message)
{
    struct team_plan plan = team_plan_default(2);
    struct team_result result;
    plan.sample.failing_task = 3;
    plan.sample.task_s = 0.02;
    team_run(&plan, &result);
    CHECK(!result.ok[0] && !result.ok[1] && result.failure[0] == FAIL_UNSUPPORTED);
    CHECK(strstr(result.error[0], "it is made to fail"));
}

// ---- interruptions

// The next run, of one process, has the rest to do.
static void check_resumes(const char *checkpoint, const char *path, int most_runs)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2, .checkpoint = checkpoint }));
    CHECK(sample.runs <= most_runs);
    CHECK(bake_save(bake, path, false));
    CHECK(access(checkpoint, F_OK) != 0);
    bake_destroy(bake);
    check_same_as_alone(path, 23);
}

TEST(team_whose_rank_is_asked_to_stop_ends_and_resumes)
{
    for (int rank = 0; rank < 3; rank++) {
        struct team_plan plan = team_plan_default(3);
        struct team_result result;
        plan.checkpoint = test_path("quit.checkpoint");
        plan.quitting_rank = rank;
        plan.sample.task_s = 0.06;
        team_run(&plan, &result);
        for (int i = 0; i < 3; i++) CHECK(!result.ok[i] && result.failure[i] == FAIL_CANCELLED);
        check_resumes(plan.checkpoint, test_path("quit.safetensors"), TASKS - 1);
        CHECK(access(test_path("quit.checkpoint.tasks"), F_OK) != 0);
    }
}

// The journal of a whole bake, which was not saved.
static struct file_bytes journal_of_a_bake(const char *checkpoint)
{
    struct team_plan plan = team_plan_default(2);
    struct team_result result;
    char path[600];
    plan.checkpoint = checkpoint;
    plan.sample.task_s = 0.005;
    team_run(&plan, &result);
    CHECK(result.ok[0]);
    snprintf(path, sizeof path, "%s.tasks", checkpoint);
    return bake_sample_bytes(path);
}

static void write_bytes(const char *path, const uint8_t *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(data, 1, size, file) == size && fclose(file) == 0);
}

// Paths of a checkpoint and its journal, longer than test_path keeps them.
struct paths {
    char checkpoint[600], journal[600];
};

static struct paths paths_of(const char *name)
{
    struct paths out;
    snprintf(out.checkpoint, sizeof out.checkpoint, "%s", test_path(name));
    snprintf(out.journal, sizeof out.journal, "%.580s.tasks", out.checkpoint);
    return out;
}

static int runs_with(const char *checkpoint)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    const char *path = test_path("torn.safetensors");
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 1, .checkpoint = checkpoint }));
    CHECK(bake_save(bake, path, false));
    bake_destroy(bake);
    check_same_as_alone(path, 23);
    return sample.runs;
}

TEST(team_journal_that_ends_anywhere_gives_the_same_bytes_with_less_to_do)
{
    const struct paths paths = paths_of("torn.checkpoint");
    struct file_bytes whole = journal_of_a_bake(paths.checkpoint);
    int before = TASKS;
    for (size_t size = 0; size < whole.size; size += 37) {
        write_bytes(paths.journal, whole.data, size);
        const int runs = runs_with(paths.checkpoint);
        CHECK(runs <= before); // the longer, the less
        before = runs;
    }
    CHECK(before <= 1);
    write_bytes(paths.journal, whole.data, whole.size);
    assert_int_equal(runs_with(paths.checkpoint), 0);
    file_bytes_finish(test_host(), &whole);
}

TEST(team_journal_with_a_changed_byte_is_used_up_to_it)
{
    const struct paths paths = paths_of("flipped.checkpoint");
    struct file_bytes whole = journal_of_a_bake(paths.checkpoint);
    for (size_t at = 0; at < whole.size; at += 23) {
        whole.data[at] ^= 0x41;
        write_bytes(paths.journal, whole.data, whole.size);
        whole.data[at] ^= 0x41;
        CHECK(runs_with(paths.checkpoint) > 0);
    }
    file_bytes_finish(test_host(), &whole);
}

TEST(team_journal_of_another_bake_is_ignored_with_a_warning)
{
    const char *checkpoint = test_path("other.checkpoint");
    struct file_bytes whole = journal_of_a_bake(checkpoint);
    struct bake_sample sample = bake_sample_default();
    struct bake_identity identity = bake_sample_identity();
    identity.seed = 77;
    struct bake *bake = bake_sample_create(&sample, &identity);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 1, .checkpoint = checkpoint }));
    CHECK(sample.runs == TASKS && strstr(test_last_message(), "the checkpoint is ignored"));
    bake_destroy(bake);
    file_bytes_finish(test_host(), &whole);
}

// As on a full disk: no file may grow beyond this.
static void limit_files(rlim_t bytes, struct rlimit *before)
{
    CHECK(getrlimit(RLIMIT_FSIZE, before) == 0);
    const struct rlimit limit = { .rlim_cur = bytes, .rlim_max = before->rlim_max };
    signal(SIGXFSZ, SIG_IGN);
    CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
}

TEST(team_on_a_full_disk_ends_with_a_sentence_and_resumes)
{
    struct team_plan plan = team_plan_default(3);
    struct team_result result;
    struct rlimit before;
    plan.checkpoint = test_path("full.checkpoint");
    plan.sample.task_s = 0.02;
    limit_files(700, &before);
    team_run(&plan, &result);
    CHECK(setrlimit(RLIMIT_FSIZE, &before) == 0);
    for (int i = 0; i < 3; i++) CHECK(!result.ok[i]);
    CHECK(result.failure[0] == FAIL_FILE);
    CHECK(strstr(result.error[0], "cannot keep finished tasks in"));
    CHECK(strstr(result.error[0], "the same command continues"));
    check_resumes(plan.checkpoint, test_path("full.safetensors"), TASKS - 1);
}
