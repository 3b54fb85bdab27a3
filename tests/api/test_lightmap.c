// Light maps through the public interface: of a renderer's radiosity, and by paths.
#include "api/renderer_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define SPEC "radiosity:texels=8192,rays=128"
enum { SAMPLES = 64 };

// Complete. samples 0: of the technique.
static struct ag_bake *bake_of(struct ag_scene *scene, const char *spec, int samples)
{
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = samples;
    assert_int_equal(ag_bake_create(scene, spec, &desc, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    return bake;
}

static void open_renderer(struct renderer_fixture *s, const char *spec)
{
    struct ag_renderer_desc desc = fixture_renderer_desc(spec);
    struct ag_bake *bake = bake_of(s->scene, spec, 0);
    const struct ag_bake *bakes[] = { bake };
    desc.bakes = bakes;
    desc.bake_count = 1;
    ag_renderer_destroy(s->renderer);
    assert_int_equal(ag_renderer_create(s->device, s->scene, &desc, &s->renderer), AG_OK);
    ag_bake_destroy(bake);
}

static struct ag_image *map_of(struct ag_lightmap *lightmap)
{
    struct ag_image *image = NULL;
    assert_int_equal(ag_lightmap_read(lightmap, false, &image), AG_OK);
    ag_lightmap_destroy(lightmap);
    return image;
}

static double mean_of(const struct ag_image *image)
{
    double sum = 0.0;
    const size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) sum += (double)image->pixels[i];
    return sum / (double)count;
}

static struct ag_image *map_of_renderer(struct renderer_fixture *s, bool indirect_only)
{
    struct ag_lightmap_desc desc;
    struct ag_lightmap *lightmap = NULL;
    ag_lightmap_desc_default(&desc);
    desc.indirect_only = indirect_only;
    assert_int_equal(ag_lightmap_from_renderer(s->renderer, &desc, &lightmap), AG_OK);
    return map_of(lightmap);
}

static struct ag_image *map_of_paths(struct ag_bake *bake, bool indirect_only)
{
    const struct ag_lightmap_desc desc = { .indirect_only = indirect_only };
    struct ag_lightmap *lightmap = NULL;
    assert_int_equal(ag_lightmap_from_bake(bake, &desc, &lightmap), AG_OK);
    return map_of(lightmap);
}

TEST_GPU(maps_of_radiosity_and_of_paths_agree)
{
    (void)gpu;
    struct renderer_fixture s = fixture_open(NULL, NULL);
    open_renderer(&s, SPEC);
    for (int i = 0; i < 2; i++) assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_bake *paths = bake_of(s.scene, SPEC, SAMPLES);
    double last = 0.0;
    for (int direct = 0; direct < 2; direct++) {
        struct ag_image *a = map_of_renderer(&s, !direct), *b = map_of_paths(paths, !direct);
        assert_int_equal(a->width, b->width);
        print_message("%s: %.1f and %.1f lx, mean difference %.3f\n", direct ? "all" : "indirect",
                      mean_of(a), mean_of(b), fixture_difference(a, b));
        CHECK_RELATIVE(mean_of(a), mean_of(b), 0.05);
        CHECK(mean_of(a) > last);
        last = mean_of(a);
        ag_image_destroy(s.context, a);
        ag_image_destroy(s.context, b);
    }
    ag_bake_destroy(paths);
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    fixture_close(&s);
}

// In a room light scatters within texels: the map has the direct light, once.
TEST_GPU(scattered_light_has_direct_light_once)
{
    (void)gpu;
    static const char SCATTERING[] = "ort:transfer=scattering,texels=8192,rays=16,offsets=50";
    struct renderer_fixture s = fixture_open(NULL, NULL);
    open_renderer(&s, SCATTERING);
    for (int i = 0; i < 2; i++) assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_bake *paths = bake_of(s.scene, SCATTERING, 1);
    struct ag_image *scattered = map_of_renderer(&s, false), *all = map_of_paths(paths, false),
                    *indirect = map_of_paths(paths, true);
    const double direct = mean_of(all) - mean_of(indirect);
    print_message("%.1f lx, %.1f lx of direct light\n", mean_of(scattered), direct);
    CHECK_RELATIVE(mean_of(scattered), direct, 0.05);
    struct ag_lightmap *none = NULL;
    const struct ag_lightmap_desc desc = { .indirect_only = true };
    assert_int_equal(ag_lightmap_from_renderer(s.renderer, &desc, &none), AG_ERROR_UNSUPPORTED);
    CHECK(none == NULL && strstr(ag_context_last_error(s.context), "light map of ort"));
    ag_image_destroy(s.context, scattered);
    ag_image_destroy(s.context, all);
    ag_image_destroy(s.context, indirect);
    ag_bake_destroy(paths);
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    fixture_close(&s);
}

TEST_GPU(light_maps_are_of_techniques_that_have_one)
{
    (void)gpu;
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_lightmap *lightmap = (struct ag_lightmap *)1;
    assert_int_equal(ag_lightmap_from_renderer(s.renderer, NULL, &lightmap), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_lightmap_from_renderer(s.renderer, NULL, &lightmap), AG_ERROR_ARGUMENT);
    CHECK(lightmap == NULL);
    CHECK_STRING(ag_context_last_error(s.context), "light map: no technique of the stack has one");
    fixture_close(&s);
}

TEST_GPU(transfer_at_vertices_has_no_light_map)
{
    (void)gpu;
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_bake_desc desc;
    struct ag_bake *bake = NULL;
    struct ag_lightmap *lightmap = NULL;
    open_renderer(&s, "prt:at=vertex,rays=16");
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_lightmap_from_renderer(s.renderer, NULL, &lightmap), AG_ERROR_ARGUMENT);
    CHECK_STRING(ag_context_last_error(s.context), "light map: no technique of the stack has one");
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = 1;
    assert_int_equal(ag_bake_create(s.scene, "prt:at=vertex", &desc, &bake), AG_ERROR_ARGUMENT);
    CHECK_STRING(ag_context_last_error(s.context),
                 "cannot bake prt:at=vertex: it has no light map");
    fixture_close(&s);
}

TEST(technique_of_a_light_map_is_the_one_of_the_stack_that_has_it)
{
    struct ag_context *context = fixture_context();
    struct ag_technique_info info;
    const char *name = NULL;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        assert_int_equal(ag_lightmap_technique(context, info.name, &name), AG_OK);
        if (info.has_lightmap)
            CHECK_STRING(name, info.name);
        else
            CHECK(name == NULL);
    }
    assert_int_equal(ag_lightmap_technique(context, "radiosity:texels=4096+vo", &name), AG_OK);
    CHECK_STRING(name, "radiosity");
    static const char *const NONE[] = { "vct", "prt:at=vertex" };
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_lightmap_technique(context, NONE[i], &name), AG_OK);
        CHECK(name == NULL);
    }
    assert_int_equal(ag_lightmap_technique(context, "radiosty", &name), AG_ERROR_ARGUMENT);
    ag_context_destroy(context);
}

TEST(light_map_with_a_bound_of_noise_states_noise_and_paths)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    struct ag_lightmap *lightmap = NULL;
    struct ag_lightmap_info info;
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    ag_bake_desc_default(&desc);
    for (int bound = 0; bound < 2; bound++) {
        desc.lightmap_samples = 512;
        desc.lightmap_noise = bound ? 0.1f : 0.0f;
        assert_int_equal(ag_bake_create(scene, "radiosity:texels=2048", &desc, &bake), AG_OK);
        assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
        assert_int_equal(ag_lightmap_from_bake(bake, NULL, &lightmap), AG_OK);
        assert_int_equal(ag_lightmap_get_info(lightmap, &info), AG_OK);
        if (bound) {
            CHECK(info.paths >= 32.0f && info.paths < 512.0f);
            CHECK(info.noise > 0.02f && (info.noise <= 0.11f || info.noisy_charts > 0));
        } else {
            CHECK(info.paths == 512.0f && isnan(info.noise) && info.noisy_charts == 0);
        }
        ag_lightmap_destroy(lightmap);
        ag_bake_destroy(bake);
    }
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST(light_map_functions_refuse_wrong_arguments)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    struct ag_lightmap *lightmap = NULL;
    struct ag_lightmap_info info;
    struct ag_image *image;
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = -1;
    assert_int_equal(ag_bake_create(scene, SPEC, &desc, &bake), AG_ERROR_ARGUMENT);
    desc.lightmap_samples = 31;
    desc.lightmap_noise = 0.1f;
    assert_int_equal(ag_bake_create(scene, SPEC, &desc, &bake), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "lightmap_samples"));
    desc.lightmap_samples = 64;
    desc.lightmap_noise = 1.0f;
    assert_int_equal(ag_bake_create(scene, SPEC, &desc, &bake), AG_ERROR_ARGUMENT);
    desc.lightmap_noise = 0.0f;
    desc.lightmap_samples = 1;
    assert_int_equal(ag_bake_create(scene, "mrt", &desc, &bake), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_create(scene, SPEC, &desc, &bake), AG_OK);
    assert_int_equal(ag_lightmap_from_bake(bake, NULL, &lightmap), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "incomplete"));
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    struct ag_lightmap_desc unknown;
    memset(&unknown, 0xff, sizeof unknown);
    ag_lightmap_desc_default(&unknown);
    unknown.reserved[7] = 1;
    assert_int_equal(ag_lightmap_from_bake(bake, &unknown, &lightmap), AG_ERROR_ARGUMENT);
    ag_lightmap_desc_default(NULL);
    assert_int_equal(ag_lightmap_from_bake(NULL, NULL, &lightmap), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_from_renderer(NULL, NULL, &lightmap), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_from_bake(bake, NULL, &lightmap), AG_OK);
    assert_int_equal(ag_lightmap_get_info(lightmap, &info), AG_OK);
    CHECK(info.width > 0 && info.texels > 1000 && !info.has_back && info.texels_per_m > 0.0f);
    assert_int_equal(ag_lightmap_get_info(NULL, &info), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_read(lightmap, true, &image), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_write(lightmap, ""), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_write_as(lightmap, test_path("."), 0), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_write_as(lightmap, test_path("."), 8), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_write(lightmap, test_path("absent")), AG_ERROR_FILE);
    ag_lightmap_destroy(lightmap);
    ag_lightmap_destroy(NULL);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

// ---- pages

// A texel's position and its light.
struct place {
    float position[3], light[3];
};

static int compare_places(const void *a, const void *b)
{
    return memcmp(a, b, sizeof((const struct place *)a)->position);
}

// Sorted by position. Each is on one page. Owned by the caller.
static struct place *places_of(const struct ag_lightmap *lightmap, int *count)
{
    struct ag_image *positions = NULL, *light = NULL;
    struct ag_lightmap_info info;
    *count = 0;
    assert_int_equal(ag_lightmap_get_info(lightmap, &info), AG_OK);
    assert_int_equal(ag_lightmap_positions(lightmap, false, &positions), AG_OK);
    assert_int_equal(ag_lightmap_read(lightmap, false, &light), AG_OK);
    struct place *out = calloc((size_t)info.texels, sizeof *out);
    assert_non_null(out);
    for (int i = 0; i < info.pages; i++) {
        struct ag_lightmap_page page;
        assert_int_equal(ag_lightmap_get_page(lightmap, i, &page), AG_OK);
        CHECK(page.x + page.width <= info.width && page.y + page.height <= info.height);
        for (int y = page.y; y < page.y + page.height; y++)
            for (int x = page.x; x < page.x + page.width; x++) {
                const size_t at = 3 * ((size_t)y * (size_t)info.width + (size_t)x);
                if (isnan(positions->pixels[at])) continue;
                assert_true(*count < info.texels);
                memcpy(out[*count].position, positions->pixels + at, sizeof out->position);
                memcpy(out[(*count)++].light, light->pixels + at, sizeof out->light);
            }
    }
    assert_int_equal(*count, info.texels);
    ag_image_destroy(NULL, positions);
    ag_image_destroy(NULL, light);
    qsort(out, (size_t)*count, sizeof *out, compare_places);
    return out;
}

// Destroys both. Closing of seams sums in another order.
static void check_equal_light(struct ag_lightmap *a, struct ag_lightmap *b)
{
    int count, other;
    struct place *one = places_of(a, &count), *paged = places_of(b, &other);
    double mean = 0.0, largest = 0.0;
    assert_int_equal(count, other);
    for (int i = 0; i < count; i++) {
        assert_int_equal(compare_places(&one[i], &paged[i]), 0);
        for (int c = 0; c < 3; c++) {
            largest = fmax(largest, fabs((double)one[i].light[c] - (double)paged[i].light[c]));
            mean += (double)one[i].light[c] / (3.0 * count);
        }
    }
    print_message("mean %.1f lx, largest difference %.2g lx\n", mean, largest);
    CHECK(mean > 0.0 && largest < 1e-3 * mean);
    free(one);
    free(paged);
    ag_lightmap_destroy(a);
    ag_lightmap_destroy(b);
}

TEST(texels_of_pages_have_the_light_of_one_map)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_lightmap *one = NULL, *paged = NULL;
    struct ag_lightmap_desc how;
    struct ag_lightmap_info info;
    int count = 0;
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    struct ag_bake *bake = bake_of(scene, SPEC, 4);
    ag_lightmap_desc_default(&how);
    how.denoise = true;
    assert_int_equal(ag_lightmap_from_bake(bake, &how, &one), AG_OK);
    how.page = 64;
    assert_int_equal(ag_lightmap_from_bake(bake, &how, &paged), AG_OK);
    assert_int_equal(ag_lightmap_get_info(paged, &info), AG_OK);
    assert_int_equal(ag_lightmap_count_pages(scene, SPEC, 64, &count), AG_OK);
    CHECK(count == info.pages && count >= 3);
    assert_int_equal(ag_lightmap_get_info(one, &info), AG_OK);
    assert_int_equal(info.pages, 1);
    check_equal_light(one, paged);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST_GPU(pages_of_a_renderer_have_the_light_of_one_map)
{
    (void)gpu;
    struct renderer_fixture s = fixture_open(NULL, NULL);
    struct ag_lightmap *one = NULL, *paged = NULL;
    const struct ag_lightmap_desc how = { .page = 64 };
    open_renderer(&s, SPEC);
    for (int i = 0; i < 2; i++) assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_lightmap_from_renderer(s.renderer, NULL, &one), AG_OK);
    assert_int_equal(ag_lightmap_from_renderer(s.renderer, &how, &paged), AG_OK);
    check_equal_light(one, paged);
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    fixture_close(&s);
}

TEST(pages_that_cannot_be_are_refused)
{
    static const int wrong[] = { -64, 0, 56, 100, 16392 };
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    struct ag_lightmap *lightmap = NULL;
    struct ag_lightmap_desc how;
    struct ag_lightmap_page page;
    int count = 1;
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(ag_lightmap_count_pages(scene, SPEC, wrong[i], &count), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_count_pages(NULL, SPEC, 64, &count), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_count_pages(scene, "vct", 64, &count), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_count_pages(scene, "radiosity:texels=65536", 64, &count),
                     AG_ERROR_MEMORY);
    CHECK(count == 0 && strstr(ag_context_last_error(context), "does not fit on a page of 64x64"));
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = 1;
    assert_int_equal(ag_bake_create(scene, "radiosity:texels=65536", &desc, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    ag_lightmap_desc_default(&how);
    how.page = 100;
    assert_int_equal(ag_lightmap_from_bake(bake, &how, &lightmap), AG_ERROR_ARGUMENT);
    how.page = 64;
    assert_int_equal(ag_lightmap_from_bake(bake, &how, &lightmap), AG_ERROR_MEMORY);
    CHECK(!lightmap);
    how.page = 2048;
    assert_int_equal(ag_lightmap_from_bake(bake, &how, &lightmap), AG_OK);
    assert_int_equal(ag_lightmap_get_page(lightmap, 0, &page), AG_OK);
    CHECK(page.x == 0 && page.y == 0 && page.width > 64);
    assert_int_equal(ag_lightmap_get_page(lightmap, 1, &page), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_get_page(lightmap, 0, NULL), AG_ERROR_ARGUMENT);
    ag_lightmap_destroy(lightmap);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST(estimated_memory_of_a_light_map_has_its_charts)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake_estimate few, many;
    struct ag_bake_desc desc;
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = 1;
    for (int i = 0; i < 2; i++) {
        struct ag_bake *bake = NULL;
        const char *spec = i ? "radiosity:texels=65536" : "radiosity:texels=4096";
        assert_int_equal(ag_bake_create(scene, spec, &desc, &bake), AG_OK);
        assert_int_equal(ag_bake_estimate_cost(bake, false, i ? &many : &few), AG_OK);
        ag_bake_destroy(bake);
    }
    // A texel has a position, its middle and places in the atlas, for the bake and for the map, the
    // result, two images, and what measures the map.
    const double texels = many.texels - few.texels;
    const double bytes = (double)many.peak_memory_bytes - (double)few.peak_memory_bytes;
    print_message("%.0f bytes for a texel\n", bytes / texels);
    CHECK(bytes > 200.0 * texels && bytes < 400.0 * texels);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

// Finite values of a layer.
static int values_of(const struct ag_lightmap *lightmap, enum ag_lightmap_layer layer)
{
    struct ag_image *image = NULL;
    int count = 0;
    assert_int_equal(ag_lightmap_read_layer(lightmap, layer, false, &image), AG_OK);
    assert_int_equal(image->channels, 1);
    for (int i = 0; i < image->width * image->height; i++) count += isfinite(image->pixels[i]) != 0;
    ag_image_destroy(NULL, image);
    return count;
}

TEST(report_of_a_light_map_is_there_where_it_was_asked_for)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    struct ag_lightmap *lightmap = NULL;
    struct ag_lightmap_desc how;
    struct ag_lightmap_info info;
    struct ag_image *image;
    const char *json = "";
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = 8;
    assert_int_equal(ag_bake_create(scene, "radiosity:density=6", &desc, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    ag_lightmap_desc_default(&how);
    assert_int_equal(ag_lightmap_from_bake(bake, &how, &lightmap), AG_OK);
    assert_int_equal(ag_lightmap_report(lightmap, &json), AG_ERROR_ARGUMENT);
    CHECK(!json && strstr(ag_context_last_error(context), "ag_lightmap_desc.report"));
    assert_int_equal(ag_lightmap_read_layer(lightmap, AG_LIGHTMAP_CHART, false, &image),
                     AG_ERROR_ARGUMENT);
    ag_lightmap_destroy(lightmap);
    how.report = true;
    assert_int_equal(ag_lightmap_from_bake(bake, &how, &lightmap), AG_OK);
    assert_int_equal(ag_lightmap_get_info(lightmap, &info), AG_OK);
    assert_int_equal(ag_lightmap_report(lightmap, &json), AG_OK);
    CHECK(strstr(json, "\"wanted\": 6") || strstr(json, "\"wanted\":6"));
    for (int layer = AG_LIGHTMAP_CHART; layer <= AG_LIGHTMAP_LEAK; layer++)
        assert_int_equal(values_of(lightmap, (enum ag_lightmap_layer)layer), info.texels);
    assert_int_equal(ag_lightmap_report(NULL, &json), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_report(lightmap, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_read_layer(lightmap, AG_LIGHTMAP_OPEN, true, &image),
                     AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_read_layer(lightmap, (enum ag_lightmap_layer)5, false, &image),
                     AG_ERROR_ARGUMENT);
    ag_lightmap_destroy(lightmap);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

// ---- updates: no device is needed

#define UPDATE_SPEC "radiosity:texels=4096"

static enum ag_result create_update(struct ag_scene *scene, const char *folder, int samples,
                                    struct ag_bake **out)
{
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = samples;
    desc.update_folder = folder;
    return ag_bake_create(scene, UPDATE_SPEC, &desc, out);
}

// Bakes and writes the map into the folder, and destroys the bake.
static void write_map(struct ag_bake *bake, const char *folder)
{
    struct ag_lightmap *lightmap = NULL;
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(ag_lightmap_from_bake(bake, NULL, &lightmap), AG_OK);
    assert_int_equal(ag_lightmap_write_as(lightmap, folder, AG_LIGHTMAP_EXR), AG_OK);
    ag_lightmap_destroy(lightmap);
    ag_bake_destroy(bake);
}

TEST(update_keeps_what_a_moved_instance_does_not_reach)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_update_info info;
    struct ag_scene_info counts;
    char folder[512];
    snprintf(folder, sizeof folder, "%s", test_path("update-maps"));
    CHECK(mkdir(folder, 0700) == 0);
    assert_int_equal(ag_scene_load(context, "@cornell:light=point", &scene), AG_OK);
    assert_int_equal(create_update(scene, NULL, SAMPLES, &bake), AG_OK);
    assert_int_equal(ag_bake_get_update(bake, &info), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "set update_folder"));
    write_map(bake, folder);

    // A small move of the last instance.
    assert_int_equal(ag_scene_get_info(scene, -1, 0.0, &counts), AG_OK);
    struct ag_instance_info placed;
    const int last = counts.instances - 1;
    assert_int_equal(ag_scene_get_instance(scene, last, -1, 0.0, &placed), AG_OK);
    placed.world_from_mesh[12] += 0.1f;
    assert_int_equal(ag_scene_set_instance_transform(scene, last, placed.world_from_mesh), AG_OK);
    assert_int_equal(ag_scene_set_instance_mobility(scene, last, AG_MOBILITY_STATIC), AG_OK);
    assert_int_equal(create_update(scene, folder, SAMPLES, &bake), AG_OK);
    assert_int_equal(ag_bake_get_update(bake, &info), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "run it first"));
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(ag_bake_get_update(bake, &info), AG_OK);
    print_message("%d instances, %llu of %llu texels, %.2f s, all %.2f s\n", info.instances_changed,
                  (unsigned long long)info.texels_again, (unsigned long long)info.texels,
                  info.seconds, info.full_seconds);
    CHECK(info.instances_changed == 1 && !info.lights_changed);
    CHECK(info.texels_again > 0 && info.texels_again < info.texels);
    write_map(bake, folder);

    // Now nothing has changed.
    assert_int_equal(create_update(scene, folder, SAMPLES, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(ag_bake_get_update(bake, &info), AG_OK);
    CHECK(info.texels_again == 0 && info.instances_changed == 0);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST(folders_that_cannot_be_updated_are_refused_in_one_sentence)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    char folder[512];
    snprintf(folder, sizeof folder, "%s", test_path("update-refused"));
    CHECK(mkdir(folder, 0700) == 0);
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    assert_int_equal(create_update(scene, folder, 4, &bake), AG_ERROR_FILE);
    CHECK(bake == NULL && strstr(ag_context_last_error(context), "bake.safetensors"));
    assert_int_equal(create_update(scene, folder, 0, &bake), AG_ERROR_ARGUMENT);
    assert_int_equal(create_update(scene, NULL, 4, &bake), AG_OK);
    write_map(bake, folder);
    bake = NULL;
    assert_int_equal(create_update(scene, folder, 8, &bake), AG_ERROR_FORMAT);
    CHECK(bake == NULL && strstr(ag_context_last_error(context), "samples is 4, not 8"));
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = 4;
    desc.update_folder = folder;
    desc.shard_count = 2;
    assert_int_equal(ag_bake_create(scene, UPDATE_SPEC, &desc, &bake), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "an update has no shards"));
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}
