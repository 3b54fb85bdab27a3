// The far ends of @corridor: niches around the corners of its arms, which light reaches after
// several bounces. Irradiance of regions of the floor, against the reference.
#include "techniques/baked_fixture.h"
#include "techniques/trials/light_trial.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 8, SAMPLES = 4096, ARMS = 4 };
static const float HALF_M = 0.6f;

static void load(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    scene_destroy(s->scene);
    s->scene = scene_load(test_host(), "@corridor");
    assert_non_null(s->scene);
    s->width = s->height = SIZE;
}

// A camera above a place of the floor that sees the region alone; arm: quarter turns.
static void look_at(struct frame_fixture *s, int arm, float x, float z)
{
    const float height = 1.0f;
    vec3s at = vec3_of(x, 0, z);
    for (int k = 0; k < arm; k++) at = vec3_of(at.z, 0, -at.x);
    fixture_look(s, glms_vec3_add(at, vec3_of(0.0f, height, 0.01f)), at);
    s->input.camera.vertical_fov_rad = 2.0f * atanf(HALF_M / height);
}

static double luminance_of(const double e[3])
{
    return 0.2126 * e[0] + 0.7152 * e[1] + 0.0722 * e[2];
}

static double mean_of(struct frame_fixture *s)
{
    double sum[3] = { 0 };
    fixture_render(s);
    float *e = fixture_read(s, READ_IRRADIANCE);
    for (int i = 0; i < 3 * SIZE * SIZE; i++) sum[i % 3] += (double)e[i] / (SIZE * SIZE);
    free(e);
    return luminance_of(sum);
}

static double reference_of(struct gpu *gpu, int arm, float x, float z)
{
    struct frame_fixture s;
    load(&s, gpu);
    look_at(&s, arm, x, z);
    const struct trial_irradiance e = trial_reference(&s, -1, SAMPLES);
    fixture_finish(&s);
    return luminance_of(e.mean);
}

// Places in the arm towards +x, in metres: before the end wall, and in the niche beside it.
static const struct {
    const char *name;
    float x, z;
} regions[] = { { "end", 7.8f, 0.0f }, { "niche", 7.8f, 3.3f } };
static const double MOST = 0.1; // difference of each region

TEST_GPU(far_ends_of_the_corridors_have_the_light_of_the_reference)
{
    struct frame_fixture s;
    struct baked_fixture run;
    load(&s, gpu);
    baked_fixture_open(&run, &s, "radiosity");
    for (size_t r = 0; r < sizeof regions / sizeof *regions; r++) {
        double sum[2] = { 0.0, 0.0 };
        for (int arm = 0; arm < ARMS; arm++) {
            look_at(&s, arm, regions[r].x, regions[r].z);
            const double e = mean_of(&s);
            const double expected = reference_of(gpu, arm, regions[r].x, regions[r].z);
            print_message("%s of arm %d: %.2f of %.2f lux, %.3f\n", regions[r].name, arm, e,
                          expected, e / expected);
            sum[0] += e;
            sum[1] += expected;
            CHECK_NEAR(e / expected, 1.0, MOST);
        }
        print_message("all: %.3f of the reference\n", sum[0] / sum[1]);
        CHECK_NEAR(sum[0] / sum[1], 1.0, MOST);
    }
    baked_fixture_close(&run, &s);
}
