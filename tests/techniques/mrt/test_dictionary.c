// The bake of a dictionary: its bytes on several threads, its size, and operators that must agree.
#include "framework/test.h"
#include "techniques/mrt/mrt_bake_fixture.h"

#include "core/files/file.h"
#include "core/sh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct mrt_dictionary_options small_options(void)
{
    struct mrt_dictionary_options options = mrt_fixture_options();
    options.texels = 6;
    options.rays = 1024;
    options.modes = 12;
    options.lightfield_modes = 32;
    options.response_modes = 12;
    return options;
}

// Baked once for all tests.
static struct bake *baked_small, *baked_default;

static struct bake *small_bake(void) // by one thread
{
    const struct mrt_dictionary_options options = small_options();
    if (!baked_small) baked_small = mrt_fixture_bake(&options, 1, false);
    return baked_small;
}

static struct bake *default_bake(struct mrt_dictionary_options *options) // with a full report
{
    option_defaults(mrt_dictionary_option_table(), options);
    if (!baked_default) baked_default = mrt_fixture_bake(options, 0, true);
    return baked_default;
}

static bool finish_at_end(void)
{
    bake_destroy(baked_small);
    bake_destroy(baked_default);
    return true;
}

__attribute__((constructor)) static void register_end(void)
{
    test_register_end(finish_at_end);
}

static void check_same_bytes(struct bake *a, struct bake *b)
{
    struct file_bytes bytes[2];
    const char *path = test_path("dictionary.safetensors");
    CHECK(bake_save(a, path, false) && file_read(test_host(), path, 64 << 20, &bytes[0]));
    CHECK(bake_save(b, path, false) && file_read(test_host(), path, 64 << 20, &bytes[1]));
    CHECK(bytes[0].size == bytes[1].size);
    CHECK(memcmp(bytes[0].data, bytes[1].data, bytes[0].size) == 0);
    for (int i = 0; i < 2; i++) file_bytes_finish(test_host(), &bytes[i]);
}

TEST(dictionary_has_the_same_bytes_on_1_2_and_4_threads)
{
    const struct mrt_dictionary_options options = small_options();
    for (int threads = 2; threads <= 4; threads += 2) {
        struct bake *more = mrt_fixture_bake(&options, threads, false);
        check_same_bytes(small_bake(), more);
        bake_destroy(more);
    }
}

static bool stop_at(void *user, const struct bake_progress *progress)
{
    (void)progress;
    return ++*(int *)user < 3;
}

TEST(dictionary_has_the_same_bytes_after_a_cancel_and_a_resume)
{
    const struct mrt_dictionary_options options = small_options();
    int calls = 0;
    struct bake *bake = mrt_fixture_plan(&options, 1);
    bake_run(bake, &(struct bake_run_options){ .progress = stop_at, .user = &calls });
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2 }));
    check_same_bytes(small_bake(), bake);
    bake_destroy(bake);
}

TEST(dictionary_of_other_options_is_refused)
{
    struct mrt_dictionary_options options = small_options();
    struct mrt_dictionary dictionary;
    options.modes++;
    CHECK(!mrt_dictionary_init(test_host(), bake_tensors(small_bake()), &options, &dictionary));
    CHECK(strstr(test_last_message(), "U_b") || strstr(test_last_message(), "R_"));
    options = small_options();
    options.maze = MRT_MAZE_3D;
    CHECK(!mrt_dictionary_init(test_host(), bake_tensors(small_bake()), &options, &dictionary));
}

// Largest difference between irradiance and OHLSH along the normal, of columns with an L2 norm
// of 1.
static double along_normal(const struct matrix_f32 *scalar, const struct matrix_f32 *vector)
{
    float y[4];
    double worst = 0.0;
    sh_eval(2, vec3_of(0, 0, 1), y);
    for (size_t c = 0; c < scalar->columns; c++) {
        double difference = 0.0, all = 0.0;
        for (size_t r = 0; r < scalar->rows; r++) {
            double value = 0.0, exact = (double)scalar->at[r * scalar->stride + c];
            for (size_t k = 0; k < 4; k++)
                value += (double)(vector->at[(4 * r + k) * vector->stride + c] * y[k]);
            difference += (value - exact) * (value - exact);
            all += exact * exact;
        }
        if (all > 0.0 && c < 4) worst = fmax(worst, sqrt(difference / all));
    }
    return worst;
}

// Largest difference of all parts of an interface together from the whole interface, which lets
// everything pass.
static double sum_of_parts_error(const struct mrt_dictionary *d)
{
    const size_t n = d->r_hole[0].rows;
    double worst = 0.0;
    for (size_t i = 0; i < n * n; i++) {
        double sum = 0.0;
        for (int p = 0; p < MRT_HOLE_PARTS; p++) sum += (double)d->r_hole[p].at[i];
        worst = fmax(worst, fabs(sum - (i / n == i % n)));
    }
    return worst;
}

TEST(default_dictionary_is_as_large_as_the_paper_s)
{
    struct mrt_dictionary_options options;
    struct mrt_dictionary d;
    struct bake *bake = default_bake(&options);
    CHECK(mrt_dictionary_init(test_host(), bake_tensors(bake), &options, &d));
    const struct mrt_dictionary_bytes bytes = mrt_dictionary_bytes(&d);
    double task_s = 0.0;
    for (int i = 0; i < bake_stage_count(bake); i++) {
        const struct bake_stage_info stage = bake_stage_info(bake, i);
        task_s += stage.seconds;
        print_message("  %-24s %6.2f s in %zu tasks\n", stage.name, stage.seconds, stage.tasks);
    }
    print_message("shapes %.3f MB (paper: 4.7), interfaces %.3f MB (paper: 1.2), probes %.3f MB, "
                  "holes %.3f MB; %.1f s of tasks\n",
                  1e-6 * (double)bytes.shapes, 1e-6 * (double)bytes.interfaces,
                  1e-6 * (double)bytes.probes, 1e-6 * (double)bytes.holes, task_s);
    print_message("parts of an interface: %.1e from the whole\n", sum_of_parts_error(&d));
    CHECK(sum_of_parts_error(&d) < 1e-3);
    CHECK_NEAR(1e-6 * (double)bytes.shapes, 4.7, 0.05);
    CHECK_NEAR(1e-6 * (double)bytes.interfaces, 1.2, 0.05);
    for (int i = 0; i < d.element_count; i++) {
        const float *checks = mrt_fixture_tensor(bake, "checks", i),
                    *sigma = mrt_fixture_tensor(bake, "sigma_M", i);
        print_message("cube %d: |Um'Um - I| %.1e, |F Limp - Ub| / |Ub| %.1e, sigma %.3f, vector "
                      "irradiance differs by %.3f\n",
                      i, (double)checks[0], (double)checks[1], (double)sigma[0],
                      along_normal(&d.element[i].u_b, &d.element[i].u_vec));
        CHECK(checks[0] < 1e-10f && checks[1] < 1e-10f);
        CHECK(along_normal(&d.element[i].u_b, &d.element[i].u_vec) < 0.05);
    }
    print_message("interface: vector irradiance differs by %.3f\n",
                  along_normal(&d.entered[0].u_r, &d.entered[0].u_rvec));
    CHECK(along_normal(&d.entered[0].u_r, &d.entered[0].u_rvec) < 0.145);
    mrt_dictionary_finish(test_host(), &d);
}

static int modes_at(const char *report, const char *operator_name, const char *percent)
{
    char quoted[16];
    snprintf(quoted, sizeof quoted, "\"%s\": {", operator_name);
    const char *at = strstr(report, quoted);
    snprintf(quoted, sizeof quoted, "\"%s\": ", percent);
    CHECK(at && (at = strstr(at, quoted)) != NULL);
    return atoi(at + strlen(quoted));
}

// Table 3.2 of the paper, by the bake itself.
TEST(full_report_of_the_closed_cube_has_the_modes_of_the_paper)
{
    struct mrt_dictionary_options options;
    struct bake *bake = default_bake(&options);
    char *report = mrt_fixture_report(bake, &options);
    static const char *const percents[] = { "80", "90", "95" };
    static const int paper[] = { 164, 240, 313 }, within[] = { 2, 2, 3 };
    for (int i = 0; i < 3; i++) {
        const int modes = modes_at(report, "F", percents[i]);
        print_message("F: %s %% of the energy with %d modes (paper: %d)\n", percents[i], modes,
                      paper[i]);
        CHECK_NEAR(modes, paper[i], within[i]);
    }
    host_free(test_host(), report);
}
