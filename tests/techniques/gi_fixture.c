#include "techniques/gi_fixture.h"

#include "framework/test.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"
#include "techniques/kept_bake.h"

#include <string.h>

enum { MAX_KEPT = 4 };

// The newest bakes; freed by the end of the process.
static struct bake *kept[MAX_KEPT];
static int oldest;

static void lower(const struct technique *technique, void *options)
{
    for (size_t i = 0; i < technique->options.count; i++) {
        const struct option_row *row = &technique->options.rows[i];
        if (row->effect == REBAKE && row->type == OPTION_TYPE_int32)
            *(int32_t *)((char *)options + row->offset) = (int32_t)row->min;
    }
}

static void parse(struct gi_spec *spec, const char *text)
{
    if (!gi_spec_parse(spec, test_host(), text)) fail_msg("%s: %s", text, test_last_message());
}

void gi_fixture_parse(struct gi_spec *spec, const char *text)
{
    parse(spec, text);
    for (int i = 0; i < spec->count; i++)
        if (spec->technique[i]->bake_version != 0) lower(spec->technique[i], spec->options[i]);
}

static struct bake *bake_of(const struct technique *technique, const void *options,
                            const struct scene_pose *pose)
{
    const struct technique_bake how = { .pose = pose, .options = options };
    struct bake *bake =
        gi_bake_create(test_host(), technique, &how, (struct bake_identity){ .program = "test" });
    assert_non_null(bake);
    for (int i = 0; i < MAX_KEPT; i++) {
        if (kept[i] && bake_fits(kept[i], bake)) {
            bake_destroy(bake);
            return kept[i];
        }
    }
    CHECK(kept_bake_run(bake));
    bake_destroy(kept[oldest]);
    kept[oldest] = bake;
    oldest = (oldest + 1) % MAX_KEPT;
    return bake;
}

struct gi *gi_fixture_create(struct gpu *gpu, const struct gi_spec *spec,
                             const struct scene_pose *pose, uint32_t width, uint32_t height)
{
    struct gi_bakes bakes = { { NULL } };
    for (int i = 0; i < spec->count; i++)
        if (spec->technique[i]->bake_version != 0)
            bakes.of_term[i] = bake_tensors(bake_of(spec->technique[i], spec->options[i], pose));
    return gi_create_baked(test_host(), gpu, spec, &bakes, pose, width, height);
}

static struct gi *light(struct frame_fixture *s, struct gi_spec *spec, const char *text)
{
    struct gi *gi = gi_fixture_create(s->gpu, spec, &s->pose, s->width, s->height);
    if (!gi) fail_msg("%s: %s", text, test_last_message());
    gi_spec_finish(spec);
    s->indirect = gi_hook(gi);
    return gi;
}

struct gi *gi_fixture_light(struct frame_fixture *s, const char *text)
{
    struct gi_spec spec;
    parse(&spec, text);
    return light(s, &spec, text);
}

struct gi *gi_fixture_light_small(struct frame_fixture *s, const char *text)
{
    struct gi_spec spec;
    gi_fixture_parse(&spec, text);
    return light(s, &spec, text);
}
