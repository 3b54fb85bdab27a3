#include "techniques/vo/vo_fixture.h"

#include "techniques/gi.h"
#include "techniques/vo/vo.h"

#include <stdio.h>
#include <stdlib.h>

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    technique_vo.record(user, cmd, view);
}

struct vo_fixture vo_fixture_create(struct frame_fixture *frame_fixture, const char *options)
{
    char text[128];
    struct gi_spec spec;
    snprintf(text, sizeof text, "vo:%s", options);
    if (!gi_spec_parse(&spec, test_host(), text)) fail_msg("%s: %s", text, test_last_message());
    struct vo_fixture fixture = { frame_fixture, calloc(1, technique_vo.state_size) };
    assert_non_null(fixture.vo);
    const struct technique_create how = { .host = test_host(),
                                          .gpu = frame_fixture->gpu,
                                          .pose = &frame_fixture->pose,
                                          .options = spec.options[1],
                                          .width = frame_fixture->width,
                                          .height = frame_fixture->height };
    CHECK(technique_create(&technique_vo, fixture.vo, &how));
    gi_spec_finish(&spec);
    frame_fixture->indirect = (struct frame_indirect){ .record = record,
                                                       .user = fixture.vo,
                                                       .needs = technique_vo.needs };
    return fixture;
}

void vo_fixture_destroy(struct vo_fixture *fixture)
{
    technique_destroy(&technique_vo, fixture->frame_fixture->gpu, fixture->vo,
                      &fixture->vo->options);
    free(fixture->vo);
    *fixture = (struct vo_fixture){ 0 };
}

float *vo_fixture_estimate(struct vo_fixture *fixture)
{
    fixture_render(fixture->frame_fixture);
    const struct screen_ao *ao = &fixture->vo->ao;
    const size_t pixels = (size_t)ao->params.work_width * ao->params.work_height;
    float *both = malloc(pixels * 2 * sizeof *both);
    CHECK(gpu_image_download_float(fixture->frame_fixture->gpu, ao->estimate, 0, 0, both, 2,
                                   2 * pixels));
    for (size_t i = 0; i < pixels; i++) both[i] = both[2 * i];
    return both;
}
