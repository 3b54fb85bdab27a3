// The samples as the shaders take them, and the estimate.
#include "techniques/vo/vo_state.h"

#include "technique_shaders.h"

#include <math.h>

_Static_assert(SAMPLE_SET_MOST == VO_MOST_SAMPLES, "every set fits into the table");

static const struct way {
    const char *name;
    const struct gpu_shader *shader;
} ways[] = {
    [VO_MODE_LINES] = { "lines", &shader_vo_lines_comp },
    [VO_MODE_AREAS] = { "areas", &shader_vo_areas_comp },
    [VO_MODE_POINTS] = { "points", &shader_vo_points_comp },
};

// An area alone stands for the whole disk, wherever a line alone would be.
static const struct sample whole_disk = { .z = 1.0f, .weight = 1.0f, .share = 1.0f };
static const struct sample_set one_area = { .count = 1, .samples = &whole_disk };

static const struct sample_set *set_of(const struct vo_options *options)
{
    const bool points = options->mode == VO_MODE_POINTS;
    const struct sample_set *set =
        sample_set_at(points ? SAMPLE_BALL : SAMPLE_DISK, options->samples);
    return options->mode == VO_MODE_AREAS && set->count == 1 ? &one_area : set;
}

// At the centre the surface is where it is looked at from: such a sample needs no look, unless it
// stands for more.
static bool needs_no_look(const struct sample *s, int mode)
{
    return mode != VO_MODE_AREAS && s->x == 0.0f && s->y == 0.0f &&
           (mode != VO_MODE_POINTS || s->z == 0.0f);
}

// Of half the side of the square that is as large as the sample's share of the disk: the patterns
// move texels over it.
static float level_of(const struct sample *s)
{
    return 0.5f * log2f(GLM_PIf * s->share) - 1.0f;
}

// The looks of a set but its centre are pairs of opposite ones, first and second by turns: of lines
// the shader takes both from the first, with the weight that they have in the mean (the tables'
// come from cells of a grid).
static void even_out_pairs(struct vo_samples *table, int looks)
{
    for (int i = 0; i + 1 < looks; i += 2)
        table->at[i].w = table->at[i + 1].w = 0.5f * (table->at[i].w + table->at[i + 1].w);
}

// Returns how many samples need a look.
static int fill_table(const struct vo_options *options, struct vo_samples *table)
{
    const struct sample_set *set = set_of(options);
    table->radii_m = (vec2s){ { options->radius, options->radius2 } };
    table->thickness = options->thickness;
    table->centre = 0.0f;
    int looks = 0;
    for (int i = 0; i < set->count; i++) {
        const struct sample *s = &set->samples[i];
        if (needs_no_look(s, options->mode)) {
            table->centre = s->weight;
            continue;
        }
        const float weight =
            options->mode == VO_MODE_POINTS ? s->weight : s->weight / (2.0f * s->z);
        table->at[looks] = (vec4s){ { s->x, s->y, s->z, weight } };
        table->levels[looks++] = level_of(s);
    }
    if (options->mode == VO_MODE_LINES) even_out_pairs(table, looks);
    return looks;
}

bool vo_create_estimate(struct vo *vo)
{
    const struct gpu_constant constants[] = {
        screen_ao_step(&vo->ao),
        { VO_CONSTANT_COUNT, (uint32_t)fill_table(&vo->options, &vo->table) },
        { VO_CONSTANT_NORMAL, vo->options.normal },
        { VO_CONSTANT_TWO_RADII, vo->options.radius2 > 0.0f },
    };
    const struct way *way = &ways[vo->options.mode];
    return gpu_compute_pipeline_create(vo->gpu, way->name, way->shader, constants,
                                       sizeof constants / sizeof constants[0], &vo->estimate);
}

void vo_record_estimate(struct vo *vo, struct gpu_cmd *cmd, const struct frame_view *view)
{
    fill_table(&vo->options, &vo->table);
    const struct way *way = &ways[vo->options.mode];
    const bool areas = vo->options.mode == VO_MODE_AREAS;
    screen_ao_estimate(
        &vo->ao, cmd, view, way->name, vo->estimate,
        GPU_BIND(gpu_transient(cmd, "vo_table", &vo->table, sizeof vo->table),
                 { .name = "moments", .image = areas ? vo->moments : view->layers[FRAME_DEPTH] }));
}
