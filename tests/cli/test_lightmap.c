// bake --lightmap: its files, what is refused, and that the scene's copy looks the same.
#include "cli/program.h"
#include "cli/screen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BAKE "bake @cornell --gi radiosity:texels=2048 --spp 4 --quiet"

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
    assert_int_equal(count_files(a), 6);
    CHECK(files_are_equal(path_of("maps-a/irradiance.exr"), path_of("maps-b/irradiance.exr")));
    CHECK(files_are_equal(path_of("maps-a/scene.glb"), path_of("maps-b/scene.glb")));
    run_expect(0, BAKE " --seed 5 --lightmap", a, NULL);
    assert_int_equal(count_files(a), 6);
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

#define NOISE "bake @cornell --gi radiosity:texels=2048 --spp auto:noise=12,max=2048 --quiet"

TEST(light_map_to_a_bound_of_noise_is_the_same_in_parts)
{
    use_cache("lightmap-noise");
    const char *maps = path_of("maps-bound"), *merged = path_of("maps-noise-merged");
    const char *a = path_of("n0.safetensors"), *b = path_of("n1.safetensors");
    json_t *result = run_json(run_expect(0, NOISE " --json --lightmap", maps, NULL));
    const double noise = json_number_value(json_object_get(result, "noise"));
    CHECK(noise > 0.01 && noise < 0.13);
    CHECK(json_number_value(json_object_get(result, "paths")) >= 32.0);
    json_decref(result);
    run_expect(0, NOISE " --lightmap x --shard 0/2 -o", a, NULL);
    run_expect(0, NOISE " --lightmap x --shard 1/2 -o", b, NULL);
    run_expect(0, "bake --quiet --merge", a, b, "--lightmap", merged, NULL);
    CHECK(files_are_equal(path_of("maps-bound/irradiance.exr"),
                          path_of("maps-noise-merged/irradiance.exr")));
}

// Sanitizers have memory of their own.
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
static void check_memory(const char *bake)
{
    char words[256];
    snprintf(words, sizeof words, "%s --spp 1 --force --quiet --json --lightmap", bake);
    json_t *result = run_json(run_expect(0, words, path_of("maps-memory"), NULL));
    const json_t *memory = json_object_get(result, "memory");
    const double estimate = json_number_value(json_object_get(memory, "estimate_bytes")),
                 peak = json_number_value(json_object_get(memory, "peak_bytes"));
    print_message("%s: %.1f MB, estimated %.1f\n", bake, peak * 1e-6, estimate * 1e-6);
    CHECK(peak > 1e6 && peak <= 1.25 * estimate && estimate <= 1.25 * peak);
    json_decref(result);
}

TEST(peak_memory_is_within_the_estimate)
{
    use_cache("lightmap-memory");
    check_memory("bake @cornell --gi radiosity:texels=131072");
    check_memory("bake @atrium --gi radiosity:density=5");
}
#endif

TEST(wrong_bounds_of_noise_are_refused_in_one_line)
{
    static const char *const wrong[] = {
        "auto:",         "auto:noise=0", "auto:noise=x", "auto:max=64", "auto:noise=2,max=31",
        "auto:noise=60", "auto:paths=3", "noise=2"
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        check_one_error_line(run_expect(2, "bake @cornell --lightmap x --spp", wrong[i], NULL));
    check_one_error_line(run_expect(2, "reference @cornell -o x.exr --spp auto:noise=2", NULL));
}

static double width_of(const char *scene)
{
    json_t *info = run_json(run_expect(0, "info --json", scene, NULL));
    const json_t *bounds = json_object_get(info, "bounds");
    const double width = json_number_value(json_array_get(json_object_get(bounds, "max"), 0)) -
                         json_number_value(json_array_get(json_object_get(bounds, "min"), 0));
    json_decref(info);
    return width;
}

// The copy of a file too, which is otherwise that of its own bytes.
TEST(the_copy_of_a_scaled_scene_is_in_metres)
{
    use_cache("lightmap-scaled");
    const char *maps = path_of("maps-s"), *again = path_of("maps-t");
    run_expect(0, BAKE " --scene-scale 0.5 --lightmap", maps, NULL);
    const double width = width_of(path_of("maps-s/scene.glb"));
    CHECK_NEAR(width, 0.5 * width_of("@cornell"), 1e-5);
    run_expect(0, "bake --gi radiosity:texels=2048 --spp 1 --quiet --scene-scale 4 --lightmap",
               again, path_of("maps-s/scene.glb"), NULL);
    CHECK_NEAR(width_of(path_of("maps-t/scene.glb")), 4 * width, 1e-5);
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

// ---- formats

static bool scene_has(const char *folder, const char *text)
{
    static char glb[1 << 22];
    FILE *file = fopen(path_of(folder), "rb");
    assert_non_null(file);
    const size_t size = fread(glb, 1, sizeof glb, file);
    fclose(file);
    return memmem(glb, size, text, strlen(text)) != NULL;
}

TEST(formats_are_those_of_the_list_and_replace_those_of_an_earlier_run)
{
    use_cache("lightmap-formats");
    const char *maps = path_of("maps-f");
    run_expect(0, BAKE " --lightmap-format ktx2 --lightmap", maps, NULL);
    assert_int_equal(count_files(maps), 4);
    CHECK(file_exists(path_of("maps-f/irradiance.ktx2")));
    CHECK(!scene_has("maps-f/scene.glb", "MOZ_lightmap"));
    const struct run *r =
        run_expect(0, BAKE " --lightmap-format png,exr --json --lightmap", maps, NULL);
    json_t *report = run_json(r), *formats = json_object_get(report, "formats");
    assert_int_equal(json_array_size(formats), 2);
    CHECK_STRING(json_string_value(json_array_get(formats, 0)), "exr");
    json_decref(report);
    assert_int_equal(count_files(maps), 5);
    CHECK(file_exists(path_of("maps-f/irradiance.png")));
    CHECK(scene_has("maps-f/scene.glb", "MOZ_lightmap"));
    // A copy's copy has the map once more, not twice.
    run_expect(0,
               "bake --gi radiosity:texels=2048 --spp 1 --quiet --lightmap-format exr --lightmap",
               path_of("maps-g"), path_of("maps-f/scene.glb"), NULL);
    CHECK(!scene_has("maps-g/scene.glb", "MOZ_lightmap"));
}

TEST(formats_that_are_none_are_refused_and_the_known_ones_named)
{
    use_cache("lightmap-no-formats");
    const char *maps = path_of("maps-n");
    static const char *const wrong[] = { "tga", "exr,", "exr,hdr", "exr ktx2" };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct run *r =
            run_expect(2, BAKE " --lightmap", maps, "--lightmap-format", wrong[i], NULL);
        check_one_error_line(r);
        CHECK(strstr(r->err, "exr ktx2 png"));
    }
    check_one_error_line(run_expect(2, "bake @cornell --gi radiosity --lightmap-format png", NULL));
    check_one_error_line(run_expect(2, BAKE " --lightmap-format png --shard 0/2 -o",
                                    path_of("p.safetensors"), "--lightmap", maps, NULL));
    CHECK(!file_exists(maps));
}

// ---- parts

#define LIGHT " --light point:0,3,1:90,80,70 --sky 1,2,3"

static void bake_part(const char *scene, const char *shard, const char *part, const char *folder)
{
    run_expect(0, "bake --gi radiosity:texels=2048 --spp 2 --seed 7 --quiet" LIGHT " --lightmap",
               folder, "-o", part, "--shard", shard, scene, NULL);
    CHECK(file_exists(part) && !file_exists(folder));
}

static void check_merged(const char *scene, const char *more)
{
    const char *a = path_of("parts-0.safetensors"), *b = path_of("parts-1.safetensors"),
               *c = path_of("parts-2.safetensors"), *whole = path_of("parts-whole"),
               *merged = path_of("parts-merged");
    char words[300];
    bake_part(scene, "0/3", a, merged);
    bake_part(scene, "1/3", b, merged);
    bake_part(scene, "2/3", c, merged);
    snprintf(words, sizeof words, "bake --merge --quiet%s" LIGHT " --lightmap", more);
    run_expect(0, words, merged, b, c, a, NULL);
    snprintf(words, sizeof words,
             "bake --gi radiosity:texels=2048 --spp 2 --seed 7 --force --quiet%s" LIGHT
             " --lightmap",
             more);
    run_expect(0, words, whole, scene, NULL);
    assert_int_equal(count_files(merged), count_files(whole));
    CHECK(files_are_equal(path_of("parts-merged/irradiance.exr"),
                          path_of("parts-whole/irradiance.exr")));
    CHECK(files_are_equal(path_of("parts-merged/scene.glb"), path_of("parts-whole/scene.glb")));
    static const char *const files[] = { "irradiance.exr",   "irradiance.ktx2", "irradiance.png",
                                         "bake.safetensors", "scene.glb",       "report.html" };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char name[64];
        snprintf(name, sizeof name, "parts-merged/%s", files[i]);
        unlink(path_of(name));
    }
    CHECK(rmdir(merged) == 0);
}

TEST(light_map_of_merged_parts_has_the_same_bytes_as_that_of_one_run)
{
    use_cache("lightmap-parts");
    check_merged("@cornell", "");
    check_merged("@cornell", " --indirect-only --denoise");
    run_expect(0, BAKE " --lightmap", path_of("maps-parts"), NULL);
    check_merged(path_of("maps-parts/scene.glb"), "");
}

TEST(parts_of_a_light_map_are_refused_where_they_do_not_fit)
{
    use_cache("lightmap-parts-refused");
    const char *part = path_of("part-x.safetensors"), *maps = path_of("part-x"),
               *other = path_of("part-y.safetensors");
    bake_part("@cornell", "0/2", part, maps);
    const struct run *r = run_expect(1, "bake --merge --lightmap", maps, part, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "of other light"));
    r = run_expect(1, "bake --merge -o", other, part, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "add --lightmap DIR"));
    run_expect(0, "bake @cornell --gi radiosity:texels=2048 --quiet --shard 0/2 -o", other, NULL);
    r = run_expect(1, "bake --merge --lightmap", maps, other, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "no part of a light map"));
    check_one_error_line(run_expect(2, "bake --merge --spp 2 --lightmap", maps, part, NULL));
    check_one_error_line(
        run_expect(2, BAKE " --shard 0/2 --denoise --lightmap", maps, "-o", other, NULL));
    r = run_expect(2, "bake @cornell --shard 0/2 --lightmap", maps, "-o", other, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "add --spp N") && !file_exists(maps));
}

// ---- techniques

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

TEST(denoised_light_maps_of_paths_have_less_noise)
{
    use_cache("lightmap-denoise");
    const char *noisy = path_of("maps-d0"), *denoised = path_of("maps-d1"),
               *reference = path_of("maps-d2");
    run_expect(0, BAKE " --seed 3 --spp 256 --lightmap", reference, NULL);
    run_expect(0, BAKE " --lightmap", noisy, NULL);
    const struct run *r = run_expect(0, BAKE " --denoise --lightmap", denoised, NULL);
    CHECK(!strstr(r->err, "warning"));
    double mse[2];
    for (int i = 0; i < 2; i++) {
        json_t *errors = run_json(run_expect(
            0, "diff --json", path_of(i ? "maps-d1/irradiance.exr" : "maps-d0/irradiance.exr"),
            path_of("maps-d2/irradiance.exr"), NULL));
        mse[i] = json_number_value(json_object_get(errors, "mse"));
        json_decref(errors);
    }
    CHECK(mse[1] < 0.6 * mse[0]);
}

// ---- updates

#define SCREEN                                                                                     \
    "bake --gi radiosity:texels=2048 --spp 16 --sky 100,100,100 --light "                          \
    "sun:0.3,-1,0.2:500,500,500 "

static json_t *update_of(const struct run *r)
{
    json_t *report = run_json(r), *update = json_object_get(report, "update");
    assert_non_null(update);
    json_incref(update);
    json_decref(report);
    return update;
}

static double number(const json_t *update, const char *key)
{
    return json_number_value(json_object_get(update, key));
}

TEST(update_without_a_change_writes_the_same_bytes_without_the_cache)
{
    use_cache("update-same");
    const char *scene = write_screen("update-same.gltf", 0.0), *maps = path_of("update-same-maps");
    static const char *const files[] = { "irradiance.exr", "irradiance_back.exr", "scene.glb",
                                         "bake.safetensors" };
    char a[64], b[64];
    run_expect(0, SCREEN "--quiet --lightmap", path_of("update-first"), scene, NULL);
    run_expect(0, SCREEN "--quiet --lightmap", maps, scene, NULL);
    use_cache("update-same-empty");
    json_t *update =
        update_of(run_expect(0, SCREEN "--quiet --json --update --lightmap", maps, scene, NULL));
    CHECK(number(update, "texels_again") == 0.0 && number(update, "instances_changed") == 0.0);
    json_decref(update);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        snprintf(a, sizeof a, "update-first/%s", files[i]);
        snprintf(b, sizeof b, "update-same-maps/%s", files[i]);
        CHECK(files_are_equal(path_of(a), path_of(b)));
    }
}

TEST(update_after_a_move_bakes_a_part_again_and_says_what_it_cost)
{
    use_cache("update-moved");
    const char *maps = path_of("update-moved-maps");
    run_expect(0, SCREEN "--quiet --lightmap", maps, write_screen("moved-a.gltf", -3.0), NULL);
    const struct run *r = run_expect(0, SCREEN "--json --update --lightmap", maps,
                                     write_screen("moved-b.gltf", -2.4), NULL);
    CHECK(strstr(r->err, "changed: 1 instance; baked again: "));
    json_t *update = update_of(r);
    const double again = number(update, "texels_again"), texels = number(update, "texels");
    print_message("%.0f of %.0f texels\n", again, texels);
    CHECK(again > 0.01 * texels && again < 0.7 * texels);
    CHECK(number(update, "instances_changed") == 1.0);
    CHECK(number(update, "seconds") > 0.0);
    json_decref(update);
    // The result is an earlier map, too.
    update = update_of(run_expect(0, SCREEN "--quiet --json --update --lightmap", maps,
                                  path_of("moved-b.gltf"), NULL));
    CHECK(number(update, "texels_again") == 0.0);
    json_decref(update);
}

static void check_all_is_baked(const char *words, const char *maps, const char *scene,
                               const char *why)
{
    const struct run *r = run_expect(0, words, maps, scene, NULL);
    CHECK(strstr(r->err, "warning: all is baked: cannot ") && strstr(r->err, why));
}

TEST(folders_that_cannot_be_updated_are_baked_completely_and_the_reason_is_said)
{
    use_cache("update-not");
    const char *scene = write_screen("update-not.gltf", 1.0), *maps = path_of("update-not-maps");
    check_all_is_baked(SCREEN "--update --lightmap", maps, scene, "bake.safetensors");
    check_all_is_baked("bake --gi radiosity:texels=4096 --spp 4 --update --lightmap", maps, scene,
                       "texels is 2048, not 4096, samples is 16, not 4");
    check_all_is_baked("bake --gi radiosity:texels=4096 --spp 4 --seed 9 --update --lightmap", maps,
                       scene, "its seed is 0, not 9");
    check_all_is_baked("bake --gi radiosity:texels=4096 --spp 4 --seed 9 --sky 1,2,3 --update "
                       "--lightmap",
                       maps, scene, "the sky or the environment has changed");
    write_file(path_of("update-not-maps/bake.safetensors"), "no", 2);
    check_all_is_baked(SCREEN "--update --lightmap", maps, scene, "bake.safetensors");
    check_all_is_baked("bake @cornell --gi radiosity:texels=2048 --spp 16 --light "
                       "sun:0.3,-1,0.2:500,500,500 --sky 100,100,100 --update --lightmap",
                       maps, NULL, "no surface of the scene is in it");
}

TEST(updates_that_cannot_be_are_wrong_usage)
{
    use_cache("update-usage");
    const char *maps = path_of("update-usage-maps"), *part = path_of("update-usage.safetensors");
    const struct run *r = run_expect(2, "bake @cornell --gi radiosity --update", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "it requires --lightmap DIR"));
    r = run_expect(2, "bake @cornell --gi radiosity --update --lightmap", maps, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "add --spp N"));
    r = run_expect(2, "bake @cornell --spp auto:noise=5 --update --lightmap x", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "--spp N"));
    r = run_expect(2, BAKE " --update --shard 0/2 --lightmap", maps, "-o", part, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "cannot use --update with --shard"));
    r = run_expect(2, "bake --merge --update --lightmap", maps, part, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "cannot use --update with --merge"));
    CHECK(!file_exists(maps) && !file_exists(part));
}
