// bake --lightmap --page: the same bytes in all ways to bake, what replaces what, and refusals.
#include "cli/program.h"
#include "cli/screen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BAKE "bake @cornell --gi radiosity:texels=8192 --spp 2 --page 64 --quiet"

static void use_cache(const char *name)
{
    setenv("AFTERGLOW_CACHE", make_folder(name), 1);
}

static int count_maps(const char *folder, const char *name, const char *ending)
{
    int count = 0;
    for (char path[200];; count++) {
        snprintf(path, sizeof path, "%s/%s.%d.%s", folder, name, count, ending);
        if (!file_exists(path_of(path))) return count;
    }
}

static void check_equal(const char *a, const char *b, const char *name)
{
    char one[200], other[200];
    snprintf(one, sizeof one, "%s/%s", a, name);
    snprintf(other, sizeof other, "%s/%s", b, name);
    if (!files_are_equal(path_of(one), path_of(other))) fail_msg("%s differs in %s", name, b);
}

// All maps of fronts, and the scene.
static void check_same_maps(const char *a, const char *b)
{
    const int count = count_maps(a, "irradiance", "exr");
    CHECK(count >= 2);
    assert_int_equal(count_maps(b, "irradiance", "exr"), count);
    for (int i = 0; i < count; i++) {
        char name[40];
        snprintf(name, sizeof name, "irradiance.%d.exr", i);
        check_equal(a, b, name);
    }
    check_equal(a, b, "scene.glb");
    check_equal(a, b, "bake.safetensors");
}

static void bake_to(const char *words, const char *folder, const char *scene)
{
    char line[400];
    snprintf(line, sizeof line, "%s --lightmap", words);
    run_expect(0, line, path_of(folder), scene, NULL);
}

TEST(pages_have_the_same_bytes_for_any_threads_and_in_parts)
{
    use_cache("pages-cache");
    bake_to(BAKE " --threads 1 --denoise", "pages-one", NULL);
    bake_to(BAKE " --threads 3 --denoise --force", "pages-three", NULL);
    check_same_maps("pages-one", "pages-three");
    CHECK(count_maps("pages-one", "irradiance", "ktx2") ==
          count_maps("pages-one", "irradiance", "exr"));
    const char *a = path_of("pages-0.safetensors"), *b = path_of("pages-1.safetensors");
    static const char part[] = "bake @cornell --gi radiosity:texels=8192 --spp 2 --quiet "
                               "--lightmap x --shard";
    run_expect(0, part, "0/2", "-o", a, NULL);
    run_expect(0, part, "1/2", "-o", b, NULL);
    run_expect(0, "bake --merge --page 64 --denoise --quiet --lightmap", path_of("pages-merged"), a,
               b, NULL);
    check_same_maps("pages-one", "pages-merged");
}

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

// An update keeps the light of an earlier map, whatever its pages are.
TEST(pages_of_an_update_are_those_of_a_bake)
{
    static const char screen[] = "bake --gi radiosity:density=8 --spp 2 --quiet --sky 100,100,100";
    char words[300], scene[400];
    use_cache("pages-update");
    snprintf(scene, sizeof scene, "%s", write_screen("pages-screen.gltf", 0.0));
    bake_to(screen, "pages-updated", scene);
    snprintf(words, sizeof words, "%s --page 72", screen);
    bake_to(words, "pages-baked", scene);
    snprintf(words, sizeof words, "%s --page 72 --update --json --lightmap", screen);
    json_t *report = run_json(run_expect(0, words, path_of("pages-updated"), scene, NULL));
    CHECK(number(json_object_get(report, "update"), "texels_again") == 0.0);
    CHECK(json_array_size(json_object_get(report, "pages")) >= 2);
    json_decref(report);
    check_same_maps("pages-baked", "pages-updated");
    CHECK(!file_exists(path_of("pages-updated/irradiance.exr")));
    assert_int_equal(count_maps("pages-updated", "irradiance_back", "png"),
                     count_maps("pages-updated", "irradiance", "exr"));
    // And back.
    snprintf(words, sizeof words, "%s --update", screen);
    bake_to(words, "pages-updated", scene);
    CHECK(file_exists(path_of("pages-updated/irradiance.exr")));
    CHECK(count_maps("pages-updated", "irradiance", "exr") == 0);
}

// Also after a change, which is found by the copy of the earlier scene: its materials are divided.
TEST(an_update_of_pages_bakes_the_same_texels_again)
{
    static const char words[] = "bake --gi radiosity:density=8 --spp 4 --quiet --sky 100,100,100";
    char line[300];
    use_cache("pages-moved");
    for (int paged = 0; paged < 2; paged++) {
        const char *folder = paged ? "moved-pages" : "moved-one";
        const char *pages = paged ? " --page 72" : "";
        snprintf(line, sizeof line, "%s%s", words, pages);
        bake_to(line, folder, write_screen("pages-from.gltf", -3.0));
        snprintf(line, sizeof line, "%s%s --update --json --lightmap", words, pages);
        json_t *report = run_json(
            run_expect(0, line, path_of(folder), write_screen("pages-to.gltf", -2.4), NULL));
        CHECK(number(json_object_get(report, "update"), "texels_again") > 0.0);
        json_decref(report);
    }
    check_equal("moved-one", "moved-pages", "bake.safetensors");
    CHECK(count_maps("moved-pages", "irradiance", "exr") >= 2);
}

TEST(a_map_that_fits_on_a_page_is_the_one_without_pages)
{
    static const char *const files[] = { "irradiance.exr", "irradiance.ktx2", "irradiance.png",
                                         "scene.glb", "bake.safetensors" };
    use_cache("pages-single");
    bake_to("bake @cornell --gi radiosity:texels=2048 --spp 2 --quiet", "pages-none", NULL);
    bake_to("bake @cornell --gi radiosity:texels=2048 --spp 2 --quiet --page 2048", "pages-large",
            NULL);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        check_equal("pages-none", "pages-large", files[i]);
}

TEST(report_and_info_tell_pages)
{
    use_cache("pages-report");
    json_t *report =
        run_json(run_expect(0, BAKE " --json --lightmap", path_of("pages-json"), NULL));
    const json_t *pages = json_object_get(report, "pages"), *page, *item;
    size_t i;
    assert_int_equal(json_array_size(pages), count_maps("pages-json", "irradiance", "exr"));
    double places = 0.0;
    json_array_foreach(pages, i, page)
    {
        const json_t *size = json_object_get(page, "size");
        assert_int_equal(json_integer_value(json_array_get(size, 0)), 64);
        places += 64.0 * json_number_value(json_array_get(size, 1));
    }
    CHECK_RELATIVE(number(report, "utilisation"), number(report, "texels") / places, 1e-6);
    const json_t *noise = json_object_get(json_object_get(report, "quality"), "noise");
    json_array_foreach(json_object_get(noise, "worst"), i, item)
        CHECK(number(json_object_get(item, "first"), "page") < (double)json_array_size(pages));
    json_decref(report);
    const struct run *r = run_expect(0, "info @atrium --page 256", NULL);
    CHECK(strstr(r->out, "light map    3 pages of "));
    json_t *info = run_json(run_expect(0, "info @atrium --page 256 --json", NULL));
    CHECK(number(json_object_get(info, "light_map"), "pages") == 3.0);
    json_decref(info);
}

TEST(pages_that_cannot_be_are_refused_in_one_line_before_any_work)
{
    static const char *const wrong[] = { "0", "63", "56", "100", "16392", "x", "64x64" };
    use_cache("pages-refused");
    const char *maps = path_of("pages-refused-maps"), *part = path_of("pages-p.safetensors");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct run *r =
            run_expect(2, "bake @cornell --lightmap", maps, "--page", wrong[i], NULL);
        check_one_error_line(r);
        CHECK(strstr(r->err, "a multiple of 8, from 64 to 16384"));
    }
    const struct run *r = run_expect(2, "bake @cornell --gi radiosity --page 64", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "it requires --lightmap DIR"));
    r = run_expect(2, BAKE " --shard 0/2 --lightmap", maps, "-o", part, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "cannot use --page with --shard: give it with --merge"));
    // A billion paths: it would not end.
    r = run_expect(1,
                   "bake @cornell --gi radiosity:texels=65536 --spp 100000 --page 64 --quiet "
                   "--lightmap",
                   maps, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "(tall block) does not fit on a page of 64x64") &&
          strstr(r->err, "would do"));
    CHECK(!file_exists(maps) && !file_exists(part));
}

// Files of others stay, whatever they are called.
TEST(folders_with_pages_are_replaced_and_other_files_are_not)
{
    static const char *const others[] = { "irradiance.x.exr", "irradiance..exr", "irradiance.1.tga",
                                          "irradiance.1" };
    use_cache("pages-replaced");
    const char *maps = path_of("pages-replaced-maps");
    bake_to(BAKE " --lightmap-format ktx2", "pages-replaced-maps", NULL);
    bake_to("bake @cornell --gi radiosity:texels=2048 --spp 2 --quiet", "pages-replaced-maps",
            NULL);
    CHECK(count_maps("pages-replaced-maps", "irradiance", "ktx2") == 0);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        char path[200];
        snprintf(path, sizeof path, "pages-replaced-maps/%s", others[i]);
        write_file(path_of(path), "x", 1);
        const struct run *r = run_expect(1, BAKE " --lightmap", maps, NULL);
        check_one_error_line(r);
        CHECK(strstr(r->err, others[i]) && file_exists(path_of(path)));
        CHECK(remove(path_of(path)) == 0);
    }
}
