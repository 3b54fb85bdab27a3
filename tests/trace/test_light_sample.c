// Emitter sampling: distribution by power, and the pdf of directions.
#include "trace/trace_fixture.h"

#include "core/rng.h"
#include "trace/trace_scene.h"

#include <math.h>

enum { PANELS = 3, SIDE = 8, BINS = PANELS * SIDE * SIDE, SAMPLES = 200000 };

// Three emissive panels that face the origin, and a black one.
static const double areas_m2[PANELS] = { 4, 4, 1 };
static const double luminances[PANELS] = { 1, 5, 2 * 0.7152 };

static struct trace_scene *panels(struct trace_fixture *s)
{
    fixture_init(s);
    int dim = fixture_diffuse(s, vec3_of(0, 0, 0), vec3_of(1, 1, 1));
    int bright = fixture_diffuse(s, vec3_of(0, 0, 0), vec3_of(5, 5, 5));
    int green = fixture_diffuse(s, vec3_of(0, 0, 0), vec3_of(0, 2, 0));
    int dark = fixture_diffuse(s, vec3_of(1, 1, 1), vec3_of(0, 0, 0));
    fixture_quad(s, vec3_of(2, -1, -1), vec3_of(2, -1, 1), vec3_of(2, 1, 1), vec3_of(2, 1, -1),
                 dim);
    fixture_quad(s, vec3_of(-1, -3, 1), vec3_of(1, -3, 1), vec3_of(1, -3, -1), vec3_of(-1, -3, -1),
                 dark);
    fixture_quad(s, vec3_of(-2, -1, -1), vec3_of(-2, 1, -1), vec3_of(-2, 1, 1), vec3_of(-2, -1, 1),
                 bright);
    fixture_quad(s, vec3_of(-0.5f, 3, -0.5f), vec3_of(0.5f, 3, -0.5f), vec3_of(0.5f, 3, 0.5f),
                 vec3_of(-0.5f, 3, 0.5f), green);
    assert_true(pose_init(&s->pose, s->scene, -1, 0));
    struct trace_scene *scene = trace_scene_create(test_host(), &s->pose);
    assert_non_null(scene);
    return scene;
}

static double total_power(void)
{
    double total = 0;
    for (int i = 0; i < PANELS; i++) total += areas_m2[i] * luminances[i];
    return total;
}

static struct emitter_sample sample(const struct trace_scene *scene, uint32_t i)
{
    struct rng rng = rng_for(2, i, 9);
    float choice = rng_float(&rng);
    return light_sample_emitter(scene, vec3_of(0, 0, 0), choice, rng_vec2(&rng));
}

static int panel_of(vec3s p)
{
    return p.x > 1.9f ? 0 : p.x < -1.9f ? 1 : 2;
}

static int bin_of(vec3s p)
{
    int panel = panel_of(p);
    float u = panel == 2 ? p.x + 0.5f : 0.5f * (p.y + 1), v = p.z + 0.5f;
    if (panel != 2) v = 0.5f * (p.z + 1);
    int x = (int)fminf(u * SIDE, SIDE - 1), y = (int)fminf(v * SIDE, SIDE - 1);
    return (panel * SIDE + y) * SIDE + x;
}

TEST(points_are_distributed_by_power_and_area)
{
    struct trace_fixture s;
    struct trace_scene *scene = panels(&s);
    int counts[BINS] = { 0 }, chosen[PANELS] = { 0 };
    double chi2 = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        int bin = bin_of(sample(scene, i).position);
        counts[bin]++;
        chosen[bin / (SIDE * SIDE)]++;
    }
    for (int i = 0; i < PANELS; i++) { // 4.5 standard deviations, here and below
        double share = areas_m2[i] * luminances[i] / total_power();
        CHECK_NEAR(chosen[i], SAMPLES * share, 4.5 * sqrt(SAMPLES * share * (1 - share)));
    }
    for (int i = 0; i < BINS; i++) {
        int panel = i / (SIDE * SIDE);
        double share = areas_m2[panel] * luminances[panel] / total_power() / (SIDE * SIDE);
        chi2 += (counts[i] - SAMPLES * share) * (counts[i] - SAMPLES * share) / (SAMPLES * share);
    }
    CHECK(chi2 < BINS - 1 + 4.5 * sqrt(2.0 * (BINS - 1)));
    trace_scene_destroy(scene);
    fixture_finish(&s);
}

// Power per area over all power, as seen from the origin: times the squared distance over the
// cosine at the panel.
TEST(sample_pdf_is_a_density_over_solid_angle)
{
    struct trace_fixture s;
    struct trace_scene *scene = panels(&s);
    for (uint32_t i = 0; i < 1000; i++) {
        struct emitter_sample e = sample(scene, i);
        int panel = panel_of(e.position);
        double distance = (double)glms_vec3_norm(e.position);
        double cosine = (panel == 2 ? 3 : 2) / distance;
        double expected = luminances[panel] / total_power() * distance * distance / cosine;
        CHECK_RELATIVE(e.pdf, expected, 1e-4);
        CHECK_RELATIVE(luminance(e.radiance), luminances[panel], 1e-6);
    }
    trace_scene_destroy(scene);
    fixture_finish(&s);
}

TEST(pdf_of_a_hit_equals_the_pdf_of_a_sample)
{
    struct trace_fixture s;
    struct trace_scene *scene = panels(&s);
    for (uint32_t i = 0; i < 1000; i++) {
        struct emitter_sample e = sample(scene, i);
        struct ray ray = { vec3_of(0, 0, 0), e.to_light, 0, INFINITY };
        struct ray_hit hit;
        assert_true(embree_closest(scene->embree, &ray, NULL, false, &hit));
        vec3s normal = scene->meshes[hit.geometry].facets[hit.triangle].normal;
        float cosine = -glms_vec3_dot(normal, e.to_light);
        float pdf = light_emitter_pdf(scene, hit.geometry, hit.triangle, hit.distance, cosine);
        CHECK_RELATIVE(pdf, e.pdf, 1e-4);
        CHECK(light_emitter_pdf(scene, hit.geometry, hit.triangle, hit.distance, -cosine) == 0);
    }
    struct ray down = { vec3_of(0, 0, 0), vec3_of(0.1f, -1, 0.2f), 0, INFINITY };
    struct ray_hit hit;
    assert_true(embree_closest(scene->embree, &down, NULL, false, &hit));
    CHECK(light_emitter_pdf(scene, hit.geometry, hit.triangle, hit.distance, 1) ==
          0); // not emissive
    trace_scene_destroy(scene);
    fixture_finish(&s);
}
