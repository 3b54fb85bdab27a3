// The public functions of bakes.
#include "api/renderer_fixture.h"

#include <string.h>

struct opened {
    struct ag_context *context;
    struct ag_scene *scene;
};

static struct opened open_scene(void)
{
    struct opened s = { .context = fixture_context() };
    assert_int_equal(ag_scene_load(s.context, "@cornell:light=point", &s.scene), AG_OK);
    return s;
}

static void close_scene(struct opened *s)
{
    ag_scene_destroy(s->scene);
    ag_context_destroy(s->context);
}

TEST(bake_of_techniques_that_need_none_is_refused_in_one_sentence)
{
    struct opened s = open_scene();
    struct ag_bake *bake = NULL;
    assert_int_equal(ag_bake_create(s.scene, "ambient+vo", NULL, &bake), AG_ERROR_ARGUMENT);
    CHECK(bake == NULL);
    CHECK_STRING(ag_context_last_error(s.context), "cannot bake ambient+vo: it needs no bake");
    const char *name = "x";
    assert_int_equal(ag_bake_technique(s.context, "ambient+vo", 0, &name), AG_OK);
    CHECK(name == NULL);
    close_scene(&s);
}

TEST(techniques_with_the_same_bake_name_one_of_them_in_its_files)
{
    struct opened s = open_scene();
    const char *name = NULL;
    assert_int_equal(ag_bake_technique(s.context, "drt", 0, &name), AG_OK);
    CHECK_STRING(name, "drt");
    assert_int_equal(ag_bake_technique_in_file(s.context, "drt", 0, &name), AG_OK);
    CHECK_STRING(name, "mrt");
    assert_int_equal(ag_bake_technique_in_file(s.context, "drt", 1, &name), AG_OK);
    CHECK(name == NULL);
    assert_int_equal(ag_bake_technique_in_file(s.context, "drt", -1, &name), AG_ERROR_ARGUMENT);
    close_scene(&s);
}

TEST(bake_functions_refuse_missing_arguments)
{
    struct opened s = open_scene();
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    struct ag_bake_estimate estimate;
    struct ag_bake_info info;
    const char *text;
    char name[32];
    ag_bake_desc_default(NULL);
    ag_bake_desc_default(&desc);
    CHECK(desc.threads == 0 && desc.shard_count == 0 && desc.checkpoint_every_s == 30.0);
    desc.threads = -1;
    assert_int_equal(ag_bake_create(s.scene, "none", &desc, &bake), AG_ERROR_ARGUMENT);
    ag_bake_desc_default(&desc);
    desc.shard = 2;
    desc.shard_count = 2;
    assert_int_equal(ag_bake_create(s.scene, "none", &desc, &bake), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "shard 2 is not one of 2"));
    assert_int_equal(ag_bake_create(NULL, "none", NULL, &bake), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_create(s.scene, NULL, NULL, &bake), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_create(s.scene, "lpvv", NULL, &bake), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_technique(s.context, "none", -1, &text), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_file_technique(s.context, "", name), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_estimate_cost(NULL, false, &estimate), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_run(NULL, NULL, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_save(NULL, "a", false), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_load(NULL, "a"), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_save_partial(NULL, "a"), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_merge(NULL, "a"), AG_ERROR_ARGUMENT);
    struct ag_bake_origin origin;
    assert_int_equal(ag_bake_set_checkpoint(NULL, "a"), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_partial_origin(s.context, "", &origin), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_get_info(NULL, &info), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_report(NULL, &text), AG_ERROR_ARGUMENT);
    ag_bake_destroy(NULL);
    close_scene(&s);
}

TEST(bake_file_that_is_none_is_refused)
{
    struct opened s = open_scene();
    char name[32] = "x";
    assert_int_equal(ag_bake_file_technique(s.context, test_path("absent"), name), AG_ERROR_FILE);
    CHECK(name[0] == 0);
    close_scene(&s);
}
