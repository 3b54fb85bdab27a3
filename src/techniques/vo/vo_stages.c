// The samples as the shaders take them, and the estimate.
#include "techniques/vo/vo_state.h"

#include "technique_shaders.h"

enum { LOCAL = 8 }; // of all shaders, in x and y

_Static_assert(SAMPLE_SET_MOST == VO_MOST_SAMPLES, "every set fits into the table");

static const struct sample_set *set_of(const struct vo_options *options)
{
    const bool points = options->mode == VO_MODE_POINTS;
    return sample_set_at(points ? SAMPLE_BALL : SAMPLE_DISK, options->samples);
}

// At the centre the surface is where it is looked at from: such a sample needs no look.
static bool is_central(const struct sample *s, bool points)
{
    return s->x == 0.0f && s->y == 0.0f && (!points || s->z == 0.0f);
}

// Returns how many samples need a look.
static int fill_table(const struct vo_options *options, struct vo_samples *table)
{
    const struct sample_set *set = set_of(options);
    const bool points = options->mode == VO_MODE_POINTS;
    *table = (struct vo_samples){ .radii_m = { { options->radius, options->radius2 } },
                                  .thickness = options->thickness };
    int looks = 0;
    for (int i = 0; i < set->count; i++) {
        const struct sample *s = &set->samples[i];
        const float weight = points ? s->weight : s->weight / (2.0f * s->z);
        if (is_central(s, points))
            table->centre = s->weight;
        else
            table->at[looks++] = (vec4s){ { s->x, s->y, s->z, weight } };
    }
    return looks;
}

const char *vo_estimate_name(const struct vo_options *options)
{
    return options->mode == VO_MODE_POINTS ? "vo.points" : "vo.lines";
}

bool vo_create_estimate(struct vo *vo)
{
    const bool points = vo->options.mode == VO_MODE_POINTS;
    const struct gpu_shader *shader = points ? &shader_vo_points_comp : &shader_vo_lines_comp;
    const struct gpu_constant constants[] = {
        screen_ao_step(&vo->ao),
        { 1, (uint32_t)fill_table(&vo->options, &vo->table) },
        { 2, vo->options.normal },
    };
    return gpu_compute_pipeline_create(vo->gpu, vo_estimate_name(&vo->options), shader, constants,
                                       sizeof constants / sizeof constants[0], &vo->estimate);
}

void vo_record_estimate(struct vo *vo, struct gpu_cmd *cmd, const struct frame_view *view)
{
    fill_table(&vo->options, &vo->table);
    gpu_scope_begin(cmd, vo_estimate_name(&vo->options));
    gpu_dispatch(cmd, vo->estimate,
                 GPU_BIND(screen_ao_binding(&vo->ao, cmd),
                          gpu_transient(cmd, "vo_table", &vo->table, sizeof vo->table),
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "estimate", .image = vo->ao.estimate }),
                 NULL, 0, gpu_groups(vo->ao.work_width, LOCAL),
                 gpu_groups(vo->ao.work_height, LOCAL), 1);
    gpu_scope_end(cmd);
}
