// Direct light and surfaces of the real-time frame against the reference.
#include "frame/frame_fixture.h"
#include "trace/trace.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 128, HEIGHT = 72, PIXELS = WIDTH * HEIGHT };

// Changes a scene's materials after loading; NULL: unchanged.
typedef void change_scene(struct scene *scene);

static float *frame_layer_of(struct gpu *gpu, const char *name, change_scene *change,
                             enum frame_readback what)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    scene_destroy(s.scene);
    s.scene = scene_load(test_host(), name);
    assert_non_null(s.scene);
    if (change) change(s.scene);
    s.options.shadow_size = 1024;
    s.width = WIDTH;
    s.height = HEIGHT;
    fixture_open(&s);
    s.input.camera = pose_camera(&s.pose, 0);
    s.input.environment.sky = s.scene->environment.sky;
    for (int i = 0; i < s.scene->light_count; i++)
        s.lights[s.input.light_count++] = pose_light(&s.pose, i);
    fixture_render(&s);
    float *pixels = fixture_read(&s, what);
    fixture_finish(&s);
    return pixels;
}

static struct image reference_layer_of(const char *name, change_scene *change,
                                       enum reference_layer layer)
{
    struct scene *scene = scene_load(test_host(), name);
    struct scene_pose pose;
    assert_non_null(scene);
    if (change) change(scene);
    assert_true(pose_init(&pose, scene, scene->animation_count ? 0 : -1, 0));
    struct world_camera camera = pose_camera(&pose, 0);
    struct reference_options options = reference_options_default();
    options.bounces = 0;
    struct reference *r = reference_create(test_host(), &pose, &camera, WIDTH, HEIGHT, &options);
    struct image image = { 0 };
    assert_non_null(r);
    assert_true(reference_render(r, 1, NULL, NULL));
    assert_true(reference_read(r, layer, &image));
    reference_destroy(r);
    pose_finish(&pose);
    scene_destroy(scene);
    return image;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Sorted relative differences of pixels that are not black in both; returns their number.
static int differences(struct gpu *gpu, const char *name, change_scene *change,
                       enum frame_readback what, enum reference_layer layer, double out[PIXELS])
{
    float *frame = frame_layer_of(gpu, name, change, what);
    struct image reference = reference_layer_of(name, change, layer);
    int count = 0, channels = reference.channels;
    for (int i = 0; i < PIXELS; i++) {
        double difference = 0, size = 0;
        for (int c = 0; c < channels; c++) {
            double a = (double)frame[i * channels + c],
                   b = (double)reference.pixels[i * channels + c];
            difference += fabs(a - b);
            size += fmax(fabs(a), fabs(b));
        }
        if (size > 0) out[count++] = difference / size;
    }
    qsort(out, (size_t)count, sizeof *out, compare);
    image_finish(&reference, test_host());
    free(frame);
    return count;
}

TEST_GPU(direct_light_of_the_frame_equals_the_reference)
{
    static double d[PIXELS];
    int count = differences(gpu, "@cornell:light=point", NULL, READ_DIRECT, REFERENCE_DIRECT, d);
    CHECK(count > PIXELS / 4);
    // Errors of half floats, 8-bit albedo and approximate sRGB decoding; the last tenth are edges.
    CHECK(d[count / 2] < 0.007);
    CHECK(d[count * 9 / 10] < 0.01);
}

static void change_materials(struct scene *scene)
{
    for (int i = 0; i < scene->material_count; i++) {
        struct material *m = &scene->materials[i];
        m->ior = 1.2f + 0.3f * (float)(i % 3);
        m->specular = i % 4 == 0 ? 0.0f : 0.8f;
        m->specular_color = vec3_of(1, 0.6f, 0.3f);
        m->roughness = 0.3f + 0.2f * (float)(i % 3);
        m->metallic = i % 5 == 4 ? 0.7f : 0.0f;
        m->unlit = i % 6 == 5;
    }
}

TEST_GPU(specular_ior_and_unlit_of_the_frame_equal_the_reference)
{
    static double d[PIXELS];
    int count = differences(gpu, "@cornell:light=point", change_materials, READ_DIRECT,
                            REFERENCE_DIRECT, d);
    CHECK(count > PIXELS / 4);
    CHECK(d[count / 2] < 0.007);
    CHECK(d[count * 9 / 10] < 0.015);
    print_message("median %.4f, nine in ten %.4f\n", d[count / 2], d[count * 9 / 10]);
}

TEST_GPU(surfaces_of_the_frame_equal_the_reference)
{
    static const struct {
        const char *scene;
        enum frame_readback what;
        enum reference_layer layer;
        double tolerance; // of nine pixels in ten
    } cases[] = {
        { "@cornell:light=point", READ_DEPTH, REFERENCE_DEPTH, 1e-4 },
        { "@cornell:light=point", READ_NORMAL, REFERENCE_NORMAL, 2e-3 },
        { "@cornell:light=point", READ_POSITION, REFERENCE_POSITION, 1e-3 },
        { "@cornell:light=point", READ_ALBEDO, REFERENCE_ALBEDO, 0.01 },
        { "@atrium", READ_DEPTH, REFERENCE_DEPTH, 1e-4 },
        // Software drivers filter mips in 8 bits: errors up to 4/255 in a normal map.
        { "@atrium", READ_NORMAL, REFERENCE_NORMAL, 0.06 },
        { "@atrium", READ_ALBEDO, REFERENCE_ALBEDO, 0.05 },
    };
    static double d[PIXELS];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        int count = differences(gpu, cases[i].scene, NULL, cases[i].what, cases[i].layer, d);
        CHECK(count > PIXELS / 4);
        CHECK_NEAR(d[count * 9 / 10], 0, cases[i].tolerance);
    }
}
