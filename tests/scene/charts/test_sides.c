// Texels of both sides of charts.
#include "scene/charts/charts_fixture.h"

static void open_two_sided(struct scene **scene, struct scene_pose *pose, struct charts *charts)
{
    const struct charts_options options = { .texels_per_m = 8.0f, .max_texels = 1u << 20 };
    *scene = open_scene("@cornell", pose);
    const int chosen = scene_mesh_of(*scene, 0)->material;
    (*scene)->materials[chosen].double_sided = true;
    CHECK(charts_init(charts, test_host(), pose, &options));
    CHECK(charts->side_texel_count > charts->texel_count);
    CHECK(charts->side_texel_count < 2 * charts->texel_count);
}

TEST(texels_of_both_sides_are_found_by_place_and_by_triangle)
{
    struct scene *scene;
    struct scene_pose pose;
    struct charts charts;
    uint32_t met = 0;
    open_two_sided(&scene, &pose, &charts);
    for (uint32_t i = 0; i < charts.side_texel_count; i++) {
        const struct chart_texel *t = chart_texel_of(&charts, i);
        const struct chart_triangle *of = chart_triangle_of(&charts, i);
        const bool back = chart_is_back(&charts, i);
        const size_t row = (back ? charts.height : 0) + t->y;
        CHECK(chart_texel_of_place(&charts, row * charts.width + t->x) == i);
        met += chart_texel_at(&charts, of->instance, of->triangle, t->u, t->v, back) == i;
        const float along = glms_vec3_dot(chart_texel_normal(&charts, i), of->normal);
        CHECK(along * (back ? -1.0f : 1.0f) > 0.999f);
        const int material = scene_mesh_of(scene, of->instance)->material;
        CHECK(!back || scene->materials[material].double_sided);
    }
    CHECK(met > 0.98 * charts.side_texel_count); // some are beside their triangle by rounding
    charts_finish(&charts);
    close_scene(scene, &pose);
}

TEST(hidden_texels_show_the_nearest_of_their_side)
{
    struct scene *scene;
    struct scene_pose pose;
    struct charts charts;
    open_two_sided(&scene, &pose, &charts);
    bool *hidden = host_alloc(test_host(), charts.side_texel_count, sizeof *hidden);
    for (uint32_t i = 0; i < charts.side_texel_count; i++) hidden[i] = true;
    for (uint32_t c = 1; c < charts.count; c++) {
        hidden[charts.charts[c].first_texel] = false;
        if (charts.charts[c].first_back != CHART_NONE) hidden[charts.charts[c].first_back] = false;
    }
    uint32_t *shown = charts_fill(&charts, hidden);
    CHECK(shown);
    for (uint32_t i = 0; i < charts.side_texel_count; i++) {
        const uint32_t c = chart_triangle_of(&charts, i)->chart;
        const struct chart *chart = &charts.charts[c];
        const uint32_t open = chart_is_back(&charts, i) ? chart->first_back : chart->first_texel;
        CHECK(shown[i] == (c == 0 ? i : open)); // nothing of the first chart is open
    }
    host_free(test_host(), hidden);
    host_free(test_host(), shown);
    charts_finish(&charts);
    close_scene(scene, &pose);
}
