// The run time of modular radiance transfer against its matrices, and laws of light.
#include "techniques/mrt/atlas_twin.h"
#include "techniques/mrt/mrt_map_fixture.h"
#include "techniques/mrt/mrt_runtime_fixture.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { K_B = 32, K_R = 24 };

static struct mrt_runtime start(struct gpu *gpu, const struct mrt_runtime_fixture *f, bool half)
{
    struct mrt_runtime runtime;
    CHECK(mrt_runtime_init(&runtime, test_host(), gpu, &f->input,
                           &(struct mrt_runtime_options){ .half = half, .vector = true }));
    return runtime;
}

static float *random_radiosity(const struct mrt_runtime_fixture *f, float scale)
{
    struct rng rng = rng_for(7, 0, 0);
    float *out = malloc((size_t)f->atlas.texels * 3 * sizeof *out);
    for (int i = 0; i < 3 * f->atlas.texels; i++) out[i] = scale * rng_float(&rng);
    return out;
}

static void set_direct(struct mrt_runtime *runtime, const float *radiosity)
{
    const size_t bytes = (size_t)runtime->level.texels * 3 * sizeof *radiosity;
    CHECK(gpu_buffer_upload(runtime->gpu, mrt_buffer(runtime, "mrt_direct"), 0, radiosity, bytes));
}

// `bounces` of the radiosity in the buffer, and the light map.
static void solve_rest(struct mrt_runtime *runtime, int bounces, bool feedback, float rest)
{
    struct gpu_cmd *cmd = gpu_frame_begin(runtime->gpu);
    assert_non_null(cmd);
    mrt_record_bounces(runtime, cmd,
                       &(struct mrt_bounces){ bounces, feedback ? 1.0f : 0.0f, rest });
    mrt_record_light_map(runtime, cmd);
    CHECK(gpu_frame_end(runtime->gpu, cmd));
    CHECK(gpu_wait(runtime->gpu));
}

static void solve(struct mrt_runtime *runtime, int bounces, bool feedback)
{
    solve_rest(runtime, bounces, feedback, 1.0f);
}

static float *read_buffer(struct mrt_runtime *runtime, gpu_buffer buffer, size_t floats)
{
    float *out = malloc(floats * sizeof *out);
    CHECK(gpu_buffer_download(runtime->gpu, buffer, 0, out, floats * sizeof *out));
    return out;
}

static float *read_irradiance(struct mrt_runtime *runtime)
{
    return read_buffer(runtime, mrt_buffer(runtime, "mrt_irradiance"),
                       3 * (size_t)runtime->level.texels);
}

static double relative_error(const float *a, const float *b, size_t count)
{
    double difference = 0.0, size = 0.0;
    for (size_t i = 0; i < count; i++) {
        difference += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
        size += (double)b[i] * (double)b[i];
    }
    CHECK(size > 0.0);
    return sqrt(difference / size);
}

static void expect_matrices(struct gpu *gpu, const struct mrt_runtime_fixture *f, bool half,
                            double tolerance)
{
    struct mrt_runtime runtime = start(gpu, f, half);
    size_t texels = runtime.level.texels;
    float *radiosity = random_radiosity(f, 4.0f);
    set_direct(&runtime, radiosity);
    solve(&runtime, 1, false);
    float *scalar = read_irradiance(&runtime), *expected = mrt_runtime_fixture_solve(f, radiosity);
    float *vector = read_buffer(&runtime, mrt_buffer(&runtime, "mrt_vector"), 12 * texels);
    float *expected_vector = mrt_runtime_fixture_solve_vector(f, radiosity);
    double error = relative_error(scalar, expected, 3 * texels);
    double error_vector = relative_error(vector, expected_vector, 12 * texels);
    print_message("%s: %.1e, by normal %.1e\n", half ? "half" : "float", error, error_vector);
    CHECK(error < tolerance && error_vector < tolerance);
    free(radiosity);
    free(scalar);
    free(expected);
    free(vector);
    free(expected_vector);
    mrt_runtime_finish(&runtime);
}

TEST_GPU(mrt_gpu_equals_the_matrices)
{
    static const int resolutions[] = { 6, 16 };
    for (size_t i = 0; i < 2; i++) {
        struct mrt_runtime_fixture f;
        mrt_runtime_fixture_init(&f, mrt_random_grid(3, 2, 0.8f, true, 3), resolutions[i], K_B, K_R,
                                 vec3_of(0.5f, 0.5f, 0.5f));
        mrt_runtime_fixture_randomize(&f, 11);
        CHECK(f.operators.opening_count > 4);
        expect_matrices(gpu, &f, false, 1e-5);
        expect_matrices(gpu, &f, true, 1e-3);
        mrt_runtime_fixture_finish(&f);
    }
}

TEST_GPU(mrt_gpu_takes_any_number_of_modes)
{
    static const int modes[][2] = { { 12, 12 }, { 5, 7 }, { 64, 64 } };
    for (size_t i = 0; i < 3; i++) {
        struct mrt_runtime_fixture f;
        mrt_runtime_fixture_init(&f, mrt_random_grid(2, 2, 1.0f, true, 5), 6, modes[i][0],
                                 modes[i][1], vec3_of(0.5f, 0.5f, 0.5f));
        mrt_runtime_fixture_randomize(&f, 12);
        expect_matrices(gpu, &f, false, 1e-5);
        mrt_runtime_fixture_finish(&f);
    }
}

TEST_GPU(mrt_light_map_has_the_borders_of_the_level)
{
    struct mrt_runtime_fixture f;
    mrt_runtime_fixture_init(&f, mrt_random_grid(3, 3, 0.7f, true, 2), 8, K_B, K_R,
                             vec3_of(1, 1, 1));
    mrt_runtime_fixture_randomize(&f, 13);
    struct mrt_runtime runtime = start(gpu, &f, false);
    size_t pixels = (size_t)(f.atlas.width * f.atlas.height);
    float *radiosity = random_radiosity(&f, 4.0f);
    set_direct(&runtime, radiosity);
    solve(&runtime, 1, false);
    float *texels = read_irradiance(&runtime);
    float *expected = calloc(3 * pixels, sizeof *expected), *map = calloc(4 * pixels, sizeof *map);
    mrt_atlas_fill(&f.atlas, texels, 3, expected);
    for (int c = 0; c < 3; c++) {
        float most = 0.0f;
        CHECK(gpu_image_download_float(gpu, runtime.light_map, 0, (uint32_t)c, map, 4, 4 * pixels));
        for (size_t i = 0; i < 4 * pixels; i++) most = fmaxf(most, fabsf(map[i]));
        CHECK(most > 0.0f);
        for (size_t i = 0; i < pixels; i++) {
            const float along_normal = 0.5f * (map[4 * i] + map[4 * i + 3]);
            CHECK_NEAR(along_normal, expected[3 * i + (size_t)c], 1e-3 * (double)most);
        }
    }
    free(radiosity);
    free(texels);
    free(expected);
    free(map);
    mrt_runtime_finish(&runtime);
    mrt_runtime_fixture_finish(&f);
}

// Area light of all texels is 1, but of one, which stands for an object amid the block, 1000.
static void light_of_an_object(struct mrt_runtime *runtime, int texel)
{
    const size_t texels = runtime->level.texels;
    struct mrt_gpu_area_light *light = calloc(texels, sizeof *light);
    for (size_t i = 0; i < texels; i++) light[i].irradiance = vec3_of(1, 1, 1);
    light[texel].irradiance = vec3_of(1000, 1000, 1000);
    CHECK(gpu_buffer_upload(runtime->gpu, mrt_buffer(runtime, "mrt_area_light"), 0, light,
                            texels * sizeof *light));
    free(light);
}

TEST_GPU(mrt_walls_behind_an_object_have_the_light_beside_it)
{
    struct mrt_runtime_fixture f;
    const int texel = 27, n = 8;
    mrt_runtime_fixture_init(&f, mrt_one_block(vec3_of(-1, 0, -1), vec3_of(2, 2, 3)), n, K_B, K_R,
                             vec3_of(0.5f, 0.5f, 0.5f));
    f.images.geometry[texel].position = vec3_of(0.5f, 1, 1);
    struct mrt_runtime runtime = start(gpu, &f, false);
    light_of_an_object(&runtime, texel);
    solve(&runtime, 1, false);
    const size_t floats = 4 * (size_t)(f.atlas.width * f.atlas.height);
    float *map = calloc(floats, sizeof *map);
    CHECK(gpu_image_download_float(gpu, runtime.light_map, 0, 0, map, 4, floats));
    const struct mrt_tile *tile = &f.atlas.tiles[0];
    const int at = (tile->y + texel / n) * f.atlas.width + tile->x + texel % n;
    CHECK_NEAR(0.5f * (map[4 * at] + map[4 * at + 3]), 1.0, 1e-3);
    free(map);
    mrt_runtime_finish(&runtime);
    mrt_runtime_fixture_finish(&f);
}

static void closed_cube(struct mrt_runtime_fixture *f, vec3s reflectance)
{
    mrt_runtime_fixture_init(f, mrt_one_block(vec3_of(-1, 0, -1), vec3_of(2, 2, 3)), 8, K_B, K_R,
                             reflectance);
    mrt_runtime_fixture_use_closed_cube(f);
}

TEST_GPU(mrt_closed_cube_equals_the_matrices)
{
    struct mrt_runtime_fixture f;
    closed_cube(&f, vec3_of(0.5f, 0.5f, 0.5f));
    struct mrt_runtime runtime = start(gpu, &f, true);
    float *radiosity = random_radiosity(&f, 100.0f);
    set_direct(&runtime, radiosity);
    solve(&runtime, 1, false);
    float *got = read_irradiance(&runtime), *expected = mrt_runtime_fixture_solve(&f, radiosity);
    double error = relative_error(got, expected, 3 * (size_t)runtime.level.texels);
    print_message("half floats: %.1e of the result\n", error);
    CHECK(error < 1e-3);
    free(radiosity);
    free(got);
    free(expected);
    mrt_runtime_finish(&runtime);
    mrt_runtime_fixture_finish(&f);
}

TEST_GPU(mrt_gives_twice_for_twice_the_light)
{
    struct mrt_runtime_fixture f;
    closed_cube(&f, vec3_of(0.8f, 0.5f, 0.2f));
    struct mrt_runtime runtime = start(gpu, &f, true);
    float *once = random_radiosity(&f, 1.0f), *twice = random_radiosity(&f, 2.0f);
    set_direct(&runtime, once);
    solve(&runtime, 4, false);
    float *one = read_irradiance(&runtime);
    set_direct(&runtime, twice);
    solve(&runtime, 4, false);
    float *two = read_irradiance(&runtime);
    for (size_t i = 0; i < 3 * (size_t)runtime.level.texels; i++) CHECK(two[i] == 2.0f * one[i]);
    free(once);
    free(twice);
    free(one);
    free(two);
    mrt_runtime_finish(&runtime);
    mrt_runtime_fixture_finish(&f);
}

TEST_GPU(mrt_is_black_without_light)
{
    struct mrt_runtime_fixture f;
    closed_cube(&f, vec3_of(1, 1, 1));
    struct mrt_runtime runtime = start(gpu, &f, true);
    float *light = random_radiosity(&f, 1.0f), *dark = random_radiosity(&f, 0.0f);
    set_direct(&runtime, light);
    solve(&runtime, 2, false);
    set_direct(&runtime, dark);
    solve(&runtime, 2, false);
    float *got = read_irradiance(&runtime);
    for (size_t i = 0; i < 3 * (size_t)runtime.level.texels; i++) CHECK(got[i] == 0.0f);
    free(light);
    free(dark);
    free(got);
    mrt_runtime_finish(&runtime);
    mrt_runtime_fixture_finish(&f);
}

// In a closed box of reflectance ρ whose walls send radiosity 1, irradiance after n bounces is
// 1 + ρ + … + ρⁿ⁻¹, and 1/(1 − ρ) in the end.
TEST_GPU(mrt_feedback_converges_to_the_geometric_series)
{
    const float reflectance[3] = { 0.8f, 0.5f, 0.2f };
    struct mrt_runtime_fixture f;
    closed_cube(&f, vec3_of(reflectance[0], reflectance[1], reflectance[2]));
    struct mrt_runtime runtime = start(gpu, &f, true);
    const size_t floats = 3 * (size_t)runtime.level.texels;
    float *radiosity = malloc(floats * sizeof *radiosity);
    for (size_t i = 0; i < floats; i++) radiosity[i] = 1.0f;
    set_direct(&runtime, radiosity);
    double sum[3] = { 0, 0, 0 }, power[3] = { 1, 1, 1 };
    for (int bounce = 1; bounce <= 32; bounce++) {
        solve(&runtime, 1, bounce > 1);
        for (int c = 0; c < 3; c++) {
            sum[c] += power[c];
            power[c] *= (double)reflectance[c];
        }
        if (bounce & (bounce - 1)) continue;
        float *got = read_irradiance(&runtime);
        double worst = 0.0;
        for (size_t i = 0; i < floats; i++)
            worst = fmax(worst, fabs((double)got[i] / sum[i % 3] - 1.0));
        print_message("%2d bounces: %.3f %.3f %.3f, at most %.1f %% from the series\n", bounce,
                      (double)got[0], (double)got[1], (double)got[2], 100.0 * worst);
        CHECK(worst < 0.03);
        free(got);
    }
    free(radiosity);
    mrt_runtime_finish(&runtime);
    mrt_runtime_fixture_finish(&f);
}

// The last power of the series has the weight of all that follow. Eight bounces alone have 0.83 of
// the light.
TEST_GPU(mrt_remainder_completes_the_geometric_series)
{
    const float reflectance = 0.8f;
    struct mrt_runtime_fixture f;
    closed_cube(&f, vec3_of(reflectance, reflectance, reflectance));
    struct mrt_runtime runtime = start(gpu, &f, true);
    const size_t floats = 3 * (size_t)runtime.level.texels;
    float *radiosity = malloc(floats * sizeof *radiosity);
    for (size_t i = 0; i < floats; i++) radiosity[i] = 1.0f;
    set_direct(&runtime, radiosity);
    CHECK_NEAR(runtime.rest, 1 / (1 - (double)reflectance), 1e-3);
    for (int bounces = 2; bounces <= 8; bounces *= 2) {
        solve_rest(&runtime, bounces, false, runtime.rest);
        float *got = read_irradiance(&runtime);
        double worst = 0.0;
        for (size_t i = 0; i < floats; i++)
            worst = fmax(worst, fabs((double)(got[i] * (1.0f - reflectance)) - 1.0));
        print_message("%d bounces: at most %.1f %% from the series\n", bounces, 100.0 * worst);
        CHECK(worst < 0.03);
        free(got);
    }
    free(radiosity);
    mrt_runtime_finish(&runtime);
    mrt_runtime_fixture_finish(&f);
}
