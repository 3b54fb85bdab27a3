// Painted light through the public interface: arguments, positions of texels, how long paint lasts.
#include "api/renderer_fixture.h"

#include <math.h>
#include <string.h>

#define SPEC "ort:texels=1024,offsets=50,rays=32"

static const float RADIUS = 0.9f; // of the brush, m

static struct ag_bake *bake_of(struct renderer_fixture *s, const char *spec)
{
    struct ag_bake *bake = NULL;
    assert_int_equal(ag_bake_create(s->scene, spec, NULL, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    return bake;
}

static struct renderer_fixture open_fixture(const char *spec)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_bake *bake = bake_of(&s, spec);
    const struct ag_bake *bakes[] = { bake };
    struct ag_renderer_desc desc = fixture_renderer_desc(spec);
    desc.bakes = bakes;
    desc.bake_count = 1;
    ag_renderer_destroy(s.renderer);
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    ag_bake_destroy(bake);
    return s;
}

static struct ag_lightmap *texels_of(struct renderer_fixture *s)
{
    struct ag_lightmap_desc desc;
    struct ag_lightmap *lightmap = NULL;
    ag_lightmap_desc_default(&desc);
    desc.no_light = true;
    assert_int_equal(ag_lightmap_from_renderer(s->renderer, &desc, &lightmap), AG_OK);
    return lightmap;
}

static struct ag_image *positions_of(struct renderer_fixture *s)
{
    struct ag_lightmap *lightmap = texels_of(s);
    struct ag_image *positions = NULL;
    assert_int_equal(ag_lightmap_positions(lightmap, false, &positions), AG_OK);
    ag_lightmap_destroy(lightmap);
    return positions;
}

// A brush: texels around a point of the floor.
static void paint_spot(struct renderer_fixture *s, const struct ag_image *positions, float lux)
{
    struct ag_light_paint paint;
    const size_t count = (size_t)positions->width * (size_t)positions->height;
    float *values = calloc(count, 3 * sizeof *values);
    assert_non_null(values);
    for (size_t i = 0; i < count; i++) {
        const float *p = positions->pixels + 3 * i;
        const bool near = hypotf(p[0], p[2]) < RADIUS && p[1] < 0.01f;
        for (int c = 0; near && c < 3; c++) values[3 * i + (size_t)c] = lux;
    }
    ag_light_paint_default(&paint);
    paint.width = positions->width;
    paint.height = positions->height;
    paint.lux = values;
    if (ag_renderer_paint_light(s->renderer, &paint) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    free(values);
}

static struct ag_image *next_frame(struct renderer_fixture *s)
{
    assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
    return fixture_read(s, "irradiance");
}

static bool are_equal(const struct ag_image *a, const struct ag_image *b)
{
    return memcmp(a->pixels, b->pixels,
                  3 * (size_t)a->width * (size_t)a->height * sizeof *a->pixels) == 0;
}

// Whether the next frame equals an image.
static bool is_next(struct renderer_fixture *s, const struct ag_image *expected)
{
    struct ag_image *image = next_frame(s);
    const bool equal = are_equal(image, expected);
    ag_image_destroy(s->context, image);
    return equal;
}

// ---- positions

TEST_GPU(positions_are_on_the_surfaces_of_the_scene)
{
    (void)gpu;
    struct renderer_fixture s = open_fixture(SPEC);
    struct ag_lightmap *lightmap = texels_of(&s); // before the first frame
    struct ag_lightmap_info info;
    struct ag_scene_info scene;
    struct ag_image *positions = positions_of(&s), *light = NULL;
    assert_int_equal(ag_scene_get_info(s.scene, 0, 0.0, &scene), AG_OK);
    assert_int_equal(ag_lightmap_get_info(lightmap, &info), AG_OK);
    assert_int_equal(positions->width, info.width);
    assert_int_equal(positions->height, info.height);
    int texels = 0;
    for (int i = 0; i < info.width * info.height; i++) {
        const float *p = positions->pixels + 3 * (size_t)i;
        if (isnan(p[0])) continue;
        texels++;
        for (int a = 0; a < 3; a++)
            CHECK(p[a] >= scene.bounds_min[a] - 1e-4f && p[a] <= scene.bounds_max[a] + 1e-4f);
    }
    assert_int_equal(texels, info.texels);
    assert_int_equal(ag_lightmap_read(lightmap, false, &light), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "no_light"));
    assert_int_equal(ag_lightmap_write(lightmap, test_path(".")), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_positions(lightmap, true, &light), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_positions(NULL, false, &light), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_lightmap_positions(lightmap, false, NULL), AG_ERROR_ARGUMENT);
    ag_image_destroy(s.context, positions);
    ag_lightmap_destroy(lightmap);
    fixture_close(&s);
}

// ---- frames

// The light map as a file has painted light, too: of the spot and of what it lights.
TEST_GPU(painted_light_is_in_frames_and_in_light_maps)
{
    (void)gpu;
    static const char *const SPECS[] = { SPEC, "radiosity:texels=2048,rays=64" };
    for (int k = 0; k < 2; k++) {
        struct renderer_fixture s = open_fixture(SPECS[k]);
        struct ag_image *positions = positions_of(&s), *map = NULL;
        struct ag_lightmap *lightmap = NULL;
        assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
        struct ag_image *dark = next_frame(&s);
        paint_spot(&s, positions, 1000);
        struct ag_image *lit = next_frame(&s);
        for (int i = 0; i < 3 * dark->width * dark->height; i++) CHECK(dark->pixels[i] == 0.0f);
        assert_int_equal(ag_lightmap_from_renderer(s.renderer, NULL, &lightmap), AG_OK);
        assert_int_equal(ag_lightmap_read(lightmap, false, &map), AG_OK);
        int painted = 0, others = 0;
        for (int i = 0; i < map->width * map->height; i++) {
            const float *p = positions->pixels + 3 * (size_t)i;
            if (isnan(p[0])) continue;
            const bool near = hypotf(p[0], p[2]) < RADIUS - 0.2f && p[1] < 0.01f;
            if (near) CHECK(map->pixels[3 * i] > 600.0f);
            painted += near;
            others += !near && map->pixels[3 * i] > 0.1f;
        }
        print_message("%s: %d texels painted, %d of the others lit\n", SPECS[k], painted, others);
        CHECK(painted > 8 && others > 200);
        struct ag_image *all[] = { positions, map, dark, lit };
        for (int i = 0; i < 4; i++) ag_image_destroy(s.context, all[i]);
        ag_lightmap_destroy(lightmap);
        fixture_close(&s);
    }
}

static void set_gi(struct renderer_fixture *s, const struct ag_bake *bake, const char *gi)
{
    assert_int_equal(ag_renderer_set_gi(s->renderer, gi, &bake, 1), AG_OK);
}

TEST_GPU(paint_lasts_until_the_technique_is_created_again)
{
    (void)gpu;
    struct renderer_fixture s = open_fixture(SPEC);
    struct ag_bake *bake = bake_of(&s, SPEC);
    struct ag_image *positions = positions_of(&s);
    struct ag_image *unpainted = next_frame(&s);
    paint_spot(&s, positions, 1000);
    struct ag_image *painted = next_frame(&s);
    CHECK(!are_equal(painted, unpainted));
    CHECK(is_next(&s, painted));
    set_gi(&s, bake, SPEC ",emitters=false"); // live
    CHECK(is_next(&s, painted));
    set_gi(&s, bake, SPEC "+vo"); // the technique stays
    CHECK(is_next(&s, painted));
    set_gi(&s, bake, SPEC);
    assert_int_equal(ag_renderer_resize(s.renderer, 16, 16), AG_OK);
    assert_int_equal(ag_renderer_resize(s.renderer, FIXTURE_WIDTH, FIXTURE_HEIGHT), AG_OK);
    CHECK(is_next(&s, painted));
    set_gi(&s, bake, SPEC ",parts=2"); // created again
    set_gi(&s, bake, SPEC);
    CHECK(is_next(&s, unpainted));
    paint_spot(&s, positions, 1000);
    CHECK(is_next(&s, painted));
    paint_spot(&s, positions, 0);
    CHECK(is_next(&s, unpainted));
    struct ag_image *all[] = { positions, unpainted, painted };
    for (int i = 0; i < 3; i++) ag_image_destroy(s.context, all[i]);
    ag_bake_destroy(bake);
    fixture_close(&s);
}

// A brush in frames that follow each other without a wait: each frame has its own paint.
TEST_GPU(frames_in_flight_have_their_own_paint)
{
    (void)gpu;
    enum { FRAMES = 6 };
    struct renderer_fixture s = open_fixture(SPEC);
    struct ag_image *positions = positions_of(&s);
    struct ag_device_counters before, after;
    ag_device_get_counters(s.device, &before);
    paint_spot(&s, positions, FRAMES);
    ag_device_get_counters(s.device, &after);
    CHECK(after.transfers == before.transfers); // nothing to wait for
    struct ag_image *expected = next_frame(&s);
    for (int i = 1; i <= FRAMES; i++) {
        paint_spot(&s, positions, 100.0f * (float)(FRAMES - i) + FRAMES);
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    }
    struct ag_image *image = fixture_read(&s, "irradiance");
    CHECK(are_equal(image, expected));
    struct ag_image *all[] = { positions, expected, image };
    for (int i = 0; i < 3; i++) ag_image_destroy(s.context, all[i]);
    fixture_close(&s);
}

// ---- arguments

static void refuse(struct renderer_fixture *s, const struct ag_light_paint *paint, const char *why)
{
    assert_int_equal(ag_renderer_paint_light(s->renderer, paint), AG_ERROR_ARGUMENT);
    if (!strstr(ag_context_last_error(s->context), why))
        fail_msg("no \"%s\" in: %s", why, ag_context_last_error(s->context));
}

TEST_GPU(wrong_rectangles_and_values_are_refused_by_name)
{
    (void)gpu;
    struct renderer_fixture s = open_fixture(SPEC);
    struct ag_light_paint paint;
    const float wrong[3] = { 1, -2, 3 };
    ag_light_paint_default(&paint);
    refuse(&s, &paint, "width 0 and height 0: the rectangle is empty");
    paint.width = paint.height = 1;
    assert_int_equal(ag_renderer_paint_light(s.renderer, &paint), AG_OK);
    paint.x = -1;
    refuse(&s, &paint, "x -1 and y 0");
    paint.x = 100000;
    refuse(&s, &paint, "x 100000 with a width of 1 texels is beyond the light map's width");
    paint.x = 0;
    paint.height = 100000;
    refuse(&s, &paint, "height of 100000 texels");
    paint.height = 1;
    paint.lux = wrong;
    refuse(&s, &paint, "the texel at 0, 0 has -2 lux");
    paint.lux = NULL;
    paint.back = true;
    refuse(&s, &paint, "no material is double-sided");
    paint.back = false;
    paint.reserved[7] = 1;
    refuse(&s, &paint, "newer library");
    assert_int_equal(ag_renderer_paint_light(s.renderer, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_paint_light(NULL, &paint), AG_ERROR_ARGUMENT);
    ag_light_paint_default(NULL);
    fixture_close(&s);
}

TEST_GPU(techniques_that_take_no_paint_name_those_that_do)
{
    (void)gpu;
    struct renderer_fixture s = fixture_open("lpv:dim=8,cascades=1", NULL);
    struct ag_light_paint paint;
    ag_light_paint_default(&paint);
    paint.width = paint.height = 1;
    refuse(&s, &paint, "these do: radiosity, ort");
    fixture_close(&s);
}
