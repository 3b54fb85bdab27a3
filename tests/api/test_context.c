// Contexts: logs, allocators and independence.
#include "api/counting_allocator.h"
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct ears {
    int errors, others;
    char last[512];
};

static void listen(void *user, enum ag_log_level level, const char *message)
{
    struct ears *ears = user;
    if (level == AG_LOG_ERROR)
        ears->errors++;
    else
        ears->others++;
    snprintf(ears->last, sizeof ears->last, "%s", message);
    CHECK(strchr(message, '\n') == NULL);
}

TEST(an_error_is_logged_once_and_kept)
{
    struct ears ears = { 0 };
    struct ag_context_desc desc;
    ag_context_desc_default(&desc);
    desc.log = listen;
    desc.user = &ears;
    struct ag_context *context = NULL;
    struct ag_scene *scene = NULL;
    assert_int_equal(ag_context_create(&desc, &context), AG_OK);
    CHECK_STRING(ag_context_last_error(context), "");
    assert_int_equal(ag_scene_load(context, test_path("none.glb"), &scene), AG_ERROR_FILE);
    assert_int_equal(ears.errors, 1);
    CHECK_STRING(ag_context_last_error(context), ears.last);
    CHECK(strstr(ears.last, "none.glb"));
    ag_context_destroy(context);
}

TEST(a_context_without_a_log_still_knows_its_last_error)
{
    struct ag_context *context = NULL;
    struct ag_scene *scene = NULL;
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    assert_int_equal(ag_scene_load(context, "@nowhere", &scene), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "nowhere"));
    ag_context_destroy(context);
}

TEST(two_contexts_have_separate_logs)
{
    struct ears ears[2] = { 0 };
    struct ag_context *contexts[2] = { NULL };
    struct ag_scene *scenes[2] = { NULL };
    for (int i = 0; i < 2; i++) {
        struct ag_context_desc desc;
        ag_context_desc_default(&desc);
        desc.log = listen;
        desc.user = &ears[i];
        assert_int_equal(ag_context_create(&desc, &contexts[i]), AG_OK);
        assert_int_equal(ag_scene_load(contexts[i], i ? "@maze:blocks=3" : "@cornell", &scenes[i]),
                         AG_OK);
    }
    struct ag_scene *none = NULL;
    assert_int_equal(ag_scene_load(contexts[0], "@nowhere", &none), AG_ERROR_ARGUMENT);
    assert_int_equal(ears[0].errors, 1);
    assert_int_equal(ears[1].errors, 0);
    CHECK_STRING(ag_context_last_error(contexts[1]), "");
    // Any order of destruction works.
    ag_scene_destroy(scenes[0]);
    ag_context_destroy(contexts[0]);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scenes[1], 0, 0.0, &info), AG_OK);
    assert_true(info.triangles > 0);
    ag_scene_destroy(scenes[1]);
    ag_context_destroy(contexts[1]);
}

// ---- memory

static struct ag_context *allocator_context(struct counting_allocator *allocator)
{
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    ag_context_desc_default(&desc);
    desc.reallocate = counting_reallocate;
    desc.user = allocator;
    ag_context_create(&desc, &context);
    return context;
}

// Calls everything that allocates without a GPU; stops at the first failure, which must be
// AG_ERROR_MEMORY.
static enum ag_result use_everything(struct ag_context *context, const char *scene_name,
                                     const char *folder)
{
    struct ag_scene *scene = NULL, *built = NULL;
    struct ag_image *image = NULL, *shown = NULL, *read = NULL, *pair = NULL, *map = NULL;
    struct ag_scene_info info;
    struct ag_camera camera;
    struct ag_metrics metrics;
    struct ag_compare_desc compare;
    ag_compare_desc_default(&compare);
    compare.radiance = true;
    char png[512], exr[512];
    snprintf(png, sizeof png, "%s.png", folder);
    snprintf(exr, sizeof exr, "%s.exr", folder);
    enum ag_result result = ag_scene_load(context, scene_name, &scene);
    if (result == AG_OK) result = ag_scene_get_info(scene, 0, 0.5, &info);
    if (result == AG_OK) result = ag_scene_default_camera(scene, 0, 0, &camera, NULL);
    if (result == AG_OK) result = ag_scene_add_default_lighting(scene, NULL);
    if (result == AG_OK) result = ag_scene_create(context, &built);
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    if (result == AG_OK) result = ag_scene_add_material(built, &material, NULL);
    const float corners[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    const uint32_t indices[3] = { 0, 1, 2 };
    const struct ag_mesh_desc mesh = {
        .positions = corners, .vertex_count = 3, .indices = indices, .index_count = 3
    };
    if (result == AG_OK) result = ag_scene_add_mesh(built, &mesh, NULL);
    if (result == AG_OK) result = ag_scene_add_instance(built, 0, NULL, NULL);
    if (result == AG_OK) result = ag_image_create(context, 8, 4, 3, &image);
    if (result == AG_OK) result = ag_image_tonemap(context, image, 0, &shown);
    if (result == AG_OK) result = ag_image_write_png(context, png, shown);
    const struct ag_image_layer layer = { "color", image };
    if (result == AG_OK) result = ag_image_write_exr(context, exr, &layer, 1, NULL, 0);
    if (result == AG_OK) result = ag_image_read(context, exr, NULL, &read);
    if (result == AG_OK) result = ag_image_side_by_side(context, image, read, 1, &pair);
    if (result == AG_OK) result = ag_image_metrics(context, image, read, &compare, &metrics);
    if (result == AG_OK)
        result = ag_image_error_map(context, image, read, &compare, AG_DIFFERENCE_FLIP, 0, &map);
    ag_image_destroy(context, map);
    ag_image_destroy(context, pair);
    ag_image_destroy(context, read);
    ag_image_destroy(context, shown);
    ag_image_destroy(context, image);
    ag_scene_destroy(built);
    ag_scene_destroy(scene);
    return result;
}

static void check_every_refusal(const char *scene_name)
{
    struct counting_allocator allocator = { 0 };
    char folder[512];
    snprintf(folder, sizeof folder, "%s", test_path("memory"));
    struct ag_context *context = allocator_context(&allocator);
    assert_non_null(context);
    assert_int_equal(use_everything(context, scene_name, folder), AG_OK);
    ag_context_destroy(context);
    assert_true(allocator.asked > 10);
    assert_int_equal(allocator.blocks, 0);
    long calls = allocator.asked;

    for (int all = 0; all < 2; all++)
        for (long k = 1; k <= calls; k++) {
            allocator = (struct counting_allocator){ .refuse_at = k, .refuse_all = all };
            context = allocator_context(&allocator);
            enum ag_result result =
                context ? use_everything(context, scene_name, folder) : AG_ERROR_MEMORY;
            ag_context_destroy(context);
            if (allocator.blocks != 0)
                fail_msg("refusal %ld leaks %ld blocks", k, allocator.blocks);
            if (result != AG_ERROR_MEMORY)
                fail_msg("refusal %ld of %ld gives \"%s\"", k, calls, ag_result_string(result));
        }
}

TEST(every_refused_allocation_is_a_memory_error_and_leaks_nothing)
{
    check_every_refusal("@cornell:light=point");
}

TEST(every_refused_allocation_of_a_file_is_a_memory_error_and_leaks_nothing)
{
    check_every_refusal(test_scene_path("box-animated.gltf"));
}

TEST(every_refused_allocation_of_a_skin_or_a_texture_is_a_memory_error_and_leaks_nothing)
{
    check_every_refusal(test_scene_path("fox.glb"));
}

TEST(the_programs_allocator_is_the_only_one)
{
    struct counting_allocator allocator = { .refuse_at = 1, .refuse_all = true };
    assert_null(allocator_context(&allocator));
    assert_true(allocator.asked > 0);
}

TEST(text_is_made_printable)
{
    char out[32];
    CHECK(ag_printable("a\x1b\u202e", out, sizeof out) == 13);
    CHECK_STRING(out, "a\\u001b\\u202e");
    CHECK(ag_printable("abc", out, 3) == 2 && strcmp(out, "ab") == 0);
    CHECK(ag_printable(NULL, out, sizeof out) == 0 && out[0] == 0);
    CHECK(ag_printable("abc", NULL, 8) == 0 && ag_printable("abc", out, 0) == 0);
}

TEST(links_are_followed_unless_in_the_named_folder)
{
    char folder[512], link[600];
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    struct ag_image *image = NULL;
    CHECK(snprintf(folder, sizeof folder, "%s", test_path("")) < (int)sizeof folder);
    snprintf(link, sizeof link, "%s/link.png", folder);
    ag_context_desc_default(&desc);
    for (int guarded = 0; guarded < 2; guarded++) {
        desc.no_links_in = guarded ? folder : NULL;
        CHECK(ag_context_create(&desc, &context) == AG_OK);
        if (!guarded) {
            CHECK(ag_image_create(context, 2, 2, 3, &image) == AG_OK);
            CHECK(ag_image_write_png(context, test_path("real.png"), image) == AG_OK);
            ag_image_destroy(context, image);
            assert_int_equal(symlink(test_path("real.png"), link), 0);
        }
        const enum ag_result result = ag_image_read(context, link, NULL, &image);
        CHECK(result == (guarded ? AG_ERROR_FILE : AG_OK));
        ag_image_destroy(context, image);
        ag_context_destroy(context);
    }
}

TEST(the_size_of_an_image_is_known_before_it_is_read)
{
    struct ag_context *context = NULL;
    struct ag_image *image = NULL;
    int width = 0, height = 0;
    CHECK(ag_context_create(NULL, &context) == AG_OK);
    CHECK(ag_image_create(context, 5, 3, 3, &image) == AG_OK);
    const struct ag_image_layer layer = { "color", image };
    const char *const paths[] = { test_path("size.png"), test_path("size.exr") };
    CHECK(ag_image_write_png(context, paths[0], image) == AG_OK);
    CHECK(ag_image_write_exr(context, paths[1], &layer, 1, NULL, 0) == AG_OK);
    for (int i = 0; i < 2; i++) {
        CHECK(ag_image_read_size(context, paths[i], &width, &height) == AG_OK);
        CHECK(width == 5 && height == 3);
    }
    CHECK(ag_image_read_size(context, test_path("none.png"), &width, &height) == AG_ERROR_FILE);
    CHECK(ag_image_read_size(context, "a.jpg", &width, &height) == AG_ERROR_UNSUPPORTED);
    CHECK(ag_image_read_size(context, paths[0], NULL, &height) == AG_ERROR_ARGUMENT);
    ag_image_destroy(context, image);
    ag_context_destroy(context);
}
