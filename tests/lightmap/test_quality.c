// Figures on the quality of light maps whose faults are known.
#include "lightmap/lightmap_fixture.h"

#include "lightmap/quality/quality.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

static const float TEXELS_PER_M = 3.0f;
enum { SAMPLES = 16 };

// ---- a floor of two quads of 4 × 8 m, which meet at x = 0, and a box

static int add_mesh(struct scene *scene, vec3s *at, uint32_t vertices, uint32_t *indices,
                    uint32_t count, vec3s centre)
{
    struct material material = material_default();
    material.metallic = 0;
    const struct mesh mesh = { .name = "mesh",
                               .positions = at,
                               .vertex_count = vertices,
                               .indices = indices,
                               .index_count = count,
                               .material = scene_add_material(scene, &material) };
    struct node node = node_default();
    node.name = "node";
    node.translation = centre;
    const struct instance instance = { .node = scene_add_node(scene, &node),
                                       .mesh = scene_add_mesh(scene, &mesh),
                                       .skin = -1 };
    return scene_add_instance(scene, &instance);
}

static void add_quad(struct scene *scene, float from, float to)
{
    vec3s at[] = { { { from, 0, -4 } }, { { from, 0, 4 } }, { { to, 0, 4 } }, { { to, 0, -4 } } };
    uint32_t indices[] = { 0, 1, 2, 0, 2, 3 };
    CHECK(add_mesh(scene, at, 4, indices, 6, vec3_of(0, 0, 0)) >= 0);
}

static void add_box(struct scene *scene, vec3s centre, vec3s size)
{
    struct fixture_box box = fixture_box(size, false);
    CHECK(add_mesh(scene, box.at, 24, box.indices, 36, centre) >= 0);
}

static struct scene *create_floor(void)
{
    struct scene *scene = scene_create(test_host(), "floor");
    add_quad(scene, -4, 0);
    add_quad(scene, 0, 4);
    const int node = scene_add_node_looking(scene, "sun", vec3_of(0, 9, 0), vec3_of(1, -1, 0.1f));
    const struct light sun = {
        .name = "sun", .type = LIGHT_SUN, .node = node, .intensity = vec3_of(1000, 1000, 1000)
    };
    CHECK(scene_add_light(scene, &sun) >= 0);
    return scene;
}

// ---- measurements

struct measured {
    struct scene *scene;
    struct scene_pose pose;
    struct bake *bake;
    struct lightmap map;
    struct lightmap_tracing tracing;
    struct seam_closing closing;
    struct lightmap_quality quality;
};

static bool make_charts(const struct scene_pose *statics, const void *options, struct host *host,
                        const struct charts_search *begin, struct charts *out)
{
    (void)options;
    (void)begin;
    return charts_init(
        out, host, statics,
        &(struct charts_options){ .texels_per_m = TEXELS_PER_M, .max_texels = 1 << 20 });
}

// Takes the scene over. The light is in the map, and nothing is measured yet.
static void begin(struct measured *m, struct scene *scene)
{
    const struct bake_identity identity = {
        .technique = LIGHTMAP_NAME, .version = 1, .options = "", .program = "test"
    };
    *m = (struct measured){ .scene = scene, .bake = bake_create(test_host(), &identity) };
    CHECK(pose_init(&m->pose, scene, -1, 0));
    const struct lightmap_bake how = { .pose = &m->pose,
                                       .samples = SAMPLES,
                                       .charts = make_charts };
    struct charts charts;
    CHECK(lightmap_add_stages(bake_plan_of(m->bake), &how, NULL));
    CHECK(bake_run(m->bake, &(struct bake_run_options){ 0 }));
    CHECK(make_charts(&m->pose, NULL, test_host(), NULL, &charts));
    CHECK(lightmap_init(&m->map, &charts, scene));
    CHECK(lightmap_set_paths(&m->map, bake_tensors(m->bake), true, false));
    CHECK(lightmap_tracing_init(&m->tracing, &m->pose, &m->map.charts));
    CHECK(seam_closing_init(&m->closing, test_host(), &m->map.charts, m->tracing.scene.trace));
}

static void measure(struct measured *m)
{
    CHECK(quality_begin(&m->quality, &m->map, &m->closing));
    CHECK(lightmap_close(&m->map, &m->closing));
    CHECK(quality_measure(&m->quality, &m->map, &m->closing, &m->tracing, TEXELS_PER_M));
}

static void end(struct measured *m)
{
    quality_finish(&m->quality);
    seam_closing_finish(&m->closing);
    lightmap_tracing_finish(&m->tracing);
    lightmap_finish(&m->map);
    bake_destroy(m->bake);
    pose_finish(&m->pose);
    scene_destroy(m->scene);
}

// ---- charts

TEST(charts_of_a_flat_floor_have_the_wanted_density_and_no_overlap)
{
    struct measured m;
    begin(&m, create_floor());
    measure(&m);
    const struct lightmap_quality *q = &m.quality;
    assert_int_equal(q->charts.densities[DENSITY_CLASSES / 2].charts, 2);
    CHECK_RELATIVE(q->charts.densities[DENSITY_CLASSES / 2].amount, 64.0, 1e-4);
    CHECK_RELATIVE(q->charts.median, TEXELS_PER_M, 1e-3);
    CHECK_RELATIVE(q->charts.least, TEXELS_PER_M, 1e-3);
    // 12 × 24 texels in each, and those on the border.
    assert_int_equal(q->charts.sizes[8].charts, 2);
    assert_int_equal(q->overlaps.shared, 0);
    assert_int_equal(q->overlaps.folded, 0);
    assert_int_equal(q->filled, 0);
    assert_int_equal(q->leaks.texels, 0);
    end(&m);
}

TEST(texels_of_two_charts_are_counted)
{
    struct measured m;
    begin(&m, create_floor());
    // The second chart is moved onto the first one.
    struct charts *charts = &m.map.charts;
    const struct chart *a = &charts->charts[0], *b = &charts->charts[1];
    for (uint32_t i = 0; i < b->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            vec2s *place = &charts->triangles[b->first_triangle + i].place[k];
            place->x += (float)a->x - (float)b->x;
            place->y += (float)a->y - (float)b->y;
        }
    measure(&m);
    print_message("%u of %u texels\n", m.quality.overlaps.shared, a->texel_count);
    CHECK(m.quality.overlaps.shared > a->texel_count / 2);
    CHECK(m.quality.overlaps.shared <= a->texel_count);
    assert_int_equal(m.quality.overlaps.folded, 0);
    end(&m);
}

TEST(texels_that_two_triangles_of_a_chart_cover_are_counted)
{
    struct measured m;
    begin(&m, create_floor());
    // The second triangle of a quad is put onto the first one.
    struct chart_triangle *t = &m.map.charts.triangles[m.map.charts.charts[0].first_triangle];
    memcpy(t[1].place, t[0].place, sizeof t->place);
    measure(&m);
    CHECK_RELATIVE(m.quality.overlaps.folded, 12 * 24 / 2, 0.1);
    assert_int_equal(m.quality.overlaps.shared, 0);
    end(&m);
}

TEST(texels_below_a_box_are_filled)
{
    struct measured m;
    struct scene *scene = create_floor();
    add_box(scene, vec3_of(2.1667f, 0.5f, 0), vec3_of(2, 2, 2));
    begin(&m, scene);
    measure(&m);
    print_message("%u filled, %u partly\n", m.quality.filled, m.quality.partly);
    // The box's base has 6 × 6 texels, of which its sides halve two columns.
    assert_int_equal(m.quality.filled, 5 * 6);
    assert_int_equal(m.quality.partly, 2 * 6);
    end(&m);
}

// ---- light

static void set_light(struct measured *m, uint32_t chart, float lux)
{
    const struct charts *charts = &m->map.charts;
    for (uint32_t y = 0; y < charts->height; y++)
        for (uint32_t x = 0; x < charts->width; x++) {
            const uint32_t owner = charts->owner[(size_t)y * charts->width + x];
            if (owner == CHART_NONE || chart_triangle_of(charts, owner)->chart != chart) continue;
            float *pixel = image_at(&m->map.irradiance[0], (int)x, (int)y);
            for (int c = 0; c < 3; c++) pixel[c] = lux;
        }
}

TEST(step_of_a_seam_is_known_before_and_after_it_is_closed)
{
    struct measured m;
    begin(&m, create_floor());
    set_light(&m, 0, 100.0f);
    set_light(&m, 1, 200.0f);
    measure(&m);
    const struct quality_seams *seams = &m.quality.seams;
    CHECK_RELATIVE(seams->texels, 8.0 * (double)TEXELS_PER_M, 1e-3);
    CHECK_RELATIVE(seams->unclosed.mean, 0.5, 1e-4);
    CHECK_RELATIVE(seams->unclosed.largest, 0.5, 1e-4);
    CHECK_RELATIVE(seams->unclosed.above, 1.0, 1e-6);
    CHECK(seams->closed.largest < 0.1 && seams->closed.mean <= seams->closed.largest);
    assert_int_equal(seams->worst.count, 1); // one pair of charts
    const struct quality_step *step = &seams->worst.at[0];
    CHECK_NEAR(step->position.x, 0.0, 1e-5);
    CHECK_NEAR(step->before, 0.5, 1e-4);
    CHECK(step->chart[0] == 0 && step->chart[1] == 1);
    end(&m);
}

// A wall of 2 cm at x = 1, from a height on; the sun is on its left.
static void measure_wall(struct measured *m, float above)
{
    struct scene *scene = create_floor();
    add_box(scene, vec3_of(1, above + 1, 0), vec3_of(0.02f, 2, 8));
    begin(m, scene);
    measure(m);
    print_message("wall %g m above the floor: %u texels leak\n", (double)above,
                  m->quality.leaks.texels);
}

TEST(light_beside_a_thin_wall_leaks_and_a_shadow_does_not)
{
    struct measured m;
    measure_wall(&m, 0.0f);
    // A row of 24 texels on each side, or of those whose texels the wall halves.
    CHECK(m.quality.leaks.texels >= 24 && m.quality.leaks.texels <= 3 * 25);
    const struct quality_steps *worst = &m.quality.leaks.worst;
    CHECK(worst->count > 0);
    for (int i = 0; i < worst->count; i++) {
        CHECK_NEAR(worst->at[i].position.x, 1.0, 2.0 / (double)TEXELS_PER_M);
        CHECK(worst->at[i].step >= QUALITY_LEAK_STEP);
    }
    end(&m);
    measure_wall(&m, 0.5f);
    assert_int_equal(m.quality.leaks.texels, 0);
    end(&m);
}

TEST(noise_of_charts_is_that_of_their_paths)
{
    struct measured m;
    struct scene *scene = create_floor();
    scene->environment.sky = vec3_of(100, 100, 100);
    add_box(scene, vec3_of(2, 1, 0), vec3_of(2, 2, 2));
    begin(&m, scene);
    measure(&m);
    const struct quality_noise *noise = &m.quality.noise;
    CHECK(noise->known && noise->count > 0);
    CHECK(noise->worst[0].noise == noise->largest && noise->median <= noise->largest);
    for (int i = 1; i < noise->count; i++)
        CHECK(noise->worst[i].noise <= noise->worst[i - 1].noise);
    // The worst unit again, from the bake's rows.
    const float *rest = fixture_tensor(m.bake, LIGHTMAP_REST);
    const struct chart *chart = &m.map.charts.charts[noise->worst[0].chart];
    double variance = 0.0, light = 0.0, count = 0.0;
    for (uint32_t i = 0; i < noise->worst[0].texels; i++) {
        const size_t row = chart->first_texel + i;
        if (!(rest[LIGHTMAP_COLUMNS * row + LIGHTMAP_SHARE] > 0.0f)) continue;
        variance += (double)rest[LIGHTMAP_COLUMNS * row + LIGHTMAP_VARIANCE];
        light += fixture_luminance(rest, row);
        count += 1.0;
    }
    CHECK_RELATIVE(noise->largest, sqrt(variance / count) / (light / count), 1e-4);
    end(&m);
}

// ---- results

TEST(report_is_json_with_names_and_places)
{
    struct measured m;
    measure_wall(&m, 0.0f);
    struct report *report = report_create(test_host());
    assert_non_null(report);
    quality_report(report, &m.quality, &m.map, m.scene);
    assert_non_null(report_text(report));
    json_t *json = json_loads(report_text(report), 0, NULL);
    assert_non_null(json);
    static const char *const members[] = { "density", "texels", "overlaps", "charts",
                                           "seams",   "leaks",  "noise" };
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        assert_non_null(json_object_get(json, members[i]));
    const json_t *leak =
        json_array_get(json_object_get(json_object_get(json, "leaks"), "worst"), 0);
    const json_t *chart = json_array_get(json_object_get(leak, "charts"), 0);
    CHECK_STRING(json_string_value(json_object_get(chart, "name")), "node");
    CHECK_STRING(json_string_value(json_object_get(chart, "mesh")), "mesh");
    assert_int_equal(json_array_size(json_object_get(leak, "position")), 3);
    json_decref(json);
    report_destroy(report);
    end(&m);
}

TEST(layers_have_values_on_surfaces_alone)
{
    struct measured m;
    measure_wall(&m, 0.0f);
    for (int layer = QUALITY_CHART; layer <= QUALITY_LEAK; layer++) {
        struct image image = { 0 };
        uint32_t texels = 0;
        CHECK(quality_layer(&m.quality, &m.map, (enum quality_layer)layer, LIGHTMAP_FRONT, &image));
        for (size_t i = 0; i < (size_t)image.width * (size_t)image.height; i++)
            texels += isfinite(image.pixels[i]);
        assert_int_equal(texels, m.map.charts.texel_count);
        image_finish(&image, test_host());
    }
    end(&m);
}
