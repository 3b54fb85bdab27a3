// Objects that come after a renderer was created: the bake of their mesh alone brings them in.
#include "api/moving_box.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define GI "lpv:dim=16,cascades=1,probes=true+dnrt:size=16,rays=32,direct=true"

static void path_of(const char *folder, const struct ag_bake_part *part, char out[512])
{
    snprintf(out, 512, "%s/%s.safetensors", folder, part->key);
}

// Loads what the folder has, and bakes and keeps the rest. Returns the number of parts that were
// run.
static int bake_into(struct renderer_fixture *s, const char *folder)
{
    struct ag_bake *bake = NULL;
    struct ag_bake_info info;
    struct ag_bake_part part;
    char path[512];
    int run = 0;
    assert_int_equal(ag_bake_create(s->scene, GI, NULL, &bake), AG_OK);
    assert_int_equal(ag_bake_get_info(bake, &info), AG_OK);
    assert_int_equal(ag_bake_get_part(bake, info.part_count, &part), AG_ERROR_ARGUMENT);
    for (int i = 0; i < info.part_count; i++) {
        assert_int_equal(ag_bake_get_part(bake, i, &part), AG_OK);
        path_of(folder, &part, path);
        if (access(path, R_OK) == 0) assert_int_equal(ag_bake_load_part(bake, i, path), AG_OK);
    }
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    for (int i = 0; i < info.part_count; i++) {
        assert_int_equal(ag_bake_get_part(bake, i, &part), AG_OK);
        CHECK(part.complete);
        if (part.loaded) continue;
        path_of(folder, &part, path);
        assert_int_equal(ag_bake_save_part(bake, i, path, true), AG_OK);
        run++;
    }
    ag_bake_destroy(bake);
    return run;
}

// A movable plate above the floor, of another mesh than the box.
static void add_plate(struct ag_scene *scene)
{
    static const float corners[12] = { -0.6f, 0, -0.6f, -0.6f, 0, 0.6f,
                                       0.6f,  0, 0.6f,  0.6f,  0, -0.6f };
    static const uint32_t faces[12] = { 0, 1, 2, 0, 2, 3, 0, 2, 1, 0, 3, 2 };
    const float at[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0.4f, 1, 1 };
    const struct ag_mesh_desc desc = {
        .positions = corners, .vertex_count = 4, .indices = faces, .index_count = 12, .material = 0
    };
    int mesh = -1, instance = -1;
    assert_int_equal(ag_scene_add_mesh(scene, &desc, &mesh), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, mesh, at, &instance), AG_OK);
    assert_int_equal(ag_scene_set_instance_mobility(scene, instance, AG_MOBILITY_MOVABLE), AG_OK);
}

static struct ag_image *frame_of(struct renderer_fixture *s)
{
    assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
    return fixture_read(s, "indirect");
}

static struct ag_image *fresh_frame(struct renderer_fixture *s, const struct ag_renderer_desc *desc)
{
    struct ag_renderer *fresh = NULL;
    assert_int_equal(ag_renderer_create(s->device, s->scene, desc, &fresh), AG_OK);
    assert_int_equal(ag_renderer_render(fresh, &s->frame), AG_OK);
    struct ag_image *image = fixture_read_from(s, fresh, "indirect");
    ag_renderer_destroy(fresh);
    return image;
}

TEST(an_object_that_comes_later_has_light_after_the_bake_of_its_mesh_alone)
{
    char folder[512];
    snprintf(folder, sizeof folder, "%s", test_path("bakes"));
    mkdir(folder, 0777);
    struct renderer_fixture s = fixture_open("none", NULL);
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    assert_int_equal(moving_box_place(s.scene, moving_box_add(s.scene), -1), AG_OK);
    const int baked_before = bake_into(&s, folder);
    CHECK(baked_before >= 1 && bake_into(&s, folder) == 0);
    struct ag_renderer_desc desc = fixture_renderer_desc(GI);
    desc.bake_folder = folder;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    struct ag_image *before = frame_of(&s);

    fixture_last_warning[0] = 0;
    add_plate(s.scene);
    struct ag_image *without = frame_of(&s);
    CHECK(strstr(fixture_last_warning, "dnrt: 1 dynamic objects are not in its bake"));
    fixture_last_warning[0] = 0;
    // Without that bake the technique goes on, with a warning that it has given.
    assert_int_equal(ag_renderer_set_gi(s.renderer, GI, NULL, 0), AG_OK);
    ag_image_destroy(s.context, frame_of(&s));
    CHECK_STRING(fixture_last_warning, "");

    assert_int_equal(bake_into(&s, folder), 1);
    assert_int_equal(ag_renderer_set_gi(s.renderer, GI, NULL, 0), AG_OK);
    struct ag_image *with = frame_of(&s), *fresh = fresh_frame(&s, &desc);
    print_message("the plate changes indirect light by %g\n", fixture_difference(with, without));
    CHECK(fixture_difference(with, without) > 1e-3);
    CHECK(fixture_difference(with, fresh) <= 0);
    struct ag_image *const images[] = { before, without, with, fresh };
    for (int i = 0; i < 4; i++) ag_image_destroy(s.context, images[i]);
    fixture_close(&s);
}

TEST(all_objects_are_of_techniques_that_bake_objects)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    CHECK(!desc.all_objects);
    desc.all_objects = true;
    assert_int_equal(ag_scene_load(context, "@cornell:light=point", &scene), AG_OK);
    assert_int_equal(ag_bake_create(scene, "radiosity", &desc, &bake), AG_ERROR_ARGUMENT);
    CHECK_STRING(ag_context_last_error(context), "cannot bake objects of radiosity: it bakes none");
    assert_int_equal(ag_bake_create(scene, GI, &desc, &bake), AG_OK);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}
