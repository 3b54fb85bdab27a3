// Modular radiance transfer in whole frames.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"
#include "trace/reflectance.h"

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
    snprintf(text, sizeof text, DICTIONARY ",%s", options);
    fixture_open(&room->s);
    room->gi = gi_fixture_light(&room->s, text);
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

// If all walls emit the radiance L and have the reflectance ρ, irradiance is π L / (1 − ρ).
static void check_furnace(struct gpu *gpu, struct material material, vec3s reflectance)
{
    struct room room;
    material.emissive = vec3_of(2, 1, 0.5f);
    room_begin(&room, gpu, &material);
    room_open(&room, "bounces=16");
    float *e = room_end(&room, 1);
    double sum[3] = { 0, 0, 0 }, worst = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        const double expected = 3.14159265 * (double)material.emissive.raw[i % 3] /
                                (1.0 - (double)reflectance.raw[i % 3]);
        sum[i % 3] += (double)e[i] / (FLOATS / 3) / expected;
        worst = fmax(worst, fabs((double)e[i] / expected - 1.0));
    }
    print_message("mean %.3f %.3f %.3f of the series, at most %.1f %% from it\n", sum[0], sum[1],
                  sum[2], 100.0 * worst);
    for (int c = 0; c < 3; c++) CHECK_NEAR(sum[c], 1.0, 0.01);
    CHECK(worst < 0.05);
    free(e);
}

TEST_GPU(mrt_furnace_has_the_radiance_of_the_series)
{
    check_furnace(gpu, matte(0.5f), vec3_of(0.5f, 0.5f, 0.5f));
}

// A metal has no diffuse lobe, and yet sends on what its specular lobe reflects.
TEST_GPU(mrt_furnace_of_metal_has_the_radiance_of_the_series)
{
    const vec3s base = vec3_of(0.7f, 0.5f, 0.3f);
    struct material metal = material_default();
    metal.base_color = vec4_of(base, 1);
    metal.metallic = 1;
    metal.roughness = 0.5f;
    const struct surface surface = { .material = {
                                         .albedo = base, .metallic = 1, .roughness = 0.5f } };
    check_furnace(gpu, metal, surface_reflectance(&surface));
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
    // The first frames are the GPU's.
    for (int frames = 1; frames < 5; frames++) {
        float *cpu_light = point_lit(gpu, light, "bounces=3,vector=false,solver=cpu", frames);
        const double error = difference(cpu_light, gpu_light);
        print_message("cpu against gpu, frame %d: %.1e\n", frames, error);
        CHECK(error < 1e-3);
        free(cpu_light);
    }
    free(gpu_light);
}

enum { MOVES = 12, STANDS_FROM = 7, DELAY = 2 };

// Irradiance of frames in which the light moves, stands still for a while and moves again.
static void moving_light(struct gpu *gpu, const char *options, float *frames[MOVES])
{
    struct room room;
    const struct material material = matte(0.6f);
    room_begin(&room, gpu, &material);
    struct world_light *light = fixture_add_point(&room.s, vec3_of(0, 2, 0), vec3_of(100, 60, 20));
    room_open(&room, options);
    for (int i = 0; i < MOVES; i++) {
        const bool stands = i > 2 && i < STANDS_FROM;
        light->position.x = stands ? 0.5f : 0.25f * (float)i - 1.2f;
        fixture_render(&room.s);
        frames[i] = fixture_read(&room.s, READ_IRRADIANCE);
    }
    gi_destroy(room.gi);
    fixture_finish(&room.s);
}

TEST_GPU(mrt_on_the_cpu_shows_the_light_of_two_frames_ago)
{
    float *on_gpu[MOVES], *on_cpu[MOVES];
    moving_light(gpu, "bounces=3,vector=false,bright=false", on_gpu);
    moving_light(gpu, "bounces=3,vector=false,solver=cpu", on_cpu);
    for (int i = 0; i < MOVES; i++) {
        const double error = difference(on_cpu[i], on_gpu[i < DELAY ? i : i - DELAY]);
        print_message("frame %d: %.1e\n", i, error);
        CHECK(error < 1e-3);
    }
    CHECK(difference(on_gpu[1], on_gpu[0]) > 1e-2);
    for (int i = 0; i < MOVES; i++) {
        free(on_gpu[i]);
        free(on_cpu[i]);
    }
}

TEST_GPU(mrt_feedback_begins_with_the_light_of_many_bounces)
{
    const vec3s light = vec3_of(0.5f, 2, 0.3f);
    static const char *const solvers[] = { "gpu", "cpu,vector=false" };
    float *all = point_lit(gpu, light, "bounces=16", 1);
    for (int i = 0; i < 2; i++)
        for (int frames = 1; frames < 4; frames++) {
            char options[64];
            snprintf(options, sizeof options, "bounces=1,feedback=true,solver=%s", solvers[i]);
            float *e = point_lit(gpu, light, options, frames);
            print_message("%s, %d frames: %.1e from 16 bounces\n", options, frames,
                          difference(e, all));
            CHECK(difference(e, all) < 1e-3);
            free(e);
        }
    free(all);
}

// After the light has moved.
TEST_GPU(mrt_feedback_reaches_the_light_of_many_bounces)
{
    struct room room;
    const struct material material = matte(0.6f);
    const vec3s at = vec3_of(0.5f, 2, 0.3f);
    float *all = point_lit(gpu, at, "bounces=16", 1);
    double before = INFINITY;
    room_begin(&room, gpu, &material);
    struct world_light *light = fixture_add_point(&room.s, vec3_of(-1, 1, 1), vec3_of(300, 0, 0));
    room_open(&room, "bounces=1,feedback=true");
    fixture_render(&room.s);
    light->position = at;
    light->intensity = vec3_of(100, 60, 20);
    for (int i = 1; i <= 16; i++) {
        fixture_render(&room.s);
        if (i != 1 && i != 4 && i != 16) continue;
        float *e = fixture_read(&room.s, READ_IRRADIANCE);
        const double error = difference(e, all);
        print_message("%2d frames: %.1e from 16 bounces\n", i, error);
        CHECK(error < before);
        before = error;
        free(e);
    }
    CHECK(before < 1e-3);
    free(all);
    gi_destroy(room.gi);
    fixture_finish(&room.s);
}

// ---- surfaces inside a block

// A box stands in the middle of the room.
static void room_begin_cluttered(struct room *room, struct gpu *gpu, float walls, float box)
{
    const struct material of_walls = matte(walls), of_box = matte(box);
    room_begin(room, gpu, &of_walls);
    fixture_box(&room->s, vec3_of(-0.3f, 0.6f, -0.7f), vec3_of(0.7f, 1.4f, 0.3f), false,
                fixture_material(&room->s, &of_box));
}

static float *cluttered(struct gpu *gpu, vec3s light, const char *options, int frames)
{
    struct room room;
    room_begin_cluttered(&room, gpu, 0.6f, 0.6f);
    fixture_add_point(&room.s, light, vec3_of(100, 60, 20));
    room_open(&room, options);
    return room_end(&room, frames);
}

// As without the box: whatever a surface sees has the same radiance.
TEST_GPU(mrt_furnace_lights_what_is_inside_a_block)
{
    struct room room;
    struct material material = matte(0.5f);
    material.emissive = vec3_of(2, 1, 0.5f);
    room_begin(&room, gpu, &material);
    fixture_box(&room.s, vec3_of(-0.3f, 0.6f, -0.7f), vec3_of(0.7f, 1.4f, 0.3f), false,
                fixture_material(&room.s, &material));
    room_open(&room, "bounces=16,map=single");
    float *e = room_end(&room, 1);
    double worst = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        const double expected = 3.14159265 * (double)material.emissive.raw[i % 3] / 0.5;
        worst = fmax(worst, fabs((double)e[i] / expected - 1.0));
    }
    print_message("at most %.1f %% from the series\n", 100.0 * worst);
    CHECK(worst < 0.06);
    free(e);
}

// Surfaces inside a block are lit from their own side: the light stands near one wall, and of two
// opposite sides of the box the one that faces this wall receives more.
TEST_GPU(mrt_probes_know_the_side_that_light_comes_from)
{
    double mean[2][2] = { { 0 } };
    for (int turn = 0; turn < 2; turn++) {
        struct room room;
        room_begin_cluttered(&room, gpu, 0.6f, 0.6f);
        fixture_add_spot(&room.s, vec3_of(-0.5f, 1, 0), vec3_of(-1, 0, 0), 0.3f, 0.6f,
                         vec3_of(500, 500, 500));
        fixture_look(&room.s, vec3_of(turn ? 1.9f : -1.9f, 1, -0.2f), vec3_of(0.2f, 1, -0.2f));
        room_open(&room, "bounces=1,map=single");
        float *e = room_end(&room, 1);
        mean[turn][0] = (double)e[3 * (SIZE / 2 * SIZE + SIZE / 2)];
        free(e);
    }
    print_message("side towards the lit wall %.1f, the other %.1f\n", mean[0][0], mean[1][0]);
    CHECK(mean[0][0] > 2.0 * mean[1][0] && mean[1][0] >= 0.0);
}

// Light of one bounce is nowhere twice the flux of the light over the area of the walls.
TEST_GPU(mrt_is_bounded_outside_the_prior)
{
    const vec3s lights[] = {
        vec3_of(-2, 1, 0),         // on a wall
        vec3_of(-1.9999f, 1, 0),   // just before it
        vec3_of(-2.0001f, 1, 0),   // just behind it
        vec3_of(0.2f, 1.4f, 0),    // on the box
        vec3_of(0.2f, 1.4001f, 0), // just above it
        vec3_of(0.2f, 1, 0),       // within it
        vec3_of(40, 1, 3),         // outside of all blocks
    };
    const float albedo[][2] = { { 0.95f, 0.02f }, { 0.02f, 0.95f }, { 0.95f, 0.95f } };
    const double area = 2.0 * (4 * 4 + 4 * 3 + 4 * 3), flux = 4.0 * 3.14159265 * 100.0;
    double worst = 0.0;
    for (size_t i = 0; i < sizeof lights / sizeof *lights; i++)
        for (size_t k = 0; k < 3; k++) {
            struct room room;
            room_begin_cluttered(&room, gpu, albedo[k][0], albedo[k][1]);
            fixture_add_point(&room.s, lights[i], vec3_of(100, 100, 100));
            room_open(&room, "bounces=1,map=single");
            float *e = room_end(&room, 1);
            for (int p = 0; p < FLOATS; p++) {
                CHECK(isfinite(e[p]) && e[p] >= 0.0f);
                worst = fmax(worst, (double)e[p] / (flux / area));
            }
            free(e);
        }
    print_message("irradiance is at most %.1f of flux over area\n", worst);
    CHECK(worst > 0.1 && worst < 2.0);
}

TEST_GPU(mrt_solvers_light_what_is_inside_a_block_alike)
{
    const vec3s light = vec3_of(-1.2f, 2, 1);
    float *gpu_light = cluttered(gpu, light, "bounces=3,vector=false,map=single", 1);
    float *cpu_light = cluttered(gpu, light, "bounces=3,vector=false,map=single,solver=cpu", 4);
    const double error = difference(cpu_light, gpu_light);
    print_message("cpu against gpu: %.1e\n", error);
    CHECK(error < 1e-3);
    free(gpu_light);
    free(cpu_light);
}

// The level stays as it was made: an emitter that moves away leaves its light, and a box that moves
// is lit at its new place by the walls as before.
TEST_GPU(mrt_stays_finite_while_geometry_moves)
{
    struct room room;
    struct material bright = matte(0.5f);
    const struct material walls = matte(0.6f);
    bright.emissive = vec3_of(5, 5, 5);
    room_begin(&room, gpu, &walls);
    const int first = room.s.scene->instance_count;
    fixture_box(&room.s, vec3_of(-0.3f, 0.6f, -0.7f), vec3_of(0.7f, 1.4f, 0.3f), false,
                fixture_material(&room.s, &bright));
    room_open(&room, "bounces=4,map=single");
    fixture_render(&room.s);
    float *before = fixture_read(&room.s, READ_IRRADIANCE);
    for (int step = 1; step <= 4; step++) {
        for (int i = first; i < room.s.scene->instance_count; i++)
            room.s.pose.world_from_node[room.s.scene->instances[i].node] =
                glms_translate(glms_mat4_identity(), vec3_of(0, (float)step, 0));
        fixture_render(&room.s);
    }
    float *after = room_end(&room, 1);
    double mean[2] = { 0 };
    for (int i = 0; i < FLOATS; i++) {
        CHECK(isfinite(after[i]) && after[i] >= 0.0f);
        mean[0] += (double)before[i];
        mean[1] += (double)after[i];
    }
    print_message("mean irradiance %.2f, after the emitter left the room %.2f\n", mean[0] / FLOATS,
                  mean[1] / FLOATS);
    CHECK(mean[1] > 0.5 * mean[0] && mean[1] < 2.0 * mean[0]);
    free(before);
    free(after);
}

// ---- the published volume

TEST_GPU(mrt_publishes_the_irradiance_of_a_furnace)
{
    struct room room;
    struct probe_volume volume;
    struct material material = matte(0.5f);
    material.emissive = vec3_of(2, 2, 2);
    room_begin(&room, gpu, &material);
    room_open(&room, "bounces=16,map=single,probes=true");
    fixture_render(&room.s);
    CHECK(gi_probes(room.gi, &volume));
    const int count[3] = { volume.grid.count_x, volume.grid.count_y, volume.grid.count_z };
    const size_t layer = (size_t)(count[0] * count[1]);
    const struct gpu_image_desc *size = gpu_image_info(gpu, volume.image);
    CHECK((int)size->width == count[0] && (int)size->height == count[1]);
    CHECK((int)size->depth == (FRAME_PROBE_SLABS + 1) * volume.grid.slab && volume.depth.id);
    float *texels = malloc(4 * layer * size->depth * sizeof *texels);
    CHECK(gpu_image_download_float(gpu, volume.image, 0, 0, texels, 4, 4 * layer * size->depth));
    // The constant coefficient of π L / (1 − ρ); linear ones are coefficient 3 and on.
    const double expected = 2.0 * 3.14159265 / 0.5 * sqrt(4.0 * 3.14159265) *
                            (double)frame_radiance_scale(room.s.frame);
    for (size_t i = 0; i < layer * (size_t)count[2]; i++) {
        CHECK_NEAR((double)texels[4 * i] / expected, 1.0, 0.05);
        CHECK(fabs((double)texels[4 * i + 3]) < 0.05 * expected);
        CHECK(texels[4 * (i + FRAME_PROBE_SLABS * layer * (size_t)volume.grid.slab) + 3] == 1);
    }
    free(texels);
    free(room_end(&room, 1));
}
