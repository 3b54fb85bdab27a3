// Options that change while a renderer runs: the next frame equals that of a renderer created with
// them.
#include "api/renderer_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Techniques without a row have the defaults: small volumes, and options under which more live
// options have an effect.
static const struct {
    const char *technique, *options;
    int frames; // before each change, besides that of the last change
} bases[] = {
    { "lpv", ":dim=16,cascades=2", 0 },
    { "lpv", ":dim=16,cascades=1,closure=linear", 0 },
    { "holpv", ":dim=16,cascades=1", 0 },
    { "holpv", ":dim=8,cascades=1,closure=linear", 0 },
    { "vct", ":resolution=32", 0 },
    { "vct", ":resolution=32,temporal=true,specular=true", 0 },
    { "vctao", ":resolution=32", 0 },
    { "vctao", ":resolution=32,temporal=true", 0 },
    { "mrt", "", 0 },
    { "mrt", ",solver=cpu", 3 }, // the CPU's light has arrived
    { "mrt", ",probes=true", 0 },
    { "ort", "", 0 },
    { "ort", ",order=slices,parts=3,precision=byte", 0 },
};

// Options after which the next frame still has light of earlier frames. Tolerances are relative to
// the mean.
static const struct {
    const char *technique, *option;
    double tolerance;
} exceptions[] = {
    // By definition: the irradiance of the last frame is the light of further bounces.
    { "mrt", "feedback", 3e-3 },
    { "drt", "feedback", 2e-3 },
};

static double tolerance_of(const char *technique, const char *option)
{
    for (size_t i = 0; i < sizeof exceptions / sizeof *exceptions; i++)
        if (strcmp(exceptions[i].technique, technique) == 0 &&
            strcmp(exceptions[i].option, option) == 0)
            return exceptions[i].tolerance;
    return 0.0;
}

// Another value than the default.
static void print_other(const struct ag_option_info *o, char *out, size_t size)
{
    const bool lower = o->initial > o->min;
    if (strcmp(o->type, "bool") == 0) {
        snprintf(out, size, "%s", o->initial != 0.0 ? "false" : "true");
    } else if (strcmp(o->type, "choice") == 0) {
        const char *name = o->unit;
        for (int i = lower ? (int)o->initial - 1 : 1; i > 0; i--) name = strchr(name, '|') + 1;
        snprintf(out, size, "%.*s", (int)strcspn(name, "|"), name);
    } else if (strcmp(o->type, "int") == 0) {
        snprintf(out, size, "%d", (int)(lower ? (o->initial + o->min) / 2 : o->initial + 1));
    } else {
        const double step = fmin(1.0, (o->max - o->initial) / 2);
        snprintf(out, size, "%g", lower ? (o->initial + o->min) / 2 : o->initial + step);
    }
}

struct bakes {
    const struct ag_bake *list[1];
    int count;
};

// The newest frame of the fixture's renderer equals the first frame of a new one.
static void check_fresh(struct renderer_fixture *s, const struct ag_renderer_desc *desc,
                        double tolerance)
{
    static const char *const layers[] = { "indirect", "color" };
    struct ag_renderer *fresh = NULL;
    if (ag_renderer_create(s->device, s->scene, desc, &fresh) != AG_OK)
        fail_msg("%s: %s", desc->gi, ag_context_last_error(s->context));
    assert_int_equal(ag_renderer_render(fresh, &s->frame), AG_OK);
    for (int i = 0; i < 2; i++) {
        struct ag_image *a = fixture_read(s, layers[i]),
                        *b = fixture_read_from(s, fresh, layers[i]);
        const double got = fixture_difference(a, b);
        if (!(got <= tolerance))
            fail_msg("%s, frame options %s: %s differs by %g", desc->gi, desc->frame_options,
                     layers[i], got);
        ag_image_destroy(s->context, a);
        ag_image_destroy(s->context, b);
    }
    ag_renderer_destroy(fresh);
}

static void render(struct renderer_fixture *s, int frames)
{
    for (int i = 0; i < frames; i++)
        assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
}

static void set_gi(struct renderer_fixture *s, const char *gi, const struct bakes *bakes)
{
    if (ag_renderer_set_gi(s->renderer, gi, bakes->list, bakes->count) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
}

static void check_live(struct renderer_fixture *s, const char *gi, const struct bakes *bakes,
                       double tolerance)
{
    struct ag_device_counters before, after;
    ag_device_get_counters(s->device, &before);
    set_gi(s, gi, bakes);
    render(s, 1);
    ag_device_get_counters(s->device, &after);
    if (after.images != before.images || after.pipelines != before.pipelines ||
        after.buffers != before.buffers || after.transfers != before.transfers)
        fail_msg("%s creates objects", gi);
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.bakes = bakes->list;
    desc.bake_count = bakes->count;
    check_fresh(s, &desc, tolerance);
}

// Every live option of a technique in turn; the one before gets its default back.
static void check_technique(struct renderer_fixture *s, int technique,
                            const struct ag_technique_info *info, const char *base, int frames,
                            const struct bakes *bakes)
{
    struct ag_renderer_desc desc = fixture_renderer_desc(base);
    desc.bakes = bakes->list;
    desc.bake_count = bakes->count;
    if (ag_renderer_create(s->device, s->scene, &desc, &s->renderer) != AG_OK)
        fail_msg("%s: %s", base, ag_context_last_error(s->context));
    render(s, 2);
    struct ag_option_info option;
    for (int k = 0; ag_technique_option_get(technique, k, &option); k++) {
        char text[3 * FIXTURE_SPEC], value[64];
        const bool live =
            strcmp(option.effect, "live") == 0 || strcmp(option.effect, "invalidate") == 0;
        if (!live) continue;
        print_other(&option, value, sizeof value);
        const char *separator = strchr(base, ':') ? "," : ":";
        snprintf(text, sizeof text, "%s%s%s=%s", base, separator, option.name, value);
        render(s, frames);
        check_live(s, text, bakes, tolerance_of(info->name, option.name));
    }
    ag_renderer_destroy(s->renderer);
    s->renderer = NULL;
}

TEST(a_live_option_creates_nothing_and_the_next_frame_equals_a_new_renderers)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        char base[FIXTURE_SPEC];
        fixture_print_base(i, &info, base);
        struct ag_bake *bake = fixture_bake(&s, base, &info);
        const struct bakes bakes = { { bake }, bake != NULL };
        int checked = 0;
        for (size_t b = 0; b < sizeof bases / sizeof *bases; b++) {
            char longer[2 * FIXTURE_SPEC];
            if (strcmp(bases[b].technique, info.name) != 0) continue;
            snprintf(longer, sizeof longer, "%s%s", base, bases[b].options);
            check_technique(&s, i, &info, longer, bases[b].frames, &bakes);
            checked++;
        }
        for (int k = 0; !checked && fixture_print_variant(i, &info, k, base); k++)
            check_technique(&s, i, &info, base, 0, &bakes);
        ag_bake_destroy(bake);
    }
    fixture_close(&s);
}

TEST(after_other_changes_the_next_frame_equals_a_new_renderers)
{
    static const char *const steps[] = { "none",
                                         "lpv",
                                         "lpv:dim=16",
                                         "lpv:dim=16,cascades=2+vo:temporal=true",
                                         "vct:temporal=true",
                                         "vct:temporal=true,resolution=32+vo",
                                         "ambient+vo",
                                         "none+vctao",
                                         "lpv" };
    struct renderer_fixture s = fixture_open_lit("lpv");
    const struct bakes no_bakes = { .count = 0 };
    render(&s, 2);
    struct ag_memory before[64], after[64];
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const int owners = ag_renderer_memory(s.renderer, before, 64);
        set_gi(&s, steps[i], &no_bakes);
        CHECK(strncmp(ag_renderer_gi(s.renderer), steps[i], 3) == 0);
        render(&s, 1);
        const int now = ag_renderer_memory(s.renderer, after, 64);
        for (int a = 0; a < owners; a++)
            for (int b = 0; b < now; b++)
                if (strcmp(before[a].owner, "scene") == 0 && strcmp(after[b].owner, "scene") == 0)
                    CHECK(before[a].bytes == after[b].bytes);
        struct ag_renderer_desc desc = fixture_renderer_desc(steps[i]);
        check_fresh(&s, &desc, 0.0);
        render(&s, 1);
    }
    fixture_close(&s);
}

TEST(a_technique_beside_another_keeps_its_light)
{
    struct renderer_fixture s = fixture_open_lit("vct:temporal=false");
    const struct bakes no_bakes = { .count = 0 };
    render(&s, 6);
    struct ag_device_counters before, after;
    ag_device_get_counters(s.device, &before);
    struct ag_image *expected = fixture_read(&s, "irradiance");
    set_gi(&s, "vct:temporal=false+hbao", &no_bakes);
    render(&s, 1);
    ag_device_get_counters(s.device, &after);
    struct ag_image *got = fixture_read(&s, "irradiance");
    CHECK(fixture_difference(got, expected) <
          1e-3);                              // vct alone is not converged in its first frame
    CHECK(after.images - before.images <= 4); // visibility, and what hbao has
    ag_image_destroy(s.context, got);
    ag_image_destroy(s.context, expected);
    fixture_close(&s);
}

TEST(frame_options_change_and_the_next_frame_equals_a_new_renderers)
{
    static const char *const steps[] = {
        "shadow_size=256,rsm_size=32",
        "shadow_size=512,rsm_size=32",
        "shadow_size=512,rsm_size=32,cascades=4",
        "shadow_size=256,shadow_filter=2,rsm_size=64",
        "shadow_size=256,cascade_blend=0.1,rsm_size=64,keep_maps=false",
        "shadow_size=256,rsm_size=64"
    };
    static const char *const techniques[] = { "lpv:dim=16", "vct:resolution=32", "ambient" };
    for (size_t t = 0; t < sizeof techniques / sizeof *techniques; t++) {
        struct renderer_fixture s = fixture_open_lit(techniques[t]);
        render(&s, 2);
        struct ag_device_counters before, after;
        for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
            assert_int_equal(ag_renderer_set_frame_options(s.renderer, steps[i]), AG_OK);
            render(&s, 1);
            struct ag_renderer_desc desc = fixture_renderer_desc(techniques[t]);
            desc.frame_options = steps[i];
            check_fresh(&s, &desc, 0.0);
        }
        ag_device_get_counters(s.device, &before);
        assert_int_equal(ag_renderer_set_frame_options(s.renderer, steps[5]), AG_OK); // the same
        assert_int_equal(ag_renderer_set_frame_options(s.renderer, "cascades=9"),
                         AG_ERROR_ARGUMENT);
        render(&s, 1);
        ag_device_get_counters(s.device, &after);
        CHECK(after.images == before.images && after.pipelines == before.pipelines);
        fixture_close(&s);
    }
}

TEST(a_refused_spec_changes_nothing)
{
    struct renderer_fixture s = fixture_open_lit("lpv");
    render(&s, 1);
    char text[FIXTURE_SPEC];
    snprintf(text, sizeof text, "%.500s", ag_renderer_gi(s.renderer));
    static const char *const refused[] = { "lpv:stepz=2", "no-such", "lpv:dim=9", "mrt",
                                           "lpv+vo:samples=99999" };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        CHECK(ag_renderer_set_gi(s.renderer, refused[i], NULL, 0) != AG_OK);
        CHECK(strncmp(ag_renderer_gi(s.renderer), text, strlen(text)) == 0);
    }
    assert_int_equal(ag_renderer_set_gi(s.renderer, NULL, NULL, 0), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_set_gi(s.renderer, "lpv", NULL, 1), AG_ERROR_ARGUMENT);
    render(&s, 1);
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv");
    check_fresh(&s, &desc, 0.0);
    fixture_close(&s);
}

TEST(a_debug_view_stays_with_its_technique)
{
    struct renderer_fixture s = fixture_open_lit("lpv");
    const struct bakes no_bakes = { .count = 0 };
    struct ag_image *image = NULL;
    assert_int_equal(ag_renderer_set_debug_view(s.renderer, "lpv.injected"), AG_OK);
    render(&s, 1);
    set_gi(&s, "lpv:dim=16+vo", &no_bakes);
    render(&s, 1);
    image = fixture_read(&s, "debug");
    ag_image_destroy(s.context, image);
    set_gi(&s, "ambient", &no_bakes);
    render(&s, 1);
    assert_int_equal(ag_renderer_read(s.renderer, "debug", &image), AG_ERROR_ARGUMENT);
    fixture_close(&s);
}
