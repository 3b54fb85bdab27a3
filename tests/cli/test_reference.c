// reference: reproducible, resumable, layers add up, interruptions keep the samples.
#include "cli/program.h"

#include "image/exr.h"
#include "image/png_file.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define SMALL "reference @cornell --size 32x24 --quiet"

static struct image read_layer(const char *path, const char *layer)
{
    struct image image = { 0 };
    if (!exr_read(test_host(), path, layer, &image)) fail_msg("%s", test_last_message());
    return image;
}

static double mean_of(const char *path, const char *layer)
{
    struct image image = read_layer(path, layer);
    double sum = 0;
    int count = image.width * image.height * image.channels;
    for (int i = 0; i < count; i++) sum += (double)image.pixels[i];
    image_finish(&image, test_host());
    return sum / count;
}

TEST(equal_commands_write_equal_files)
{
    const char *a = path_of("a.exr"), *b = path_of("b.exr"), *other = path_of("c.exr");
    const struct run *r = run_expect(0, SMALL, "--spp", "4", "-o", a, NULL);
    CHECK_STRING(r->err, "");
    CHECK_STRING(r->out, "");
    run_expect(0, SMALL, "--spp", "4", "-o", b, NULL);
    run_expect(0, SMALL, "--spp", "4", "--seed", "7", "-o", other, NULL);
    CHECK(files_are_equal(a, b));
    CHECK(!files_are_equal(a, other));
}

TEST(the_number_of_threads_does_not_change_the_file)
{
    const char *one = path_of("one-thread.exr"), *three = path_of("three-threads.exr");
    assert_int_equal(setenv("OMP_NUM_THREADS", "1", 1), 0);
    run_expect(0, SMALL, "--spp", "4", "-o", one, NULL);
    assert_int_equal(setenv("OMP_NUM_THREADS", "3", 1), 0);
    run_expect(0, SMALL, "--spp", "4", "-o", three, NULL);
    assert_int_equal(unsetenv("OMP_NUM_THREADS"), 0);
    CHECK(files_are_equal(one, three));
}

// Doubling is exact in floats: equal random numbers must give exactly twice the values.
TEST(a_doubled_light_doubles_every_pixel)
{
    static const char *const layers[] = { "color", "direct", "indirect", "irradiance", "error" };
    const char *once = path_of("once.exr"), *twice = path_of("twice.exr");
    run_expect(0, "reference @cornell:light=point --size 32x24 --quiet --spp 4 --no-scene-lights",
               "--light", "point:0.3,1.2,0:30,50,70", "--light", "spot:0,1.9,0:0,-1,0:20:40:9,8,7",
               "-o", once, NULL);
    run_expect(0, "reference @cornell:light=point --size 32x24 --quiet --spp 4 --no-scene-lights",
               "--light", "point:0.3,1.2,0:60,100,140", "--light",
               "spot:0,1.9,0:0,-1,0:20:40:18,16,14", "-o", twice, NULL);
    for (size_t i = 0; i < sizeof layers / sizeof layers[0]; i++) {
        struct image a = read_layer(once, layers[i]), b = read_layer(twice, layers[i]);
        double sum = 0;
        for (int p = 0; p < 32 * 24 * 3; p++) {
            CHECK(b.pixels[p] == 2 * a.pixels[p]);
            sum += (double)a.pixels[p];
        }
        CHECK(sum > 0);
        image_finish(&a, test_host());
        image_finish(&b, test_host());
    }
}

TEST(the_default_layers_allow_resuming)
{
    const char *path = path_of("layers.exr");
    run_expect(0, SMALL, "--spp", "4", "-o", path, NULL);
    char *names = exr_layer_names(test_host(), path);
    assert_non_null(names);
    CHECK_STRING(names, "color\ndirect\nerror\nindirect\nindirect_emitters_"
                        "sky\nirradiance\nirradiance_emitters_sky\nsamples");
    host_free(test_host(), names);
    struct image color = read_layer(path, NULL), direct = read_layer(path, "direct"),
                 indirect = read_layer(path, "indirect");
    for (int i = 0; i < 32 * 24 * 3; i++)
        CHECK(color.pixels[i] == direct.pixels[i] + indirect.pixels[i]);
    image_finish(&color, test_host());
    image_finish(&direct, test_host());
    image_finish(&indirect, test_host());
    CHECK_NEAR(mean_of(path, "samples"), 4, 0);
}

TEST(former_layer_names_are_accepted_with_a_warning)
{
    const char *path = path_of("former.exr");
    const struct run *run =
        run_expect(0, "reference @cornell --size 8x6 --spp 1 --aov gathered,gathered_irradiance -o",
                   path, NULL);
    CHECK(strstr(run->err, "layer gathered is now indirect_emitters_sky"));
    char *names = exr_layer_names(test_host(), path);
    assert_non_null(names);
    CHECK_STRING(names, "indirect_emitters_sky\nirradiance_emitters_sky");
    host_free(test_host(), names);
    run_expect(0, "diff --layer gathered", path, path, NULL);
}

TEST(direct_and_indirect_only_add_up)
{
    const char *all = path_of("all.exr"), *direct = path_of("direct.exr"),
               *indirect = path_of("indirect.exr");
    run_expect(0, SMALL " --spp 64 -o", all, NULL);
    run_expect(0, SMALL " --spp 64 --direct-only -o", direct, NULL);
    run_expect(0, SMALL " --spp 64 --indirect-only -o", indirect, NULL);
    CHECK(mean_of(direct, "indirect") == 0 && mean_of(indirect, "direct") == 0);
    CHECK_RELATIVE(mean_of(direct, NULL) + mean_of(indirect, NULL), mean_of(all, NULL), 0.02);
    run_expect(0, SMALL " --spp 64 --bounces 0 -o", indirect, NULL);
    CHECK_RELATIVE(mean_of(indirect, NULL), mean_of(direct, NULL), 0.01);
    run_expect(0, SMALL " --spp 64 --bounces 1 -o", indirect, NULL);
    CHECK(mean_of(indirect, NULL) < 0.97 * mean_of(all, NULL));
}

// Error of the mean over all pixels, whose errors are independent.
static double error_of_mean(const char *path)
{
    struct image error = read_layer(path, "error");
    double variance = 0; // of a sum whose channels rise and fall together: an upper bound
    int pixels = error.width * error.height;
    for (int i = 0; i < pixels; i++) {
        const float *e = &error.pixels[3 * i];
        double all = (double)e[0] + (double)e[1] + (double)e[2];
        variance += all * all;
    }
    image_finish(&error, test_host());
    return sqrt(variance) / (3.0 * pixels);
}

TEST(one_bounce_adds_the_first_bounce_to_direct_light)
{
    const char *one = path_of("one.exr"), *none = path_of("none.exr"),
               *alone = path_of("alone.exr");
    run_expect(0, SMALL " --spp 64 --bounces 1 --seed 1 -o", one, NULL);
    run_expect(0, SMALL " --spp 64 --bounces 0 --seed 2 -o", none, NULL);
    run_expect(0, SMALL " --spp 64 --bounces 1 --indirect-only --seed 3 -o", alone, NULL);
    double noise = hypot(error_of_mean(one), hypot(error_of_mean(none), error_of_mean(alone)));
    CHECK(mean_of(alone, NULL) > 20 * noise); // so that the next line can fail
    CHECK_NEAR(mean_of(one, NULL) - mean_of(none, NULL), mean_of(alone, NULL), 4 * noise);
}

TEST(the_option_sets_the_radius_of_obscurance)
{
    const char *small = path_of("small.exr"), *large = path_of("large.exr"),
               *whole = path_of("whole.exr");
    run_expect(0, SMALL " --spp 16 --aov obscurance --obscurance-radius 0.05 -o", small, NULL);
    run_expect(0, SMALL " --spp 16 --aov obscurance --obscurance-radius 2 -o", large, NULL);
    // A square image shows only the room.
    run_expect(0,
               "reference @cornell --size 24x24 --quiet --spp 16 --aov obscurance "
               "--obscurance-radius 0.05 --obscurance-sphere -o",
               whole, NULL);
    CHECK(mean_of(small, "obscurance") > 0.95 && mean_of(small, "obscurance") < 1.0);
    CHECK(mean_of(large, "obscurance") < 0.9);
    CHECK_NEAR(mean_of(whole, "obscurance"), 0.5, 0.1);
}

TEST(the_option_sets_the_decay_of_occlusion)
{
    const char *far = path_of("far.exr"), *decayed = path_of("decayed.exr");
    const char *words = "reference @cornell --size 24x24 --quiet --spp 16 --aov ambient_occlusion "
                        "--obscurance-radius 100 --occlusion-decay";
    run_expect(0, words, "0", "-o", far, NULL);
    run_expect(0, words, "1000", "-o", decayed, NULL);
    // Only the front of the room is open; with this decay occluders at a hand's distance count
    // less than a thousandth.
    CHECK(mean_of(far, "ambient_occlusion") < 0.5);
    CHECK(mean_of(decayed, "ambient_occlusion") > 0.98);
}

TEST(a_resumed_run_equals_a_longer_one)
{
    const char *whole = path_of("whole.exr"), *parts = path_of("parts.exr");
    run_expect(0, SMALL " --spp 9 -o", whole, NULL);
    run_expect(0, SMALL " --spp 4 --resume -o", parts, NULL); // there is none yet: it begins
    run_expect(0, SMALL " --spp 9 --resume -o", parts, NULL);
    CHECK_NEAR(mean_of(parts, "samples"), 9, 0);
    CHECK_RELATIVE(mean_of(parts, NULL), mean_of(whole, NULL), 1e-6);
    CHECK_RELATIVE(mean_of(parts, "error"), mean_of(whole, "error"), 1e-4);
    run_expect(0, SMALL " --spp 9 --resume -o", parts, NULL); // nothing is left to do
    const struct run *r = run_expect(1, SMALL " --spp 12 --resume --seed 5 -o", parts, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "traced with --seed 0\n"));
    r = run_expect(1, SMALL " --spp 12 --resume --fov 50 --sky 1,1,1 -o", parts, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "--fov ") && strstr(r->err, "light that of the scene"));
    CHECK_NEAR(mean_of(parts, "samples"), 9, 0);
    const char *bare = path_of("bare.exr");
    run_expect(0, SMALL " --spp 2 --aov color -o", bare, NULL);
    check_one_error_line(run_expect(1, SMALL " --spp 4 --resume -o", bare, NULL));
}

// A million samples of the scene, with the program's messages in a file.
static pid_t start_tracing(const char *scene, const char *image, const char *messages)
{
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child > 0) return child;
    signal(SIGINT, SIG_DFL);
    if (!freopen(messages, "w", stderr)) _exit(126);
    execl(AFTERGLOW_PROGRAM, AFTERGLOW_PROGRAM, "reference", scene, "--size", "64x64", "--spp",
          "1000000", "-o", image, (char *)NULL);
    _exit(127);
}

// One signal, when the first sample has been written: a second one would end the program at once.
static void interrupt_tracing(pid_t child, const char *image)
{
    for (int i = 0; i < 1000 * test_time_factor() && !file_exists(image); i++) test_pause_ms(20);
    test_pause_ms(300 * test_time_factor());
    assert_int_equal(kill(child, SIGINT), 0);
    int status = 0;
    assert_true(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 1);
}

TEST(default_light_and_camera_are_said_before_the_samples)
{
    static const char triangle[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                   "property float y\nproperty float z\nelement face 1\n"
                                   "property list uchar int vertex_indices\nend_header\n"
                                   "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const char *scene = path_of("triangle.ply"), *image = path_of("triangle.exr");
    const char *messages = path_of("triangle.txt");
    write_file(scene, triangle, sizeof triangle - 1);
    interrupt_tracing(start_tracing(scene, image, messages), image);
    char said[2048] = "";
    FILE *file = fopen(messages, "re");
    assert_non_null(file);
    CHECK(fread(said, 1, sizeof said - 1, file) > 0);
    fclose(file);
    const char *end = strstr(said, "interrupted after");
    const char *light = strstr(said, "no light in "), *camera = strstr(said, "no camera in ");
    CHECK(end && light && light < end && camera && camera < end);
    CHECK(!strstr(said, "million rays"));
}

TEST(json_describes_the_traced_image)
{
    const char *path = path_of("json.png");
    const struct run *r = run_expect(0, SMALL " --spp 3 --json -o", path, NULL);
    json_t *document = run_json(r);
    assert_int_equal(json_integer_value(json_object_get(document, "spp")), 3);
    CHECK(json_is_null(json_object_get(document, "bounces")));
    CHECK(json_integer_value(json_object_get(document, "rays")) > 3 * 32 * 24);
    CHECK(json_number_value(json_object_get(document, "rays_per_second")) > 0);
    CHECK(json_number_value(json_object_get(document, "error")) > 0);
    CHECK_STRING(json_string_value(json_object_get(document, "camera")), "main");
    json_decref(document);
    struct image image = { 0 };
    assert_true(png_read(test_host(), path, &image));
    image_finish(&image, test_host());
    r = run_expect(0, "reference @cornell --size 16x16 --spp 2 -o", path, NULL);
    CHECK(strstr(r->err, "million per second") && strstr(r->err, "standard error"));
}

TEST(each_layer_makes_an_image)
{
    static const char *const layers[] = { "color",      "indirect_emitters_sky",
                                          "irradiance", "irradiance_emitters_sky",
                                          "albedo",     "normal",
                                          "depth",      "position",
                                          "error",      "samples",
                                          "obscurance", "ambient_occlusion" };
    for (size_t i = 0; i < sizeof layers / sizeof layers[0]; i++)
        run_expect(0, SMALL " --spp 2 --aov", layers[i], "-o", path_of("layer.png"), NULL);
}

TEST(wrong_usage_is_reported_before_the_work)
{
    static const char *const wrong[] = { "--spp 0",
                                         "--spp x",
                                         "--bounces -1",
                                         "--obscurance-radius 0",
                                         "--obscurance-radius nan",
                                         "--occlusion-decay -1",
                                         "--direct-only --indirect-only",
                                         "--aov color,visibility",
                                         "--aov color,direct -o a.png",
                                         "--resume -o a.png",
                                         "--gi lpv",
                                         "-o a.jpg" };
    char words[200];
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        snprintf(words, sizeof words, "reference @cornell %s", wrong[i]);
        check_one_error_line(run_expect(2, words, NULL));
    }
    check_one_error_line(run_expect(1, SMALL, "-o", "/nowhere/a.exr", NULL));
    check_one_error_line(run_expect(1, SMALL, "--camera", "nobody", "-o", path_of("x.exr"), NULL));
}

TEST(an_interrupt_leaves_an_image_to_resume)
{
    const char *path = path_of("interrupted.exr");
    interrupt_tracing(start_tracing("@cornell", path, "/dev/null"), path);
    double samples = mean_of(path, "samples");
    CHECK(samples > 1 && samples < 1000000);
    char spp[32];
    snprintf(spp, sizeof spp, "%d", (int)samples + 3);
    run_expect(0, "reference @cornell --size 64x64 --quiet --resume --spp", spp, "-o", path, NULL);
    CHECK_NEAR(mean_of(path, "samples"), (int)samples + 3, 0);
}
