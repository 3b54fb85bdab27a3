// Pages: all of an instance on one, nothing over a border, and texels as in one atlas.
#include "scene/charts/charts_fixture.h"

#include <stdio.h>
#include <string.h>

static const struct charts_options OPTIONS = {
    .texels_per_m = 1e3f, .max_texels = 1u << 20, .surface_texels = 16384, .join = CHARTS_JOINED
};

static void check_pages_have_whole_instances(const struct charts *charts, int instances)
{
    int page_of[256];
    assert_true(instances <= 256);
    for (int i = 0; i < instances; i++) page_of[i] = -1;
    for (uint32_t t = 0; t < charts->triangle_count; t++) {
        const struct chart_triangle *of = &charts->triangles[t];
        const int page = (int)charts->charts[of->chart].page;
        if (page_of[of->instance] < 0) page_of[of->instance] = page;
        assert_int_equal(page_of[of->instance], page);
    }
}

static void check_charts_are_on_their_pages(const struct charts *charts, uint32_t side)
{
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        const struct chart_page page = charts_page(charts, chart->page);
        CHECK(chart->x >= page.x && chart->y >= page.y);
        CHECK(chart->x + chart->width <= page.x + page.width);
        CHECK(chart->y + chart->height <= page.y + page.height);
    }
    for (uint32_t i = 0; i < charts_page_count(charts); i++) {
        const struct chart_page page = charts_page(charts, i);
        CHECK(page.width == side && page.height <= side && page.height % 8 == 0);
        CHECK(page.height == side || i + 1 == charts_page_count(charts));
        CHECK(page.x + page.width <= charts->width && page.y + page.height <= charts->height);
    }
}

// Numbers, positions and areas.
static void check_texels_are_equal(const struct charts *a, const struct charts *b)
{
    assert_int_equal(a->texel_count, b->texel_count);
    assert_int_equal(a->side_texel_count, b->side_texel_count);
    for (uint32_t i = 0; i < a->texel_count; i++) {
        const struct chart_texel *x = &a->texels[i], *y = &b->texels[i];
        CHECK(x->triangle == y->triangle && x->u == y->u && x->v == y->v);
        CHECK(memcmp(&x->position, &y->position, sizeof x->position) == 0);
        const struct chart *p = &a->charts[a->triangles[x->triangle].chart];
        const struct chart *q = &b->charts[b->triangles[y->triangle].chart];
        const struct chart_place at = chart_own_place(p, x), same = chart_own_place(q, y);
        CHECK(at.x == same.x && at.y == same.y);
    }
}

// least: pages, and the share of one atlas' utilisation.
static void check_pages(const char *name, uint32_t side, uint32_t pages, double share)
{
    struct scene_pose pose;
    struct scene *scene = open_scene(name, &pose);
    struct charts one, charts;
    CHECK(charts_init(&one, test_host(), &pose, &OPTIONS));
    CHECK(charts_copy(&charts, &one, scene->instance_count));
    CHECK(charts_set_pages(&charts, scene, side));
    print_message("%s: %u pages of %u, %.2f of them with a surface, %.2f of one atlas\n", name,
                  charts_page_count(&charts), side, (double)charts_utilisation(&charts),
                  (double)charts_utilisation(&one));
    CHECK(charts_page_count(&charts) >= pages);
    CHECK(charts_utilisation(&charts) > (float)share * charts_utilisation(&one));
    check_pages_have_whole_instances(&charts, scene->instance_count);
    check_charts_are_on_their_pages(&charts, side);
    check_gutters_are_own(&charts);
    check_texels_lie_on_triangles(&charts);
    check_lookups_stay_in_the_chart(&charts);
    check_texels_are_equal(&one, &charts);
    struct charts copy;
    CHECK(charts_copy(&copy, &charts, scene->instance_count));
    CHECK(charts_page_count(&copy) == charts_page_count(&charts));
    CHECK(memcmp(copy.pages, charts.pages, charts.page_count * sizeof *copy.pages) == 0);
    charts_finish(&copy);
    charts_finish(&charts);
    charts_finish(&one);
    close_scene(scene, &pose);
}

TEST(an_instance_is_on_one_page_and_texels_keep_their_numbers)
{
    check_pages("@cornell", 88, 3, 0.5);
    check_pages("@atrium", 128, 3, 0.8);
    check_pages("@spheres", 152, 2, 0.4);
}

TEST(an_atlas_that_fits_on_a_page_stays)
{
    struct scene_pose pose;
    struct scene *scene = open_scene("@cornell", &pose);
    struct charts charts, one;
    CHECK(charts_init(&charts, test_host(), &pose, &OPTIONS));
    CHECK(charts_copy(&one, &charts, scene->instance_count));
    CHECK(charts_set_pages(&charts, scene, 256));
    CHECK(!charts.pages && charts_page_count(&charts) == 1);
    CHECK(charts.width == one.width && charts.height == one.height);
    CHECK(memcmp(charts.owner, one.owner, (size_t)one.width * one.height * sizeof *one.owner) == 0);
    charts_finish(&charts);
    charts_finish(&one);
    close_scene(scene, &pose);
}

// The message has a page and a density that would do.
TEST(an_instance_that_does_not_fit_on_a_page_is_named)
{
    struct scene_pose pose;
    struct scene *scene = open_scene("@cornell", &pose);
    struct charts charts;
    unsigned enough = 0;
    float density = 0.0f;
    CHECK(charts_init(&charts, test_host(), &pose, &OPTIONS));
    CHECK(!charts_set_pages(&charts, scene, 64));
    charts_finish(&charts);
    const char *message = test_last_message(), *page = strstr(message, "; a page of ");
    assert_non_null(page);
    CHECK(strstr(message, "(tall block) does not fit on a page of 64x64"));
    CHECK(sscanf(page, "; a page of %u, or density=%g, would do", &enough, &density) == 2);
    CHECK(enough > 64 && enough % 8 == 0);
    CHECK(charts_init(&charts, test_host(), &pose, &OPTIONS));
    CHECK(charts_set_pages(&charts, scene, enough));
    charts_finish(&charts);
    struct charts_options sparse = OPTIONS;
    sparse.texels_per_m = density;
    CHECK(charts_init(&charts, test_host(), &pose, &sparse));
    CHECK(charts_set_pages(&charts, scene, 64));
    charts_finish(&charts);
    close_scene(scene, &pose);
}

// Quads of 1 cm in pairs, which share a texel of 20 cm.
static struct scene *rows_of_quads(int instances)
{
    static const uint32_t order[6] = { 0, 1, 2, 0, 2, 3 };
    const vec3s positions[4] = {
        { { 0, 0, 0 } }, { { 0.01f, 0, 0 } }, { { 0.01f, 0.01f, 0 } }, { { 0, 0.01f, 0 } }
    };
    const struct mesh mesh = { .vertex_count = 4,
                               .index_count = 6,
                               .positions = (vec3s *)positions,
                               .indices = (uint32_t *)order,
                               .material = -1 };
    struct scene *scene = scene_of(&mesh, instances);
    for (int i = 0; i < instances; i++)
        scene->nodes[i].translation = vec3_of(0.02f * (float)(i % 2) + 3.0f * (float)(i / 2), 0, 0);
    return scene;
}

TEST(instances_that_share_texels_are_on_one_page)
{
    enum { INSTANCES = 2000 };
    struct scene *scene = rows_of_quads(INSTANCES);
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 5.0f,
                                            .max_texels = 1u << 20,
                                            .join = CHARTS_JOINED_ACROSS };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    assert_int_equal(charts.count, INSTANCES / 2);
    CHECK(charts_set_pages(&charts, scene, 64));
    CHECK(charts_page_count(&charts) >= 2);
    check_charts_are_on_their_pages(&charts, 64);
    check_gutters_are_own(&charts);
    charts_finish(&charts);
    close_scene(scene, &pose);
}
