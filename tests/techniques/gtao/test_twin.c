// The shader against a slow version of the definition, over the same G-buffer.
#include "techniques/gtao/gtao_fixture.h"
#include "techniques/gtao/gtao_twin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 64, HEIGHT = 44 };

// A box on a floor before a wall, and a board in the air.
static void make_scene(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->width = WIDTH;
    s->height = HEIGHT;
    const int matte = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
    fixture_floor(s, 20, matte);
    fixture_box(s, vec3_of(-0.6f, 0, -0.4f), vec3_of(0.4f, 0.8f, 0.4f), false, matte);
    fixture_quad(s, vec3_of(-3, 0, -1), vec3_of(3, 0, -1), vec3_of(3, 1.5f, -1),
                 vec3_of(-3, 1.5f, -1), matte);
    fixture_quad(s, vec3_of(0.5f, 0.4f, 0.3f), vec3_of(1.1f, 0.5f, 0.1f), vec3_of(1.1f, 0.9f, 0.1f),
                 vec3_of(0.5f, 0.8f, 0.3f), matte);
    fixture_look(s, vec3_of(0.7f, 1.2f, 1.4f), vec3_of(0.1f, 0.3f, -0.2f));
    fixture_open(s);
}

// Pixels whose sample is rounded to another pixel, or whose sector ends at a sample, differ: few.
static void compare(struct frame_fixture *s, struct gtao_twin twin)
{
    char options[160];
    snprintf(options, sizeof options,
             "slices=%d,steps=%d,radius=%g,reach=%g,falloff=%g,bitmask=%s,thickness=%g",
             twin.slices, twin.steps, (double)twin.radius_m, (double)twin.reach,
             (double)twin.falloff, twin.bitmask ? "true" : "false", (double)twin.thickness_m);
    float *got = gtao_visibility(s, options), *position = fixture_read(s, READ_POSITION),
          *normal = fixture_read(s, READ_NORMAL), *depth = fixture_read(s, READ_DEPTH);
    twin.position = position;
    twin.normal = normal;
    twin.depth = depth;
    double mean = 0.0, occluded = 0.0;
    int surfaces = 0, others = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        if (depth[i] <= 0.0f) continue;
        const double expected = gtao_twin_visibility(&twin, s, i % WIDTH, i / WIDTH);
        const double off = fabs((double)got[i] - expected);
        mean += off;
        occluded += 1.0 - expected;
        others += off > 2.0 / 255.0;
        surfaces++;
    }
    print_message("%s: mean difference %.5f, %d of %d pixels by more than 2/255, occlusion %.3f\n",
                  options, mean / surfaces, others, surfaces, occluded / surfaces);
    CHECK(surfaces > WIDTH * HEIGHT / 2 && occluded > 0.01 * surfaces);
    CHECK(mean < 0.02 * occluded && others < surfaces / 100);
    free(got);
    free(position);
    free(normal);
    free(depth);
}

TEST_GPU(slices_equal_the_slow_version)
{
    static const struct gtao_twin cases[] = {
        { .slices = 2, .steps = 4, .radius_m = 0.5f, .reach = 0.2f, .falloff = 0.6f },
        { .slices = 1, .steps = 8, .radius_m = 1.0f, .reach = 1.0f, .falloff = 0.0f },
        { .slices = 5, .steps = 3, .radius_m = 1.0f, .reach = 0.3f, .falloff = 1.0f },
        { 2, 4, 0.5f, 0.2f, 0.6f, true, 0.25f, NULL, NULL, NULL },
        { 3, 9, 1.0f, 1.0f, 0.0f, true, 0.05f, NULL, NULL, NULL },
        { 1, 5, 0.7f, 0.3f, 0.3f, true, 10.0f, NULL, NULL, NULL },
    };
    struct frame_fixture s;
    make_scene(&s, gpu);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) compare(&s, cases[i]);
    fixture_finish(&s);
}
