// Ground-truth ambient occlusion (Jiménez et al. 2016), with visibility bitmasks (Therrien et al.
// 2023) as an option. README.md lists the differences.
#include "techniques/gtao/gtao.h"

#include "techniques/common/screen_ao.h"
#include "techniques/gtao/gtao_shared.h"

#include "technique_shaders.h"

#include <stddef.h>

struct gtao_options {
#define OPTION OPTION_FIELD
#include "techniques/gtao/gtao_options.def"
#undef OPTION
};

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct gtao_options, __VA_ARGS__)
#include "techniques/gtao/gtao_options.def"
#undef OPTION
};

struct gtao {
    struct gtao_options options;
    struct screen_ao ao;
    gpu_pipeline slices;
};

static struct screen_ao_options ao_options(const struct gtao_options *options)
{
    return (struct screen_ao_options){ .blur = options->blur,
                                       .half_resolution = options->half_resolution,
                                       .temporal = options->temporal };
}

_Static_assert(GTAO_CONSTANT_BITMASK == SCREEN_AO_CONSTANT_NEXT, "the next constant");

static void gtao_objects(const void *options, int view, uint32_t width, uint32_t height,
                         struct gpu_objects *out)
{
    const struct gtao_options *o = options;
    const struct screen_ao_options ao = ao_options(o);
    (void)view;
    screen_ao_objects(&ao, offsetof(struct gtao, ao), width, height, out);
    out->constants[GTAO_CONSTANT_BITMASK] =
        (struct gpu_constant){ GTAO_CONSTANT_BITMASK, o->bitmask };
    out->constants[GTAO_CONSTANT_FALLOFF] =
        (struct gpu_constant){ GTAO_CONSTANT_FALLOFF, o->falloff > 0.0f };
    GPU_ADD(
        out, 0,
        { GPU_PIPELINE, "slices", offsetof(struct gtao, slices), .shader = &shader_gtao_slices_comp,
          .consts = SCREEN_AO_STEP | 1u << GTAO_CONSTANT_BITMASK | 1u << GTAO_CONSTANT_FALLOFF });
}

static uint32_t gtao_more_needs(const void *options)
{
    return ((const struct gtao_options *)options)->temporal ? FRAME_NEEDS_MOTION : 0;
}

static void gtao_set_options(void *state, const void *options)
{
    (void)options;
    screen_ao_invalidate(&((struct gtao *)state)->ao);
}

static void gtao_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct gtao *gtao = state;
    const struct gtao_options *o = &gtao->options;
    const struct gtao_params params = {
        .slices = o->slices, .steps = o->steps, .falloff = o->falloff, .thickness_m = o->thickness
    };
    screen_ao_begin(&gtao->ao, ao_options(o), view, o->radius, o->reach);
    screen_ao_estimate(&gtao->ao, cmd, view, "slices", gtao->slices,
                       GPU_BIND(gpu_transient(cmd, "gtao_table", &params, sizeof params)));
    screen_ao_record(&gtao->ao, cmd, view);
}

const struct technique technique_gtao = {
    .name = "gtao",
    .title = "ground-truth ambient occlusion",
    .paper = "Jimenez et al. 2016, Practical Realtime Strategies for Accurate Indirect Occlusion; "
             "Therrien et al. 2023, Screen Space Indirect Lighting with Visibility Bitmask",
    .role = ROLE_VISIBILITY,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_WRITES_VISIBILITY,
    .more_needs = gtao_more_needs,
    .options = OPTION_TABLE(struct gtao_options, option_rows, NULL),
    .state_size = sizeof(struct gtao),
    .objects = gtao_objects,
    .set_options = gtao_set_options,
    .record = gtao_record,
};
