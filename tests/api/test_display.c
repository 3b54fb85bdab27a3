// Any layer as the display image, under validation.
#include "api/renderer_fixture.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static double encoded(double v)
{
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

static struct renderer_fixture open_all(const char *gi)
{
    struct renderer_fixture s = fixture_open(gi, NULL);
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.indirect_layer = desc.motion_layer = desc.display_layer = true;
    ag_renderer_destroy(s.renderer);
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    return s;
}

static void show(struct renderer_fixture *s, const char *layer)
{
    if (ag_renderer_set_display(s->renderer, layer) != AG_OK)
        fail_msg("%s: %s", layer, ag_context_last_error(s->context));
    assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
}

static double mapped(const char *layer, const float *value, int k, const float *normal)
{
    const double size[3] = { FIXTURE_WIDTH, FIXTURE_HEIGHT, 1.0 };
    const bool surface = normal[0] != 0.0f || normal[1] != 0.0f || normal[2] != 0.0f;
    if (strcmp(layer, "albedo") == 0) return value[k];
    if (strcmp(layer, "visibility") == 0) return value[0];
    if (!surface) return 0.0;
    if (strcmp(layer, "normal") == 0) return 0.5 + 0.5 * (double)value[k];
    if (strcmp(layer, "depth") == 0) return 1.0 / (1.0 + (double)value[0]);
    const double v = (double)value[k] * size[k]; // motion
    return 0.5 + 0.5 * v / (1.0 + fabs(v));
}

static enum ag_tonemap shown_curve; // of the renderer

static struct ag_image *tone_mapped(struct renderer_fixture *s, struct ag_image *radiance,
                                    double factor)
{
    float ev;
    struct ag_image *out;
    const int count = radiance->width * radiance->height * 3;
    assert_int_equal(ag_renderer_exposure(s->renderer, &ev), AG_OK);
    for (int i = 0; i < count; i++) radiance->pixels[i] *= (float)factor;
    assert_int_equal(ag_image_tonemap_curve(s->context, radiance, ev, shown_curve, &out), AG_OK);
    return out;
}

// Half a step of the eight bits, and the rounding of the tone mapping.
static void check_value(const char *layer, int pixel, double got, double expected)
{
    if (fabs(encoded(got) - encoded(expected)) > 0.6 / 255.0)
        fail_msg("%s, pixel %d: %g, not %g", layer, pixel, got, expected);
}

static void check_radiance(struct renderer_fixture *s, const char *layer, double factor)
{
    show(s, layer);
    struct ag_image *value = fixture_read(s, layer), *display = fixture_read(s, "display");
    struct ag_image *expected = tone_mapped(s, value, factor);
    double sum = 0.0;
    for (int i = 0; i < 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT; i++) {
        check_value(layer, i / 3, display->pixels[i], expected->pixels[i]);
        sum += (double)display->pixels[i];
    }
    const bool dark = strcmp(layer, "specular") == 0 || strcmp(layer, "emissive") == 0;
    if (!dark && sum <= 0.0) fail_msg("%s is black", layer);
    ag_image_destroy(s->context, value);
    ag_image_destroy(s->context, display);
    ag_image_destroy(s->context, expected);
}

static void check_value_layer(struct renderer_fixture *s, const char *layer)
{
    show(s, layer);
    struct ag_image *value = fixture_read(s, layer), *display = fixture_read(s, "display");
    struct ag_image *normal = fixture_read(s, "normal");
    for (int i = 0; i < FIXTURE_WIDTH * FIXTURE_HEIGHT; i++)
        for (int k = 0; k < 3; k++)
            check_value(
                layer, i, display->pixels[3 * i + k],
                mapped(layer, &value->pixels[i * value->channels], k, &normal->pixels[3 * i]));
    ag_image_destroy(s->context, value);
    ag_image_destroy(s->context, display);
    ag_image_destroy(s->context, normal);
}

TEST(each_layer_is_shown_by_its_rule)
{
    test_gpu_require();
    struct renderer_fixture s = open_all("lpv:dim=16+vo");
    static const char *const radiance[] = { "color", "direct", "indirect", "specular", "emissive" };
    static const char *const values[] = { "albedo", "visibility", "normal", "depth", "motion" };
    for (int i = 0; i < 5; i++) check_radiance(&s, radiance[i], 1.0);
    check_radiance(&s, "irradiance", 1.0 / PI);
    for (int i = 0; i < 5; i++) {
        s.frame.camera.eye[0] += 0.05f;
        check_value_layer(&s, values[i]);
    }
    check_radiance(&s, "color", 1.0);
    fixture_close(&s);
}

// By the pass of composite, by that of other layers, and by antialiasing.
TEST(the_tone_curve_is_that_of_the_frame_options)
{
    static const char *const options[][2] = {
        { "tonemap=neutral", "tonemap=neutral,antialias=temporal" },
        { "tonemap=agx", "tonemap=agx,antialias=temporal" },
        { "tonemap=linear", "tonemap=linear,antialias=temporal" },
    };
    test_gpu_require();
    struct renderer_fixture s = open_all("ambient");
    for (int i = 0; i < 6; i++) {
        shown_curve = (enum ag_tonemap)(i / 2);
        assert_int_equal(ag_renderer_set_frame_options(s.renderer, options[i / 2][i % 2]), AG_OK);
        check_radiance(&s, "color", 1.0);
        check_radiance(&s, "direct", 1.0);
    }
    shown_curve = AG_TONEMAP_NEUTRAL;
    fixture_close(&s);
}

static bool is_color(struct renderer_fixture *s)
{
    struct ag_image *color = fixture_read(s, "color"), *display = fixture_read(s, "display");
    struct ag_image *expected = tone_mapped(s, color, 1.0);
    bool same = true;
    for (int i = 0; i < 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT; i++)
        same &= fabs(encoded(display->pixels[i]) - encoded(expected->pixels[i])) < 0.6 / 255.0;
    ag_image_destroy(s->context, color);
    ag_image_destroy(s->context, display);
    ag_image_destroy(s->context, expected);
    return same;
}

TEST(a_debug_view_is_shown_until_it_ends)
{
    test_gpu_require();
    struct renderer_fixture s = open_all("vct:resolution=32");
    const char *view, *help;
    int vct = 0;
    struct ag_technique_info info;
    while (ag_technique_get(vct, &info) && strcmp(info.name, "vct") != 0) vct++;
    CHECK(ag_technique_debug_view_get(vct, 0, &view, &help));
    show(&s, "debug");
    CHECK(is_color(&s));
    assert_int_equal(ag_renderer_set_debug_view(s.renderer, view), AG_OK);
    check_radiance(&s, "debug", 1.0);
    CHECK(!is_color(&s));
    assert_int_equal(ag_renderer_resize(s.renderer, FIXTURE_WIDTH, FIXTURE_HEIGHT), AG_OK);
    check_radiance(&s, "debug", 1.0);
    assert_int_equal(ag_renderer_set_gi(s.renderer, "none", NULL, 0), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    CHECK(is_color(&s));
    fixture_close(&s);
}

static uint64_t frame_bytes(struct renderer_fixture *s)
{
    struct ag_memory owners[64];
    const int count = ag_renderer_memory(s->renderer, owners, 64);
    for (int i = 0; i < count; i++)
        if (strcmp(owners[i].owner, "frame") == 0) return owners[i].bytes;
    return 0;
}

static int passes_named_display(struct renderer_fixture *s)
{
    struct ag_timing timings[64];
    int found = 0;
    const int count = ag_renderer_timings(s->renderer, timings, 64);
    for (int i = 0; i < count && i < 64; i++) found += strcmp(timings[i].name, "display") == 0;
    return found;
}

TEST(a_layer_that_nobody_writes_is_neutral_and_kept_while_shown)
{
    test_gpu_require();
    struct renderer_fixture s = fixture_open("none", NULL);
    show(&s, NULL);
    const uint64_t before = frame_bytes(&s);
    for (int again = 0; again < 2; again++) {
        check_value_layer(&s, "visibility");
        CHECK(frame_bytes(&s) > before && passes_named_display(&s) == 1);
        show(&s, "irradiance");
        struct ag_image *display = fixture_read(&s, "display");
        for (int i = 0; i < 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT; i++) CHECK(!display->pixels[i]);
        ag_image_destroy(s.context, display);
        show(&s, NULL);
        CHECK(is_color(&s) && frame_bytes(&s) == before && passes_named_display(&s) == 0);
    }
    fixture_close(&s);
}

TEST(what_cannot_be_shown_is_refused)
{
    test_gpu_require();
    struct renderer_fixture s = fixture_open("none", NULL);
    static const char *const names[] = { "position", "display", "colour" };
    for (int i = 0; i < 3; i++)
        assert_int_equal(ag_renderer_set_display(s.renderer, names[i]), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "did you mean color"));
    show(&s, "motion");
    show(&s, NULL);
    CHECK(is_color(&s));
    struct ag_renderer_desc desc = fixture_renderer_desc("none");
    desc.indirect_layer = false;
    ag_renderer_destroy(s.renderer);
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    assert_int_equal(ag_renderer_set_display(s.renderer, "indirect"), AG_ERROR_ARGUMENT);
    desc.display_layer = false;
    ag_renderer_destroy(s.renderer);
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    assert_int_equal(ag_renderer_set_display(s.renderer, "direct"), AG_ERROR_ARGUMENT);
    fixture_close(&s);
}
