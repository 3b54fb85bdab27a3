// Estimates of memory against what renderers and views take, within 1 %. An estimate counts bytes
// of buffers and texels; the software driver pads rows of texels to 64 bytes, nothing at this
// width. Hardware pads rows of tiles, of up to 128 texels: 288 rows become 384. It knows no scene:
// this one has what it assumes, one sun and a dielectric of an own specular.
#include "api/view_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 512, HEIGHT = 288 };

// Without the scene.
static uint64_t taken_by(struct ag_renderer *renderer)
{
    struct ag_memory owners[64];
    assert_int_equal(ag_renderer_wait(renderer), AG_OK); // what was destroyed is freed
    const int count = ag_renderer_memory(renderer, owners, 64);
    uint64_t bytes = 0;
    for (int i = 0; i < count; i++)
        if (strcmp(owners[i].owner, "scene") != 0) bytes += owners[i].bytes;
    return bytes;
}

static void check_bound(struct renderer_fixture *s, const char *what, const char *gi,
                        uint64_t taken, uint64_t estimate)
{
    const double most = fixture_is_software(s) ? 1.01 : 1.5;
    if (getenv("VIEWS_PRINT"))
        printf("%-28s %-18s %8.2f MB, estimate %8.2f\n", gi, what, (double)taken * 1e-6,
               (double)estimate * 1e-6);
    if ((double)taken < 0.99 * (double)estimate || (double)taken > most * (double)estimate)
        fail_msg("%s, %s: %.3f MB, estimated %.3f", gi, what, (double)taken * 1e-6,
                 (double)estimate * 1e-6);
}

static void check_view(struct renderer_fixture *s, const char *what,
                       const struct ag_renderer_desc *renderer_desc, struct ag_renderer *renderer,
                       const struct ag_view_desc *desc, struct ag_frame_desc frame)
{
    uint64_t estimate;
    assert_int_equal(ag_view_estimate_memory(s->context, renderer_desc, desc, &estimate), AG_OK);
    const uint64_t before = taken_by(renderer);
    struct ag_view *view = view_create(s, renderer, desc);
    const struct ag_view_frame further = view_in_frame(view, &frame.camera);
    frame.views = &further;
    frame.view_count = 1;
    if (ag_renderer_render(renderer, &frame) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    check_bound(s, what, renderer_desc->gi, taken_by(renderer) - before, estimate);
    ag_view_destroy(view);
}

static void check_views(struct renderer_fixture *s, const struct ag_renderer_desc *renderer_desc,
                        struct ag_renderer *renderer, const struct ag_frame_desc *frame)
{
    struct ag_view_desc desc;
    ag_view_desc_default(&desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    check_view(s, "view", renderer_desc, renderer, &desc, *frame);
    desc.all_layers = desc.indirect_layer = true;
    check_view(s, "view, all layers", renderer_desc, renderer, &desc, *frame);
    desc.all_layers = false;
    desc.width = WIDTH / 2;
    check_view(s, "half a view", renderer_desc, renderer, &desc, *frame);
    desc.height = HEIGHT / 4;
    check_view(s, "small view", renderer_desc, renderer, &desc, *frame);
    desc.width = WIDTH + 64;
    desc.height = HEIGHT;
    check_view(s, "larger view", renderer_desc, renderer, &desc, *frame);
}

static struct ag_layer_handle layer(struct renderer_fixture *s, const char *name)
{
    struct ag_layer_handle handle;
    if (ag_renderer_layer_handle(s->renderer, name, &handle) != AG_OK)
        fail_msg("%s: %s", name, ag_context_last_error(s->context));
    return handle;
}

// Faces of reflective shadow maps are counted as those of a point light.
static struct ag_renderer_desc renderer_desc(const char *gi, bool temporal)
{
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.frame_options =
        temporal ? "shadow_size=256,rsm_size=32,antialias=temporal" : "shadow_size=256,rsm_size=32";
    return desc;
}

static struct renderer_fixture open_scene(void)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_light_desc sun;
    struct ag_material_desc glossy;
    ag_renderer_destroy(s.renderer);
    ag_light_desc_default(&sun, AG_LIGHT_SUN);
    ag_material_desc_default(&glossy);
    glossy.ior = 2.0f;
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    assert_int_equal(ag_scene_add_light(s.scene, &sun, NULL), AG_OK);
    assert_int_equal(ag_scene_set_material(s.scene, 0, &glossy), AG_OK);
    const struct ag_renderer_desc desc = renderer_desc("none", false);
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    assert_int_equal(ag_renderer_resize(s.renderer, WIDTH, HEIGHT), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    return s;
}

// With an own G-buffer, or with that of the fixture's renderer.
static void check(struct renderer_fixture *s, const char *gi, bool temporal, bool hosted,
                  bool views)
{
    struct ag_renderer_desc desc = renderer_desc(gi, temporal);
    struct ag_renderer *renderer = NULL;
    uint64_t estimate;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.host_gbuffer = hosted;
    assert_int_equal(ag_renderer_estimate_memory(s->context, &desc, 1, &estimate), AG_OK);
    assert_int_equal(ag_renderer_create(s->device, s->scene, &desc, &renderer), AG_OK);
    const struct ag_gbuffer gbuffer = { .depth = layer(s, "depth"),
                                        .normal = layer(s, "normal"),
                                        .albedo = layer(s, "albedo"),
                                        .motion = layer(s, "motion") };
    struct ag_frame_desc frame = s->frame;
    if (hosted) frame.gbuffer = &gbuffer;
    if (ag_renderer_render(renderer, &frame) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    check_bound(s, hosted ? "own G-buffer" : "renderer", gi, taken_by(renderer), estimate);
    if (views) check_views(s, &desc, renderer, &frame);
    ag_renderer_destroy(renderer);
}

TEST(estimates_are_exact_with_views_and_a_programs_gbuffer)
{
    static const char *const specs[] = { "none", "lpv:dim=16,cascades=1+vo:temporal=true",
                                         "vct:resolution=32,temporal=true" };
    struct renderer_fixture s = open_scene();
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++)
        for (int hosted = 0; hosted < 2; hosted++) check(&s, specs[i], false, hosted, true);
    for (int hosted = 0; hosted < 2; hosted++) check(&s, "none", true, hosted, true);
    fixture_close(&s);
}

TEST(estimates_of_techniques_are_exact)
{
    static const char *const specs[] = { "lpv:geometry=maps,precision=float,probes=true",
                                         "vct:storage=svo",
                                         "vct:levels=2,specular=true,half_resolution=true",
                                         "ambient+hbao:half_resolution=true",
                                         "ambient+vo:mode=areas" };
    struct renderer_fixture s = open_scene();
    struct ag_technique_info info;
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++)
        check(&s, specs[i], false, false, false);
    for (int i = 0; ag_technique_get(i, &info); i++) {
        char gi[FIXTURE_SPEC];
        fixture_print_base(i, &info, gi);
        if (!info.needs_bake) check(&s, gi, false, false, false);
    }
    fixture_close(&s);
}

static uint64_t estimate_of(struct renderer_fixture *s, const char *gi, float scene_size_m)
{
    struct ag_renderer_desc desc = renderer_desc(gi, false);
    uint64_t bytes = 0;
    desc.scene_size_m = scene_size_m;
    assert_int_equal(ag_renderer_estimate_memory(s->context, &desc, 1, &bytes), AG_OK);
    return bytes;
}

TEST(an_estimate_has_the_levels_of_a_large_scene)
{
    struct renderer_fixture s = open_scene();
    CHECK(estimate_of(&s, "vct", 0) == estimate_of(&s, "vct:levels=1", 0));
    CHECK(estimate_of(&s, "vct", 19) == estimate_of(&s, "vct:levels=1", 0));
    CHECK(estimate_of(&s, "vct", 40) == estimate_of(&s, "vct:levels=3", 0));
    CHECK(estimate_of(&s, "vct", 5000) == estimate_of(&s, "vct:levels=4", 0));
    CHECK(estimate_of(&s, "vct:trace=cones", 40) == estimate_of(&s, "vct:trace=cones", 0));
    fixture_close(&s);
}
