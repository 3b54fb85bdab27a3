// Modular radiance transfer in whole frames.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/gi_spec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 32, FLOATS = SIZE * SIZE * 3, TEXT = 512 };

#define DICTIONARY                                                                                 \
    "mrt:texels=8,rays=1024,modes=24,lightfield_positions=4,lightfield_directions=6,"              \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=8,"         \
    "block_probes=2"

// A closed room of this albedo, with these options after those of the dictionary.
struct room {
    struct frame_fixture s;
    struct gi *gi;
};

static void room_begin(struct room *room, struct gpu *gpu, const struct material *material)
{
    fixture_init(&room->s, gpu);
    fixture_box(&room->s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
                fixture_material(&room->s, material));
    fixture_look(&room->s, vec3_of(-1.5f, 1.5f, 1.5f), vec3_of(1, 1, -1));
}

static void room_open(struct room *room, const char *options)
{
    char text[TEXT];
    struct gi_spec spec;
    snprintf(text, sizeof text, DICTIONARY ",%s", options);
    fixture_open(&room->s);
    CHECK(gi_spec_parse(&spec, test_host(), text));
    room->gi = gi_fixture_create(room->s.gpu, &spec, &room->s.pose, SIZE, SIZE);
    assert_non_null(room->gi);
    room->s.indirect = gi_hook(room->gi);
    gi_spec_finish(&spec);
}

// Irradiance after some frames; ends the room.
static float *room_end(struct room *room, int frames)
{
    for (int i = 0; i < frames; i++) fixture_render(&room->s);
    float *out = fixture_read(&room->s, READ_IRRADIANCE);
    gi_destroy(room->gi);
    fixture_finish(&room->s);
    return out;
}

static struct material matte(float albedo)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    return m;
}

static float *point_lit(struct gpu *gpu, vec3s position, const char *options, int frames)
{
    struct room room;
    const struct material material = matte(0.6f);
    room_begin(&room, gpu, &material);
    fixture_add_point(&room.s, position, vec3_of(100, 60, 20));
    room_open(&room, options);
    return room_end(&room, frames);
}

// Where all walls emit the radiance L and reflect ρ of what they receive, irradiance is
// π L / (1 − ρ).
TEST_GPU(mrt_furnace_has_the_radiance_of_the_series)
{
    struct room room;
    struct material material = matte(0.5f);
    material.emissive = vec3_of(2, 1, 0.5f);
    room_begin(&room, gpu, &material);
    room_open(&room, "bounces=16");
    float *e = room_end(&room, 1);
    double sum[3] = { 0, 0, 0 }, worst = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        const double expected = 3.14159265 * (double)material.emissive.raw[i % 3] / 0.5;
        sum[i % 3] += (double)e[i] / (FLOATS / 3) / expected;
        worst = fmax(worst, fabs((double)e[i] / expected - 1.0));
    }
    print_message("mean %.3f %.3f %.3f of the series, at most %.1f %% from it\n", sum[0], sum[1],
                  sum[2], 100.0 * worst);
    for (int c = 0; c < 3; c++) CHECK_NEAR(sum[c], 1.0, 0.01);
    CHECK(worst < 0.05);
    free(e);
}

TEST_GPU(mrt_is_finite_with_lights_outside_and_on_walls)
{
    const vec3s positions[] = {
        vec3_of(-2, 1, 0),                // on a wall
        vec3_of(-2, 0, -2),               // in a corner
        vec3_of(1.9999f, 1.5f, 0),        // just before a wall
        vec3_of(2.0001f, 1.5f, 0),        // just behind it
        vec3_of(40, 1, 3),                // outside of all blocks
        vec3_of(-1.75f, 0.1875f, -1.75f), // above the middle of a texel
    };
    for (size_t i = 0; i < sizeof positions / sizeof *positions; i++) {
        float *e = point_lit(gpu, positions[i], "bounces=4", 1);
        for (int k = 0; k < FLOATS; k++) CHECK(isfinite(e[k]) && e[k] >= 0.0f);
        free(e);
    }
}

static double difference(const float *a, const float *b)
{
    double sum = 0.0, size = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
        size += (double)b[i] * (double)b[i];
    }
    CHECK(size > 0.0);
    return sqrt(sum / size);
}

TEST_GPU(mrt_solvers_give_the_same_light)
{
    const vec3s light = vec3_of(0.5f, 2, 0.3f);
    float *gpu_light = point_lit(gpu, light, "bounces=3", 1);
    float *cpu_light = point_lit(gpu, light, "bounces=3,vector=false,solver=cpu", 4);
    const double error = difference(cpu_light, gpu_light);
    print_message("cpu against gpu: %.1e\n", error);
    CHECK(error < 1e-3);
    free(gpu_light);
    free(cpu_light);
}

TEST_GPU(mrt_feedback_reaches_the_light_of_many_bounces)
{
    const vec3s light = vec3_of(0.5f, 2, 0.3f);
    const int frames[] = { 1, 4, 16 };
    float *all = point_lit(gpu, light, "bounces=16", 1);
    double before = INFINITY;
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        float *e = point_lit(gpu, light, "bounces=1,feedback=true", frames[i]);
        const double error = difference(e, all);
        print_message("%2d frames: %.1e from 16 bounces\n", frames[i], error);
        CHECK(error < before);
        before = error;
        free(e);
    }
    CHECK(before < 1e-3);
    free(all);
}
