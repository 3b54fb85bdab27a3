// The shaders' sample tables, and the pass of the estimate.
#include "techniques/vo/vo_state.h"

#include "technique_shaders.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

_Static_assert(SAMPLE_SET_MOST == VO_MOST_SAMPLES, "every set fits into the table");

static const struct estimator {
    const char *name;
    const struct gpu_shader *shader;
} estimators[] = {
    [VO_MODE_LINES] = { "lines", &shader_vo_lines_comp },
    [VO_MODE_AREAS] = { "areas", &shader_vo_areas_comp },
    [VO_MODE_POINTS] = { "points", &shader_vo_points_comp },
};

// A single area sample covers the whole disk; its position is the center, unlike a single line's.
static const struct sample whole_disk = { .z = 1.0f, .weight = 1.0f, .share = 1.0f };
static const struct sample_set one_area = { .count = 1, .samples = &whole_disk };

static const struct sample_set *set_of(const struct vo_options *options)
{
    const bool points = options->mode == VO_MODE_POINTS;
    const struct sample_set *set =
        sample_set_at(points ? SAMPLE_BALL : SAMPLE_DISK, options->samples);
    return options->mode == VO_MODE_AREAS && set->count == 1 ? &one_area : set;
}

// The visibility of a sample at the center is known without a fetch, except for areas.
static bool is_center(const struct sample *s, int mode)
{
    return mode != VO_MODE_AREAS && s->x == 0.0f && s->y == 0.0f &&
           (mode != VO_MODE_POINTS || s->z == 0.0f);
}

// Level of half the side of the square with the sample's area; the patterns jitter texels over it.
static float level_of(const struct sample *s)
{
    return 0.5f * log2f(GLM_PIf * s->share) - 1.0f;
}

// Opposite samples are adjacent. Lines share one weight per pair, the mean of both: the tables'
// weights come from cells of a grid and differ slightly.
static void average_pairs(struct vo_samples *table, int fetched)
{
    for (int i = 0; i + 1 < fetched; i += 2)
        table->at[i].w = table->at[i + 1].w = 0.5f * (table->at[i].w + table->at[i + 1].w);
}

// Returns the number of samples that need a fetch.
static int fill_table(const struct vo_options *options, struct vo_samples *table)
{
    const struct sample_set *set = set_of(options);
    table->radii_m = (vec2s){ { options->radius, options->radius2 } };
    table->thickness = options->thickness;
    table->center = 0.0f;
    int fetched = 0;
    for (int i = 0; i < set->count; i++) {
        const struct sample *s = &set->samples[i];
        if (is_center(s, options->mode)) {
            table->center = s->weight;
            continue;
        }
        const float weight =
            options->mode == VO_MODE_POINTS ? s->weight : s->weight / (2.0f * s->z);
        table->at[fetched] = (vec4s){ { s->x, s->y, s->z, weight } };
        table->levels[fetched++] = level_of(s);
    }
    if (options->mode == VO_MODE_LINES) average_pairs(table, fetched);
    return fetched;
}

void vo_estimate_objects(const struct vo_options *options, struct gpu_objects *out)
{
    struct vo_samples table;
    const struct gpu_constant constants[] = {
        { VO_CONSTANT_COUNT, (uint32_t)fill_table(options, &table) },
        { VO_CONSTANT_NORMAL, options->normal },
        { VO_CONSTANT_TWO_RADII, options->radius2 > 0.0f },
    };
    const struct estimator *estimator = &estimators[options->mode];
    memcpy(out->constants + VO_CONSTANT_COUNT, constants, sizeof constants);
    GPU_ADD(out, 0,
            { GPU_PIPELINE, estimator->name, offsetof(struct vo, estimate),
              .shader = estimator->shader, .consts = SCREEN_AO_STEP | 7u << VO_CONSTANT_COUNT });
}

void vo_record_estimate(struct vo *vo, struct gpu_cmd *cmd, const struct frame_view *view)
{
    fill_table(&vo->options, &vo->table);
    const struct estimator *estimator = &estimators[vo->options.mode];
    const bool areas = vo->options.mode == VO_MODE_AREAS;
    screen_ao_estimate(
        &vo->ao, cmd, view, estimator->name, vo->estimate,
        GPU_BIND(gpu_transient(cmd, "vo_table", &vo->table, sizeof vo->table),
                 { .name = "moments", .image = areas ? vo->moments : view->layers[FRAME_DEPTH] }));
}
