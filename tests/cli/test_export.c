// bake --export: its folder, its report, and that a technique without such data is refused before
// any work.
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define BAKE "bake @cornell --gi ort:texels=1024,offsets=50,rays=16 --quiet"

static void use_cache(const char *name)
{
    setenv("AFTERGLOW_CACHE", make_folder(name), 1);
}

static double size_of(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (double)info.st_size : -1.0;
}

TEST(export_is_the_same_after_a_run_and_from_the_cache_and_replaces_an_earlier_one)
{
    use_cache("export-cache");
    const char *a = path_of("export-a"), *b = path_of("export-b"),
               *file = path_of("export.safetensors");
    run_expect(0, BAKE " --export", a, NULL);
    run_expect(0, BAKE " --export", b, "-o", file, NULL);
    CHECK(file_exists(file));
    assert_int_equal(count_files(a), 2);
    CHECK(files_are_equal(path_of("export-a/index.json"), path_of("export-b/index.json")));
    CHECK(files_are_equal(path_of("export-a/bin-000.exr"), path_of("export-b/bin-000.exr")));
    write_file(path_of("export-b/bin-1234.exr"), "x", 1); // of a larger export
    run_expect(0, BAKE " --force --seed 3 --export", b, NULL);
    assert_int_equal(count_files(b), 2);
    CHECK(!files_are_equal(path_of("export-a/bin-000.exr"), path_of("export-b/bin-000.exr")));
}

TEST(export_reports_its_bins_bytes_and_occupancy)
{
    use_cache("export-report");
    const char *folder = path_of("export-r");
    json_t *report = run_json(run_expect(0, BAKE " --json --export", folder, NULL));
    const json_t *facts = json_object_get(report, "export");
    const json_t *occupancy = json_object_get(facts, "occupancy");
    const double bytes =
        size_of(path_of("export-r/index.json")) + size_of(path_of("export-r/bin-000.exr"));
    CHECK_STRING(json_string_value(json_object_get(facts, "output")), folder);
    CHECK(json_integer_value(json_object_get(facts, "bins")) == 1);
    CHECK(json_number_value(json_object_get(facts, "bytes")) == bytes);
    CHECK(json_number_value(json_object_get(occupancy, "pieces")) > 0.0);
    CHECK(json_number_value(json_object_get(occupancy, "weights")) > 0.0);
    json_decref(report);
    const struct run *r = run_expect(
        0, "bake @cornell --gi ort:texels=1024,offsets=50,rays=16 --export", folder, NULL);
    CHECK(strstr(r->err, "exported 1 bin,") && strstr(r->err, folder));
}

// The light map of the same texels is as large as a side of the plane.
TEST(light_map_has_the_plane_of_the_export)
{
    use_cache("export-plane");
    const char *folder = path_of("export-p"), *maps = path_of("export-m");
    run_expect(0, BAKE " --export", folder, NULL);
    json_t *report = run_json(run_expect(0, BAKE " --spp 1 --json --lightmap", maps, NULL));
    json_t *index = json_load_file(path_of("export-p/index.json"), 0, NULL);
    const json_t *size = json_object_get(report, "size"),
                 *map = json_object_get(index, "light_map");
    CHECK(json_integer_value(json_array_get(size, 0)) > 0);
    CHECK(json_equal(json_array_get(size, 0), json_object_get(map, "width")));
    CHECK(json_equal(json_array_get(size, 1), json_object_get(map, "height")));
    json_decref(report);
    json_decref(index);
}

TEST(bakes_in_parts_are_exported_where_they_are_merged)
{
    use_cache("export-parts");
    const char *a = path_of("export-0.safetensors"), *b = path_of("export-1.safetensors"),
               *all = path_of("export-all.safetensors"), *whole = path_of("export-w"),
               *merged = path_of("export-j");
    run_expect(0, BAKE " --export", whole, NULL);
    run_expect(0, BAKE " --shard 0/2 -o", a, NULL);
    run_expect(0, BAKE " --shard 1/2 -o", b, NULL);
    run_expect(0, "bake --merge --quiet", a, b, "-o", all, "--export", merged, NULL);
    CHECK(files_are_equal(path_of("export-w/index.json"), path_of("export-j/index.json")));
    CHECK(files_are_equal(path_of("export-w/bin-000.exr"), path_of("export-j/bin-000.exr")));
}

// Before the scene is loaded: there is none of that name.
TEST(exports_that_cannot_be_are_refused_in_one_line_before_any_work)
{
    use_cache("export-refused");
    const char *folder = path_of("export-x"), *full = make_folder("export-full");
    const struct run *r = run_expect(2, "bake absent.glb --gi mrt --export", folder, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "--gi mrt") && strstr(r->err, "techniques that have: ort"));
    r = run_expect(2, BAKE " --shard 0/2 -o a.safetensors --export", folder, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "--shard"));
    check_one_error_line(run_expect(2, BAKE " --lightmap b --export", folder, NULL));
    check_one_error_line(run_expect(2, "bake @cornell --gi lpv --export", folder, NULL));
    check_one_error_line(run_expect(2, BAKE " --export", "", NULL));
    check_one_error_line(
        run_expect(1, "bake absent.glb --gi ort --export", path_of("absent/export"), NULL));
    write_file(path_of("export-full/letter.txt"), "x", 1);
    check_one_error_line(run_expect(1, BAKE " --export", full, NULL));
    CHECK(file_exists(path_of("export-full/letter.txt")) && !file_exists(folder));
}
