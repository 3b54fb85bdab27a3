// Irradiance of a fixture's scene by techniques and by the reference.
#include "techniques/trials/light_trial.h"

#include "image/metrics.h"
#include "scene/scene_edit.h"
#include "techniques/baked_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/trials/light_trial_scenes.h"
#include "trace/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct trial_irradiance summary(const float *irradiance, const float *depth, size_t pixels)
{
    struct trial_irradiance sum = { .least = HUGE_VAL };
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!(depth[i] > 0)) continue;
        count++;
        for (size_t c = 0; c < 3; c++) {
            const double e = (double)irradiance[3 * i + c];
            sum.mean[c] += e;
            sum.least = fmin(sum.least, e);
            sum.most = fmax(sum.most, e);
        }
    }
    assert_true(count > 0);
    for (int c = 0; c < 3; c++) sum.mean[c] /= (double)count;
    return sum;
}

struct trial_irradiance trial_technique(struct frame_fixture *s, const char *text)
{
    fixture_open(s);
    struct gi *gi = gi_fixture_light(s, text);
    fixture_render(s);
    float *irradiance = fixture_read(s, READ_IRRADIANCE), *depth = fixture_read(s, READ_DEPTH);
    const struct trial_irradiance result = summary(irradiance, depth, s->width * s->height);
    free(irradiance);
    free(depth);
    gi_destroy(gi);
    return result;
}

float *trial_pixels(struct frame_fixture *s, const char *text)
{
    fixture_open(s);
    struct gi *gi = gi_fixture_light(s, text);
    fixture_render(s);
    float *irradiance = fixture_read(s, READ_IRRADIANCE);
    gi_destroy(gi);
    return irradiance;
}

static void add_to_scene(struct scene *scene, const struct world_light *light)
{
    const bool spot = light->type == LIGHT_SPOT;
    const struct light copy = { .name = "light",
                                .type = light->type,
                                .node = scene_add_node_looking(scene, "light", light->position,
                                                               light->direction),
                                .intensity = light->intensity,
                                .inner_rad = spot ? acosf(light->cos_inner) : 0,
                                .outer_rad = spot ? acosf(light->cos_outer) : GLM_PI_4f,
                                .range_m = light->range_m };
    assert_true(copy.node >= 0 && scene_add_light(scene, &copy) >= 0);
}

// Irradiance, and depth if it is wanted.
static void trace_reference(struct frame_fixture *s, int bounces, int samples,
                            struct image *irradiance, struct image *depth)
{
    for (int i = 0; i < s->input.light_count; i++) add_to_scene(s->scene, &s->lights[i]);
    const struct environment *environment = &s->input.environment;
    s->scene->environment.sky = environment->sky;
    scene_set_environment_map(s->scene, environment->map, environment->strength,
                              environment->rotation_rad);
    assert_true(pose_init(&s->pose, s->scene, -1, 0));
    struct reference_options options = reference_options_default();
    options.bounces = bounces;
    struct reference *reference = reference_create(test_host(), &s->pose, &s->input.camera,
                                                   (int)s->width, (int)s->height, &options);
    assert_non_null(reference);
    assert_true(reference_render(reference, samples, NULL, NULL));
    assert_true(reference_read(reference, REFERENCE_IRRADIANCE_EMITTERS_SKY, irradiance));
    if (depth) assert_true(reference_read(reference, REFERENCE_DEPTH, depth));
    reference_destroy(reference);
}

struct trial_irradiance trial_reference(struct frame_fixture *s, int bounces, int samples)
{
    struct image irradiance, depth;
    trace_reference(s, bounces, samples, &irradiance, &depth);
    const struct trial_irradiance result =
        summary(irradiance.pixels, depth.pixels, s->width * s->height);
    image_finish(&irradiance, test_host());
    image_finish(&depth, test_host());
    return result;
}

static double mean_of(const struct image *image)
{
    const size_t count = 3 * (size_t)image->width * (size_t)image->height;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)image->pixels[i];
    return sum / (double)count;
}

static void scale(struct image *image, double factor)
{
    const size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        image->pixels[i] = fminf((float)(factor * (double)image->pixels[i]), 1.0f);
}

static struct image technique_image(struct gpu *gpu, trial_build build, const char *text)
{
    struct frame_fixture s;
    struct image out;
    build(&s, gpu);
    float *irradiance = trial_pixels(&s, text);
    assert_true(image_init(&out, test_host(), (int)s.width, (int)s.height, 3));
    memcpy(out.pixels, irradiance, 3 * (size_t)s.width * s.height * sizeof *irradiance);
    free(irradiance);
    fixture_finish(&s);
    return out;
}

struct trial_error trial_error_of(struct gpu *gpu, trial_build build, const char *gi, int samples)
{
    static const double DISPLAYED = 0.3;
    struct frame_fixture s;
    struct metrics metrics;
    struct image expected, got = technique_image(gpu, build, gi);
    build(&s, gpu);
    trace_reference(&s, -1, samples, &expected, NULL);
    fixture_finish(&s);
    const double mean = mean_of(&expected);
    struct trial_error error = { .energy = mean_of(&got) / mean };
    scale(&got, DISPLAYED / mean);
    scale(&expected, DISPLAYED / mean);
    assert_true(metrics_compute(test_host(), &got, &expected, NULL, &metrics));
    image_finish(&got, test_host());
    image_finish(&expected, test_host());
    error.flip = metrics.flip;
    return error;
}

static double mean_of_square(const struct image *image, int x0, int y0, int size)
{
    double sum = 0.0;
    for (int y = y0; y < y0 + size; y++)
        for (int x = x0; x < x0 + size; x++) sum += (double)image_at(image, x, y)[1];
    return sum / (size * size);
}

static const double DARK = 0.1; // of the mean

struct trial_squares trial_squares_of(struct gpu *gpu, trial_build build, const char *gi,
                                      int bounces, int samples, int size)
{
    struct frame_fixture s;
    struct image expected, got = technique_image(gpu, build, gi);
    struct trial_squares out = { .least = HUGE_VAL };
    build(&s, gpu);
    trace_reference(&s, bounces, samples, &expected, NULL);
    fixture_finish(&s);
    const double mean = mean_of(&expected);
    for (int y = 0; y + size <= got.height; y += size)
        for (int x = 0; x + size <= got.width; x += size) {
            const double light = mean_of_square(&expected, x, y, size);
            const double share = mean_of_square(&got, x, y, size) / light;
            if (light < DARK * mean) continue;
            out.least = fmin(out.least, share);
            out.most = fmax(out.most, share);
        }
    out.mean = mean_of(&got) / mean;
    image_finish(&got, test_host());
    image_finish(&expected, test_host());
    return out;
}

void trial_check_energy(struct gpu *gpu,
                        void (*build)(struct frame_fixture *s, struct gpu *gpu, bool view),
                        int samples, const struct trial_bounds *bounds, size_t count)
{
    for (int view = 0; view < 2; view++) {
        struct frame_fixture s;
        build(&s, gpu, view);
        const struct trial_irradiance expected = trial_reference(&s, -1, samples);
        fixture_finish(&s);
        for (size_t i = 0; i < count; i++) {
            build(&s, gpu, view);
            const double share = trial_technique(&s, bounds[i].gi).mean[1] / expected.mean[1];
            fixture_finish(&s);
            print_message("%s: view %d: %.3f of the reference's %.3f lux\n", bounds[i].gi, view,
                          share, expected.mean[1]);
            CHECK(share >= bounds[i].least && share <= bounds[i].most);
        }
    }
}

struct trial_irradiance trial_object_irradiance(struct frame_fixture *s, int first)
{
    struct trial_irradiance sum = { .least = HUGE_VAL };
    s->input.want_id_layer = true;
    fixture_render(s);
    float *e = fixture_read(s, READ_IRRADIANCE), *id = fixture_read(s, READ_ID);
    int seen = 0;
    for (size_t p = 0; p < (size_t)s->width * s->height; p++) {
        if ((int)id[2 * p] < first) continue;
        for (int c = 0; c < 3; c++) {
            sum.mean[c] += (double)e[3 * p + (size_t)c];
            sum.least = fmin(sum.least, (double)e[3 * p + (size_t)c]);
            sum.most = fmax(sum.most, (double)e[3 * p + (size_t)c]);
        }
        seen++;
    }
    CHECK(seen > 8);
    for (int c = 0; c < 3; c++) sum.mean[c] /= seen;
    free(e);
    free(id);
    return sum;
}

void trial_object_in_furnace(struct gpu *gpu, const char *gi)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init_furnace(&s, gpu, 0.5f, 10);
    fixture_look(&s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(0.2f, 0.8f, -0.2f));
    const int object =
        trial_add_movable_box(&s, vec3_of(0.2f, 0.8f, -0.2f), 1.2f, fixture_emissive(&s, 0.5f, 0));
    baked_fixture_open(&run, &s, gi);
    const double expected = GLM_PI * 10 / (1 - 0.5);
    const struct trial_irradiance e = trial_object_irradiance(&s, object);
    print_message("object in a furnace: %.4f to %.4f of L/(1 - albedo)\n", e.least / expected,
                  e.most / expected);
    CHECK(e.least > 0.99 * expected && e.most < 1.01 * expected);
    baked_fixture_close(&run, &s);
}

static double difference_at(const float *image, int size, int reach, int x, int y)
{
    double sum = 0;
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++)
            sum += (double)image[3 * ((y + dy) * size + x + dx) + 1];
    const double mean = sum / ((2 * reach + 1) * (2 * reach + 1));
    return (double)image[3 * (y * size + x) + 1] / mean - 1;
}

double trial_mottle(const float *image, int size, int reach)
{
    double squares = 0, count = 0;
    for (int y = reach; y < size - reach; y++)
        for (int x = reach; x < size - reach; x++, count++) {
            const double difference = difference_at(image, size, reach, x, y);
            squares += difference * difference;
        }
    return sqrt(squares / count);
}
