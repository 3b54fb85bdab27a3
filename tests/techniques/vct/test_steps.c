// Temporal accumulation while an object and a light move evenly: changes from frame to frame are
// even too.
#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdlib.h>

enum { WARM = 16, STEPS = 24, LONGEST_PERIOD = VCT_ROTATION_FRAMES };

struct motion {
    float light_m, box_m; // per frame
};

static void move(struct vct_fixture *fixture, int box, const struct motion *by)
{
    fixture->frame_fixture.lights[0].position.x += by->light_m;
    vct_fixture_move_box(fixture, box, vec3_of(0, by->box_m, by->box_m));
}

// Mean absolute change of irradiance in each frame, over its mean.
static void measure_steps(struct gpu *gpu, const char *options, const struct motion *by,
                          double steps[STEPS])
{
    struct vct_fixture fixture;
    const int box = vct_fixture_room(&fixture, gpu);
    fixture.frame_fixture.width = fixture.frame_fixture.height = 64;
    vct_fixture_open(&fixture, options);
    const size_t count = (size_t)fixture.frame_fixture.width * fixture.frame_fixture.height * 3;
    free(vct_fixture_irradiance_after(&fixture, WARM));
    float *last = NULL;
    for (int i = -WARM; i < STEPS; i++) {
        move(&fixture, box, by);
        float *now = vct_fixture_irradiance_after(&fixture, 1);
        if (i >= 0) steps[i] = vct_fixture_difference(now, last, count);
        free(last);
        last = now;
    }
    free(last);
    vct_fixture_finish(&fixture);
}

// The largest mean of the steps of one phase of a period over that of its other phases.
static double most_periodic(const double steps[STEPS])
{
    double most = 0.0;
    for (int period = 2; period <= LONGEST_PERIOD; period++)
        for (int phase = 0; phase < period; phase++) {
            double in = 0.0, others = 0.0;
            int in_count = 0;
            for (int i = 0; i < STEPS; i++) {
                const bool counts = i % period == phase;
                *(counts ? &in : &others) += steps[i];
                in_count += counts;
            }
            most = fmax(most, in / in_count / (others / (STEPS - in_count)));
        }
    return most;
}

TEST_GPU(steps_of_moving_light_have_no_pulse)
{
    static const char *const OPTIONS[] = { "resolution=32,temporal=true",
                                           "resolution=64,temporal=true,trace=rays",
                                           "resolution=128,temporal=true" };
    static const struct motion MOTIONS[] = { { 0.02f, 0.03f }, { 0.1f, 0.05f }, { 0, 0.05f } };
    for (size_t i = 0; i < sizeof OPTIONS / sizeof OPTIONS[0]; i++)
        for (size_t k = 0; k < sizeof MOTIONS / sizeof MOTIONS[0]; k++) {
            double steps[STEPS];
            measure_steps(gpu, OPTIONS[i], &MOTIONS[k], steps);
            const double most = most_periodic(steps);
            print_message("%s: light by %.2f m, box by %.2f m: pulse %.2f; steps in %%:",
                          OPTIONS[i], (double)MOTIONS[k].light_m, (double)MOTIONS[k].box_m, most);
            for (int j = 0; j < STEPS; j++) print_message(" %.2f", 100.0 * steps[j]);
            print_message("\n");
            CHECK(most < 1.5);
        }
}
