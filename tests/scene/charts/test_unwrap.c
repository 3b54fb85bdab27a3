// Unwraps of a file: valid ones are charts, others are refused or replaced.
#include "scene/charts/charts_fixture.h"

#include "scene/charts/unwrap.h"

#include <math.h>
#include <string.h>

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
    check_gutters_are_own(&charts);
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
