// Paths shared by receivers: the mean of paths of their own, with less variance.
#include "trace/share.h"
#include "trace/trace_fixture.h"

#include <math.h>

enum { RECEIVERS = 8, PATHS = 8, SEEDS = 4096 };

// White points in a row on a quad's plane, whose normal is up.
static void place(vec3s first, vec3s step, struct path_start starts[RECEIVERS])
{
    for (int i = 0; i < RECEIVERS; i++) {
        starts[i] = (struct path_start){ .hit = true };
        starts[i].surface = (struct surface){
            .position = glms_vec3_muladds(step, (float)i, first),
            .geometric = vec3_of(0, 1, 0),
            .normal = vec3_of(0, 1, 0),
            .reach = 1e-5f,
            .front = true,
            .material = { .albedo = vec3_of(1, 1, 1), .roughness = 1.0f },
        };
        starts[i].bsdf = surface_bsdf(&starts[i].surface, vec3_of(0, 1, 0), true);
    }
}

struct estimates {
    double mean[RECEIVERS], squares[RECEIVERS];
};

static void add_seed(const struct path_settings *settings, const struct path_start *starts,
                     bool shared, struct estimates *out)
{
    struct path_sample samples[RECEIVERS];
    struct path_end ends[RECEIVERS];
    const struct path_start *at[RECEIVERS];
    double sum[RECEIVERS] = { 0 };
    uint64_t rays = 0;
    for (uint32_t k = 0; k < PATHS; k++) {
        vec3s light[RECEIVERS];
        for (uint32_t i = 0; i < RECEIVERS; i++) {
            at[i] = &starts[i];
            ends[i] = (struct path_end){ .pixel = 99, .sample = PATHS * i + k, .directions = 3.0f };
            samples[i] = (struct path_sample){
                .start = &starts[i], .pixel = i, .sample = k, .end = shared ? &ends[i] : NULL
            };
        }
        path_trace(settings, samples, RECEIVERS, &rays);
        for (int i = 0; i < RECEIVERS; i++) light[i] = samples[i].light.irradiance_emitters_sky;
        for (int i = 0; shared && i < RECEIVERS; i++)
            path_share(settings, at, RECEIVERS, i, &ends[i], light, &rays);
        for (int i = 0; i < RECEIVERS; i++) sum[i] += (double)luminance(light[i]) / PATHS;
    }
    for (int i = 0; i < RECEIVERS; i++) {
        out->mean[i] += sum[i] / SEEDS;
        out->squares[i] += sum[i] * sum[i] / SEEDS;
    }
}

// Each receiver's mean is within four standard errors. The variance, in the mean, is at most
// `most` of that of paths that are not shared.
static void compare(const struct trace_fixture *f, vec3s first, vec3s step, float roughness,
                    double most)
{
    struct trace_scene *scene = trace_scene_create(test_host(), &f->pose);
    assert_non_null(scene);
    struct path_start starts[RECEIVERS];
    struct estimates own = { 0 }, shared = { 0 };
    struct path_settings settings = { .scene = scene,
                                      .bounces = -1,
                                      .direct = true,
                                      .indirect = true,
                                      .stratified = true,
                                      .min_punctual_roughness = roughness };
    place(first, step, starts);
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        settings.seed = seed;
        add_seed(&settings, starts, false, &own);
        settings.seed = SEEDS + seed;
        add_seed(&settings, starts, true, &shared);
    }
    double variance[2] = { 0 };
    for (int i = 0; i < RECEIVERS; i++) {
        const double a = own.squares[i] - own.mean[i] * own.mean[i];
        const double b = shared.squares[i] - shared.mean[i] * shared.mean[i];
        print_message("receiver %d: %.5f of the light, %.3f of the variance\n", i,
                      shared.mean[i] / own.mean[i], b / a);
        CHECK(own.mean[i] > 0.0);
        CHECK_NEAR(shared.mean[i], own.mean[i], 4.0 * sqrt((a + b) / SEEDS));
        variance[0] += a;
        variance[1] += b;
    }
    CHECK(variance[1] < most * variance[0]);
    trace_scene_destroy(scene);
}

// A floor below a wall, a part of which is an emitter, and a ceiling; grey, or glossy.
static void add_room(struct trace_fixture *f, int material, vec3s emission)
{
    const int bright = fixture_diffuse(f, vec3_of(0.5f, 0.5f, 0.5f), emission);
    fixture_quad(f, vec3_of(-2, 0, 2), vec3_of(2, 0, 2), vec3_of(2, 0, -2), vec3_of(-2, 0, -2),
                 material);
    fixture_quad(f, vec3_of(-2, 0, -1), vec3_of(2, 0, -1), vec3_of(2, 2, -1), vec3_of(-2, 2, -1),
                 material);
    fixture_quad(f, vec3_of(-2, 2, -1), vec3_of(2, 2, -1), vec3_of(2, 2, 1), vec3_of(-2, 2, 1),
                 material);
    fixture_quad(f, vec3_of(-0.5f, 0.5f, -0.9f), vec3_of(0.5f, 0.5f, -0.9f),
                 vec3_of(0.5f, 1, -0.9f), vec3_of(-0.5f, 1, -0.9f), bright);
}

TEST(shared_paths_under_an_emitter_have_the_same_mean)
{
    struct trace_fixture f;
    fixture_init(&f);
    add_room(&f, fixture_diffuse(&f, vec3_of(0.6f, 0.6f, 0.6f), vec3_of(0, 0, 0)),
             vec3_of(10, 10, 10));
    CHECK(pose_init(&f.pose, f.scene, -1, 0));
    compare(&f, vec3_of(-0.3f, 0, -0.3f), vec3_of(0.1f, 0, 0), 0.0f, 0.8);
    fixture_finish(&f);
}

// Some receivers are in the corner, where densities differ by orders of magnitude.
TEST(shared_paths_into_a_corner_have_the_same_mean)
{
    struct trace_fixture f;
    fixture_init(&f);
    add_room(&f, fixture_diffuse(&f, vec3_of(0.6f, 0.6f, 0.6f), vec3_of(0, 0, 0)),
             vec3_of(0, 0, 0));
    f.scene->environment.sky = vec3_of(1, 1, 1);
    fixture_light(&f, LIGHT_SUN, vec3_of(0, 0, 0), vec3_of(0.3f, -1, -0.8f), vec3_of(5, 5, 5));
    CHECK(pose_init(&f.pose, f.scene, -1, 0));
    compare(&f, vec3_of(0, 0, -0.99f), vec3_of(0, 0, 0.1f), 0.4f, 0.5);
    fixture_finish(&f);
}

TEST(shared_paths_among_glossy_surfaces_have_the_same_mean)
{
    struct trace_fixture f;
    struct material glossy = material_default();
    glossy.base_color = vec4_of(vec3_of(0.6f, 0.5f, 0.4f), 1);
    glossy.metallic = 0.3f;
    glossy.roughness = 0.3f;
    fixture_init(&f);
    add_room(&f, fixture_material(&f, &glossy), vec3_of(10, 10, 10));
    f.scene->environment.sky = vec3_of(1, 1, 1);
    fixture_light(&f, LIGHT_SUN, vec3_of(0, 0, 0), vec3_of(0.3f, -1, -0.8f), vec3_of(5, 5, 5));
    CHECK(pose_init(&f.pose, f.scene, -1, 0));
    compare(&f, vec3_of(-0.3f, 0, -0.5f), vec3_of(0.1f, 0, 0), 0.4f, 0.9);
    fixture_finish(&f);
}
