// bake --lightmap: its files, what is refused, and that the scene's copy looks the same.
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BAKE "bake @cornell --gi radiosity:texels=2048 --spp 4 --quiet"

static const char *path_of(const char *name)
{
    static char paths[16][400];
    static int next;
    char *path = paths[next++ % 16];
    snprintf(path, sizeof paths[0], "%s", test_path(name));
    return path;
}

static void use_cache(const char *name)
{
    setenv("AFTERGLOW_CACHE", make_folder(name), 1);
}

TEST(light_map_is_the_same_for_any_threads_and_replaces_an_earlier_one)
{
    use_cache("lightmap-cache");
    const char *a = path_of("maps-a"), *b = path_of("maps-b");
    run_expect(0, BAKE " --threads 1 --force --lightmap", a, NULL);
    run_expect(0, BAKE " --threads 3 --force --lightmap", b, NULL);
    assert_int_equal(count_files(a), 2);
    CHECK(files_are_equal(path_of("maps-a/irradiance.exr"), path_of("maps-b/irradiance.exr")));
    CHECK(files_are_equal(path_of("maps-a/scene.glb"), path_of("maps-b/scene.glb")));
    run_expect(0, BAKE " --seed 5 --lightmap", a, NULL);
    assert_int_equal(count_files(a), 2);
    CHECK(!files_are_equal(path_of("maps-a/irradiance.exr"), path_of("maps-b/irradiance.exr")));
}

TEST(scene_with_light_map_renders_as_before)
{
    require_device();
    use_cache("lightmap-render");
    const char *maps = path_of("maps-r"), *a = path_of("a.exr"), *b = path_of("b.exr");
    run_expect(0, BAKE " --lightmap", maps, NULL);
    run_expect(0, "render @cornell --size 64x48 --gi lpv --quiet -o", a, NULL);
    run_expect(0, "render --size 64x48 --gi lpv --quiet -o", b, path_of("maps-r/scene.glb"), NULL);
    json_t *errors = run_json(run_expect(0, "diff --json", a, b, NULL));
    CHECK(json_number_value(json_object_get(errors, "flip")) < 0.001);
    json_decref(errors);
}

TEST(light_maps_that_cannot_be_are_refused_in_one_line)
{
    use_cache("lightmap-refused");
    const char *maps = path_of("maps-x"), *ours = make_folder("maps-full");
    check_one_error_line(run_expect(2, "bake @cornell --gi radiosity --spp 4", NULL));
    check_one_error_line(run_expect(2, BAKE " --shard 0/2 --lightmap", maps, NULL));
    const struct run *mrt = run_expect(2, "bake @cornell --gi mrt --spp 1 --lightmap", maps, NULL);
    check_one_error_line(mrt);
    CHECK(strstr(mrt->err, "--gi mrt") && strstr(mrt->err, "radiosity"));
    check_one_error_line(run_expect(1, BAKE " --lightmap", path_of("absent/maps"), NULL));
    write_file(path_of("maps-full/letter.txt"), "x", 1);
    check_one_error_line(run_expect(1, BAKE " --lightmap", ours, NULL));
    CHECK(file_exists(path_of("maps-full/letter.txt")));
    write_file(path_of("empty.gltf"), "{\"asset\":{\"version\":\"2.0\"}}", 27);
    const struct run *r =
        run_expect(1, "bake --spp 1 --lightmap", maps, path_of("empty.gltf"), NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "it has no triangles"));
    CHECK(!file_exists(maps));
}

// Before the scene is loaded: there is none of that name.
TEST(technique_without_a_light_map_is_wrong_usage_before_any_work)
{
    use_cache("lightmap-technique");
    const char *maps = path_of("maps-vct");
    const struct run *r = run_expect(2, "bake absent.glb --gi vct --lightmap", maps, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "--gi vct") && strstr(r->err, "radiosity") && !file_exists(maps));
    r = run_expect(1, "bake absent.glb --gi radiosity+vo --lightmap", maps, NULL);
    CHECK(strstr(r->err, "absent.glb"));
}

TEST(denoising_without_its_library_is_a_warning)
{
    use_cache("lightmap-denoise");
    const struct run *r = run_expect(0,
                                     "bake @cornell --gi radiosity:texels=2048 --spp 1 --denoise "
                                     "--lightmap",
                                     path_of("maps-d"), NULL);
#ifndef AG_OPEN_IMAGE_DENOISE
    CHECK(strstr(r->err, "built without Open Image Denoise"));
#endif
    CHECK(file_exists(path_of("maps-d/irradiance.exr")));
}
