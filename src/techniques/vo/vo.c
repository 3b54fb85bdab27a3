// Volumetric obscurance (Loos 2015, ch. 6): the empty share of a sphere around each surface point,
// estimated from the depth buffer.
//
// The estimate has few samples per pixel, rotated per pixel; techniques/common/screen_ao.h filters
// the noise. README.md lists the differences from the paper.
#include "techniques/vo/vo.h"

#include "techniques/vo/vo_state.h"

#include <math.h>
#include <stddef.h>

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct vo_options, __VA_ARGS__)
#include "techniques/vo/vo_options.def"
#undef OPTION
};

static const struct option_alias aliases[] = { { "half", "half_resolution" }, { NULL, NULL } };

// Chosen by measured error and time, see docs/notes/vo.md.
static const struct technique_preset presets[] = { { "low", "half_resolution=true" },
                                                   { "medium", "" },
                                                   { "high", "samples=9,temporal=true" },
                                                   { NULL, NULL } };

static struct screen_ao_options ao_options(const struct vo_options *options)
{
    return (struct screen_ao_options){ .blur = options->blur,
                                       .half_resolution = options->half_resolution,
                                       .temporal = options->temporal };
}

static void vo_objects(const void *options, int view, uint32_t width, uint32_t height,
                       struct gpu_objects *out)
{
    const struct screen_ao_options ao = ao_options(options);
    (void)view;
    screen_ao_objects(&ao, offsetof(struct vo, ao), width, height, out);
    vo_pyramid_objects(options, width, height, out);
    vo_estimate_objects(options, out);
}

static void vo_set_options(void *state, const void *options)
{
    (void)options;
    screen_ao_invalidate(&((struct vo *)state)->ao);
}

static void vo_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct vo *vo = state;
    const float radius_m = fmaxf(vo->options.radius, vo->options.radius2);
    screen_ao_begin(&vo->ao, ao_options(&vo->options), view, radius_m, vo->options.reach);
    if (vo->options.mode == VO_MODE_AREAS) vo_record_pyramid(vo, cmd, view);
    vo_record_estimate(vo, cmd, view);
    screen_ao_record(&vo->ao, cmd, view);
}

static uint32_t vo_more_needs(const void *options)
{
    return ((const struct vo_options *)options)->temporal ? FRAME_NEEDS_MOTION : 0;
}

const struct technique technique_vo = {
    .name = "vo",
    .title = "volumetric obscurance",
    .paper =
        "Loos 2015, Modular Radiance Transfer, ch. 6; Loos & Sloan 2010, Volumetric Obscurance",
    .role = ROLE_VISIBILITY,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_WRITES_VISIBILITY,
    .more_needs = vo_more_needs,
    .options = OPTION_TABLE(struct vo_options, option_rows, aliases),
    .presets = presets,
    .state_size = sizeof(struct vo),
    .objects = vo_objects,
    .set_options = vo_set_options,
    .record = vo_record,
};
