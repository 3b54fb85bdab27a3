// The catalogue: its ends, and complete descriptions of all options.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

static void check_option(const struct ag_option_info *option)
{
    CHECK(option->name && option->name[0] && option->help && option->help[0]);
    CHECK(strspn(option->name, "abcdefghijklmnopqrstuvwxyz0123456789_") == strlen(option->name));
    CHECK(option->initial >= option->min && option->initial <= option->max);
    CHECK(option->unit && option->effect && option->effect[0]);
    CHECK(strcmp(option->type, "int") == 0 || strcmp(option->type, "float") == 0 ||
          strcmp(option->type, "bool") == 0 || strcmp(option->type, "choice") == 0 ||
          strcmp(option->type, "text") == 0);
}

TEST(the_catalogue_lists_all_techniques_and_options)
{
    struct ag_technique_info technique;
    struct ag_option_info option;
    const char *name, *help;
    int count = 0;
    bool has_none = false;
    for (; ag_technique_get(count, &technique); count++) {
        CHECK(technique.name[0] && technique.title[0]);
        has_none |= strcmp(technique.name, "none") == 0;
        for (int i = 0; i < technique.option_count; i++) {
            CHECK(ag_technique_option_get(count, i, &option));
            check_option(&option);
        }
        CHECK(!ag_technique_option_get(count, technique.option_count, &option));
        for (int i = 0; i < technique.preset_count; i++)
            CHECK(ag_technique_preset_get(count, i, &name, &help) && name[0] && help);
        CHECK(!ag_technique_preset_get(count, technique.preset_count, &name, &help));
        for (int i = 0; i < technique.debug_view_count; i++)
            CHECK(ag_technique_debug_view_get(count, i, &name, &help) && name[0] && help[0] &&
                  ag_technique_debug_view_find(count, name) == i);
        CHECK(ag_technique_debug_view_find(count, "nonesuch") == -1);
        CHECK(!ag_technique_debug_view_get(count, technique.debug_view_count, &name, &help));
    }
    CHECK(count >= 3 && has_none);
    CHECK(!ag_technique_get(-1, &technique));
    CHECK(!ag_technique_get(0, NULL));
    CHECK(!ag_technique_option_get(count, 0, &option));
    CHECK(!ag_technique_preset_get(-1, 0, &name, &help));
    CHECK(!ag_technique_debug_view_get(-1, 0, &name, &help));
    CHECK(ag_technique_debug_view_find(-1, "a") == -1);
    CHECK(ag_technique_debug_view_find(0, NULL) == -1);
}

TEST(every_technique_parses_with_its_defaults)
{
    struct ag_context *context = NULL;
    struct ag_technique_info technique;
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    for (int i = 0; ag_technique_get(i, &technique); i++) {
        struct ag_renderer_desc desc;
        uint64_t bytes = 0;
        ag_renderer_desc_default(&desc);
        desc.gi = technique.name;
        assert_int_equal(ag_renderer_estimate_memory(context, &desc, 1, &bytes), AG_OK);
        CHECK(bytes >= 1280 * 720 * 4);
    }
    ag_context_destroy(context);
}

TEST(the_catalogue_lists_all_frame_options)
{
    struct ag_option_info option;
    int count = 0;
    for (; ag_frame_option_get(count, &option); count++) check_option(&option);
    CHECK(count > 0);
    CHECK(!ag_frame_option_get(-1, &option));
}

TEST(every_builtin_scene_loads_and_has_a_camera_called_main)
{
    struct ag_context *context = NULL;
    struct ag_builtin_scene_info builtin;
    struct ag_option_info option;
    int count = 0;
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    for (; ag_builtin_scene_get(count, &builtin); count++) {
        char name[64];
        struct ag_scene *scene = NULL;
        snprintf(name, sizeof name, "@%s", builtin.name);
        assert_int_equal(ag_scene_load(context, name, &scene), AG_OK);
        CHECK_STRING(ag_scene_camera_name(scene, 0), "main");
        ag_scene_destroy(scene);
        for (int i = 0; i < builtin.option_count; i++) {
            CHECK(ag_builtin_scene_option_get(count, i, &option));
            check_option(&option);
        }
        CHECK(!ag_builtin_scene_option_get(count, builtin.option_count, &option));
    }
    CHECK(count > 0);
    ag_context_destroy(context);
}

TEST(the_nearest_name_corrects_typing_errors)
{
    const char *const known[] = { "render", "info", "list" };
    CHECK_STRING(ag_nearest_name("rendr", known, 3), "render");
    assert_null(ag_nearest_name("completely else", known, 3));
    assert_null(ag_nearest_name(NULL, known, 3));
    assert_null(ag_nearest_name("list", NULL, 3));
    assert_null(ag_nearest_name("list", known, 0));
}

TEST(layer_names_are_those_of_the_header)
{
    static const char *const names[] = { "color",      "direct",   "indirect", "irradiance",
                                         "visibility", "specular", "albedo",   "normal",
                                         "depth",      "position", "emissive", "motion",
                                         "id",         "display",  "debug" };
    int count = sizeof names / sizeof names[0];
    for (int i = 0; i < count; i++) CHECK_STRING(ag_layer_name(i), names[i]);
    assert_null(ag_layer_name(count));
    assert_null(ag_layer_name(-1));
}
