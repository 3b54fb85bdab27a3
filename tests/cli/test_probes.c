// bake --probes: its files, the light in them, and what is refused. tests/web reads the files by
// programs of others.
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROBES "bake --gi radiosity:probes=true,texels=2048,rays=64 --quiet"

static const char FLOOR[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                            "property float y\nproperty float z\nelement face 1\n"
                            "property list uchar int vertex_indices\nend_header\n"
                            "-20 0 20\n20 0 20\n20 0 -20\n-20 0 -20\n4 0 1 2 3\n";

static void use_cache(const char *name)
{
    require_device();
    setenv("AFTERGLOW_CACHE", make_folder(name), 1);
}

static json_t *document(const char *name)
{
    json_t *json = json_load_file(path_of(name), 0, NULL);
    assert_non_null(json);
    CHECK(json_integer_value(json_object_get(json, "afterglow_probes")) == 1);
    return json;
}

static double number(const json_t *array, size_t index)
{
    return json_number_value(json_array_get(array, index));
}

// Irradiance on a horizontal surface: harmonics at the direction +y.
static double irradiance_up(const json_t *coefficients, size_t probe, size_t channel)
{
    static const double at_up[9] = { 0.2820948, 0.4886025, 0, 0, 0, 0, -0.3153916, 0, -0.5462742 };
    double sum = 0.0;
    for (size_t i = 0; i < 9; i++)
        sum += at_up[i] * number(coefficients, 27 * probe + 3 * i + channel);
    return sum;
}

// Close above the floor one cluster fills half of the sphere: its harmonics are those of a cap,
// exact but where two clusters meet below.
TEST(probes_over_a_floor_have_the_irradiance_of_the_sky)
{
    use_cache("probes-sky");
    write_file(path_of("floor.ply"), FLOOR, sizeof FLOOR - 1);
    run_expect(0, PROBES " --sky 10,5,0 --probes", path_of("sky"), path_of("floor.ply"), NULL);
    json_t *json = document("sky/probes.json");
    const json_t *counts = json_object_get(json_object_get(json, "grid"), "counts"),
                 *coefficients = json_object_get(json, "coefficients");
    size_t probes = 1;
    for (size_t a = 0; a < 3; a++) probes *= (size_t)number(counts, a);
    assert_int_equal(json_array_size(coefficients), 27 * probes);
    double mean = 0.0;
    for (size_t p = 0; p < probes; p++) {
        const double up = irradiance_up(coefficients, p, 0);
        CHECK_RELATIVE(up, 10 * 3.14159, 0.05);
        CHECK_RELATIVE(irradiance_up(coefficients, p, 1), 0.5 * up, 1e-3);
        CHECK(irradiance_up(coefficients, p, 2) == 0.0);
        mean += up / (double)probes;
    }
    CHECK_RELATIVE(mean, 10 * 3.14159, 0.015);
    json_decref(json);
}

TEST(files_are_the_same_each_time_and_replace_earlier_ones)
{
    use_cache("probes-same");
    const char *a = path_of("probes-a"), *b = path_of("probes-b");
    run_expect(0, PROBES " @cornell --probes", a, NULL);
    run_expect(0, PROBES " @cornell --probes", b, NULL);
    assert_int_equal(count_files(a), 3);
    CHECK(files_are_equal(path_of("probes-a/probes.json"), path_of("probes-b/probes.json")));
    CHECK(files_are_equal(path_of("probes-a/probes.exr"), path_of("probes-b/probes.exr")));
    const struct run *r = run_expect(
        0, "bake @cornell:light=point --gi lpv:probes=true,dim=16 --quiet --json --probes", a,
        NULL);
    json_t *report = run_json(r);
    CHECK(number(json_object_get(report, "counts"), 0) == 16.0);
    json_decref(report);
    assert_int_equal(count_files(a), 2); // walls are in the document
    json_t *json = document("probes-a/probes.json");
    CHECK_STRING(json_string_value(json_object_get(json_object_get(json, "visibility"), "kind")),
                 "walls");
    json_decref(json);
}

TEST(probes_that_cannot_be_are_refused_in_one_line)
{
    const char *probes = path_of("probes-x");
    check_one_error_line(run_expect(2, PROBES " @cornell --spp 4 --probes", probes, NULL));
    check_one_error_line(
        run_expect(2, PROBES " @cornell --lightmap", probes, "--probes", probes, NULL));
    check_one_error_line(run_expect(2, PROBES " @cornell --shard 0/2 --probes", probes, NULL));
    check_one_error_line(run_expect(1, PROBES " @cornell --probes", path_of("absent/x"), NULL));
    make_folder("probes-full");
    write_file(path_of("probes-full/letter.txt"), "x", 1);
    check_one_error_line(run_expect(1, PROBES " @cornell --probes", path_of("probes-full"), NULL));
    CHECK(file_exists(path_of("probes-full/letter.txt")));
    use_cache("probes-refused");
    const struct run *r = run_program("bake @cornell --gi ambient --quiet --probes", probes, NULL);
    CHECK(r->status != 0 && strstr(r->err, "probes"));
    CHECK(!file_exists(probes));
}
