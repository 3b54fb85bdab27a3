// The environment in a frame: its background, its means over lobes, and what a change of it costs.
#include "frame/frame_fixture.h"
#include "scene/environment_fixture.h"

#include "frame/environment_map.h"
#include "frame/frame_shared.h"
#include "frame_test_shaders.h"

#include "core/rng.h"

#include <stdlib.h>

static const float DEGREE = GLM_PIf / 180.0f;

static vec3s gradient(vec3s d)
{
    return vec3_of(1 + 0.5f * d.x, 1 + 0.7f * d.y * d.z, 2 + 0.5f * d.z - d.x * d.y);
}

static vec3s dark_gradient(vec3s d)
{
    return glms_vec3_scale(gradient(d), 1e-3f);
}

// Besides a smooth sky, a window of half-angle 15° whose edge is a degree or so wide.
static vec3s window(vec3s d)
{
    const float angle = acosf(fminf(glms_vec3_dot(d, vec3_of(0.48f, 0.6f, -0.64f)), 1));
    const float inside = fminf(fmaxf(0.5f + (15 * DEGREE - angle) / (2 * DEGREE), 0), 1);
    return glms_vec3_add(gradient(d), vec3_of(10 * inside, 10 * inside, 10 * inside));
}

static struct environment environment_of(int width, fixture_radiance radiance, float rotation_rad,
                                         float strength)
{
    return (struct environment){ .map = fixture_map(width, radiance),
                                 .strength = strength,
                                 .rotation_rad = rotation_rad };
}

// ---- the background

// A camera between all six directions, and a quad behind it.
static void begin(struct frame_fixture *s, struct gpu *gpu, vec3s target)
{
    fixture_init(s, gpu);
    const int material = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
    const vec3s p = glms_vec3_scale(target, -50);
    fixture_quad(s, p, glms_vec3_add(p, vec3_of(0.1f, 0, 0)),
                 glms_vec3_add(p, vec3_of(0.1f, 0.1f, 0.1f)), glms_vec3_add(p, vec3_of(0, 0.1f, 0)),
                 material);
    fixture_look(s, vec3_of(0, 0, 0), target);
    s->input.camera.vertical_fov_rad = 1.9f;
}

static void check_background(struct frame_fixture *s, double tolerance)
{
    fixture_render(s);
    float *got = fixture_read(s, READ_DIRECT);
    for (uint32_t i = 0; i < s->width * s->height; i++) {
        const vec3s d = glms_vec3_normalize(
            fixture_ray(s, (float)(i % s->width) + 0.5f, (float)(i / s->width) + 0.5f));
        const vec3s expected = environment_radiance(&s->input.environment, d);
        for (int c = 0; c < 3; c++)
            CHECK_RELATIVE(got[3 * i + (uint32_t)c], expected.raw[c], tolerance);
    }
    free(got);
}

static const vec3s VIEWS[] = { { { 0.1f, 0.2f, -1 } },
                               { { -1, -0.3f, 0.4f } },
                               { { 0.2f, 1, 0.1f } },
                               { { 0.3f, -1, -0.2f } },
                               { { 1, 0.5f, 0.9f } } };

// Half floats have 11 bits; the smooth map is interpolated twice.
TEST_GPU(the_background_is_the_radiance_along_the_ray_of_the_pixel)
{
    for (size_t i = 0; i < sizeof VIEWS / sizeof *VIEWS; i++) {
        struct frame_fixture s;
        begin(&s, gpu, VIEWS[i]);
        s.input.environment = environment_of(256, gradient, 0, 1);
        fixture_open(&s);
        check_background(&s, 4e-3);
        s.input.environment.rotation_rad = 2.3f;
        check_background(&s, 4e-3);
        s.input.environment.strength = 50;
        s.input.environment.sky = vec3_of(20, 0, 3);
        check_background(&s, 4e-3);
        environment_map_release(s.input.environment.map);
        fixture_finish(&s);
    }
}

TEST_GPU(another_map_or_none_shows_in_the_next_frame)
{
    struct frame_fixture s;
    begin(&s, gpu, VIEWS[0]);
    const struct environment first = environment_of(64, gradient, 1, 1);
    const struct environment second = environment_of(300, dark_gradient, -1, 2);
    const struct environment sky = { .sky = vec3_of(1, 2, 3) };
    const struct environment off = { .map = first.map, .sky = vec3_of(3, 1, 2) };
    fixture_open(&s);
    const struct environment *const order[] = {
        &sky, &first, &second, &off, &first, &sky, &second
    };
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        s.input.environment = *order[i];
        check_background(&s, 6e-3);
    }
    // The frame keeps the map that it shows.
    environment_map_release(first.map);
    environment_map_release(second.map);
    fixture_render(&s);
    fixture_finish(&s);
}

static void render_both(struct frame_fixture *s, struct frame *view, struct frame_input *of_view)
{
    assert_true(frame_prepare(s->frame, &s->input, NULL));
    assert_true(frame_prepare(view, of_view, NULL));
    struct gpu_cmd *cmd = gpu_frame_begin(s->gpu);
    assert_non_null(cmd);
    frame_record_light(s->frame, cmd, &s->input, NULL);
    frame_record_view(s->frame, cmd, &s->input, NULL);
    frame_record_view(view, cmd, of_view, NULL);
    assert_true(gpu_frame_end(s->gpu, cmd));
    assert_true(gpu_wait(s->gpu));
}

TEST_GPU(views_share_the_environment)
{
    struct frame_fixture s;
    const uint32_t client = gpu_client_add(gpu);
    gpu_client_set(gpu, client);
    begin(&s, gpu, VIEWS[0]);
    s.input.environment = environment_of(128, gradient, 0.4f, 3);
    fixture_open(&s);
    struct frame *view = frame_create_view(s.frame);
    assert_non_null(view);
    assert_true(frame_resize(view, s.width, s.height));
    struct frame_input of_view = s.input;
    of_view.camera = camera_look_at(vec3_of(0, 0, 0), vec3_of(0.3f, 0.4f, -1), 1.2f, 0.05f);
    float *seen = calloc((size_t)s.width * s.height * 3, sizeof *seen);
    for (int turn = 0; turn < 2; turn++) {
        of_view.environment = s.input.environment;
        render_both(&s, view, &of_view);
        assert_true(frame_read(view, READ_COLOR, seen, 3));
        struct frame_fixture other = s;
        other.input.camera = of_view.camera;
        for (uint32_t i = 0; i < s.width * s.height; i++) {
            const vec3s d = glms_vec3_normalize(
                fixture_ray(&other, (float)(i % s.width) + 0.5f, (float)(i / s.width) + 0.5f));
            const vec3s expected = environment_radiance(&s.input.environment, d);
            for (int c = 0; c < 3; c++)
                CHECK_RELATIVE(seen[3 * i + (uint32_t)c], expected.raw[c], 6e-3);
        }
        s.input.environment.rotation_rad = 1.4f;
    }
    free(seen);
    frame_destroy(view);
    environment_map_release(s.input.environment.map);
    fixture_finish(&s);
    gpu_client_set(gpu, 0);
    gpu_client_remove(gpu, client);
}

// ---- the cube

static long blocks_asked;

static void *count_reallocate(void *user, void *old, size_t bytes)
{
    (void)user;
    blocks_asked += bytes > 0;
    if (bytes > 0) return realloc(old, bytes);
    free(old);
    return NULL;
}

TEST_GPU(turning_and_dimming_allocate_nothing)
{
    struct host host = { .reallocate = count_reallocate };
    struct frame_environment e;
    struct environment environment = environment_of(64, gradient, 0, 1);
    assert_true(frame_environment_init(&e, &host, gpu));
    assert_true(frame_environment_prepare(&e, &environment));
    const uint32_t cube = e.cube.id;
    const long asked = blocks_asked;
    for (int i = 0; i < 4; i++) {
        struct frame_constants constants = { .radiance_scale = 1 };
        environment.rotation_rad += 1;
        environment.strength *= 0.5f;
        environment.sky.x += 1;
        assert_true(frame_environment_prepare(&e, &environment));
        frame_environment_constants(&e, &environment, &constants);
        CHECK(e.cube.id == cube && blocks_asked == asked);
    }
    const struct environment_map *first = environment.map, *other = fixture_map(32, window);
    environment.map = other;
    assert_true(frame_environment_prepare(&e, &environment));
    CHECK(e.map == other && e.side == 16);
    environment.map = NULL;
    assert_true(frame_environment_prepare(&e, &environment));
    CHECK(!e.map && e.side == 1);
    frame_environment_finish(&e);
    environment_map_release(first);
    environment_map_release(other);
}

// Texels of a level of the cube, 4 floats each, over texel_scale.
static double level_mean(struct gpu *gpu, const struct frame_environment *e, uint32_t mip)
{
    const uint32_t side = e->side >> mip;
    float *texels = calloc((size_t)side * side * 4, sizeof *texels);
    double sum = 0, all = 0;
    assert_non_null(texels);
    for (uint32_t face = 0; face < 6; face++) {
        assert_true(
            gpu_image_download_float(gpu, e->cube, mip, face, texels, 4, (size_t)side * side * 4));
        for (uint32_t i = 0; i < side * side; i++) {
            const double s = (2.0 * (i % side) + 1) / side - 1,
                         t = (2.0 * (i / side) + 1) / side - 1;
            const double solid_angle = pow(1 + s * s + t * t, -1.5);
            sum += solid_angle * (double)texels[4 * i + 1] / (double)e->texel_scale;
            all += solid_angle;
        }
    }
    free(texels);
    return sum / all;
}

// Means over lobes keep the mean over all directions; the last levels have few texels to show it.
TEST_GPU(all_levels_of_the_cube_have_the_mean_radiance)
{
    static const int widths[] = { 16, 256, 2048 };
    for (int i = 0; i < 3; i++) {
        struct frame_environment e;
        const struct environment environment = environment_of(widths[i], window, 0, 1);
        const double mean = (double)environment_mean(&environment).y;
        assert_true(frame_environment_init(&e, test_host(), gpu));
        assert_true(frame_environment_prepare(&e, &environment));
        for (uint32_t mip = 0; e.side >> mip >= 4; mip++) {
            const double got = level_mean(gpu, &e, mip);
            print_message("width %d, side %u: %.4f of the mean\n", widths[i], e.side >> mip,
                          got / mean);
            CHECK_RELATIVE(got, mean, e.side >> mip >= 16 ? 0.01 : 0.03);
        }
        frame_environment_finish(&e);
        environment_map_release(environment.map);
    }
}

// ---- lobes

enum { LOBES = 64 };

struct lobes {
    gpu_pipeline pipeline;
    gpu_buffer lobes, means;
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct lobes *l = user;
    const uint32_t count = LOBES;
    gpu_dispatch(cmd, l->pipeline,
                 GPU_BIND(view->constants_binding, view->environment_binding,
                          { "lobes", .buffer = l->lobes }, { "means", .buffer = l->means }),
                 &count, sizeof count, 1, 1, 1);
}

// Mean over a von Mises–Fisher lobe of sharpness 1/σ², by equal shares of its height.
static vec3s lobe_mean(const struct environment *environment, vec3s direction, float sigma)
{
    enum { RINGS = 64, STEPS = 64 };
    vec3s tangent, bitangent;
    double sum[3] = { 0 };
    basis_of(direction, &tangent, &bitangent);
    const double sharpness = sigma > 0 ? 1.0 / (double)(sigma * sigma) : 0;
    for (int i = 0; i < RINGS * STEPS; i++) {
        const double u = ((double)(i / STEPS) + 0.5) / RINGS;
        const double y = sigma > 0 ? 1 + log(u + (1 - u) * exp(-2 * sharpness)) / sharpness : 1;
        const double r = sqrt(fmax(1 - y * y, 0)),
                     azimuth = 2 * 3.14159265358979 * (i % STEPS) / STEPS;
        vec3s d = glms_vec3_scale(direction, (float)y);
        d = glms_vec3_muladds(tangent, (float)(r * cos(azimuth)), d);
        d = glms_vec3_muladds(bitangent, (float)(r * sin(azimuth)), d);
        const vec3s radiance = environment_radiance(environment, d);
        for (int c = 0; c < 3; c++) sum[c] += (double)radiance.raw[c] / (RINGS * STEPS);
    }
    return vec3_of((float)sum[0], (float)sum[1], (float)sum[2]);
}

// Largest and RMS difference over the peak of the window.
static void check_lobes(struct gpu *gpu, int width, float sigma)
{
    struct frame_fixture s;
    vec4s lobes[LOBES];
    vec3s means[LOBES];
    struct rng rng = rng_for(1, 0, 0);
    struct lobes l = { test_gpu_compute(gpu, &shader_environment_lobes_comp),
                       test_gpu_buffer(gpu, sizeof lobes), test_gpu_buffer(gpu, sizeof means) };
    begin(&s, gpu, VIEWS[0]);
    s.input.environment = environment_of(width, window, 0.8f, 2);
    s.input.environment.sky = vec3_of(1, 0, 0);
    s.indirect = (struct frame_indirect){ .record = record, .user = &l };
    fixture_open(&s);
    const vec3s centre =
        environment_world_direction(&s.input.environment, vec3_of(0.48f, 0.6f, -0.64f));
    for (int i = 0; i < LOBES; i++) { // the first half about the window
        const float spread = i < LOBES / 2 ? 0.5f : 50;
        const vec3s d =
            vec3_of(rng_float(&rng) - 0.5f, rng_float(&rng) - 0.5f, rng_float(&rng) - 0.5f);
        const vec3s towards = glms_vec3_normalize(glms_vec3_muladds(d, spread, centre));
        lobes[i] = vec4_of(glms_vec3_scale(towards, 1 + 3 * rng_float(&rng)), sigma);
    }
    assert_true(gpu_buffer_upload(gpu, l.lobes, 0, lobes, sizeof lobes));
    fixture_render(&s);
    assert_true(gpu_buffer_download(gpu, l.means, 0, means, sizeof means));
    double most = 0, squares = 0;
    for (int i = 0; i < LOBES; i++) {
        const vec3s expected =
            lobe_mean(&s.input.environment, glms_vec3_normalize(vec3_xyz(lobes[i])), sigma);
        for (int c = 0; c < 3; c++) {
            const double got = (double)(means[i].raw[c] / frame_radiance_scale(s.frame));
            const double difference = fabs(got - (double)expected.raw[c]) / (2 * 11);
            most = fmax(most, difference);
            squares += difference * difference / (3 * LOBES);
        }
    }
    print_message("width %d, sigma %.3f: off by %.4f of the peak, RMS %.4f\n", width, (double)sigma,
                  most, sqrt(squares));
    CHECK(most < 0.09 && sqrt(squares) < 0.03);
    gpu_pipeline_destroy(gpu, &l.pipeline);
    gpu_buffer_destroy(gpu, &l.lobes);
    gpu_buffer_destroy(gpu, &l.means);
    environment_map_release(s.input.environment.map);
    fixture_finish(&s);
}

TEST_GPU(lobes_have_the_mean_of_a_quadrature)
{
    static const float sigmas[] = { 0, 0.02f, 0.05f, 0.1f, 0.19634954f, 0.3f, 0.5f, 0.78539816f };
    for (size_t i = 0; i < sizeof sigmas / sizeof *sigmas; i++) check_lobes(gpu, 512, sigmas[i]);
    check_lobes(gpu, 64, 0.25f);
}
