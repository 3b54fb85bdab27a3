// Light of a lit room behind a door.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#define DICTIONARY TRIAL_DICTIONARY(16, 16, 12)

// A tenth is what a few modes lose at the second bounce, a fifth what coarse cells and cones do.
TEST_GPU(light_of_a_room_passes_a_door)
{
    const struct {
        const char *gi;
        double least, most;
    } cases[] = { { "lpv", 0.75, 1.25 },
                  { "vct", 0.75, 1.25 },
                  { "radiosity:texels=16384", 0.95, 1.05 },
                  { "mrt" DICTIONARY, 0.8, 1.2 },
                  { "drt" DICTIONARY, 0.8, 1.2 } };
    for (int back = 0; back < 2; back++) {
        struct frame_fixture s;
        trial_door(&s, gpu, back);
        const struct trial_irradiance expected = trial_reference(&s, -1, 256);
        fixture_finish(&s);
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            trial_door(&s, gpu, back);
            const double share = trial_technique(&s, cases[i].gi).mean[1] / expected.mean[1];
            fixture_finish(&s);
            print_message("%s: behind a door%s: %.3f of the reference's %.3f lux\n", cases[i].gi,
                          back ? ", its wall" : "", share, expected.mean[1]);
            CHECK(share >= cases[i].least && share <= cases[i].most);
        }
    }
}
