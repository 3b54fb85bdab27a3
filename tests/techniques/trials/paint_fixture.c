#include "techniques/trials/paint_fixture.h"

#include <stdlib.h>
#include <string.h>

static const float IGNORED = 1e6f;

void paint_fixture_open(struct paint_fixture *p, struct frame_fixture *s,
                        const struct baked_fixture *run)
{
    *p = (struct paint_fixture){ .s = s, .gi = run->gi };
    CHECK(scene_statics_init(&p->statics, test_host(), &s->pose));
    CHECK(run->spec.technique[0]->charts(&p->statics.pose, run->spec.options[0], test_host(), NULL,
                                         &p->charts));
    p->lux = calloc((size_t)p->charts.width * p->charts.height, 3 * sizeof *p->lux);
    assert_non_null(p->lux);
}

void paint_fixture_close(struct paint_fixture *p)
{
    free(p->lux);
    charts_finish(&p->charts);
    scene_statics_finish(&p->statics);
}

static void paint_side(struct paint_fixture *p, bool back, const float *lux)
{
    const struct light_map_area area = { 0, 0, p->charts.width, p->charts.height, back, lux };
    if (!gi_paint(p->gi, &area)) fail_msg("%s", test_last_message());
    p->s->input.painted = gi_painted(p->gi);
}

void paint_fixture_set(struct paint_fixture *p, const float *lux)
{
    const struct charts *charts = &p->charts;
    for (uint32_t side = 0; side < charts_sides(charts); side++) {
        for (size_t i = 0; i < 3 * (size_t)charts->width * charts->height; i++) p->lux[i] = IGNORED;
        for (uint32_t i = 0; i < charts->side_texel_count; i++) {
            const struct chart_texel *t = chart_texel_of(charts, i);
            if (chart_is_back(charts, i) == (side == 1))
                memcpy(p->lux + 3 * ((size_t)t->y * charts->width + t->x), lux + 3 * (size_t)i,
                       3 * sizeof *lux);
        }
        paint_side(p, side == 1, p->lux);
    }
}

void paint_fixture_paint(struct paint_fixture *p, vec3s (*lux)(vec3s position, vec3s normal))
{
    const struct charts *charts = &p->charts;
    float *values = calloc(charts->side_texel_count, 3 * sizeof *values);
    assert_non_null(values);
    for (uint32_t i = 0; i < charts->side_texel_count; i++) {
        const vec3s position = chart_texel_of(charts, i)->position;
        const vec3s value = lux(position, chart_texel_normal(charts, i));
        memcpy(values + 3 * (size_t)i, value.raw, sizeof value.raw);
    }
    paint_fixture_set(p, values);
    free(values);
}

void paint_fixture_clear(struct paint_fixture *p)
{
    for (uint32_t side = 0; side < charts_sides(&p->charts); side++) paint_side(p, side == 1, NULL);
}
