// Screen-space ambient occlusion with points in a sphere (Mittring 2007), a baseline for vo.
// README.md lists the differences.
#include "techniques/ssao/ssao.h"

#include "techniques/common/sample_sets.h"
#include "techniques/common/screen_ao.h"
#include "techniques/ssao/ssao_shared.h"

#include "technique_shaders.h"

#include <stddef.h>

_Static_assert(SAMPLE_SET_MOST == SSAO_MOST_SAMPLES, "every set fits into the table");

struct ssao_options {
#define OPTION OPTION_FIELD
#include "techniques/ssao/ssao_options.def"
#undef OPTION
};

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct ssao_options, __VA_ARGS__)
#include "techniques/ssao/ssao_options.def"
#undef OPTION
};

static const struct option_alias aliases[] = { { "half", "half_resolution" }, { NULL, NULL } };

struct ssao {
    struct ssao_options options;
    struct screen_ao ao;
    gpu_pipeline points;
    struct ssao_samples table;
};

static struct screen_ao_options ao_options(const struct ssao_options *options)
{
    return (struct screen_ao_options){ .blur = options->blur,
                                       .half_resolution = options->half_resolution };
}

static int fill_table(const struct ssao_options *options, struct ssao_samples *table)
{
    const struct sample_set *set = sample_set_at(SAMPLE_BALL, options->samples);
    *table = (struct ssao_samples){ .range = options->range };
    for (int i = 0; i < set->count; i++) {
        const struct sample *s = &set->samples[i];
        table->at[i] = (vec4s){ { s->x, s->y, s->z, s->weight } };
    }
    return set->count;
}

static void ssao_objects(const void *options, int view, uint32_t width, uint32_t height,
                         struct gpu_objects *out)
{
    const struct ssao_options *o = options;
    const struct screen_ao_options ao = ao_options(o);
    const uint32_t samples = (uint32_t)sample_set_at(SAMPLE_BALL, o->samples)->count;
    (void)view;
    out->constants[SSAO_CONSTANT_COUNT] = (struct gpu_constant){ SSAO_CONSTANT_COUNT, samples };
    out->constants[SSAO_CONSTANT_NORMAL] = (struct gpu_constant){ SSAO_CONSTANT_NORMAL, o->normal };
    screen_ao_objects(&ao, offsetof(struct ssao, ao), width, height, out);
    GPU_ADD(out, 0,
            { GPU_PIPELINE, "points", offsetof(struct ssao, points),
              .shader = &shader_ssao_points_comp,
              .consts = SCREEN_AO_STEP | 1u << SSAO_CONSTANT_COUNT | 1u << SSAO_CONSTANT_NORMAL });
}

static void ssao_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct ssao *ssao = state;
    screen_ao_begin(&ssao->ao, ao_options(&ssao->options), view, ssao->options.radius,
                    ssao->options.reach);
    fill_table(&ssao->options, &ssao->table);
    screen_ao_estimate(
        &ssao->ao, cmd, view, "points", ssao->points,
        GPU_BIND(gpu_transient(cmd, "ssao_table", &ssao->table, sizeof ssao->table)));
    screen_ao_record(&ssao->ao, cmd, view);
}

const struct technique technique_ssao = {
    .name = "ssao",
    .title = "screen-space ambient occlusion, points in a sphere",
    .paper = "Mittring 2007, Finding Next Gen: CryEngine 2; Filion & McNaughton 2008, Effects & "
             "Techniques (StarCraft II)",
    .role = ROLE_VISIBILITY,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_WRITES_VISIBILITY,
    .options = OPTION_TABLE(struct ssao_options, option_rows, aliases),
    .state_size = sizeof(struct ssao),
    .objects = ssao_objects,
    .record = ssao_record,
};
