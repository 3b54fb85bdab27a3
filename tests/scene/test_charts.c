// Charts of light maps: each law is checked on scenes with flat, round and disconnected surfaces.
#include "framework/test.h"

#include "core/rng.h"
#include "scene/charts/charts.h"
#include "scene/charts/raster.h"
#include "scene/charts/unwrap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static struct scene *open_scene(const char *name, struct scene_pose *pose)
{
    struct scene *scene = scene_load(test_host(), name);
    CHECK(scene);
    CHECK(pose_init(pose, scene, -1, 0.0f));
    return scene;
}

static void close_scene(struct scene *scene, struct scene_pose *pose)
{
    pose_finish(pose);
    scene_destroy(scene);
}

// ---- laws

static void check_each_triangle_is_in_one_chart(const struct charts *charts,
                                                const struct scene_pose *pose)
{
    const size_t count = scene_triangle_count(pose->scene);
    size_t *first = host_alloc(test_host(), (size_t)pose->scene->instance_count, sizeof *first);
    bool *met = host_alloc(test_host(), count, sizeof *met);
    CHECK(charts->triangle_count + charts->without_area == count);
    for (int i = 0; i + 1 < pose->scene->instance_count; i++)
        first[i + 1] = first[i] + scene_mesh_of(pose->scene, i)->index_count / 3;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        for (uint32_t i = 0; i < chart->triangle_count; i++) {
            const struct chart_triangle *t = &charts->triangles[chart->first_triangle + i];
            CHECK(t->chart == c && t->instance == chart->instance);
            CHECK(!met[first[t->instance] + t->triangle]);
            met[first[t->instance] + t->triangle] = true;
        }
    }
    host_free(test_host(), first);
    host_free(test_host(), met);
}

static void check_rectangles_are_apart(const struct charts *charts)
{
    const size_t all = (size_t)charts->width * charts->height;
    uint8_t *taken = host_alloc(test_host(), all, 1);
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        CHECK(chart->x + chart->width <= charts->width);
        CHECK(chart->y + chart->height <= charts->height);
        for (uint32_t y = chart->y; y < chart->y + chart->height; y++)
            for (uint32_t x = chart->x; x < chart->x + chart->width; x++)
                CHECK(!taken[(size_t)y * charts->width + x]++);
    }
    host_free(test_host(), taken);
}

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

static double distance_to_triangle(const struct chart_triangle *t, const struct chart_texel *texel)
{
    vec3s p = glms_vec3_scale(t->corner[0], 1.0f - texel->u - texel->v);
    p = glms_vec3_muladds(t->corner[1], texel->u, p);
    p = glms_vec3_muladds(t->corner[2], texel->v, p);
    return (double)glms_vec3_distance(p, texel->position);
}

static double largest_coordinate(const struct chart_triangle *t)
{
    float largest = 0.0f;
    for (int k = 0; k < 3; k++)
        largest = fmaxf(largest, glms_vec3_max(glms_vec3_abs(t->corner[k])));
    return (double)largest;
}

static void check_texels_lie_on_triangles(const struct charts *charts)
{
    double area = 0.0, expected = 0.0;
    for (uint32_t i = 0; i < charts->texel_count; i++) {
        const struct chart_texel *texel = &charts->texels[i];
        const struct chart_triangle *t = &charts->triangles[texel->triangle];
        CHECK(texel->u >= 0.0f && texel->v >= 0.0f && texel->u + texel->v <= 1.0f + 1e-6f);
        CHECK(distance_to_triangle(t, texel) <= 1e-6 * (1.0 + largest_coordinate(t)));
        vec2s at = glms_vec2_scale(t->place[0], 1.0f - texel->u - texel->v);
        at = glms_vec2_muladds(t->place[1], texel->u, at);
        at = glms_vec2_muladds(t->place[2], texel->v, at);
        CHECK_NEAR(at.x, texel->x + 0.5, 0.501 + 1e-6 * (double)charts->width);
        CHECK_NEAR(at.y, texel->y + 0.5, 0.501 + 1e-6 * (double)charts->height);
        CHECK(charts->owner[(size_t)texel->y * charts->width + texel->x] == i);
        area += (double)texel->area_m2;
    }
    for (uint32_t i = 0; i < charts->triangle_count; i++)
        expected += (double)charts->triangles[i].area_m2;
    CHECK_RELATIVE(area, expected, 1e-3);
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

// A bilinear lookup anywhere on a triangle reads texels of its chart alone.
static void check_lookups_stay_in_the_chart(const struct charts *charts)
{
    struct rng rng = rng_for(7, 0, 0);
    for (uint32_t i = 0; i < charts->triangle_count; i++) {
        const struct chart_triangle *t = &charts->triangles[i];
        const struct chart *chart = &charts->charts[t->chart];
        for (int trial = 0; trial < 4; trial++) {
            const float root = sqrtf(rng_float(&rng)), v = root * rng_float(&rng);
            vec2s at = glms_vec2_scale(t->place[0], 1.0f - root);
            at = glms_vec2_muladds(t->place[1], root - v, at);
            at = glms_vec2_muladds(t->place[2], v, at);
            for (int tap = 0; tap < 4; tap++) {
                const size_t x = (size_t)floorf(at.x - 0.5f) + (size_t)(tap & 1);
                const size_t y = (size_t)floorf(at.y - 0.5f) + (size_t)(tap >> 1);
                const uint32_t owner = charts->owner[y * charts->width + x];
                CHECK(owner >= chart->first_texel);
                CHECK(owner < chart->first_texel + chart->texel_count);
            }
        }
    }
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
    check_rectangles_are_apart(&charts);
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

// ---- scenes made here

enum { SHEETS = 3, SEGMENTS = 48 };

static struct scene *scene_of(const struct mesh *mesh, int instances)
{
    struct scene *scene = scene_create(test_host(), "made");
    CHECK(scene && scene_add_mesh(scene, mesh) == 0);
    for (int i = 0; i < instances; i++) {
        struct node node = node_default();
        node.translation = vec3_of(3.0f * (float)i, 0.0f, 0.0f);
        const struct instance instance = { .node = scene_add_node(scene, &node), .skin = -1 };
        CHECK(scene_add_instance(scene, &instance) == i);
    }
    return scene;
}

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
    check_rectangles_are_apart(&charts);
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

// Two quads side by side with TEXCOORD_1; `uv` moves the second one.
static struct scene *two_quads(float u_of_second, float first_u, int instances)
{
    const vec3s positions[8] = {
        { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 0, 1, 0 } },
        { { 2, 0, 0 } }, { { 3, 0, 0 } }, { { 3, 1, 0 } }, { { 2, 1, 0 } }
    };
    vec2s uv[8];
    const uint32_t indices[12] = { 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7 };
    for (int v = 0; v < 8; v++)
        uv[v] = (vec2s){ { 0.3f * (positions[v].x - (v < 4 ? 0.0f : 2.0f)) +
                               (v < 4 ? first_u : u_of_second),
                           0.3f * positions[v].y } };
    const struct mesh mesh = { .vertex_count = 8,
                               .index_count = 12,
                               .positions = (vec3s *)positions,
                               .uv = { NULL, uv },
                               .indices = (uint32_t *)indices,
                               .material = -1 };
    return scene_of(&mesh, instances);
}

static enum unwrap_fault fault_of(float u_of_second, float first_u)
{
    struct scene *scene = two_quads(u_of_second, first_u, 1);
    enum unwrap_fault fault;
    CHECK(unwrap_check(test_host(), &scene->meshes[0], 1, 0.0, &fault));
    scene_destroy(scene);
    return fault;
}

TEST(unwraps_are_checked)
{
    CHECK(fault_of(0.5f, 0.0f) == UNWRAP_VALID);
    CHECK(fault_of(0.3f, 0.0f) == UNWRAP_VALID); // a common edge
    CHECK(fault_of(0.2f, 0.0f) == UNWRAP_OVERLAPS);
    CHECK(fault_of(0.0f, 0.0f) == UNWRAP_OVERLAPS);
    CHECK(fault_of(0.8f, 0.0f) == UNWRAP_OUTSIDE);
    CHECK(fault_of(0.5f, -0.1f) == UNWRAP_OUTSIDE);
    struct scene *scene = two_quads(0.5f, 0.0f, 1);
    enum unwrap_fault fault;
    scene->meshes[0].uv[1][3].x = NAN;
    CHECK(unwrap_check(test_host(), &scene->meshes[0], 1, 0.0, &fault) &&
          fault == UNWRAP_NOT_FINITE);
    for (int v = 0; v < 8; v++) scene->meshes[0].uv[1][v] = (vec2s){ { 0.5f, 0.5f } };
    CHECK(unwrap_check(test_host(), &scene->meshes[0], 1, 0.0, &fault) &&
          fault == UNWRAP_COLLAPSED);
    scene_destroy(scene);
}

// A fifth of the covered texels is covered twice, then a quarter of the surface is collapsed.
TEST(unwraps_may_overlap_and_collapse_within_a_tolerance)
{
    struct scene *scene = two_quads(0.2f, 0.0f, 1);
    struct mesh *mesh = &scene->meshes[0];
    enum unwrap_fault fault;
    CHECK(unwrap_check(test_host(), mesh, 1, 0.19, &fault) && fault == UNWRAP_OVERLAPS);
    CHECK(unwrap_check(test_host(), mesh, 1, 0.21, &fault) && fault == UNWRAP_VALID);
    mesh->uv[1][1] = mesh->uv[1][0];
    CHECK(unwrap_check(test_host(), mesh, 1, 0.24, &fault) && fault == UNWRAP_COLLAPSED);
    CHECK(unwrap_check(test_host(), mesh, 1, 0.26, &fault) && fault == UNWRAP_VALID);
    scene_destroy(scene);
}

static uint32_t unwrapped_charts(float u_of_second, int instances)
{
    struct scene *scene = two_quads(u_of_second, 0.0f, instances);
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 16.0f, .max_texels = 1u << 20 };
    uint32_t unwrapped = 0;
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    test_forget_messages();
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    CHECK(charts.count == 2 * (uint32_t)instances);
    for (uint32_t c = 0; c < charts.count; c++) {
        unwrapped += charts.charts[c].unwrapped;
        CHECK_NEAR(charts.charts[c].width, 16 + 1 + 2 * CHART_GUTTER, 1.0);
    }
    check_rectangles_are_apart(&charts);
    check_texels_lie_on_triangles(&charts);
    charts_finish(&charts);
    close_scene(scene, &pose);
    return unwrapped;
}

TEST(islands_of_a_valid_unwrap_are_charts_of_each_instance)
{
    CHECK(unwrapped_charts(0.5f, 3) == 6);
    CHECK_STRING(test_last_message(), "");
}

TEST(a_broken_unwrap_is_replaced_with_one_warning)
{
    CHECK(unwrapped_charts(0.1f, 3) == 0);
    CHECK(strstr(test_last_message(), "overlaps itself"));
}

// Charts of two quads whose TEXCOORD_0 is a copy of TEXCOORD_1, or of one that overlaps itself,
// without TEXCOORD_1. −1: refused.
static int charts_of_set_0(bool overlaps, enum charts_coordinates coordinates)
{
    struct scene *scene = two_quads(overlaps ? 0.1f : 0.5f, 0.0f, 2);
    struct scene_pose pose;
    struct charts charts;
    const struct charts_options options = { .texels_per_m = 16.0f,
                                            .max_texels = 1u << 20,
                                            .coordinates = coordinates };
    int unwrapped = 0;
    scene->meshes[0].uv[0] = scene->meshes[0].uv[1];
    scene->meshes[0].uv[1] = NULL;
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    test_forget_messages();
    if (!charts_init(&charts, test_host(), &pose, &options)) unwrapped = -1;
    for (uint32_t c = 0; unwrapped >= 0 && c < charts.count; c++)
        unwrapped += charts.charts[c].unwrapped;
    charts_finish(&charts);
    close_scene(scene, &pose);
    return unwrapped;
}

TEST(the_wanted_coordinates_are_kept_or_refused)
{
    CHECK(charts_of_set_0(false, CHARTS_TEXCOORD_0) == 4);
    CHECK(charts_of_set_0(false, CHARTS_TEXCOORD_0_OR_1) == 4);
    CHECK(charts_of_set_0(false, CHARTS_NO_TEXCOORD) == 0);
    CHECK(charts_of_set_0(false, CHARTS_TEXCOORD_1) == 0);
    CHECK(charts_of_set_0(true, CHARTS_TEXCOORD_0_OR_1) == 0);
    CHECK_STRING(test_last_message(), "");
    CHECK(charts_of_set_0(true, CHARTS_TEXCOORD_0) == -1);
    CHECK(strstr(test_last_message(), "TEXCOORD_0 of mesh '") &&
          strstr(test_last_message(), "overlaps itself"));
    CHECK(unwrapped_charts(0.5f, 1) == 2); // TEXCOORD_1 as before
}

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
    const struct mesh mesh = { .vertex_count = 3 * triangles,
                               .index_count = 3 * triangles,
                               .positions = positions,
                               .indices = indices,
                               .material = -1 };
    struct scene *scene = scene_of(&mesh, 1);
    host_free(test_host(), positions);
    host_free(test_host(), indices);
    return scene;
}

TEST(many_separate_triangles_fit_or_are_refused)
{
    struct scene *scene = soup(2000, 1e6f);
    struct scene_pose pose;
    struct charts charts;
    struct charts_options options = { .texels_per_m = 1e3f, .max_texels = 1u << 18 };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    check_rectangles_are_apart(&charts);
    check_texels_lie_on_triangles(&charts);
    charts_finish(&charts);
    options.max_texels = 2000 * 25 - 1; // gutters alone
    CHECK(!charts_init(&charts, test_host(), &pose, &options));
    CHECK(test_host()->failure == FAIL_MEMORY && charts.texels == NULL);
    CHECK(strstr(test_last_message(), "do not fit in 49999 texels; merge meshes"));
    options.atlas_per_texel = 64;
    options.most_texels = 1u << 22;
    options.most_charts = 2000;
    CHECK(!charts_init(&charts, test_host(), &pose, &options));
    const char *remedy = strstr(test_last_message(), "do not fit in 49999 texels; try texels=");
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
    enum { TRIANGLES = 60000, ROOM = 40 * TRIANGLES };
    struct scene *scene = soup(TRIANGLES, 1e-4f);
    struct scene_pose pose;
    struct charts charts;
    struct charts_options options = { .texels_per_m = 1.0f, .max_texels = ROOM };
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    const double begun = processor_s();
    CHECK(charts_init(&charts, test_host(), &pose, &options));
    charts_finish(&charts);
    const double fitted = processor_s();
    options.max_texels = 20 * TRIANGLES;
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
    check_rectangles_are_apart(charts);
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

// ---- texels of both sides

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
