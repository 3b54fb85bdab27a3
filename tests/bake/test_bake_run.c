// Running a bake: the same bytes on any number of threads and shards, and after any interruption.
#include "bake/bake_sample.h"
#include "bake/bake_state.h"

#include "core/files/file.h"
#include "framework/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static struct file_bytes bake_on(int threads)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    const char *path = test_path("plain.safetensors");
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = threads }));
    CHECK(bake_is_complete(bake) && sample.runs == 7 + 5 + 1 + 4);
    CHECK(sample.prepared == 1 && sample.finished == 1);
    CHECK(bake_save(bake, path, false));
    bake_destroy(bake);
    return bake_sample_bytes(path);
}

static void check_same(struct file_bytes a, struct file_bytes b)
{
    CHECK(a.size == b.size && memcmp(a.data, b.data, a.size) == 0);
    file_bytes_finish(test_host(), &a);
    file_bytes_finish(test_host(), &b);
}

TEST(groups_of_rows_are_of_one_task_and_tasks_have_all_rows_in_order)
{
    static const uint64_t totals[] = { 0, 1, 15, 16, 17, 100, 1003 };
    for (size_t t = 0; t < sizeof totals / sizeof totals[0]; t++)
        for (size_t count = 1; count < 80; count += 13) {
            uint64_t next = 0;
            for (size_t task = 0; task < count; task++) {
                uint64_t rows;
                const uint64_t first = bake_rows_together(totals[t], 16, task, count, &rows);
                CHECK(first == next && (first % 16 == 0 || first == totals[t]));
                next = first + rows;
            }
            CHECK(next == totals[t]);
        }
}

TEST(bake_gives_the_same_bytes_on_1_2_and_4_threads)
{
    check_same(bake_on(1), bake_on(2));
    check_same(bake_on(1), bake_on(4));
}

TEST(bake_has_every_saved_tensor_and_only_those)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(!bake_tensors(bake) && !bake_reported(bake));
    CHECK(bake_run(bake, &(struct bake_run_options){ 0 }));
    const struct tensors *saved = bake_tensors(bake), *all = bake_reported(bake);
    CHECK(saved->count == 4 && all->count == 5);
    CHECK(tensors_find(saved, "sample/U") && tensors_find(saved, "sample/sum"));
    CHECK(!tensors_find(saved, "sample/F") && !tensors_find(saved, "sample/sigma"));
    CHECK(tensors_find(all, "sample/sigma") && !tensors_find(all, "sample/F"));
    const float *sum = tensors_find(saved, "sample/sum")->data;
    for (int i = 0; i < 4; i++) CHECK(sum[i] > 0.0f && sum[i] < 5000.0f);
    bake_destroy(bake);
}

// ---- cancelling

struct stopper {
    int after; // calls of progress
    int calls, stopping;
    double last_done;
};

static bool stop(void *user, const struct bake_progress *progress)
{
    struct stopper *stopper = user;
    if (progress->done < 0.0 || progress->done > 1.0 || progress->seconds_left < 0.0) return false;
    stopper->last_done = progress->done;
    stopper->stopping += progress->stopping;
    return stopper->calls++ < stopper->after;
}

TEST(bake_that_is_cancelled_resumes_from_its_checkpoint_with_the_same_bytes)
{
    const char *checkpoint = test_path("resume.checkpoint");
    const char *path = test_path("resumed.safetensors");
    int interruptions = 0, runs = 0;
    for (bool done = false; !done;) {
        struct bake_sample sample = bake_sample_default();
        sample.task_s = 0.07;
        struct bake *bake = bake_sample_create(&sample, NULL);
        struct stopper stopper = { .after = 1 };
        done = bake_run(
            bake, &(struct bake_run_options){
                      .threads = 2, .checkpoint = checkpoint, .progress = stop, .user = &stopper });
        CHECK(done || test_host()->failure == FAIL_CANCELLED);
        CHECK(done || (stopper.stopping > 0 && access(checkpoint, F_OK) == 0));
        if (done) CHECK(bake_save(bake, path, false) && access(checkpoint, F_OK) != 0);
        interruptions += !done;
        runs += sample.runs;
        CHECK(interruptions < 100);
        bake_destroy(bake);
    }
    CHECK(interruptions >= 2);                // 12 tasks of 0.07 s on two threads, 0.1 s at a time
    CHECK(runs < 17 + 2 * interruptions + 1); // only running tasks are lost
    check_same(bake_sample_bytes(path), bake_on(1));
}

TEST(bake_goes_on_in_the_same_object_after_a_cancel)
{
    struct bake_sample sample = bake_sample_default();
    sample.task_s = 0.05;
    struct bake *bake = bake_sample_create(&sample, NULL);
    struct stopper stopper = { .after = 1 };
    const char *path = test_path("again.safetensors");
    CHECK(!bake_run(
        bake, &(struct bake_run_options){ .threads = 1, .progress = stop, .user = &stopper }));
    CHECK(!bake_is_complete(bake) && !bake_save(bake, path, false));
    CHECK(strstr(test_last_message(), "the bake is incomplete"));
    CHECK(bake_run(bake, &(struct bake_run_options){ 0 }) && bake_save(bake, path, false));
    bake_destroy(bake);
    check_same(bake_sample_bytes(path), bake_on(1));
}

TEST(bake_stops_within_a_second_where_tasks_poll)
{
    struct bake_sample sample = bake_sample_default();
    sample.task_s = 30.0;
    struct bake *bake = bake_sample_create(&sample, NULL);
    struct stopper stopper = { .after = 0 };
    const double begun = now_s();
    CHECK(!bake_run(bake, &(struct bake_run_options){ .progress = stop, .user = &stopper }));
    CHECK(now_s() - begun < 1.0 * test_time_factor());
    bake_destroy(bake);
}

TEST(bake_writes_checkpoints_while_it_runs)
{
    const char *checkpoint = test_path("now-and-then.checkpoint");
    struct bake_sample sample = bake_sample_default();
    sample.task_s = 0.05;
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(bake_run(bake, &(struct bake_run_options){
                             .threads = 2, .checkpoint = checkpoint, .checkpoint_every_s = 0.01 }));
    CHECK(access(checkpoint, F_OK) == 0); // until the bake is saved
    bake_destroy(bake);
    struct bake_sample fresh = bake_sample_default();
    bake = bake_sample_create(&fresh, NULL);
    CHECK(bake_run(bake, &(struct bake_run_options){ .checkpoint = checkpoint }));
    CHECK(fresh.runs < 17);
    bake_destroy(bake);
}

// ---- shards

static void bake_shard(int shard, int count, const char *path)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(bake_run(bake, &(struct bake_run_options){ .shard = shard, .shard_count = count }));
    CHECK(bake_save_partial(bake, path));
    CHECK(count == 1 || !bake_is_complete(bake));
    bake_destroy(bake);
}

TEST(bake_in_shards_merges_to_the_same_bytes_in_any_order)
{
    for (int count = 1; count <= 9; count += 2) {
        struct bake_sample sample = bake_sample_default();
        struct bake *bake = bake_sample_create(&sample, NULL);
        const char *path = test_path("merged.safetensors");
        for (int i = count - 1; i >= 0; i--) {
            char name[64];
            snprintf(name, sizeof name, "shard-%d-of-%d", i, count);
            const char *shard = test_path(name);
            bake_shard(i, count, shard);
            CHECK(bake_merge(bake, shard));
        }
        CHECK(bake_run(bake, &(struct bake_run_options){ 0 }));
        CHECK(sample.runs == 5); // the waves after the first
        CHECK(bake_save(bake, path, false));
        bake_destroy(bake);
        check_same(bake_sample_bytes(path), bake_on(2));
    }
}

static bool until_last_wave(void *user, const struct bake_progress *progress)
{
    const struct bake_sample *sample = user;
    (void)progress;
    return sample->runs <= 7 + 5 + 1;
}

// A checkpoint beyond the waves that the sum and the matrix are kept for, and complete parts of the
// first wave.
static void write_checkpoint_of_last_wave(const char *path)
{
    struct bake_sample sample = bake_sample_default();
    sample.last_s = 30.0;
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(!bake_run(bake, &(struct bake_run_options){ .threads = 1,
                                                      .checkpoint = path,
                                                      .progress = until_last_wave,
                                                      .user = &sample }));
    bake_destroy(bake);
}

TEST(bake_merges_checkpoints_of_later_waves_with_parts_in_any_order)
{
    const char *checkpoint = test_path("last-wave"), *part = test_path("part");
    const char *path = test_path("of-both.safetensors");
    write_checkpoint_of_last_wave(checkpoint);
    bake_shard(0, 2, part);
    for (int order = 0; order < 2; order++) {
        struct bake_sample sample = bake_sample_default();
        struct bake *bake = bake_sample_create(&sample, NULL);
        CHECK(bake_merge(bake, order ? part : checkpoint));
        CHECK(bake_merge(bake, order ? checkpoint : part));
        CHECK(bake_merge(bake, part));
        CHECK(bake_run(bake, &(struct bake_run_options){ 0 }));
        CHECK(sample.runs == 4); // the last wave
        CHECK(bake_save(bake, path, false));
        bake_destroy(bake);
        check_same(bake_sample_bytes(path), bake_on(1));
    }
}

// Both parts of a round. before: the parts of the round before, NULL in the first.
static void bake_round(const char *const before[2], const char *const parts[2])
{
    for (int i = 0; i < 2; i++) {
        struct bake_sample sample = bake_sample_default();
        struct bake *bake = bake_sample_create(&sample, NULL);
        for (int k = 0; before && k < 2; k++) CHECK(bake_merge(bake, before[k]));
        CHECK(bake_run(bake, &(struct bake_run_options){ .shard = i, .shard_count = 2 }));
        CHECK(bake_save_partial(bake, parts[i]));
        bake_destroy(bake);
    }
}

// The probe of a small bake may run all of the first wave.
TEST(bake_whose_probe_did_the_first_wave_is_made_in_shards)
{
    const struct bake_run_options options = { .shard = 1, .shard_count = 2 };
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    struct bake *merged = bake_sample_create(&sample, NULL);
    struct bake_estimate estimate;
    const char *part = test_path("probed"), *path = test_path("probed.safetensors");
    CHECK(bake_run(bake, &(struct bake_run_options){ .shard = 0, .shard_count = 1 }));
    CHECK(bake_estimate(bake, &options, true, &estimate) && bake_run(bake, &options));
    CHECK(sample.runs == 7 + 5 && bake_save_partial(bake, part));
    CHECK(bake_merge(merged, part) && bake_run(merged, &(struct bake_run_options){ 0 }));
    CHECK(bake_save(merged, path, false));
    bake_destroy(merged);
    bake_destroy(bake);
    check_same(bake_sample_bytes(path), bake_on(1));
}

TEST(bake_in_rounds_of_shards_needs_all_parts)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    const char *part = test_path("one-of-two");
    bake_shard(0, 2, part);
    CHECK(bake_merge(bake, part) &&
          !bake_run(bake, &(struct bake_run_options){ .shard_count = 2 }));
    CHECK(strstr(test_last_message(), "5 of 12 tasks are in none of the merged files; merge all"));
    CHECK(sample.runs == 0);
    bake_destroy(bake);
}

// The last wave has a twelfth of the cost.
TEST(bake_in_rounds_of_shards_gives_the_same_bytes)
{
    const char *const first[] = { test_path("round-0-a"), test_path("round-0-b") };
    const char *const last[] = { test_path("round-1-a"), test_path("round-1-b") };
    const char *path = test_path("rounds.safetensors");
    bake_round(NULL, first);
    bake_round(first, last);
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(bake_merge(bake, last[0]) && !bake_is_complete(bake) && bake_split_stage(bake));
    CHECK(bake_merge(bake, last[1]) && bake_is_complete(bake) && !bake_split_stage(bake));
    CHECK(sample.runs == 0);
    CHECK(!bake_run(bake, &(struct bake_run_options){ .shard_count = 2 }));
    CHECK(strstr(test_last_message(), "not worth splitting"));
    CHECK(bake_save(bake, path, false));
    bake_destroy(bake);
    check_same(bake_sample_bytes(path), bake_on(1));
}

TEST(bake_of_a_shard_leaves_no_checkpoint)
{
    struct bake_sample sample = bake_sample_default();
    const struct bake_run_options options = { .shard_count = 2,
                                              .checkpoint = test_path("part.checkpoint"),
                                              .checkpoint_every_s = 1e-3 };
    sample.task_s = 0.2;
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(bake_run(bake, &options) && access(options.checkpoint, F_OK) == 0);
    CHECK(bake_save_partial(bake, test_path("part")) && access(options.checkpoint, F_OK) != 0);
    bake_destroy(bake);
}

TEST(bake_does_what_a_missing_shard_left_and_says_so)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    const char *shard = test_path("only"), *path = test_path("completed.safetensors");
    bake_shard(1, 3, shard);
    test_forget_messages();
    CHECK(bake_merge(bake, shard) && bake_run(bake, &(struct bake_run_options){ 0 }));
    CHECK(strstr(test_last_message(), "a part is missing: 8 of 12 tasks"));
    CHECK(sample.runs > 5 && sample.runs < 17 && bake_save(bake, path, false));
    bake_destroy(bake);
    check_same(bake_sample_bytes(path), bake_on(1));
}

TEST(bake_refuses_partial_files_of_another_seed)
{
    struct bake_sample sample = bake_sample_default();
    struct bake_identity other = bake_sample_identity();
    const char *shard = test_path("seed");
    bake_shard(0, 2, shard);
    other.seed = 6;
    struct bake *bake = bake_sample_create(&sample, &other);
    CHECK(!bake_merge(bake, shard) && strstr(test_last_message(), "its seed is 5, not 6"));
    bake_destroy(bake);
}

// ---- damaged checkpoints

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    fwrite(bytes, 1, size, writer.stream);
    CHECK(file_commit(&writer));
}

// A new hash over changed content, as an attacker would write it.
static void check_merge_is_safe(const char *path)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    if (bake_merge(bake, path)) CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 1 }));
    bake_destroy(bake);
}

TEST(bake_ignores_a_checkpoint_that_is_cut_or_changed_and_says_so)
{
    const char *checkpoint = test_path("damaged.checkpoint");
    bake_shard(0, 2, checkpoint);
    struct file_bytes bytes = bake_sample_bytes(checkpoint);
    for (size_t size = 0; size < bytes.size; size += 37) {
        struct bake_sample sample = bake_sample_default();
        struct bake *bake = bake_sample_create(&sample, NULL);
        write_bytes(checkpoint, bytes.data, size);
        test_forget_messages();
        CHECK(bake_run(bake, &(struct bake_run_options){ .checkpoint = checkpoint }));
        CHECK(strstr(test_last_message(), "the checkpoint is ignored: cannot"));
        CHECK(sample.runs == 17);
        bake_destroy(bake);
    }
    for (size_t i = 0; i < bytes.size; i++) {
        bytes.data[i] = (uint8_t)(bytes.data[i] ^ 1);
        write_bytes(checkpoint, bytes.data, bytes.size);
        bytes.data[i] = (uint8_t)(bytes.data[i] ^ 1);
        check_merge_is_safe(checkpoint);
    }
    file_bytes_finish(test_host(), &bytes);
}

// ---- failures

TEST(bake_whose_task_fails_says_why_and_keeps_nothing)
{
    struct bake_sample sample = bake_sample_default();
    sample.failing_task = 3;
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(!bake_run(bake, &(struct bake_run_options){ 0 }));
    CHECK(test_host()->failure == FAIL_UNSUPPORTED && sample.finished == 1);
    CHECK(strstr(test_last_message(), "it is made to fail"));
    CHECK(!bake_is_complete(bake));
    bake_destroy(bake);
}

TEST(bake_whose_preparation_fails_runs_no_task_and_finishes)
{
    struct bake_sample sample = bake_sample_default();
    sample.fail_prepare = true;
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(!bake_run(bake, &(struct bake_run_options){ 0 }));
    CHECK(sample.runs == 0 && sample.finished == 1);
    bake_destroy(bake);
}

static bool nothing(const struct bake_task *task)
{
    (void)task;
    return true;
}

TEST(bake_plan_refuses_wrong_stages_by_name)
{
    const struct bake_identity identity = bake_sample_identity();
    struct bake *bake = bake_create(test_host(), &identity);
    struct bake_plan *plan = bake_plan_of(bake);
    const struct bake_output unread = { "a", TENSOR_F32, 1, { 3 }, BAKE_ROWS, 0 };
    const struct bake_output halves = { "b", TENSOR_F16, 1, { 3 }, BAKE_SUM, BAKE_SAVED };
    struct bake_stage stage = { .name = "one", .task_count = 1, .run = nothing };
    CHECK(bake_plan_add(plan, &stage) && !bake_plan_add(plan, &stage));
    CHECK_STRING(test_last_message(), "cannot plan the stage one: its name exists twice");
    stage.name = "two";
    stage.outputs = &unread;
    stage.output_count = 1;
    CHECK(!bake_plan_add(plan, &stage) && strstr(test_last_message(), "read by no wave"));
    stage.outputs = &halves;
    CHECK(!bake_plan_add(plan, &stage) && strstr(test_last_message(), "a sum is not F32"));
    stage.output_count = 0;
    stage.wave = 2;
    CHECK(!bake_plan_add(plan, &stage) && strstr(test_last_message(), "its wave"));
    bake_destroy(bake);
}

// ---- estimate

static const struct bake_run_options two = { .threads = 2 };

TEST(bake_estimate_adds_up_the_plan)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    struct bake_estimate estimate;
    CHECK(bake_estimate(bake, &two, false, &estimate) && sample.runs == 0);
    CHECK_NEAR(estimate.rays, 7 * 100 + 5 * 50, 0.0);
    CHECK_NEAR(estimate.texels, 70, 0.0);
    CHECK(isnan(estimate.seconds));
    // Memory of wave 0: F, mask, the parts and the sum, scratch of two threads; and the job.
    CHECK_NEAR(estimate.peak_memory_bytes, 23 * 24 + 23 + 6 * 16 + 2 * 1000 + 10000, 0.0);
    const char *path = test_path("estimated.safetensors");
    CHECK(bake_run(bake, &(struct bake_run_options){ 0 }) && bake_save(bake, path, false));
    struct file_bytes bytes = bake_sample_bytes(path);
    CHECK(fabs((double)estimate.file_bytes - (double)bytes.size) < 1024.0);
    file_bytes_finish(test_host(), &bytes);
    bake_destroy(bake);
}

TEST(bake_estimate_of_time_is_near_after_a_probe_whose_results_are_kept)
{
    struct bake_sample sample = bake_sample_default();
    sample.task_s = 0.1 * test_time_factor();
    struct bake *bake = bake_sample_create(&sample, NULL);
    struct bake_estimate estimate;
    CHECK(bake_estimate(bake, &two, true, &estimate) && sample.runs == 2);
    const double begun = now_s();
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2 }) && sample.runs == 17);
    CHECK_RELATIVE(estimate.seconds, now_s() - begun, 0.5);
    bake_destroy(bake);
}

TEST(bake_estimate_of_time_has_what_the_run_prepares_again)
{
    struct bake_sample sample = bake_sample_default();
    sample.prepare_s = 0.4;
    struct bake *bake = bake_sample_create(&sample, NULL);
    struct bake_estimate estimate;
    CHECK(bake_estimate(bake, &two, true, &estimate) && sample.prepared == 1);
    CHECK(estimate.seconds >= sample.prepare_s);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2 }) && sample.prepared == 2);
    bake_destroy(bake);
}

TEST(bake_estimate_of_a_shard_is_of_its_tasks_alone)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    double rays = 0.0;
    for (int i = 0; i < 3; i++) {
        const struct bake_run_options part = { .shard = i, .shard_count = 3 };
        struct bake_estimate estimate;
        CHECK(bake_estimate(bake, &part, false, &estimate));
        CHECK(estimate.rays < 0.6 * (7 * 100 + 5 * 50));
        rays += estimate.rays;
    }
    CHECK_NEAR(rays, 7 * 100 + 5 * 50, 0.0);
    bake_destroy(bake);
}

TEST(bake_estimate_counts_what_a_checkpoint_has)
{
    struct bake_sample sample = bake_sample_default();
    const char *checkpoint = test_path("most");
    bake_shard(0, 1, checkpoint);
    struct bake *bake = bake_sample_create(&sample, NULL);
    const struct bake_run_options options = { .threads = 2, .checkpoint = checkpoint };
    struct bake_estimate estimate;
    CHECK(bake_estimate(bake, &options, true, &estimate) && sample.runs == 0);
    CHECK(estimate.seconds < 0.1 * test_time_factor());
    const double seconds = bake_seconds(bake);
    CHECK(bake_run(bake, &options) && sample.runs == 5); // the checkpoint is read once
    CHECK(bake_seconds(bake) < seconds + 10.0);
    bake_destroy(bake);
}

struct clock {
    double begun_s, left_s[1000];
    double at_s[1000];
    int count;
};

static bool note_times(void *user, const struct bake_progress *progress)
{
    struct clock *clock = user;
    if (progress->done < 0.05 || clock->count == 1000) return true;
    clock->at_s[clock->count] = now_s() - clock->begun_s;
    clock->left_s[clock->count++] = progress->seconds_left;
    return true;
}

// Tasks of a tenth of a second, or more beside others, that do nothing but wait, so that load
// hardly changes them.
TEST(bake_progress_knows_the_time_left_from_a_twentieth_of_the_work_on)
{
    struct bake_sample sample = bake_sample_default();
    static struct clock clock;
    sample.task_s = 0.1 * test_time_factor();
    struct bake *bake = bake_sample_create(&sample, NULL);
    clock.begun_s = now_s();
    CHECK(bake_run(
        bake, &(struct bake_run_options){ .threads = 1, .progress = note_times, .user = &clock }));
    const double total = now_s() - clock.begun_s;
    CHECK(clock.count >= 5);
    for (int i = 0; i < clock.count; i++)
        CHECK_NEAR(clock.at_s[i] + clock.left_s[i], total, 0.25 * total);
    bake_destroy(bake);
}

TEST(bake_over_the_memory_limit_is_refused_before_it_begins)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(!bake_run(bake, &(struct bake_run_options){ .max_memory_bytes = 100 }));
    CHECK(test_host()->failure == FAIL_MEMORY && sample.prepared == 0);
    CHECK(strstr(test_last_message(), "cannot bake sample: it needs about"));
    bake_destroy(bake);
}
