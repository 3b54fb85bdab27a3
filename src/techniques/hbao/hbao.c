// Horizon-based ambient occlusion (Bavoil & Sainz 2008), a baseline for vo. README.md lists the
// differences.
#include "techniques/hbao/hbao.h"

#include "techniques/common/screen_ao.h"
#include "techniques/hbao/hbao_shared.h"

#include "technique_shaders.h"

#include <math.h>

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
    struct gpu *gpu;
    struct hbao_options options;
    struct screen_ao ao;
    gpu_pipeline horizons;
};

static struct screen_ao_options ao_options(const struct hbao_options *options)
{
    return (struct screen_ao_options){ .blur = options->blur,
                                       .half_resolution = options->half_resolution };
}

static bool hbao_create(void *state, const struct technique_create *how)
{
    struct hbao *hbao = state;
    hbao->gpu = how->gpu;
    hbao->options = *(const struct hbao_options *)how->options;
    const struct screen_ao_options options = ao_options(&hbao->options);
    if (!screen_ao_init(&hbao->ao, how->gpu, &options, how->width, how->height)) return false;
    const struct gpu_constant step = screen_ao_step(&hbao->ao);
    return gpu_compute_pipeline_create(hbao->gpu, "horizons", &shader_hbao_horizons_comp, &step, 1,
                                       &hbao->horizons);
}

static bool hbao_resize(void *state, int view, uint32_t width, uint32_t height)
{
    (void)view;
    return screen_ao_resize(&((struct hbao *)state)->ao, width, height);
}

static void hbao_set_options(void *state, const void *options)
{
    ((struct hbao *)state)->options = *(const struct hbao_options *)options;
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
    screen_ao_begin(&hbao->ao, view, hbao->options.radius, hbao->options.reach);
    const struct hbao_params params = params_of(&hbao->options);
    screen_ao_estimate(&hbao->ao, cmd, view, "horizons", hbao->horizons,
                       GPU_BIND(gpu_transient(cmd, "hbao_table", &params, sizeof params)));
    screen_ao_record(&hbao->ao, cmd, view);
}

static void hbao_destroy(void *state)
{
    struct hbao *hbao = state;
    if (!hbao->gpu) return;
    screen_ao_finish(&hbao->ao);
    gpu_pipeline_destroy(hbao->gpu, &hbao->horizons);
}

static uint64_t hbao_memory_estimate(const void *options, uint32_t width, uint32_t height)
{
    const struct screen_ao_options ao = ao_options(options);
    return screen_ao_memory(&ao, width, height);
}

static uint64_t hbao_view_memory(const void *options, uint32_t width, uint32_t height)
{
    const struct screen_ao_options ao = ao_options(options);
    return screen_ao_history_memory(&ao, width, height);
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
    .create = hbao_create,
    .resize = hbao_resize,
    .set_options = hbao_set_options,
    .record = hbao_record,
    .destroy = hbao_destroy,
    .memory_estimate = hbao_memory_estimate,
    .view_memory = hbao_view_memory,
};
