// Stratified paths: the mean of independent ones with less variance; punctual lights in wide lobes.
#include "trace/path.h"
#include "trace/trace_fixture.h"

#include <math.h>

enum { POINTS = 24, PATHS = 64, SEEDS = 48 };

struct estimates {
    double mean, variance; // of the mean of PATHS, relative to its square; means over the points
    int points;
};

// A white point of the scene's floor, ceiling or walls.
static struct path_start start_at(const struct trace_scene *scene, uint32_t number)
{
    const uint32_t mesh = number % scene->mesh_count;
    const uint32_t triangles = scene->meshes[mesh].mesh->index_count / 3;
    struct path_start start = { .hit = true };
    const uint32_t triangle = number * 7919u % triangles;
    uint32_t corner[3];
    trace_corners(&scene->meshes[mesh], triangle, corner);
    start.surface = (struct surface){
        .position = trace_point(&scene->meshes[mesh], corner, 0.3f, 0.4f),
        .geometric = scene->meshes[mesh].facets[triangle].normal,
        .normal = scene->meshes[mesh].facets[triangle].normal,
        .reach = scene->meshes[mesh].facets[triangle].reach,
        .front = true,
        .material = { .albedo = vec3_of(1, 1, 1), .roughness = 1.0f },
        .mesh = mesh,
        .triangle = triangle,
    };
    start.bsdf = surface_bsdf(&start.surface, start.surface.normal, true);
    return start;
}

static double mean_of_paths(const struct path_settings *settings, const struct path_start *start,
                            uint32_t pixel)
{
    struct path_sample samples[PATHS];
    uint64_t rays = 0;
    double sum = 0.0;
    for (uint32_t i = 0; i < PATHS; i++)
        samples[i] = (struct path_sample){ .start = start, .pixel = pixel, .sample = i };
    path_trace(settings, samples, PATHS, &rays);
    for (int i = 0; i < PATHS; i++)
        sum += (double)luminance(samples[i].light.irradiance_emitters_sky);
    return sum / PATHS;
}

static struct estimates estimate(struct path_settings settings)
{
    struct estimates all = { 0 };
    for (uint32_t k = 0; k < POINTS; k++) {
        const struct path_start start = start_at(settings.scene, k);
        double sum = 0.0, squares = 0.0;
        for (uint32_t seed = 0; seed < SEEDS; seed++) {
            settings.seed = seed;
            const double value = mean_of_paths(&settings, &start, k);
            sum += value / SEEDS;
            squares += value * value / SEEDS;
        }
        if (!(sum > 0.0)) continue; // inside of an object
        all.points++;
        all.mean += sum;
        all.variance += squares / (sum * sum) - 1.0;
    }
    assert_true(all.points >= POINTS / 4);
    all.mean /= all.points;
    all.variance /= all.points;
    return all;
}

static void compare(const struct trace_fixture *f, double most)
{
    struct trace_scene *scene = trace_scene_create(test_host(), &f->pose);
    assert_non_null(scene);
    struct path_settings settings = {
        .scene = scene, .bounces = -1, .direct = true, .indirect = true
    };
    const struct estimates independent = estimate(settings);
    settings.stratified = true;
    const struct estimates stratified = estimate(settings);
    print_message("mean %.4f of that of independent paths, variance %.3f\n",
                  stratified.mean / independent.mean, stratified.variance / independent.variance);
    // Four standard errors of the difference of both means.
    const double error =
        sqrt((independent.variance + stratified.variance) / (stratified.points * SEEDS));
    CHECK_RELATIVE(stratified.mean, independent.mean, 4.0 * error);
    CHECK(stratified.variance < most * independent.variance);
    trace_scene_destroy(scene);
}

TEST(stratified_paths_have_the_same_mean_and_less_variance_under_an_emitter)
{
    struct trace_fixture f;
    fixture_builtin(&f, "@cornell");
    compare(&f, 0.8);
    fixture_finish(&f);
}

TEST(stratified_paths_have_the_same_mean_and_less_variance_in_a_room_open_to_the_sky)
{
    struct trace_fixture f;
    fixture_init(&f);
    const int grey = fixture_diffuse(&f, vec3_of(0.5f, 0.5f, 0.5f), vec3_of(0, 0, 0));
    fixture_quad(&f, vec3_of(-1, 0, 1), vec3_of(1, 0, 1), vec3_of(1, 0, -1), vec3_of(-1, 0, -1),
                 grey);
    fixture_quad(&f, vec3_of(-1, 0, -1), vec3_of(1, 0, -1), vec3_of(1, 3, -1), vec3_of(-1, 3, -1),
                 grey);
    fixture_quad(&f, vec3_of(-1, 0, 1), vec3_of(-1, 0, -1), vec3_of(-1, 3, -1), vec3_of(-1, 3, 1),
                 grey);
    f.scene->environment.sky = vec3_of(1, 1, 1);
    CHECK(pose_init(&f.pose, f.scene, -1, 0));
    compare(&f, 0.5);
    fixture_finish(&f);
}

// A metal floor lit by a sun, a white wall that faces it.
static double light_of_wall(float floor_roughness, float min_roughness, double *largest)
{
    struct trace_fixture f;
    fixture_init(&f);
    struct material metal = material_default();
    metal.metallic = 1.0f;
    metal.roughness = floor_roughness;
    const int material = fixture_material(&f, &metal);
    fixture_quad(&f, vec3_of(-20, 0, 20), vec3_of(20, 0, 20), vec3_of(20, 0, -20),
                 vec3_of(-20, 0, -20), material);
    fixture_light(&f, LIGHT_SUN, vec3_of(0, 0, 0), vec3_of(0, -0.8f, -0.6f), vec3_of(1, 1, 1));
    CHECK(pose_init(&f.pose, f.scene, -1, 0));
    struct trace_scene *scene = trace_scene_create(test_host(), &f.pose);
    assert_non_null(scene);
    const vec3s normal = vec3_of(0, -1, 0);
    struct path_start start = { .hit = true };
    start.surface = (struct surface){ .position = vec3_of(0, 1, 0),
                                      .geometric = normal,
                                      .normal = normal,
                                      .front = true,
                                      .material = { .albedo = vec3_of(1, 1, 1), .roughness = 1 } };
    start.bsdf = surface_bsdf(&start.surface, normal, true);
    struct path_settings settings = { .scene = scene,
                                      .bounces = 1,
                                      .direct = true,
                                      .indirect = true,
                                      .stratified = true,
                                      .min_punctual_roughness = min_roughness };
    double sum = 0.0;
    *largest = 0.0;
    for (uint32_t pixel = 0; pixel < 256; pixel++) {
        const double value = mean_of_paths(&settings, &start, pixel);
        sum += value / 256;
        *largest = fmax(*largest, value);
    }
    trace_scene_destroy(scene);
    fixture_finish(&f);
    return sum;
}

TEST(wide_lobes_of_punctual_lights_keep_the_energy_without_bright_samples)
{
    double largest, largest_wide;
    const double sharp = light_of_wall(0.15f, 0.0f, &largest);
    const double wide = light_of_wall(0.15f, 0.4f, &largest_wide);
    print_message(
        "irradiance of a ceiling by a sun in a metal floor: %.3f lx, %.3f with wide lobes; "
        "largest of 64 paths %.2f and %.2f times the mean\n",
        sharp, wide, largest / sharp, largest_wide / wide);
    CHECK_RELATIVE(wide, sharp, 0.1);
    CHECK(largest_wide / wide < 0.5 * largest / sharp);
    double unused;
    CHECK_RELATIVE(light_of_wall(0.6f, 0.4f, &unused), light_of_wall(0.6f, 0.0f, &unused), 1e-6);
}
