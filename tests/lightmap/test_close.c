// Seams of light maps as files: both charts' lookups along an edge.
#include "lightmap/lightmap_fixture.h"

#include "lightmap/close.h"
#include "lightmap/tracing.h"

#include <math.h>

static const int TEXELS = 4096;

struct closed {
    struct scene *scene;
    struct scene_pose pose;
    struct bake *bake;
    struct lightmap map;
    struct lightmap_tracing tracing;
    struct seam_closing closing;
};

static void open_map(struct closed *c, const char *name, int samples)
{
    struct charts charts;
    *c = (struct closed){ .scene = scene_load(test_host(), name) };
    assert_non_null(c->scene);
    CHECK(pose_init(&c->pose, c->scene, -1, 0));
    c->bake = fixture_bake(
        &(struct fixture_bake){ .pose = &c->pose, .texels = TEXELS, .samples = samples });
    CHECK(fixture_charts(&c->pose, &TEXELS, test_host(), NULL, &charts));
    CHECK(lightmap_init(&c->map, &charts, c->scene));
    CHECK(lightmap_set_paths(&c->map, bake_tensors(c->bake), true, false));
    CHECK(lightmap_tracing_init(&c->tracing, &c->pose, &c->map.charts));
    CHECK(seam_closing_init(&c->closing, test_host(), &c->map.charts, c->tracing.scene.trace));
    CHECK(c->closing.seams.point_count > 100);
}

static void close_map(struct closed *c)
{
    seam_closing_finish(&c->closing);
    lightmap_tracing_finish(&c->tracing);
    lightmap_finish(&c->map);
    bake_destroy(c->bake);
    pose_finish(&c->pose);
    scene_destroy(c->scene);
}

static double light_at(const struct lightmap *map, uint32_t place)
{
    const size_t places = (size_t)map->charts.width * map->charts.height;
    const float *pixel = map->irradiance[place / places].pixels + 3 * (place % places);
    return (double)luminance(vec3_of(pixel[0], pixel[1], pixel[2]));
}

// Root mean square of the differences of lookups along seams.
static double step_of(const struct closed *c)
{
    const struct chart_seams *seams = &c->closing.seams;
    double squares = 0.0, length = 0.0;
    for (uint32_t i = 0; i < seams->point_count; i++) {
        const struct chart_seam_point *p = &seams->points[i];
        double difference = 0.0;
        for (int k = 0; k < CHART_SEAM_PLACES; k++)
            difference += (double)p->weight[k] * light_at(&c->map, seams->places[p->place[k]]);
        squares += (double)p->length * difference * difference;
        length += (double)p->length;
    }
    return sqrt(squares / length);
}

static double mean_light(const struct closed *c)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < c->map.charts.texel_count; i++) {
        const struct chart_texel *t = &c->map.charts.texels[i];
        sum += light_at(&c->map, t->y * c->map.charts.width + t->x);
    }
    return sum / c->map.charts.texel_count;
}

TEST(lookups_on_both_sides_of_a_seam_agree_and_the_light_stays)
{
    struct closed c;
    open_map(&c, "@spheres", 16);
    const double before = step_of(&c), light = mean_light(&c);
    CHECK(lightmap_close(&c.map, &c.closing));
    const double after = step_of(&c);
    print_message("steps of %.3g, then %.3g of the mean light\n", before / light, after / light);
    CHECK(before > 0.02 * light);
    CHECK(after < 0.25 * before);
    CHECK_RELATIVE(mean_light(&c), light, 0.01);
    close_map(&c);
}

TEST(uniform_light_stays)
{
    struct closed c;
    open_map(&c, "@spheres", 1);
    const size_t values = 3 * (size_t)c.map.charts.width * c.map.charts.height;
    for (size_t i = 0; i < values; i++) c.map.irradiance[0].pixels[i] = 7.0f;
    CHECK(lightmap_close(&c.map, &c.closing));
    for (size_t i = 0; i < values; i++) CHECK_NEAR(c.map.irradiance[0].pixels[i], 7.0, 1e-4);
    close_map(&c);
}
