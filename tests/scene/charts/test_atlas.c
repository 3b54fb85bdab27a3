// Atlases of charts: surfaces that have a place in them, the limit of texels, and small charts that
// share one.
#include "scene/charts/charts_fixture.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

TEST(degenerate_triangles_have_no_chart)
{
    const vec3s positions[4] = {
        { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 2, 0, 0 } }, { { 0, 1, 0 } }
    };
    const uint32_t indices[12] = { 0, 1, 2, 0, 0, 0, 0, 1, 3, 1, 1, 3 };
    const struct mesh mesh = { .vertex_count = 4,
                               .index_count = 12,
                               .positions = (vec3s *)positions,
                               .indices = (uint32_t *)indices,
                               .material = -1 };
    struct scene *scene = scene_of(&mesh, 1);
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 16.0f, .max_texels = 1u << 20 };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    CHECK(charts.without_area == 3 && charts.triangle_count == 1 && charts.count == 1);
    check_texels_lie_on_triangles(&charts);
    charts_finish(&charts);
    close_scene(scene, &pose);
}

TEST(nothing_has_no_charts)
{
    struct scene *scene = scene_create(test_host(), "empty");
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 16.0f, .max_texels = 1u << 20 };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    CHECK(charts.count == 0 && charts.texel_count == 0 && charts.width == 0);
    charts_finish(&charts);
    close_scene(scene, &pose);
}

// Separate triangles of all sizes up to `size`.
static struct scene *soup(uint32_t triangles, float size)
{
    vec3s *positions = host_alloc(test_host(), 3 * triangles, sizeof *positions);
    uint32_t *indices = host_alloc(test_host(), 3 * triangles, sizeof *indices);
    struct rng rng = rng_for(1, 2, 3);
    for (uint32_t v = 0; v < 3 * triangles; v++) {
        const float scale = size * powf(rng_float(&rng), 8.0f);
        positions[v] = vec3_of(scale * rng_float(&rng), scale * rng_float(&rng), rng_float(&rng));
        indices[v] = v;
    }
    return scene_of_triangles(positions, 3 * triangles, indices, 3 * triangles);
}

TEST(many_separate_triangles_fit_or_are_refused)
{
    struct scene *scene = soup(2000, 1e6f);
    struct scene_pose pose;
    struct charts charts;
    struct charts_options options = { .texels_per_m = 1e3f, .max_texels = 1u << 18 };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    check_gutters_are_own(&charts);
    check_texels_lie_on_triangles(&charts);
    charts_finish(&charts);
    options.max_texels = 2000 * 9 - 1; // gutters alone
    CHECK(!charts_init(&charts, test_host(), &pose, &options));
    CHECK(test_host()->failure == FAIL_MEMORY && charts.texels == NULL);
    CHECK(strstr(test_last_message(), "do not fit in 17999 texels; merge meshes"));
    options.atlas_per_texel = 64;
    options.most_texels = 1u << 22;
    options.most_charts = 2000;
    CHECK(!charts_init(&charts, test_host(), &pose, &options));
    const char *remedy = strstr(test_last_message(), "do not fit in 17999 texels; try texels=");
    CHECK(remedy != NULL);
    options.max_texels = 64 * (uint32_t)atoi(strchr(remedy, '=') + 1);
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    charts_finish(&charts);
    close_scene(scene, &pose);
}

static double processor_s(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

// Tries at lower densities do not make charts of one texel smaller.
TEST(charts_of_one_texel_that_do_not_fit_are_refused_soon)
{
    enum { TRIANGLES = 60000, ROOM = 15 * TRIANGLES };
    struct scene *scene = soup(TRIANGLES, 1e-4f);
    struct scene_pose pose;
    struct charts charts;
    struct charts_options options = { .texels_per_m = 1.0f, .max_texels = ROOM };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    const double begun = processor_s();
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    charts_finish(&charts);
    const double fitted = processor_s();
    options.max_texels = 8 * TRIANGLES;
    CHECK(!charts_init(&charts, test_host(), &pose, &options));
    const double refused = processor_s();
    if (refused - fitted > 4.0 * (fitted - begun))
        fail_msg("refused in %g s, fitted in %g s", refused - fitted, fitted - begun);
    close_scene(scene, &pose);
}

TEST(chosen_triangles_alone_have_charts)
{
    struct scene_pose pose;
    struct scene *scene = open_scene("@cornell", &pose);
    const size_t count = scene_triangle_count(scene);
    bool *chosen = host_alloc(test_host(), count, sizeof *chosen);
    struct charts charts;
    for (size_t i = count / 2; i < count; i++) chosen[i] = true;
    const struct charts_options options = { .texels_per_m = 16.0f,
                                            .max_texels = 1u << 20,
                                            .chosen = chosen };
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    CHECK(charts.triangle_count == count - count / 2);
    charts_finish(&charts);
    host_free(test_host(), chosen);
    close_scene(scene, &pose);
}

// ---- single-texel charts

// Laws that single-texel charts keep; their texels have no extent.
static void check_single_texels(const struct charts *charts)
{
    double area = 0.0, expected = 0.0;
    check_gutters_are_own(charts);
    check_lookups_stay_in_the_chart(charts);
    for (uint32_t i = 0; i < charts->texel_count; i++) area += (double)charts->texels[i].area_m2;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        for (uint32_t i = 0; i < chart->triangle_count; i++)
            expected += (double)charts->triangles[chart->first_triangle + i].area_m2;
        CHECK(!chart->single_texel ||
              (chart->width == 3 && chart->height == 3 && chart->texel_count == 1));
    }
    CHECK_RELATIVE(area, expected, 1e-3);
}

enum { TILES = 6 };

static void add_quad(vec3s *positions, uint32_t *indices, uint32_t quad, vec3s corner, vec3s a,
                     vec3s b)
{
    static const uint32_t order[6] = { 0, 1, 2, 0, 2, 3 };
    vec3s *at = &positions[4 * quad];
    at[0] = corner;
    at[1] = glms_vec3_add(corner, a);
    at[2] = glms_vec3_add(at[1], b);
    at[3] = glms_vec3_add(corner, b);
    for (int k = 0; k < 6; k++) indices[6 * quad + (uint32_t)k] = 4 * quad + order[k];
}

// Tiles of 5 cm in a row, inside of one texel; a wall of 5 cm between the halves of the row.
static struct scene *tiles(bool wall)
{
    vec3s positions[4 * (TILES + 2)];
    uint32_t indices[6 * (TILES + 2)];
    for (uint32_t i = 0; i < TILES; i++)
        add_quad(positions, indices, i, vec3_of(0.05f + 0.16f * (float)i, 0, 0.5f),
                 vec3_of(0, 0, 0.05f), vec3_of(0.05f, 0, 0));
    for (uint32_t i = 0; i < 2; i++)
        add_quad(positions, indices, TILES + i, vec3_of(i ? 0.475f : 0.425f, -1, -2),
                 i ? vec3_of(0, 4, 0) : vec3_of(0, 0, 4), i ? vec3_of(0, 0, 4) : vec3_of(0, 4, 0));
    const uint32_t quads = TILES + (wall ? 2u : 0u);
    const struct mesh mesh = { .vertex_count = 4 * quads,
                               .index_count = 6 * quads,
                               .positions = positions,
                               .indices = indices,
                               .material = -1 };
    return scene_of(&mesh, 1);
}

static uint32_t spots_of_tiles(bool wall, enum charts_join join)
{
    struct scene *scene = tiles(wall);
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 1.0f,
                                            .max_texels = 1u << 20,
                                            .join = join };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    check_each_triangle_is_in_one_chart(&charts, &pose);
    check_single_texels(&charts);
    uint32_t singles = 0;
    for (uint32_t c = 0; c < charts.count; c++) singles += charts.charts[c].single_texel;
    charts_finish(&charts);
    close_scene(scene, &pose);
    return singles;
}

TEST(small_charts_that_see_each_other_share_a_texel)
{
    CHECK(spots_of_tiles(false, CHARTS_APART) == 0);
    CHECK(spots_of_tiles(false, CHARTS_JOINED) == 1);
    CHECK(spots_of_tiles(true, CHARTS_JOINED) == 2);
}

TEST(instances_share_texels_only_where_wanted)
{
    static const struct {
        enum charts_join join;
        bool fewer;
    } cases[] = { { CHARTS_JOINED, false }, { CHARTS_JOINED_ACROSS, true } };
    for (int i = 0; i < 2; i++) {
        struct scene *scene = two_quads(0.5f, 0.0f, 4);
        struct scene_pose pose;
        struct charts charts;
        const struct charts_options options = { .texels_per_m = 0.05f,
                                                .max_texels = 1u << 20,
                                                .join = cases[i].join };
        CHECK(pose_init(&pose, scene, -1, 0.0f));
        CHECK(charts_init(&charts, test_host(), &pose, &options));
        check_single_texels(&charts);
        CHECK((charts.count < 4) == cases[i].fewer);
        charts_finish(&charts);
        close_scene(scene, &pose);
    }
}
