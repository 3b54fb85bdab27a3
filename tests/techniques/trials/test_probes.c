// Physical trial of dynamic objects beside a thin wall: what they get of the light on its other
// side, in pixels and of published probe volumes.
//
// The two rooms of trial_two_rooms and a box, one side parallel to the wall of 5 cm. The figure is
// the mean irradiance of the box in the dark room over that of the same box, mirrored at the wall,
// in the sunlit one.
#include "techniques/baked_fixture.h"
#include "techniques/common/probes/copy.h"
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"
#include "techniques_test_shaders.h"

#include <math.h>
#include <string.h>

// That of test_light.c.
#define DICTIONARY                                                                                 \
    "texels=8,rays=256,prior_modes=16,modes=12,lightfield_positions=4,lightfield_directions=6,"    \
    "lightfield_modes=16,response_modes=12,block_probes="

static const float WALL = 0.05f, SIZE = 0.8f;

static vec3s box_center(bool dark, float distance)
{
    const float side = dark ? 1.0f : -1.0f;
    return vec3_of(side * (0.5f * WALL + distance + 0.5f * SIZE), 0.9f, -0.3f);
}

// ---- pixels

// Opens the fixture too. Returns the first instance of the box.
static int open_with_box(struct baked_fixture *run, struct frame_fixture *s, struct gpu *gpu,
                         const char *gi, bool dark, float distance)
{
    const vec3s at = box_center(dark, distance);
    trial_two_rooms(s, gpu, dark);
    const int object =
        trial_add_movable_box(s, at, SIZE, fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_look(s, vec3_of(at.x + (dark ? 1.2f : -1.2f), 1.9f, 1.2f), at);
    baked_fixture_open(run, s, gi);
    return object;
}

static double pixel_share(struct gpu *gpu, const char *gi, float distance)
{
    double mean[2];
    for (int dark = 0; dark < 2; dark++) {
        struct frame_fixture s;
        struct baked_fixture run;
        const int object = open_with_box(&run, &s, gpu, gi, dark, distance);
        mean[dark] = trial_object_irradiance(&s, object).mean[1];
        baked_fixture_close(&run, &s);
    }
    print_message("%s: object %.2f m from the wall: %.5f of the sunlit room's (%.1f lux)\n", gi,
                  (double)distance, mean[1] / mean[0], mean[0]);
    CHECK(mean[0] > 10);
    return mean[1] / mean[0];
}

TEST_GPU(an_object_in_a_dark_room_has_no_light_of_the_next_room)
{
    const struct {
        const char *gi;
        float distance;
        double most;
    } cases[] = {
        { "radiosity:texels=16384", 0.01f, 0.005 },
        { "radiosity:texels=16384,probe_spacing=1.3", 0.05f, 0.005 },
        { "mrt:" DICTIONARY "2", 0.01f, 0.005 },
        { "drt:" DICTIONARY "2", 0.01f, 0.005 },
        { "lpv", 0.01f, 0.005 },
        { "holpv", 0.01f, 0.005 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        CHECK(pixel_share(gpu, cases[i].gi, cases[i].distance) <= cases[i].most);
}

// ---- published volumes: a box of a program, which is not in the scene

enum { SIDES = 6, ACROSS = 5, PER_SIDE = ACROSS * ACROSS, CENTER = SIDES * PER_SIDE, POINTS };

// Positions and normals on the sides of the box, −x +x −y +y −z +z, then its centre without a
// normal.
static void points_of_box(vec3s center, vec3s out[POINTS][2])
{
    for (int i = 0; i < CENTER; i++) {
        const int side = i / PER_SIDE, axis = side / 2, k = i % PER_SIDE;
        vec3s normal = vec3_of(0, 0, 0), at;
        normal.raw[axis] = side % 2 ? 1.0f : -1.0f;
        at.raw[axis] = 0.5f * normal.raw[axis];
        at.raw[(axis + 1) % 3] = ((float)(k % ACROSS) + 0.5f) / ACROSS - 0.5f;
        at.raw[(axis + 2) % 3] = ((float)(k / ACROSS) + 0.5f) / ACROSS - 0.5f;
        out[i][0] = glms_vec3_muladds(at, SIZE, center);
        out[i][1] = normal;
    }
    out[CENTER][0] = center;
    out[CENTER][1] = vec3_of(0, 0, 0);
}

// Green, lux: the mean over all normals at the centre, as dnrt takes it, and over the side that
// faces the wall and the five others.
struct object_light {
    double center, facing, others;
};

static struct object_light light_of(vec3s points[POINTS][2], int facing, double scale)
{
    struct object_light out = { .center = (double)points[CENTER][0].y / scale };
    for (int i = 0; i < CENTER; i++) {
        const double e = (double)points[i][0].y / scale / PER_SIDE;
        if (i / PER_SIDE == facing)
            out.facing += e;
        else
            out.others += e / (SIDES - 1);
    }
    return out;
}

// probes: `depth` is any image where the shader needs none.
static void look_up_by(struct gpu *gpu, const struct gpu_shader *shader,
                       const struct probe_volume *probes, int visibility, vec3s points[POINTS][2])
{
    static const struct gpu_sampler_desc desc = { .name = "test.linear",
                                                  .filter = GPU_LINEAR,
                                                  .wrap_u = GPU_CLAMP,
                                                  .wrap_v = GPU_CLAMP,
                                                  .wrap_w = GPU_CLAMP };
    const size_t bytes = POINTS * sizeof *points;
    const struct {
        struct frame_probes grid;
        uint32_t count;
        int32_t visibility;
    } push = { probes->grid, POINTS, visibility };
    gpu_sampler linear;
    CHECK(gpu_sampler_get(gpu, &desc, &linear));
    gpu_pipeline lookup = test_gpu_compute(gpu, shader);
    gpu_buffer buffer = test_gpu_buffer(gpu, bytes);
    CHECK(gpu_buffer_upload(gpu, buffer, 0, points, bytes));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, lookup,
                 GPU_BIND({ "volume", .image = probes->image, .sampler = linear },
                          { "probe_depths", .image = probes->depth, .sampler = linear },
                          { "points", .buffer = buffer }),
                 &push, sizeof push, gpu_groups(POINTS, 64), 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_buffer_download(gpu, buffer, 0, points, bytes));
    gpu_buffer_destroy(gpu, &buffer);
    gpu_pipeline_destroy(gpu, &lookup);
}

static void look_up(struct gpu *gpu, const struct probe_volume *probes, vec3s points[POINTS][2])
{
    look_up_by(gpu,
               probes->depth.id ? &shader_probes_probe_points_seen_comp
                                : &shader_probes_probe_points_grid_comp,
               probes, probe_volume_visibility(probes), points);
}

static struct object_light volume_share(struct gpu *gpu, const char *gi)
{
    const float distance = 0.01f;
    struct object_light light[2];
    for (int dark = 0; dark < 2; dark++) {
        struct frame_fixture s;
        struct baked_fixture run;
        struct probe_volume probes;
        vec3s points[POINTS][2];
        trial_two_rooms(&s, gpu, dark);
        baked_fixture_open(&run, &s, gi);
        fixture_render(&s);
        points_of_box(box_center(dark, distance), points);
        CHECK(gi_probes(run.gi, &probes));
        look_up(gpu, &probes, points);
        light[dark] = light_of(points, dark ? 0 : 1, (double)frame_radiance_scale(s.frame));
        baked_fixture_close(&run, &s);
    }
    const struct object_light share = { light[1].center / light[0].center,
                                        light[1].facing / light[0].facing,
                                        light[1].others / light[0].others };
    print_message("%s: probes at an object %.2f m from the wall: %.5f of the sunlit room's (%.1f "
                  "lux) at its centre, %.5f on its sides, %.5f on that towards the wall\n",
                  gi, (double)distance, share.center, light[0].center, share.others, share.facing);
    CHECK(light[0].center > 300 && light[0].others > 300); // the sunlit room has 330 to 400 lux
    return share;
}

// Not bounded is the side that faces the wall, which no camera sees: lookups begin a twentieth of a
// spacing in front of it, in the wall or beyond. Those of lpv take the probes behind it, too.
TEST_GPU(probes_at_an_object_in_a_dark_room_have_no_light_of_the_next_room)
{
    const struct {
        const char *gi;
        double center, others;
    } cases[] = {
        { "radiosity:texels=16384,probes=true", 0.008, 0.005 },
        { "mrt:probes=true," DICTIONARY "2", 0.005, 0.005 },
        { "mrt:probes=true," DICTIONARY "3", 0.005, 0.005 },
        { "drt:probes=true," DICTIONARY "2", 0.005, 0.005 },
        { "lpv:probes=true", 0.005, 0.02 },
        { "holpv:probes=true", 0.005, 0.02 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct object_light got = volume_share(gpu, cases[i].gi);
        CHECK(got.center <= cases[i].center && got.others <= cases[i].others);
    }
}

// ---- the lookup for shaders of programs, and that of the CPU

struct comparison {
    double difference, light; // lux: the largest difference at points, the largest mean of a box
};

// At the points of a box, which may be in the wall in part.
static void compare_at(struct gpu *gpu, const struct probe_volume *probes,
                       const struct probe_copy *copy, float scale, vec3s center,
                       struct comparison *out)
{
    vec3s points[POINTS][2], shaded[POINTS][2];
    struct probe_volume bound = *probes;
    double mean = 0.0;
    points_of_box(center, points);
    memcpy(shaded, points, sizeof points);
    if (!bound.depth.id)
        bound.depth = test_gpu_image(gpu, GPU_2D, GPU_RG16F, 1, 1, 1, 1, GPU_SAMPLED);
    look_up_by(gpu, &shader_probes_probe_points_published_comp, &bound, copy->visibility, shaded);
    if (!probes->depth.id) gpu_image_destroy(gpu, &bound.depth);
    for (int i = 0; i < CENTER; i++) {
        float lux[3];
        probe_copy_irradiance(copy, points[i][0], points[i][1], lux);
        for (int c = 0; c < 3; c++) {
            out->difference =
                fmax(out->difference,
                     fabs((double)shaded[i][0].raw[c] / (double)scale - (double)lux[c]));
            mean += (double)lux[c] / (3 * CENTER);
        }
    }
    out->light = fmax(out->light, mean);
}

TEST_GPU(shaders_look_probes_up_as_the_cpu_does)
{
    const struct {
        const char *gi;
        int visibility;
    } cases[] = {
        { "radiosity:texels=4096,rays=64,probes=true", PROBE_VISIBILITY_DEPTHS },
        { "mrt:probes=true," DICTIONARY "2", PROBE_VISIBILITY_DEPTHS },
        { "lpv:probes=true", PROBE_VISIBILITY_WALLS },
        { "holpv:probes=true,dim=16", PROBE_VISIBILITY_WALLS },
        { "lpv:probes=true,geometry=off", PROBE_VISIBILITY_NONE },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct frame_fixture s;
        struct baked_fixture run;
        struct probe_volume probes;
        struct probe_copy copy;
        trial_two_rooms(&s, gpu, false);
        baked_fixture_open(&run, &s, cases[i].gi);
        fixture_render(&s);
        CHECK(gi_probes(run.gi, &probes));
        const float scale = frame_radiance_scale(s.frame);
        CHECK(probe_copy_create(test_host(), gpu, &probes, scale, &copy));
        CHECK(copy.visibility == cases[i].visibility);
        struct comparison got = { 0 };
        for (int k = 0; k < 5; k++) // in both rooms, and across the wall
            compare_at(gpu, &probes, &copy, scale, vec3_of(-2.9f + 1.45f * (float)k, 1.3f, 0.2f),
                       &got);
        print_message("%s: lookups on GPU and CPU differ by %.5f of %.0f lux\n", cases[i].gi,
                      got.difference / got.light, got.light);
        CHECK(got.light > 100 && got.difference <= 0.01 * got.light);
        probe_copy_finish(test_host(), &copy);
        baked_fixture_close(&run, &s);
    }
}
