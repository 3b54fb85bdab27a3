// Interreflection between voxels: its sum, and its convergence after changes of the scene.
#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FLOATS = 32 * 32 * 3 };

// A closed white room with a point light.
static void make_scene(struct vct_fixture *fixture, struct gpu *gpu, const char *options)
{
    vct_fixture_init(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
                fixture_matte(s, vec3_of(0.6f, 0.6f, 0.6f)));
    fixture_add_point(s, vec3_of(5.3f, 6, 4.2f), vec3_of(300, 300, 300));
    fixture_look(s, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    vct_fixture_open(fixture, options);
}

static void dim_and_move(struct vct_fixture *fixture)
{
    fixture->frame_fixture.lights[0].position = vec3_of(2, 2, 2);
    fixture->frame_fixture.lights[0].intensity = vec3_of(20, 40, 30);
}

static float *irradiance_after(struct vct_fixture *fixture, int frames)
{
    for (int i = 0; i < frames; i++) fixture_render(&fixture->frame_fixture);
    return fixture_read(&fixture->frame_fixture, READ_IRRADIANCE);
}

static double mean(const float *values)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) sum += (double)values[i];
    return sum / FLOATS;
}

// Uniform light: the sum over all bounces is the first bounce times 1/(1 − ρ).
TEST_GPU(bounces_sum_to_the_geometric_series)
{
    static const char *const options[] = { "resolution=32,bounces=1", "resolution=32" };
    double got[2];
    for (int i = 0; i < 2; i++) {
        struct vct_fixture fixture;
        make_scene(&fixture, gpu, options[i]);
        float *e = irradiance_after(&fixture, 1);
        got[i] = mean(e);
        free(e);
        vct_fixture_finish(&fixture);
    }
    print_message("all bounces: %.3f times the first bounce, geometric series %.3f\n",
                  got[1] / got[0], 1.0 / (1.0 - 0.6));
    // Cones lose some hundredths per bounce; the truncation after eight loses 2 %.
    CHECK(got[1] / got[0] > 2.0 && got[1] / got[0] < 2.55);
}

// Bounced irradiance is computed per block: 4³ voxels at resolution 64, 8³ half as large at 128.
TEST_GPU(bounced_irradiance_is_independent_of_voxel_size)
{
    static const char *const options[] = { "resolution=64", "resolution=128" };
    float *got[2];
    for (int i = 0; i < 2; i++) {
        struct vct_fixture fixture;
        vct_fixture_init(&fixture, gpu);
        struct frame_fixture *s = &fixture.frame_fixture;
        const int white = fixture_matte(s, vec3_of(0.6f, 0.6f, 0.6f));
        fixture_box(s, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true, white);
        fixture_box(s, vec3_of(6, 0, 2), vec3_of(8.3f, 3.1f, 4.4f), false, white);
        fixture_add_point(s, vec3_of(5.3f, 6, 4.2f), vec3_of(300, 300, 300));
        fixture_look(s, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
        vct_fixture_open(&fixture, options[i]);
        got[i] = irradiance_after(&fixture, 1);
        vct_fixture_finish(&fixture);
    }
    double difference = 0.0;
    for (int i = 0; i < FLOATS; i++) difference += fabs((double)got[1][i] - (double)got[0][i]);
    const double ratio = mean(got[1]) / mean(got[0]);
    difference /= FLOATS * mean(got[0]);
    print_message("half the voxel size: %.4f times the light, difference %.4f of the mean\n", ratio,
                  difference);
    // Cones start half as far from the walls: some hundredths of the light. Without bounced
    // irradiance half is missing.
    CHECK_NEAR(ratio, 1.0, 0.05);
    CHECK(difference < 0.05);
    free(got[0]), free(got[1]);
}

// The first frame of other light traces its bounces at once, as that of a new technique does. Later
// frames add bounces beyond the eighth, until the light is constant.
TEST_GPU(bounces_converge_after_a_light_moves)
{
    struct vct_fixture fixture, fresh;
    make_scene(&fixture, gpu, "resolution=32");
    free(irradiance_after(&fixture, 3));
    dim_and_move(&fixture);
    float *at_once = irradiance_after(&fixture, 1), *settled = irradiance_after(&fixture, 16),
          *later = irradiance_after(&fixture, 3);
    make_scene(&fresh, gpu, "resolution=32");
    dim_and_move(&fresh);
    float *expected = irradiance_after(&fresh, 1);
    double difference = 0.0, first_difference = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        difference += fabs((double)settled[i] - (double)expected[i]);
        first_difference += fabs((double)at_once[i] - (double)expected[i]);
    }
    print_message("after a light has moved: error %.3f of the mean, 16 frames later %.4f\n",
                  first_difference / FLOATS / mean(expected), difference / FLOATS / mean(expected));
    // One more round than eight includes the ninth bounce: Σ 0.6ⁿ from n = 9 on is 2 %.
    CHECK(difference / FLOATS < 0.03 * mean(expected));
    CHECK(first_difference == 0.0);
    CHECK(memcmp(settled, later, FLOATS * sizeof *settled) == 0);
    free(at_once), free(settled), free(later), free(expected);
    vct_fixture_finish(&fixture);
    vct_fixture_finish(&fresh);
}

// A moving object must not reset the bounced irradiance of the room.
TEST_GPU(bounces_persist_while_an_object_moves)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    struct frame_fixture *s = &fixture.frame_fixture;
    const int white = fixture_matte(s, vec3_of(0.6f, 0.6f, 0.6f));
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true, white);
    const int box = s->scene->instance_count;
    fixture_box(s, vec3_of(4, 0, 4), vec3_of(5, 1, 5), false, white);
    fixture_add_point(s, vec3_of(5.3f, 6, 4.2f), vec3_of(300, 300, 300));
    fixture_look(s, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    vct_fixture_open(&fixture, "resolution=32");
    float *still = irradiance_after(&fixture, 2);
    double least = 1e9, most = 0.0;
    for (int i = 0; i < 6; i++) {
        s->pose.world_from_node[s->scene->instances[box].node].raw[3][0] += 0.3f;
        float *moving = irradiance_after(&fixture, 1);
        const double ratio = mean(moving) / mean(still);
        least = fmin(least, ratio);
        most = fmax(most, ratio);
        free(moving);
    }
    print_message("while a box moves: %.3f to %.3f of the light\n", least, most);
    CHECK(least > 0.9 && most < 1.1);
    free(still);
    vct_fixture_finish(&fixture);
}
