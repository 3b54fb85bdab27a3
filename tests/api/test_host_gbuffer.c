// A program's own G-buffer in place of the renderer's: that of another renderer, and damaged ones.
#include "api/renderer_fixture.h"

#include <stdio.h>
#include <string.h>

// With options that need more than depth and normals, beside temporal=true.
static const struct {
    const char *technique, *options;
} variants[] = {
    { "lpv", ":dim=16,geometry=maps" },
    { "vct", ":resolution=32,specular=true,temporal=true" },
};

// Its G-buffer, with motion, is the program's.
static struct ag_renderer *make(struct renderer_fixture *s, const char *gi, bool host,
                                const struct ag_bake *bake)
{
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.host_gbuffer = host;
    desc.bakes = &bake;
    desc.bake_count = bake != NULL;
    if (ag_renderer_create(s->device, s->scene, &desc, &renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    return renderer;
}

static struct renderer_fixture open_with_ids(void)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    struct ag_renderer_desc desc = fixture_renderer_desc("none");
    desc.id_layer = true;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    return s;
}

static struct ag_layer_handle layer(struct renderer_fixture *s, const char *name)
{
    struct ag_layer_handle handle;
    if (ag_renderer_layer_handle(s->renderer, name, &handle) != AG_OK)
        fail_msg("%s: %s", name, ag_context_last_error(s->context));
    return handle;
}

// That of the fixture's renderer. The Cornell box is rough and not metallic, as without an image.
static struct ag_gbuffer gbuffer_of(struct renderer_fixture *s)
{
    return (struct ag_gbuffer){ .depth = layer(s, "depth"),
                                .normal = layer(s, "normal"),
                                .albedo = layer(s, "albedo"),
                                .emissive = layer(s, "emissive"),
                                .motion = layer(s, "motion"),
                                .id = layer(s, "id") };
}

// A frame of the fixture's renderer, then one each with its G-buffer and with an own one.
static void render_both(struct renderer_fixture *s, struct ag_renderer *hosted,
                        struct ag_renderer *own)
{
    assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
    assert_int_equal(ag_renderer_render(own, &s->frame), AG_OK);
    const struct ag_gbuffer gbuffer = gbuffer_of(s);
    struct ag_frame_desc frame = s->frame;
    frame.gbuffer = &gbuffer;
    if (ag_renderer_render(hosted, &frame) != AG_OK)
        fail_msg("%s: %s", ag_renderer_gi(hosted), ag_context_last_error(s->context));
}

static void check_equal(struct renderer_fixture *s, const char *gi, const struct ag_bake *bake)
{
    static const char *const names[] = { "irradiance", "specular", "visibility",
                                         "direct",     "color",    "display" };
    struct ag_renderer *hosted = make(s, gi, true, bake), *own = make(s, gi, false, bake);
    const struct ag_frame_desc before = s->frame;
    for (int i = 0; i < 3; i++) {
        s->frame.camera.eye[0] += 0.01f; // histories are reprojected
        ag_jitter(i, 3, s->frame.jitter);
        render_both(s, hosted, own);
    }
    s->frame = before;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct ag_image *a = fixture_read_from(s, hosted, names[i]);
        struct ag_image *b = fixture_read_from(s, own, names[i]);
        const size_t bytes =
            sizeof *a->pixels * FIXTURE_WIDTH * FIXTURE_HEIGHT * (size_t)a->channels;
        if (memcmp(a->pixels, b->pixels, bytes) != 0)
            fail_msg("%s: %s differs by %g", gi, names[i], fixture_difference(a, b));
        ag_image_destroy(s->context, a);
        ag_image_destroy(s->context, b);
    }
    ag_renderer_destroy(hosted);
    ag_renderer_destroy(own);
}

TEST(with_an_equal_gbuffer_all_layers_are_equal_to_the_bit)
{
    struct renderer_fixture s = open_with_ids();
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        char base[FIXTURE_SPEC], longer[2 * FIXTURE_SPEC];
        fixture_print_base(i, &info, base);
        struct ag_bake *bake = fixture_bake(&s, base, &info);
        for (int k = 0; fixture_print_variant(i, &info, k, base); k++) check_equal(&s, base, bake);
        fixture_print_base(i, &info, base);
        for (size_t v = 0; v < sizeof variants / sizeof *variants; v++) {
            if (strcmp(variants[v].technique, info.name) != 0) continue;
            snprintf(longer, sizeof longer, "%s%s", base, variants[v].options);
            check_equal(&s, longer, bake);
        }
        ag_bake_destroy(bake);
    }
    fixture_close(&s);
}

static void check_refused(struct renderer_fixture *s, struct ag_renderer *renderer,
                          const struct ag_gbuffer *gbuffer, const char *expected)
{
    struct ag_frame_desc frame = s->frame;
    frame.gbuffer = gbuffer;
    assert_int_equal(ag_renderer_render(renderer, &frame), AG_ERROR_ARGUMENT);
    if (!strstr(ag_context_last_error(s->context), expected))
        fail_msg("%s is not in: %s", expected, ag_context_last_error(s->context));
}

static double mean_of(struct renderer_fixture *s, struct ag_renderer *renderer)
{
    struct ag_image *image = fixture_read_from(s, renderer, "irradiance");
    const int count = 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT;
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (double)image->pixels[i] / count;
    ag_image_destroy(s->context, image);
    return sum;
}

// Pixels find their place in the light map by instance and triangle.
TEST(radiosity_lights_by_probes_without_ids)
{
    static const char gi[] = "radiosity:texels=4096,rays=64,sources=24";
    struct renderer_fixture s = open_with_ids();
    struct ag_technique_info info = { .needs_bake = true };
    struct ag_bake *bake = fixture_bake(&s, gi, &info);
    struct ag_renderer *hosted = make(&s, gi, true, bake);
    render_both(&s, hosted, s.renderer);
    const double with_ids = mean_of(&s, hosted);
    struct ag_gbuffer gbuffer = gbuffer_of(&s);
    struct ag_frame_desc frame = s.frame;
    gbuffer.id.vk_image = NULL;
    frame.gbuffer = &gbuffer;
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_OK);
    print_message("mean irradiance by probes %.3f of the light map's\n",
                  mean_of(&s, hosted) / with_ids);
    CHECK_RELATIVE(mean_of(&s, hosted), with_ids, 0.1);
    ag_renderer_destroy(hosted);
    ag_bake_destroy(bake);
    fixture_close(&s);
}

// Ids tell an object its own pixels, which those of a convex one need not: they face away from it.
TEST(a_convex_object_of_dnrt_needs_no_ids)
{
    static const char gi[] = "lpv:dim=16,cascades=1,probes=true+dnrt:size=16,rays=16";
    const int block = 6;
    struct renderer_fixture s = open_with_ids();
    struct ag_technique_info info = { .needs_bake = true };
    assert_int_equal(ag_scene_set_instance_mobility(s.scene, block, AG_MOBILITY_MOVABLE), AG_OK);
    struct ag_bake *bake = fixture_bake(&s, gi, &info);
    struct ag_renderer *hosted = make(&s, gi, true, bake);
    struct ag_renderer *source = make(&s, "lpv:dim=16,cascades=1,probes=true", true, NULL);
    render_both(&s, hosted, s.renderer);
    struct ag_image *with = fixture_read_from(&s, hosted, "irradiance");
    struct ag_gbuffer gbuffer = gbuffer_of(&s);
    struct ag_frame_desc frame = s.frame;
    gbuffer.id.vk_image = NULL;
    frame.gbuffer = &gbuffer;
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_OK);
    assert_int_equal(ag_renderer_render(source, &frame), AG_OK);
    struct ag_image *without = fixture_read_from(&s, hosted, "irradiance");
    struct ag_image *alone = fixture_read_from(&s, source, "irradiance");
    const size_t bytes = sizeof *with->pixels * 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT;
    CHECK(memcmp(with->pixels, without->pixels, bytes) == 0);
    CHECK(fixture_difference(without, alone) > 0.01);
    ag_image_destroy(s.context, with);
    ag_image_destroy(s.context, without);
    ag_image_destroy(s.context, alone);
    ag_renderer_destroy(source);
    ag_renderer_destroy(hosted);
    ag_bake_destroy(bake);
    fixture_close(&s);
}

TEST(what_is_missing_or_has_another_form_is_named)
{
    struct renderer_fixture s = open_with_ids();
    struct ag_renderer_desc desc = fixture_renderer_desc("ambient+vo:temporal=true");
    struct ag_renderer *hosted = NULL;
    desc.host_gbuffer = true;
    desc.motion_layer = false;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    const struct ag_gbuffer good = gbuffer_of(&s);
    struct ag_gbuffer bad = good;
    check_refused(&s, s.renderer, &good, "without host_gbuffer");
    check_refused(&s, hosted, NULL, "gbuffer is NULL");
    bad.motion.vk_image = NULL;
    check_refused(&s, hosted, &bad, "layer motion, which a technique");
    bad.albedo.vk_image = NULL;
    check_refused(&s, hosted, &bad, "layer albedo");
    bad.normal.vk_image = NULL;
    check_refused(&s, hosted, &bad, "layer normal");
    bad.depth.vk_image = NULL;
    check_refused(&s, hosted, &bad, "layer depth");
    bad = good;
    bad.normal = good.albedo;
    check_refused(&s, hosted, &bad, "gbuffer.normal: its VkFormat");
    bad = good;
    bad.depth.width++;
    check_refused(&s, hosted, &bad, "gbuffer.depth: its size");
    bad = good;
    bad.albedo.vk_layout = VK_IMAGE_LAYOUT_GENERAL;
    check_refused(&s, hosted, &bad, "gbuffer.albedo: its VkImageLayout");
    bad = good;
    bad.motion.vk_usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    check_refused(&s, hosted, &bad, "gbuffer.motion: its usage");
    bad = good;
    bad.emissive.scale = 0;
    check_refused(&s, hosted, &bad, "gbuffer.emissive: its scale");
    bad = good;
    bad.reserved[6] = 1;
    check_refused(&s, hosted, &bad, "reserved");

    struct ag_frame_desc frame = s.frame;
    frame.gbuffer = &good;
    frame.pick = (const int[2]){ 1, 1 };
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "layer id"));

    frame = s.frame; // and none of that left anything behind
    frame.gbuffer = &good;
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_OK);
    struct ag_image *image = NULL;
    struct ag_layer_handle handle;
    static const char *const own[] = { "albedo", "normal", "position", "depth", "emissive" };
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        assert_int_equal(ag_renderer_read(hosted, own[i], &image), AG_ERROR_ARGUMENT);
        assert_int_equal(ag_renderer_layer_handle(hosted, own[i], &handle), AG_ERROR_ARGUMENT);
    }
    assert_int_equal(ag_renderer_set_display(hosted, "emissive"), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_set_display(hosted, "normal"), AG_OK);
    assert_int_equal(ag_renderer_set_display(s.renderer, "normal"), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_OK);
    struct ag_image *shown = fixture_read_from(&s, hosted, "display");
    struct ag_image *expected = fixture_read_from(&s, s.renderer, "display");
    CHECK(fixture_difference(shown, expected) == 0.0);
    ag_image_destroy(s.context, shown);
    ag_image_destroy(s.context, expected);
    ag_renderer_destroy(hosted);
    fixture_close(&s);
}

TEST(a_renderer_without_an_own_gbuffer_takes_less_memory)
{
    struct renderer_fixture s = open_with_ids();
    struct ag_renderer *hosted = make(&s, "none", true, NULL);
    uint64_t bytes[2] = { 0, 0 };
    struct ag_renderer *const renderers[2] = { s.renderer, hosted };
    render_both(&s, hosted, s.renderer);
    for (int i = 0; i < 2; i++) {
        struct ag_memory owners[64];
        const int count = ag_renderer_memory(renderers[i], owners, 64);
        for (int k = 0; k < count; k++) bytes[i] += owners[k].bytes;
    }
    // Depth, normal, albedo, emissive and motion, but for the alignment of allocations.
    const uint64_t pixels = FIXTURE_WIDTH * FIXTURE_HEIGHT;
    CHECK(bytes[0] - bytes[1] >= (4 + 4 + 4 + 8 + 8) * pixels);
    ag_renderer_destroy(hosted);
    fixture_close(&s);
}
