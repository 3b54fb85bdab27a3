// Charts of light maps: each law is checked on scenes with flat, round and disconnected surfaces,
// and on surfaces that lie above themselves.
#include "scene/charts/charts_fixture.h"

#include "scene/charts/raster.h"

#include <math.h>
#include <stdio.h>

// Stretch of triangles on their charts, relative to their areas and edges in the scene.
static void check_stretch_is_bounded(const struct charts *charts)
{
    for (uint32_t i = 0; i < charts->triangle_count; i++) {
        const struct chart_triangle *t = &charts->triangles[i];
        const struct chart *chart = &charts->charts[t->chart];
        for (int k = 0; k < 3; k++) {
            CHECK(t->place[k].x >= (float)(chart->x + CHART_GUTTER) - 1e-2f);
            CHECK(t->place[k].y >= (float)(chart->y + CHART_GUTTER) - 1e-2f);
            CHECK(t->place[k].x <= (float)(chart->x + chart->width - CHART_GUTTER) + 1e-2f);
            CHECK(t->place[k].y <= (float)(chart->y + chart->height - CHART_GUTTER) + 1e-2f);
            if (chart->unwrapped) continue;
            const float world =
                charts->texels_per_m * glms_vec3_distance(t->corner[k], t->corner[(k + 1) % 3]);
            const float texels = glms_vec2_distance(t->place[k], t->place[(k + 1) % 3]);
            CHECK(texels <= 1.001f * world + 0.01f);
        }
        if (!chart->unwrapped) CHECK(glms_vec3_dot(t->normal, chart->normal) >= CHART_MIN_COSINE);
    }
}

static void add_moment(double sum[3], float area_m2, vec3s at)
{
    for (int c = 0; c < 3; c++) sum[c] += (double)area_m2 * (double)at.raw[c];
}

// The centroid of all texels is that of all triangles.
static void check_centroids(const struct charts *charts)
{
    double got[3] = { 0 }, expected[3] = { 0 }, scale = 0.0;
    for (uint32_t i = 0; i < charts->texel_count; i++)
        add_moment(got, charts->texels[i].area_m2, charts->texels[i].centroid);
    for (uint32_t i = 0; i < charts->triangle_count; i++) {
        const struct chart_triangle *t = &charts->triangles[i];
        const vec3s sum = glms_vec3_add(t->corner[0], glms_vec3_add(t->corner[1], t->corner[2]));
        add_moment(expected, t->area_m2, glms_vec3_scale(sum, 1.0f / 3.0f));
        scale += (double)t->area_m2 * largest_coordinate(t);
    }
    for (int c = 0; c < 3; c++) CHECK_NEAR(got[c], expected[c], 1e-3 * scale);
}

static void check_laws(const char *name, float texels_per_m, uint32_t max_texels)
{
    struct scene_pose pose;
    struct scene *scene = open_scene(name, &pose);
    struct charts charts;
    const struct charts_options options = { .texels_per_m = texels_per_m,
                                            .max_texels = max_texels };
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    printf("%s: %u triangles, %u charts, %u texels in %u×%u, %.3g texels/m\n", name,
           charts.triangle_count, charts.count, charts.texel_count, charts.width, charts.height,
           (double)charts.texels_per_m);
    CHECK((uint64_t)charts.width * charts.height <= max_texels);
    CHECK(charts.texels_per_m <= texels_per_m);
    check_each_triangle_is_in_one_chart(&charts, &pose);
    check_gutters_are_own(&charts);
    check_stretch_is_bounded(&charts);
    check_texels_lie_on_triangles(&charts);
    check_centroids(&charts);
    check_lookups_stay_in_the_chart(&charts);
    charts_finish(&charts);
    close_scene(scene, &pose);
}

TEST(laws_hold_on_flat_surfaces)
{
    check_laws("@cornell", 16.0f, 1u << 20);
    check_laws("@maze", 8.0f, 1u << 20);
}

TEST(laws_hold_on_round_surfaces)
{
    check_laws("@spheres", 8.0f, 1u << 20);
    check_laws("@tunnel", 4.0f, 1u << 20);
}

TEST(laws_hold_where_the_density_is_lowered)
{
    check_laws("@cornell", 1000.0f, 1u << 14);
    check_laws("@atrium", 64.0f, 1u << 18);
}

TEST(laws_hold_on_a_scan)
{
    check_laws(test_scene_path("bunny.glb"), 256.0f, 1u << 20);
}

TEST(boxes_have_a_chart_for_each_side)
{
    struct scene_pose pose;
    struct scene *scene = open_scene("@cornell", &pose);
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 16.0f, .max_texels = 1u << 20 };
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    for (uint32_t c = 0; c < charts.count; c++) {
        const struct chart *chart = &charts.charts[c];
        const struct chart_triangle *first = &charts.triangles[chart->first_triangle];
        for (uint32_t i = 0; i < chart->triangle_count; i++)
            CHECK_NEAR(glms_vec3_dot(first->normal, first[i].normal), 1.0, 1e-4);
        // Rectangles along the atlas's axes: most texels are full.
        const double full =
            (double)chart->area_m2 * (double)charts.texels_per_m * (double)charts.texels_per_m;
        CHECK(full > 0.7 * (double)chart->texel_count);
    }
    charts_finish(&charts);
    close_scene(scene, &pose);
}

// ---- surfaces above themselves

enum { SHEETS = 3, SEGMENTS = 48 };

// A spiral ramp of some turns: its normals are near to each other, and its turns are above each
// other.
static struct scene *spiral(void)
{
    enum { VERTICES = 2 * (SHEETS * SEGMENTS + 1), INDICES = 6 * SHEETS * SEGMENTS };
    vec3s positions[VERTICES];
    uint32_t indices[INDICES];
    for (uint32_t i = 0; i < VERTICES; i++) {
        const float turn = 6.2831853f * (float)(i / 2) / SEGMENTS, r = i % 2 ? 2.0f : 1.0f;
        positions[i] = vec3_of(r * cosf(turn), 0.1f * turn, r * sinf(turn));
    }
    for (uint32_t i = 0; i < SHEETS * SEGMENTS; i++) {
        const uint32_t quad[6] = { 0, 1, 2, 1, 3, 2 };
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 2 * i + quad[k];
    }
    const struct mesh mesh = { .vertex_count = VERTICES,
                               .index_count = INDICES,
                               .positions = positions,
                               .indices = indices,
                               .material = -1 };
    return scene_of(&mesh, 1);
}

static bool mark(void *user, uint32_t at)
{
    uint8_t *taken = user;
    return !taken[at]++;
}

TEST(a_spiral_does_not_overlap_itself)
{
    struct scene *scene = spiral();
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 20.0f, .max_texels = 1u << 20 };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    CHECK(charts.count >= SHEETS);
    uint8_t *taken = host_alloc(test_host(), (size_t)charts.width * charts.height, 1);
    // Middles of triangles are in texels of their own: triangles are several texels wide.
    for (uint32_t i = 0; i < charts.triangle_count; i++) {
        const vec2s *p = charts.triangles[i].place;
        const float x = (p[0].x + p[1].x + p[2].x) / 3.0f, y = (p[0].y + p[1].y + p[2].y) / 3.0f;
        CHECK(mark(taken, (uint32_t)y * charts.width + (uint32_t)x));
    }
    host_free(test_host(), taken);
    check_gutters_are_own(&charts);
    check_texels_lie_on_triangles(&charts);
    charts_finish(&charts);
    close_scene(scene, &pose);
}

// Smooth pleats, each of which hangs over the one before: seen from above a fifth of the length is
// covered three times.
static struct scene *pleats(void)
{
    enum { PLEATS = 3, STEPS = 32, ROWS = PLEATS * STEPS + 1 };
    vec3s positions[2 * ROWS];
    uint32_t indices[6 * (ROWS - 1)];
    for (uint32_t i = 0; i < 2 * ROWS; i++) {
        const float at = 6.2831853f * (float)(i / 2) / STEPS;
        positions[i] = vec3_of(0.2f * at - 0.4f * sinf(at), 0.1f * at, i % 2 ? 0.0f : 1.0f);
    }
    for (uint32_t i = 0; i + 1 < ROWS; i++) {
        const uint32_t quad[6] = { 0, 1, 2, 1, 3, 2 };
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 2 * i + quad[k];
    }
    const struct mesh mesh = { .vertex_count = 2 * ROWS,
                               .index_count = 6 * (ROWS - 1),
                               .positions = positions,
                               .indices = indices,
                               .material = -1 };
    return scene_of(&mesh, 1);
}

enum { FINE = 8 }; // parts of a texel's side

struct fine_raster {
    uint8_t *taken;
    size_t width;
};

static bool mark_part(void *user, int32_t x, int32_t y)
{
    struct fine_raster *raster = user;
    return mark(raster->taken, (uint32_t)((size_t)y * raster->width + (size_t)x));
}

TEST(a_folded_strip_does_not_overlap_itself_by_an_eighth_of_a_texel)
{
    struct scene *scene = pleats();
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 20.0f, .max_texels = 1u << 20 };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    struct fine_raster raster = { NULL, (size_t)FINE * charts.width };
    raster.taken = host_alloc(test_host(), raster.width * FINE * charts.height, 1);
    for (uint32_t i = 0; i < charts.triangle_count; i++) {
        struct raster_triangle t;
        for (int k = 0; k < 6; k++)
            t.at[k / 2][k % 2] = FINE * (double)charts.triangles[i].place[k / 2].raw[k % 2];
        CHECK(raster_centres(&t, mark_part, &raster));
    }
    CHECK(charts.count >= 4); // up and over, twice at least
    host_free(test_host(), raster.taken);
    charts_finish(&charts);
    close_scene(scene, &pose);
}
