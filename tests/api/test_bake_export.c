// Data of bakes for other programs, by the public functions.
#include "api/renderer_fixture.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SMALL "ort:texels=256,offsets=50,rays=16,local=1"

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

static struct ag_bake *bake_of(const struct opened *s, const char *gi, int samples)
{
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = samples;
    if (ag_bake_create(s->scene, gi, &desc, &bake) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return bake;
}

static void check_refused(const struct opened *s, const struct ag_bake *bake, const char *folder,
                          const char *message)
{
    assert_int_equal(ag_bake_export(bake, folder), AG_ERROR_ARGUMENT);
    if (!strstr(ag_context_last_error(s->context), message))
        fail_msg("%s", ag_context_last_error(s->context));
}

TEST(a_complete_bake_is_exported_run_or_loaded)
{
    struct opened s = open_scene();
    struct ag_bake *bake = bake_of(&s, SMALL, 0), *again = bake_of(&s, SMALL, 0);
    char folder[300], index[400], file[300];
    snprintf(folder, sizeof folder, "%s", test_path("export"));
    snprintf(file, sizeof file, "%s", test_path("export.safetensors"));
    snprintf(index, sizeof index, "%s/index.json", folder);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(ag_bake_export(bake, folder), AG_ERROR_FILE);
    CHECK(strstr(ag_context_last_error(s.context), "no such folder"));
    CHECK(mkdir(folder, 0777) == 0);
    assert_int_equal(ag_bake_export(bake, folder), AG_OK);
    CHECK(unlink(index) == 0);
    assert_int_equal(ag_bake_save(bake, file, false), AG_OK);
    assert_int_equal(ag_bake_load(again, file), AG_OK);
    assert_int_equal(ag_bake_export(again, folder), AG_OK);
    CHECK(access(index, F_OK) == 0);
    ag_bake_destroy(bake);
    ag_bake_destroy(again);
    close_scene(&s);
}

TEST(bakes_that_cannot_be_exported_are_refused)
{
    struct opened s = open_scene();
    struct ag_bake *bake = bake_of(&s, SMALL, 0), *mrt = bake_of(&s, "mrt", 0),
                   *map = bake_of(&s, SMALL, 4);
    assert_int_equal(ag_bake_export(NULL, "."), AG_ERROR_ARGUMENT);
    check_refused(&s, bake, NULL, "folder is empty");
    check_refused(&s, bake, "", "folder is empty");
    check_refused(&s, bake, ".", "cannot export the bake of ort: it is incomplete");
    check_refused(&s, mrt, ".", "techniques that have: ort");
    check_refused(&s, map, ".", "ag_lightmap_write");
    ag_bake_destroy(bake);
    ag_bake_destroy(mrt);
    ag_bake_destroy(map);
    close_scene(&s);
}

TEST(ort_alone_has_data_for_other_programs)
{
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++)
        CHECK(info.exports_bake == (strcmp(info.name, "ort") == 0));
}
