// The border of the image: occluders beyond it are missing, and nothing else changes.
#include "techniques/gtao/gtao_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, SMALL_WIDTH = 64, SMALL_HEIGHT = 32 };
enum { X = (WIDTH - SMALL_WIDTH) / 2, Y = (HEIGHT - SMALL_HEIGHT) / 2 }; // multiples of the pattern
static const float STEP = 1.0f / 255.0f;

static void make_scene(struct frame_fixture *s, struct gpu *gpu, int width, int height)
{
    fixture_init(s, gpu);
    s->width = (uint32_t)width;
    s->height = (uint32_t)height;
    const int matte = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
    fixture_floor(s, 20, matte);
    for (int i = 0; i < 36; i++) {
        const float x = 0.8f * (float)(i % 6) - 2.4f, z = 0.8f * (float)(i / 6) - 3.0f;
        fixture_box(s, vec3_of(x, 0, z), vec3_of(x + 0.4f, 0.3f + 0.1f * (float)(i % 4), z + 0.4f),
                    false, matte);
    }
    fixture_look(s, vec3_of(0.3f, 2.5f, 2.5f), vec3_of(0, 0.2f, 0));
    s->input.camera.vertical_fov_rad =
        2.0f * atanf(tanf(0.5f) * (float)height / (float)HEIGHT); // pixels of the same size
    fixture_open(s);
}

static float *visibility(struct gpu *gpu, const char *options, int width, int height)
{
    struct frame_fixture s;
    make_scene(&s, gpu, width, height);
    float *v = gtao_visibility(&s, options);
    fixture_finish(&s);
    return v;
}

static void compare(struct gpu *gpu, const char *options, int margin)
{
    float *whole = visibility(gpu, options, WIDTH, HEIGHT);
    float *part = visibility(gpu, options, SMALL_WIDTH, SMALL_HEIGHT);
    int brighter = 0, inside = 0, others = 0;
    for (int i = 0; i < SMALL_WIDTH * SMALL_HEIGHT; i++) {
        const int x = i % SMALL_WIDTH, y = i / SMALL_WIDTH;
        const float change = part[i] - whole[(y + Y) * WIDTH + x + X];
        brighter += change > 1.5f * STEP;
        others += change < -1.5f * STEP;
        inside += x >= margin && y >= margin && x < SMALL_WIDTH - margin &&
                  y < SMALL_HEIGHT - margin && fabsf(change) > 1.5f * STEP;
    }
    print_message("%s: %d pixels brighter, %d darker, %d of these inside\n", options, brighter,
                  others, inside);
    // Depths of the two images differ in their last bits: a pixel or two are on another side of an
    // edge.
    CHECK(brighter > 20 && others <= 2 && inside <= 2);
    free(whole);
    free(part);
}

TEST_GPU(the_border_takes_occluders_and_darkens_nothing)
{
    // The radius is at most 12 pixels of both images.
    compare(gpu, "radius=0.4,reach=1,falloff=0.6", 13);
    compare(gpu, "radius=0.4,reach=1,falloff=0,slices=8,steps=8", 13);
    compare(gpu, "radius=0.4,reach=1,bitmask=true", 13);
}
