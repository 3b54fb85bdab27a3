// Seams of radiosity: lookups on both sides of the borders of charts, in the light of a uniform
// sky, whose noise is that of the bake's rays.
#include "framework/test.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"
#include "scene/charts/seams.h"
#include "scene/statics.h"
#include "techniques/radiosity/radiosity_tensors.h"

#include <math.h>
#include <string.h>

#define SPEC "radiosity:texels=65536,rays=64,sources=8"

struct baked {
    struct scene *scene;
    struct scene_pose pose;
    struct gi_spec spec;
    struct bake *bake;
    struct scene_statics statics;
    struct radiosity_map map;
};

static void open_baked(struct baked *b, const char *name)
{
    b->scene = scene_load(test_host(), name);
    CHECK(b->scene && pose_init(&b->pose, b->scene, -1, 0.0f));
    CHECK(gi_spec_parse(&b->spec, test_host(), SPEC));
    const struct technique_bake how = { .pose = &b->pose, .options = b->spec.options[0] };
    b->bake = gi_bake_create(test_host(), b->spec.technique[0], &how,
                             (struct bake_identity){ .program = "test" });
    CHECK(b->bake && bake_run(b->bake, &(struct bake_run_options){ .threads = 2 }));
    CHECK(scene_statics_init(&b->statics, test_host(), &b->pose));
    CHECK(radiosity_map_init(&b->map, test_host(), &b->statics.pose, b->spec.options[0]));
}

static void close_baked(struct baked *b)
{
    radiosity_map_finish(&b->map);
    scene_statics_finish(&b->statics);
    bake_destroy(b->bake);
    gi_spec_finish(&b->spec);
    pose_finish(&b->pose);
    scene_destroy(b->scene);
}

static const void *data_of(const struct baked *b, const char *name)
{
    const struct tensor *t = tensors_find(bake_tensors(b->bake), name);
    assert_non_null(t);
    return t->data;
}

// Light of the places of `seams`: of their texels, then as the rows of `closed` have it.
static float *light_of(const struct baked *b, const struct chart_seams *seams,
                       const struct chart_seams *closed)
{
    enum { ENTRIES = CHART_SEAM_ENTRIES, VALUES = 4 };
    const float *sky = data_of(b, LIGHT_MAP_SKY), *weight = data_of(b, LIGHT_MAP_SEAM_WEIGHT);
    const uint32_t *texel = data_of(b, LIGHT_MAP_SEAM_TEXEL);
    const size_t all = 2 * (size_t)b->map.charts.width * b->map.charts.height;
    float *map = host_alloc(test_host(), all, sizeof *map);
    float *light = host_alloc(test_host(), seams->count, sizeof *light);
    for (uint32_t i = 0; i < seams->count; i++)
        map[seams->places[i]] =
            sky[VALUES * chart_texel_of_place(&b->map.charts, seams->places[i])];
    for (uint32_t i = 0; closed && i < closed->count; i++) {
        float sum = 0.0f;
        for (size_t k = 0; k < ENTRIES; k++)
            sum += weight[i * ENTRIES + k] * sky[VALUES * (size_t)texel[i * ENTRIES + k]];
        map[closed->places[i]] = sum;
    }
    for (uint32_t i = 0; i < seams->count; i++) light[i] = map[seams->places[i]];
    host_free(test_host(), map);
    return light;
}

struct difference {
    double mean, border, most; // of all points, of the worst pair of charts, of the worst point
};

static double mean_irradiance(const struct baked *b)
{
    const float *sky = data_of(b, LIGHT_MAP_SKY);
    double sum = 0.0, area = 0.0;
    for (uint32_t i = 0; i < b->map.texel_count; i++) {
        const double a = (double)chart_texel_of(&b->map.charts, i)->area_m2;
        sum += a * (double)sky[4 * (size_t)i];
        area += a;
    }
    return sum / area;
}

// Shares of the mean irradiance.
static struct difference difference_of(const struct baked *b, const struct chart_seams *seams,
                                       const float *light)
{
    const double scale = 1.0 / mean_irradiance(b);
    const struct charts *charts = &b->map.charts;
    double *sum = host_alloc(test_host(), (size_t)charts->count * charts->count, 2 * sizeof *sum);
    struct difference d = { 0 };
    for (uint32_t i = 0; i < seams->point_count; i++) {
        const struct chart_seam_point *p = &seams->points[i];
        double apart = 0.0;
        for (int k = 0; k < CHART_SEAM_PLACES; k++)
            apart += scale * (double)(p->weight[k] * light[p->place[k]]);
        const uint32_t from = charts->triangles[p->triangle[0]].chart;
        const uint32_t to = charts->triangles[p->triangle[1]].chart;
        double *pair =
            sum + 2 * ((size_t)(from < to ? from : to) * charts->count + (from < to ? to : from));
        pair[0] += fabs(apart) * (double)p->length;
        pair[1] += (double)p->length;
        d.most = fmax(d.most, fabs(apart));
    }
    double all[2] = { 0 };
    for (size_t i = 0; i < (size_t)charts->count * charts->count; i++) {
        if (sum[2 * i + 1] > 0.0) d.border = fmax(d.border, sum[2 * i] / sum[2 * i + 1]);
        all[0] += sum[2 * i];
        all[1] += sum[2 * i + 1];
    }
    d.mean = all[0] / all[1];
    host_free(test_host(), sum);
    return d;
}

// Points that the closing does not know: others along the edges.
static void check_seams(const char *name)
{
    struct baked b = { 0 };
    struct chart_seams closed, seams;
    open_baked(&b, name);
    CHECK(charts_seams_init(&closed, &b.map.charts, CHART_SEAM_POINTS));
    CHECK(charts_seams_init(&seams, &b.map.charts, 7.0f));
    CHECK(seams.point_count > 100);
    float *open_light = light_of(&b, &seams, NULL), *light = light_of(&b, &seams, &closed);
    const struct difference before = difference_of(&b, &seams, open_light);
    const struct difference after = difference_of(&b, &seams, light);
    print_message("%s, %u points, %u places: mean difference %.2f %% to %.3f %%, worst border %.2f "
                  "%% to %.3f %%, worst point %.2f %% to %.3f %%\n",
                  name, seams.point_count, closed.count, 100 * before.mean, 100 * after.mean,
                  100 * before.border, 100 * after.border, 100 * before.most, 100 * after.most);
    CHECK(before.border > 0.01);
    CHECK(after.border < 0.01);
    host_free(test_host(), open_light);
    host_free(test_host(), light);
    charts_seams_finish(&closed);
    charts_seams_finish(&seams);
    close_baked(&b);
}

TEST(lookups_on_both_sides_of_seams_are_equal_on_spheres)
{
    check_seams("@spheres");
}

TEST(lookups_on_both_sides_of_seams_are_equal_on_a_scan)
{
    check_seams(test_scene_path("bunny.glb"));
}
