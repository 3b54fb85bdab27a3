#include "techniques/trials/share_trial.h"

void share_trial(struct gpu *gpu, trial_build build, const char *name, int bounces,
                 const struct share_case *cases, size_t count, double most)
{
    struct frame_fixture s;
    build(&s, gpu);
    const struct trial_irradiance expected = trial_reference(&s, bounces, 64);
    fixture_finish(&s);
    for (size_t i = 0; i < count; i++) {
        build(&s, gpu);
        const struct trial_irradiance e = trial_technique(&s, cases[i].gi);
        fixture_finish(&s);
        const double share = e.mean[1] / expected.mean[1];
        print_message("%s: %s: %.3f of the reference's %.3f lux\n", cases[i].gi, name, share,
                      expected.mean[1]);
        CHECK(share >= cases[i].least && share <= most);
    }
}
