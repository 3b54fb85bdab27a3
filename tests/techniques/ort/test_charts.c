// The light map's coordinates: a scene without usable ones gets charts; those that overlap are
// refused where they are asked for.
#include "techniques/ort/bake_fixture.h"

#include <string.h>

// Coordinates of both halves are the same, or there are none.
static void add_folded(struct frame_fixture *s, bool has_uv)
{
    vec3s positions[8];
    vec2s uv[8];
    uint32_t indices[12] = { 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7 };
    for (int i = 0; i < 8; i++) {
        const float x = i % 4 == 1 || i % 4 == 2, z = i % 4 >= 2;
        positions[i] = vec3_of(x + (i < 4 ? 0.0f : 1.5f), 0, -z);
        uv[i] = (vec2s){ { x, z } };
    }
    const struct mesh mesh = { .name = "folded",
                               .vertex_count = 8,
                               .index_count = 12,
                               .positions = positions,
                               .uv = { has_uv ? uv : NULL },
                               .indices = indices,
                               .material = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f)) };
    const int index = scene_add_mesh(s->scene, &mesh);
    CHECK(index >= 0);
    fixture_instance(s, index, NULL);
}

static bool makes_charts(bool has_uv, enum charts_coordinates coordinates, struct charts *out)
{
    static const char *const TEXTS[] = { [CHARTS_TEXCOORD_0] =
                                             "ort:texels=256,coordinates=texcoord0",
                                         [CHARTS_TEXCOORD_0_OR_1] = "ort:texels=256" };
    struct frame_fixture s;
    struct gi_spec spec;
    fixture_init(&s, NULL);
    add_folded(&s, has_uv);
    CHECK(pose_init(&s.pose, s.scene, -1, 0.0f));
    CHECK(gi_spec_parse(&spec, test_host(), TEXTS[coordinates]));
    const bool ok = ort_charts(&s.pose, spec.options[0], test_host(), NULL, out);
    gi_spec_finish(&spec);
    fixture_finish(&s);
    return ok;
}

TEST(a_scene_without_usable_coordinates_gets_charts)
{
    for (int has_uv = 0; has_uv < 2; has_uv++) {
        struct charts charts;
        CHECK(makes_charts(has_uv, CHARTS_TEXCOORD_0_OR_1, &charts));
        float area = 0.0f;
        for (uint32_t i = 0; i < charts.texel_count; i++) area += charts.texels[i].area_m2;
        print_message("%u charts, %u texels, %.4f m2\n", charts.count, charts.texel_count,
                      (double)area);
        CHECK(charts.count == 2 && !charts.charts[0].unwrapped && charts.texel_count > 128);
        CHECK_RELATIVE(area, 2.0, 1e-4);
        charts_finish(&charts);
    }
}

TEST(overlapping_coordinates_that_are_asked_for_are_refused_by_the_name_of_the_mesh)
{
    struct charts charts;
    CHECK(!makes_charts(true, CHARTS_TEXCOORD_0, &charts));
    print_message("%s\n", test_last_message());
    CHECK(test_host()->failure == FAIL_UNSUPPORTED);
    CHECK(strstr(test_last_message(), "'folded'") && strstr(test_last_message(), "overlaps"));
}
