#include "techniques/vo_rig.h"

#include "techniques/gi.h"
#include "techniques/vo/vo.h"

#include <stdio.h>
#include <stdlib.h>

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    technique_vo.record(user, cmd, view);
}

struct vo_rig vo_rig_create(struct studio *studio, const char *options)
{
    char text[128];
    struct gi_spec spec;
    snprintf(text, sizeof text, "vo:%s", options);
    if (!gi_spec_parse(&spec, test_host(), text)) fail_msg("%s: %s", text, test_last_message());
    struct vo_rig rig = { studio, calloc(1, technique_vo.state_size) };
    assert_non_null(rig.vo);
    const struct technique_create how = { .host = test_host(),
                                          .gpu = studio->gpu,
                                          .pose = &studio->pose,
                                          .options = spec.options[1],
                                          .width = studio->width,
                                          .height = studio->height };
    CHECK(technique_vo.create(rig.vo, &how));
    gi_spec_finish(&spec);
    studio->indirect = (struct frame_indirect){ record, rig.vo, technique_vo.needs };
    return rig;
}

void vo_rig_destroy(struct vo_rig *rig)
{
    technique_vo.destroy(rig->vo);
    free(rig->vo);
    *rig = (struct vo_rig){ 0 };
}

float *vo_rig_estimate(struct vo_rig *rig)
{
    studio_render(rig->studio);
    const struct screen_ao *ao = &rig->vo->ao;
    const size_t pixels = (size_t)ao->work_width * ao->work_height;
    float *both = malloc(pixels * 2 * sizeof *both);
    CHECK(gpu_image_download_float(rig->studio->gpu, ao->estimate, 0, 0, both, 2, 2 * pixels));
    for (size_t i = 0; i < pixels; i++) both[i] = both[2 * i];
    return both;
}
