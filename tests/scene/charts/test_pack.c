// Packing: charts turned by quarters, gaps, and the order of equal input.
#include "scene/charts/charts_fixture.h"

#include "core/rng.h"

#include <string.h>

enum { QUADS = 400 };

// Quads of 3 to 13 texels' sides at one texel a metre; first: seed of those before the last half.
static struct scene *heap(uint32_t first)
{
    vec3s *positions = host_alloc(test_host(), 4 * QUADS, sizeof *positions);
    uint32_t *indices = host_alloc(test_host(), 6 * QUADS, sizeof *indices);
    static const uint32_t order[6] = { 0, 1, 2, 0, 2, 3 };
    for (uint32_t i = 0; i < QUADS; i++) {
        struct rng rng = rng_for(i < QUADS / 2 ? first : 0, i, 1);
        const float width = 3.0f + 10.0f * rng_float(&rng), height = 3.0f + 10.0f * rng_float(&rng);
        vec3s *at = &positions[4 * i];
        at[0] = vec3_of(0, 0, 2.0f * (float)i);
        at[1] = vec3_of(width, 0, at[0].z);
        at[2] = vec3_of(width, height, at[0].z);
        at[3] = vec3_of(0, height, at[0].z);
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 4 * i + order[k];
    }
    return scene_of_triangles(positions, 4 * QUADS, indices, 6 * QUADS);
}

static struct charts heap_charts(uint32_t first)
{
    struct scene *scene = heap(first);
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 1.0f, .max_texels = 1u << 20 };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    close_scene(scene, &pose);
    return charts;
}

// A quad of n texels' side has n² texels in (n + 2)²: here .66 of all footprints.
TEST(a_heap_of_small_quads_fills_its_atlas)
{
    struct charts charts = heap_charts(1);
    CHECK(charts.count == QUADS);
    CHECK(charts.width % 8 == 0 && charts.height % 8 == 0);
    check_gutters_are_own(&charts);
    check_texels_lie_on_triangles(&charts);
    check_lookups_stay_in_the_chart(&charts);
    const double filled = (double)charts_utilisation(&charts);
    if (filled < 0.6) fail_msg("%g of %u×%u", filled, charts.width, charts.height);
    charts_finish(&charts);
}

// Texels of one chart, found by their places in its own frame.
static const struct chart_texel *texel_at(const struct charts *charts, const struct chart *chart,
                                          struct chart_place at)
{
    for (uint32_t i = 0; i < chart->texel_count; i++) {
        const struct chart_texel *t = &charts->texels[chart->first_texel + i];
        const struct chart_place own = chart_own_place(chart, t);
        if (own.x == at.x && own.y == at.y) return t;
    }
    return NULL;
}

TEST(a_turned_chart_has_the_same_texels)
{
    struct charts a = heap_charts(1), b = heap_charts(2);
    uint32_t turned = 0, differently = 0;
    for (uint32_t c = QUADS / 2; c < QUADS; c++) {
        const struct chart *one = &a.charts[c], *other = &b.charts[c];
        turned += one->turns != 0;
        differently += one->turns != other->turns;
        CHECK(one->texel_count == other->texel_count);
        for (uint32_t i = 0; i < one->texel_count; i++) {
            const struct chart_texel *t = &a.texels[one->first_texel + i];
            const struct chart_texel *same = texel_at(&b, other, chart_own_place(one, t));
            CHECK(same && glms_vec3_distance(same->position, t->position) < 1e-3f);
            CHECK_RELATIVE(same->area_m2, t->area_m2, 1e-3);
        }
    }
    if (turned < QUADS / 20 || differently == 0) fail_msg("%u and %u turned", turned, differently);
    charts_finish(&a);
    charts_finish(&b);
}

TEST(equal_surfaces_have_equal_atlases)
{
    struct charts a = heap_charts(1), b = heap_charts(1);
    CHECK(a.width == b.width && a.height == b.height && a.texel_count == b.texel_count);
    CHECK(memcmp(a.owner, b.owner, (size_t)a.width * a.height * sizeof *a.owner) == 0);
    for (uint32_t t = 0; t < a.triangle_count; t++)
        CHECK(memcmp(a.triangles[t].place, b.triangles[t].place, sizeof a.triangles[t].place) == 0);
    charts_finish(&a);
    charts_finish(&b);
}
