// Groups of texels whose offsets are the same: a large chart each, and one of all others.
#include "techniques/ort/bake_fixture.h"
#include "techniques/ort/ort_tensors.h"

#include <stdlib.h>

enum { SQUARES = 20 };

// Squares apart from each other, each smaller than the one before.
static void squares(struct ort_fixture *f)
{
    *f = (struct ort_fixture){ 0 };
    fixture_init(&f->s, NULL);
    const int material = fixture_matte(&f->s, vec3_of(0.5f, 0.5f, 0.5f));
    for (int i = 0; i < SQUARES; i++) {
        const float side = 1.0f - 0.04f * (float)i, x = 1.5f * (float)i;
        fixture_quad(&f->s, vec3_of(x, 0, side), vec3_of(x + side, 0, side),
                     vec3_of(x + side, 0, 0), vec3_of(x, 0, 0), material);
    }
}

static void check_each_texel_is_in_one_group(const struct ort_map *map)
{
    int *times = calloc(map->texel_count, sizeof *times);
    assert_non_null(times);
    CHECK(map->first[0] == 0 && map->first[map->group_count] == map->texel_count);
    for (uint32_t g = 0; g < map->group_count; g++) {
        CHECK(map->first[g] < map->first[g + 1]);
        for (uint32_t m = map->first[g]; m < map->first[g + 1]; m++) {
            CHECK(map->group_of[map->members[m]] == g);
            times[map->members[m]]++;
        }
    }
    for (uint32_t i = 0; i < map->texel_count; i++) CHECK(times[i] == 1);
    free(times);
}

// The charts of a group: one, or with the last group all others.
static void check_charts_of_groups(const struct ort_map *map)
{
    int charts[64] = { 0 };
    for (uint32_t c = 0; c < map->charts.count; c++)
        charts[map->group_of[map->charts.charts[c].first_texel]]++;
    for (uint32_t g = 0; g + 1 < map->group_count; g++) {
        CHECK(charts[g] == 1);
        CHECK(map->first[g + 1] - map->first[g] >= map->first[g + 2] - map->first[g + 1] ||
              g + 2 == map->group_count);
    }
    CHECK(charts[map->group_count - 1] == (int)(map->charts.count - map->group_count + 1));
}

static void check_groups(const char *options, uint32_t expected)
{
    struct ort_fixture f;
    squares(&f);
    ort_fixture_open(&f, options);
    CHECK(f.map.charts.count == SQUARES && f.map.group_count == expected);
    check_each_texel_is_in_one_group(&f.map);
    check_charts_of_groups(&f.map);
    ort_fixture_close(&f);
}

TEST(large_charts_have_groups_of_their_own)
{
    check_groups("texels=2048,local=1", 1);
    check_groups("texels=2048,local=16", 16);
    check_groups("texels=2048,local=64", SQUARES);
}

// Distances between squares are beyond the reach of light: all of a row is of its own chart.
TEST(a_bake_has_offsets_for_each_group_and_exact_rows)
{
    struct ort_fixture f;
    squares(&f);
    ort_fixture_open(&f, "texels=1024,rays=16,offsets=50,transfer=scattering,mm_per_unit=100");
    struct ort_baked baked = ort_fixture_bake(&f, "", 0);
    const struct tensor *offsets = tensors_find(baked.tensors, ORT_OFFSETS);
    const struct tensor *energy = tensors_find(baked.tensors, ORT_ENERGY);
    assert_true(offsets && energy);
    CHECK(offsets->shape[0] == 16 && offsets->shape[1] == 50);
    float *light = ort_texel_floats(&f), *got = ort_texel_floats(&f);
    for (uint32_t i = 0; i < 3 * f.map.texel_count; i++) light[i] = 1.0f;
    ort_indirect(&f, &baked, light, got);
    for (uint32_t c = 0; c < 3; c++) {
        double lumen = 0.0;
        for (uint32_t i = 0; i < f.map.texel_count; i++)
            lumen += (double)got[3 * i + c] * (double)chart_texel_of(&f.map.charts, i)->area_m2;
        const double exact = (double)((const float *)energy->data)[3 + c];
        print_message("colour %u: %.4f of %.4f lm\n", c, lumen, exact);
        CHECK_RELATIVE(lumen, exact, 1e-3); // halves
    }
    free(light);
    free(got);
    ort_baked_finish(&baked);
    ort_fixture_close(&f);
}
