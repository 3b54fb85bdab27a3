// The lights of a light map's scene: all of the bake, marked with what of them is in the map.
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GI    " --gi radiosity:texels=2048 --spp 1 --quiet --lightmap"
#define SUN   " --light sun:0.3,-1,-0.4:5000,4000,3000"
#define POINT " --light point:0,2,1:300,200,100"
#define SKY   " --sky 20,30,40"
#define VIEW  " --size 48x36 --gi lpv:dim=16 --exposure 5 --quiet --aov color,direct,indirect -o"

static json_t *read_glb(const char *path)
{
    unsigned char head[20];
    FILE *file = fopen(path, "rb");
    CHECK(file && fread(head, 1, sizeof head, file) == sizeof head);
    const size_t size = (size_t)head[12] | (size_t)head[13] << 8 | (size_t)head[14] << 16;
    char *text = malloc(size);
    CHECK(text && fread(text, 1, size, file) == size);
    fclose(file);
    json_t *root = json_loadb(text, size, 0, NULL);
    free(text);
    CHECK(root);
    return root;
}

static const json_t *light_of(const json_t *glb, size_t i)
{
    const json_t *extensions = json_object_get(glb, "extensions");
    return json_array_get(
        json_object_get(json_object_get(extensions, "KHR_lights_punctual"), "lights"), i);
}

static void check_light(const json_t *glb, size_t i, const char *type, bool direct, bool indirect)
{
    const json_t *light = light_of(glb, i);
    const json_t *mark = json_object_get(json_object_get(light, "extras"), "afterglow_lightmap");
    const char *found = json_string_value(json_object_get(light, "type"));
    if (!found || strcmp(found, type) != 0) fail_msg("light %zu is %s, not %s", i, found, type);
    CHECK(json_is_boolean(json_object_get(mark, "direct")));
    CHECK(json_boolean_value(json_object_get(mark, "direct")) == direct);
    CHECK(json_boolean_value(json_object_get(mark, "indirect")) == indirect);
}

static void use_cache(const char *name)
{
    setenv("AFTERGLOW_CACHE", make_folder(name), 1);
}

// A glTF file with a point light, which is the copy of a built-in scene.
static const char *file_with_a_point_light(const char *folder)
{
    static char path[400];
    snprintf(path, sizeof path, "%s/scene.glb", test_path(folder));
    run_expect(0, "bake @cornell:light=point" GI, test_path(folder), NULL);
    return path;
}

static const char *copy_of(const char *folder)
{
    static char path[400];
    snprintf(path, sizeof path, "%s/scene.glb", test_path(folder));
    return path;
}

// ---- the file

TEST(copy_has_all_lights_of_the_bake_and_says_which_direct_light_is_in_the_map)
{
    use_cache("lights-cache");
    const char *given = file_with_a_point_light("lights-given");
    run_expect(0, "bake" SUN POINT SKY GI, test_path("lights-all"), given, NULL);
    json_t *glb = read_glb(copy_of("lights-all"));
    check_light(glb, 0, "point", true, true);
    check_light(glb, 1, "directional", true, true);
    check_light(glb, 2, "point", true, true);
    CHECK(!light_of(glb, 3));
    json_decref(glb);
    run_expect(0, "bake --indirect-only" SUN GI, test_path("lights-all"), given, NULL);
    glb = read_glb(copy_of("lights-all"));
    check_light(glb, 0, "point", false, true);
    check_light(glb, 1, "directional", false, true);
    json_decref(glb);
}

TEST(lights_that_the_bake_is_without_stay_in_the_file_and_emit_nothing_when_it_is_loaded)
{
    use_cache("lights-off-cache");
    const char *given = file_with_a_point_light("lights-off-given");
    run_expect(0, "bake --no-scene-lights" SUN GI, test_path("lights-off"), given, NULL);
    json_t *glb = read_glb(copy_of("lights-off"));
    check_light(glb, 0, "point", false, false);
    check_light(glb, 1, "directional", true, true);
    json_decref(glb);
    json_t *info = run_json(run_expect(0, "info --json", copy_of("lights-off"), NULL));
    const json_t *lights = json_object_get(info, "lights");
    CHECK(json_is_false(json_object_get(json_array_get(lights, 0), "enabled")));
    CHECK(json_is_true(json_object_get(json_array_get(lights, 1), "enabled")));
    json_decref(info);
    CHECK(strstr(run_expect(0, "info", copy_of("lights-off"), NULL)->out, " cd, off\n"));
    // A copy of the copy: the light stays off.
    run_expect(0, "bake" POINT GI, test_path("lights-off-again"), copy_of("lights-off"), NULL);
    glb = read_glb(copy_of("lights-off-again"));
    check_light(glb, 0, "point", false, false);
    check_light(glb, 1, "directional", true, true);
    check_light(glb, 2, "point", true, true);
    json_decref(glb);
}

// ---- its light

// Layers of `scene` with the options and of the copy without.
static void check_same_light(const char *scene, const char *options, const char *folder)
{
    static const char *const layers[] = { "color", "direct", "indirect" };
    char words[512], a[400], b[400];
    snprintf(a, sizeof a, "%s", test_path("lights-a.exr"));
    snprintf(b, sizeof b, "%s", test_path("lights-b.exr"));
    snprintf(words, sizeof words, "render%s" VIEW, options);
    run_expect(0, words, a, scene, NULL);
    run_expect(0, "render" VIEW, b, copy_of(folder), NULL);
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        snprintf(words, sizeof words, "diff --exposure 5 --json --layer %s", layers[i]);
        json_t *errors = run_json(run_expect(0, words, b, a, NULL));
        const double flip = json_number_value(json_object_get(errors, "flip"));
        const json_t *mean = json_object_get(errors, "mean_a");
        print_message("%s:%s, %s: flip %.3g\n", scene[0] == '@' ? scene : "file", options,
                      layers[i], flip);
        CHECK(flip < 0.001);
        CHECK(json_number_value(json_array_get(mean, 0)) > 1.0); // not black
        json_decref(errors);
    }
}

static void bake_and_compare(const char *scene, const char *options, const char *more,
                             const char *folder)
{
    char words[512];
    snprintf(words, sizeof words, "bake%s%s" GI, options, more);
    run_expect(0, words, test_path(folder), scene, NULL);
    check_same_light(scene, options, folder);
}

TEST(copy_of_a_file_has_the_light_of_the_bake_and_direct_light_once)
{
    require_device();
    use_cache("lights-render");
    const char *given = file_with_a_point_light("lights-render-given");
    bake_and_compare(given, SUN POINT SKY, "", "lights-same");
    bake_and_compare(given, SUN SKY, " --indirect-only", "lights-same");
    bake_and_compare(given, SUN SKY " --no-scene-lights", "", "lights-same");
    bake_and_compare(given, " --light area:0,4,0:0,-1,0:2,1:90,80,70", "", "lights-same");
}

TEST(copy_of_a_scene_without_light_has_the_default_light_that_was_baked)
{
    require_device();
    use_cache("lights-default");
    char dark[400];
    run_expect(0, "bake @cornell:light=point --no-scene-lights --sky 0,0,0" GI,
               test_path("lights-dark"), NULL);
    snprintf(dark, sizeof dark, "%s", copy_of("lights-dark"));
    bake_and_compare(dark, "", " --indirect-only", "lights-lit");
    json_t *glb = read_glb(copy_of("lights-lit"));
    check_light(glb, 0, "directional", false, true);
    json_decref(glb);
}

TEST(copy_of_a_built_in_scene_has_the_light_of_the_bake_and_direct_light_once)
{
    require_device();
    use_cache("lights-built-in");
    bake_and_compare("@cornell:light=point", SUN SKY, " --indirect-only", "lights-built-in-maps");
}
