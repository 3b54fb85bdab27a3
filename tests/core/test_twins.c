// The GLSL twins sh.glsl and ggx_albedo.glsl, run on the GPU, against C.
#include "framework/gpu_test.h"

#include "core/ggx_albedo.h"
#include "core/rng.h"
#include "core/sampling.h"
#include "core/sh.h"

#include "core_test_shaders.h"

#include <math.h>

enum { COUNT = 200 };

struct twin { // as in core_twins.comp, scalar layout
    float basis[9], lobe[9];
    float value, irradiance;
    vec3s value_rgb, irradiance_rgb;
    vec4s basis4, lobe4;
    float value4, irradiance4;
};
_Static_assert(sizeof(struct twin) == 36 * 4, "scalar layout has no padding");

static vec3s directions[COUNT];
static float coefficients[9];
static struct twin twins[COUNT];

static void fill_inputs(void)
{
    struct rng rng = rng_for(1, 0, 0);
    for (int i = 0; i < COUNT; i++) directions[i] = sample_sphere(rng_vec2(&rng));
    for (int i = 0; i < 9; i++) coefficients[i] = 2.0f * rng_float(&rng) - 1.0f;
}

static gpu_buffer make_buffer(struct gpu *gpu, const char *name, const void *data, size_t bytes)
{
    gpu_buffer buffer = { 0 };
    struct gpu_buffer_desc desc = { name, bytes, GPU_BUFFER_STORAGE };
    CHECK(gpu_buffer_create(gpu, &desc, &buffer));
    CHECK(gpu_buffer_upload(gpu, buffer, 0, data, bytes));
    return buffer;
}

// One invocation for each of COUNT elements; reads the buffer `out` back.
static void run_and_read(struct gpu *gpu, const struct gpu_shader *shader,
                         const struct gpu_binding *bindings, int binding_count, gpu_buffer out,
                         void *data, size_t bytes)
{
    gpu_pipeline pipeline = { 0 };
    CHECK(gpu_compute_pipeline_create(gpu, "test.twins", shader, NULL, 0, &pipeline));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    CHECK(cmd != NULL);
    gpu_dispatch(cmd, pipeline, bindings, binding_count, NULL, 0, gpu_groups(COUNT, 64), 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_buffer_download(gpu, out, 0, data, bytes));
    gpu_pipeline_destroy(gpu, &pipeline);
}

// Runs once per program; `twins` keeps the results.
static void run_shader(struct gpu *gpu)
{
    static bool ran;
    if (ran) return;
    fill_inputs();
    gpu_buffer in = make_buffer(gpu, "test.directions", directions, sizeof directions);
    gpu_buffer c = make_buffer(gpu, "test.coefficients", coefficients, sizeof coefficients);
    gpu_buffer out = make_buffer(gpu, "test.twins", twins, sizeof twins);
    run_and_read(gpu, &shader_core_twins_comp,
                 GPU_BIND({ .name = "Directions", .buffer = in },
                          { .name = "Coefficients", .buffer = c },
                          { .name = "Twins", .buffer = out }),
                 out, twins, sizeof twins);
    gpu_buffer_destroy(gpu, &in);
    gpu_buffer_destroy(gpu, &c);
    gpu_buffer_destroy(gpu, &out);
    ran = true;
}

static void check_floats(const float *a, const float *b, int count)
{
    for (int i = 0; i < count; i++) CHECK_NEAR(a[i], b[i], 3e-6);
}

TEST_GPU(basis_and_clamped_cosine_equal_those_of_c)
{
    run_shader(gpu);
    float zonal[3];
    zh_clamped_cosine(3, zonal);
    for (int i = 0; i < COUNT; i++) {
        float basis[9], lobe[9];
        sh_eval(3, directions[i], basis);
        zh_rotate(3, zonal, directions[i], lobe);
        check_floats(twins[i].basis, basis, 9);
        check_floats(twins[i].lobe, lobe, 9);
        check_floats(twins[i].basis4.raw, basis, 4);
        check_floats(twins[i].lobe4.raw, lobe, 4);
    }
}

TEST_GPU(evaluation_and_irradiance_equal_those_of_c)
{
    run_shader(gpu);
    float irradiance[9];
    sh_irradiance(3, coefficients, irradiance);
    for (int i = 0; i < COUNT; i++) {
        static const float rgb[3] = { 1.0f, 2.0f, -3.0f };
        float value = sh_dot(3, coefficients, directions[i]);
        float e = sh_dot(3, irradiance, directions[i]);
        CHECK_NEAR(twins[i].value, value, 3e-6);
        CHECK_NEAR(twins[i].irradiance, e, 1e-5);
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(twins[i].value_rgb.raw[k], rgb[k] * value, 1e-5);
            CHECK_NEAR(twins[i].irradiance_rgb.raw[k], rgb[k] * e, 3e-5);
        }
        CHECK_NEAR(twins[i].value4, sh_dot(2, coefficients, directions[i]), 3e-6);
        CHECK_NEAR(twins[i].irradiance4, sh_dot(2, irradiance, directions[i]), 1e-5);
    }
}

// A and B averaged over the cosine-weighted hemisphere, ∫ E d(μ²), by the table.
static void mean_albedo(float roughness, double out[2])
{
    enum { STEPS = 2000 };
    out[0] = out[1] = 0;
    for (int i = 0; i < STEPS; i++) {
        const struct ggx_albedo e = ggx_albedo_at(sqrtf(((float)i + 0.5f) / STEPS), roughness);
        out[0] += (double)e.a / STEPS;
        out[1] += (double)e.b / STEPS;
    }
}

static gpu_image make_ggx_table(struct gpu *gpu)
{
    static struct ggx_albedo_texel texels[GGX_ALBEDO_SIZE * GGX_ALBEDO_SIZE];
    const struct gpu_image_desc desc = { .name = "test.table",
                                         .format = GPU_RGBA32U,
                                         .width = GGX_ALBEDO_SIZE,
                                         .height = GGX_ALBEDO_SIZE,
                                         .usage = GPU_STORAGE };
    gpu_image table = { 0 };
    for (int i = 0; i < GGX_ALBEDO_SIZE * GGX_ALBEDO_SIZE; i++)
        texels[i] = ggx_albedo_texel(i % GGX_ALBEDO_SIZE, i / GGX_ALBEDO_SIZE);
    CHECK(gpu_image_create(gpu, &desc, &table));
    CHECK(gpu_image_upload(gpu, table, 0, 0, texels, sizeof texels));
    return table;
}

TEST_GPU(albedo_of_ggx_equals_that_of_c_and_its_mean_fits)
{
    static vec2s places[COUNT];
    static vec4s albedos[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        struct rng rng = rng_for(2, i, 0);
        const float u = rng_float(&rng);
        places[i].x = i == 0 ? 0.0f : i == 1 ? 1.0f : u * u;
        places[i].y = i < 2 ? (i ? 1.0f : GGX_MIN_ROUGHNESS)
                            : GGX_MIN_ROUGHNESS + (1.0f - GGX_MIN_ROUGHNESS) * rng_float(&rng);
    }
    gpu_image table = make_ggx_table(gpu);
    gpu_buffer in = make_buffer(gpu, "test.places", places, sizeof places);
    gpu_buffer out = make_buffer(gpu, "test.albedos", albedos, sizeof albedos);
    run_and_read(gpu, &shader_core_ggx_albedo_comp,
                 GPU_BIND({ .name = "ggx_albedo", .image = table },
                          { .name = "Places", .buffer = in }, { .name = "Albedos", .buffer = out }),
                 out, albedos, sizeof albedos);
    for (int i = 0; i < COUNT; i++) {
        const struct ggx_albedo e = ggx_albedo_at(places[i].x, places[i].y);
        double mean[2];
        mean_albedo(places[i].y, mean);
        CHECK_NEAR(albedos[i].x, e.a, 2e-5);
        CHECK_NEAR(albedos[i].y, e.b, 2e-5);
        CHECK_NEAR(albedos[i].z, mean[0], 1e-3);
        CHECK_NEAR(albedos[i].w, mean[1], 1e-3);
    }
    gpu_image_destroy(gpu, &table);
    gpu_buffer_destroy(gpu, &in);
    gpu_buffer_destroy(gpu, &out);
}
