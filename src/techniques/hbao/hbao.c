// Horizon-based ambient occlusion (Bavoil & Sainz 2008), a baseline for vo. README.md lists the
// differences.
#include "techniques/hbao/hbao.h"

#include "techniques/common/screen_ao.h"
#include "techniques/hbao/hbao_shared.h"

#include "technique_shaders.h"

#include <math.h>
#include <stddef.h>

enum hbao_falloff { HBAO_FALLOFF_CUBIC, HBAO_FALLOFF_QUADRATIC };

struct hbao_options {
#define OPTION OPTION_FIELD
#include "techniques/hbao/hbao_options.def"
#undef OPTION
};

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct hbao_options, __VA_ARGS__)
#include "techniques/hbao/hbao_options.def"
#undef OPTION
};

static const struct option_alias aliases[] = { { "half", "half_resolution" }, { NULL, NULL } };

struct hbao {
    struct hbao_options options;
    struct screen_ao ao;
    gpu_pipeline horizons;
};

static struct screen_ao_options ao_options(const struct hbao_options *options)
{
    return (struct screen_ao_options){ .blur = options->blur,
                                       .half_resolution = options->half_resolution };
}

static void hbao_objects(const void *options, int view, uint32_t width, uint32_t height,
                         struct gpu_objects *out)
{
    const struct screen_ao_options ao = ao_options(options);
    (void)view;
    screen_ao_objects(&ao, offsetof(struct hbao, ao), width, height, out);
    GPU_ADD(out, 0,
            { GPU_PIPELINE, "horizons", offsetof(struct hbao, horizons),
              .shader = &shader_hbao_horizons_comp, .consts = SCREEN_AO_STEP });
}

static struct hbao_params params_of(const struct hbao_options *options)
{
    return (struct hbao_params){ .directions = options->directions,
                                 .steps = options->steps,
                                 .bias = tanf(options->bias * GLM_PIf / 180.0f),
                                 .quadratic = options->falloff == HBAO_FALLOFF_QUADRATIC };
}

static void hbao_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct hbao *hbao = state;
    screen_ao_begin(&hbao->ao, ao_options(&hbao->options), view, hbao->options.radius,
                    hbao->options.reach);
    const struct hbao_params params = params_of(&hbao->options);
    screen_ao_estimate(&hbao->ao, cmd, view, "horizons", hbao->horizons,
                       GPU_BIND(gpu_transient(cmd, "hbao_table", &params, sizeof params)));
    screen_ao_record(&hbao->ao, cmd, view);
}

const struct technique technique_hbao = {
    .name = "hbao",
    .title = "horizon-based ambient occlusion",
    .paper = "Bavoil & Sainz 2008, Image-Space Horizon-Based Ambient Occlusion",
    .role = ROLE_VISIBILITY,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_WRITES_VISIBILITY,
    .options = OPTION_TABLE(struct hbao_options, option_rows, aliases),
    .state_size = sizeof(struct hbao),
    .objects = hbao_objects,
    .record = hbao_record,
};
