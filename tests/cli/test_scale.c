// --scene-scale: files in other units than the metre.
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A floor and a wall of `size` metres, in units of which a metre has `units`. The path stays valid.
static const char *write_scene(const char *name, double size, double units)
{
    static char paths[4][300];
    static int next;
    char text[1024], *path = paths[next++ % 4];
    const double s = size * units;
    snprintf(text, sizeof text,
             "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
             "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
             "end_header\n0 0 0\n%g 0 0\n%g 0 %g\n0 0 %g\n%g %g 0\n0 %g 0\n"
             "4 0 3 2 1\n4 0 1 4 5\n",
             s, s, s, s, s, s, s);
    snprintf(path, sizeof paths[0], "%s", test_path(name));
    write_file(path, text, strlen(text));
    return path;
}

static double size_of(const json_t *info)
{
    const json_t *bounds = json_object_get(info, "bounds");
    return json_number_value(json_array_get(json_object_get(bounds, "max"), 0)) -
           json_number_value(json_array_get(json_object_get(bounds, "min"), 0));
}

static void check_hint(double size, const char *scale, double plausible)
{
    const char *path = write_scene("hint.ply", size, 1);
    const struct run *r = run_expect(0, "info", path, NULL);
    char hint[64];
    snprintf(hint, sizeof hint, "--scene-scale %s makes it %g, ", scale, plausible);
    if (!strstr(r->out, hint)) fail_msg("no '%s' in %s", hint, r->out);
    json_t *info = run_json(run_expect(0, "info --json", path, NULL));
    CHECK_RELATIVE(json_number_value(json_object_get(info, "likelier_scale")), atof(scale), 1e-12);
    CHECK_NEAR(json_number_value(json_object_get(info, "scene_scale")), 1, 0);
    CHECK_RELATIVE(size_of(info), size, 1e-6);
    json_decref(info);
    info = run_json(run_expect(0, "info --json --scene-scale", scale, path, NULL));
    CHECK(json_is_null(json_object_get(info, "likelier_scale")));
    CHECK_RELATIVE(size_of(info), plausible, 1e-5);
    json_decref(info);
}

TEST(info_names_the_scale_of_an_implausible_scene)
{
    check_hint(164, "0.01", 1.64);
    check_hint(8000, "0.001", 8);
    check_hint(0.004, "100", 0.4);
    check_hint(0.0008, "1000", 0.8);
    CHECK(!strstr(run_expect(0, "info", write_scene("hint.ply", 30, 1), NULL)->out, "scene-scale"));
    CHECK(!strstr(run_expect(0, "info @cornell", NULL)->out, "scene-scale"));
}

static void check_same_image(const char *a, const char *b)
{
    json_t *metrics = run_json(run_expect(0, "diff --json", a, b, NULL));
    CHECK_NEAR(json_number_value(json_object_get(metrics, "mse")), 0, 0);
    CHECK(json_number_value(json_array_get(json_object_get(metrics, "mean_a"), 0)) > 0);
    json_decref(metrics);
}

// 128 units to the metre: products with 1/128 are exact.
TEST(a_scaled_file_looks_as_one_in_metres)
{
    require_device();
    char a[300], b[300];
    snprintf(a, sizeof a, "%s", test_path("scaled-a.exr"));
    snprintf(b, sizeof b, "%s", test_path("scaled-b.exr"));
    const char *metres = write_scene("metres.ply", 4, 1), *units = write_scene("u.ply", 4, 128);
    static const char options[] =
        "--size 24x16 --eye 3,2,5 --target 2,0,0 --light point:2,2,2:50,50,50 --sky 1,2,3 -o";
    char words[300];
    snprintf(words, sizeof words, "render --gi lpv:dim=16 %s", options);
    run_expect(0, words, a, metres, NULL);
    run_expect(0, words, b, units, "--scene-scale", "0.0078125", NULL);
    check_same_image(a, b);
    snprintf(words, sizeof words, "reference --spp 2 %s", options);
    run_expect(0, words, a, metres, NULL);
    run_expect(0, words, b, units, "--scene-scale", "0.0078125", NULL);
    check_same_image(a, b);
}

TEST(references_of_scales_are_not_mixed)
{
    require_device();
    char references[600], out[300];
    setenv("AFTERGLOW_CACHE", make_folder("scale-cache"), 1);
    snprintf(references, sizeof references, "%s/references", getenv("AFTERGLOW_CACHE"));
    snprintf(out, sizeof out, "%s", make_folder("scale-compare"));
    static const char words[] =
        "compare @cornell:light=point --gi none --spp 1 --frames 1 --size 16x16 -o";
    run_expect(0, words, out, NULL);
    run_expect(0, words, out, "--scene-scale", "0.5", NULL);
    assert_int_equal(count_files(references), 2);
    run_expect(0, words, out, "--scene-scale", "0.5", NULL);
    assert_int_equal(count_files(references), 2);
    json_t *report = json_load_file(test_path("scale-compare/report.json"), 0, NULL);
    CHECK_NEAR(json_number_value(json_object_get(report, "scene_scale")), 0.5, 0);
    json_decref(report);
}

TEST(a_reference_of_another_scale_is_not_resumed)
{
    char out[300];
    snprintf(out, sizeof out, "%s", test_path("scale-resumed.exr"));
    static const char words[] = "reference @cornell:light=point --size 16x16 -o";
    run_expect(0, words, out, "--spp", "1", NULL);
    const struct run *r =
        run_expect(1, words, out, "--spp", "2", "--resume", "--scene-scale", "0.5", NULL);
    check_one_error_line(r);
}

TEST(wrong_scales_are_wrong_usage)
{
    static const char *const wrong[] = { "0", "-1", "nan", "x", "1e7", "1e-7" };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const struct run *r = run_expect(2, "info @cornell --scene-scale", wrong[i], NULL);
        check_one_error_line(r);
        CHECK(strstr(r->err, "0.000001 to 1000000"));
    }
}
