// Light of sunlit ground, which enters a room by its window.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#define DICTIONARY TRIAL_DICTIONARY(16, 32, 32)

// A fifth is what two bounces outdoors and few modes indoors lose.
TEST_GPU(light_of_sunlit_ground_enters_by_a_window)
{
    const struct {
        const char *gi;
        double least, most;
    } cases[] = { { "radiosity:texels=16384", 0.95, 1.05 },
                  { "mrt" DICTIONARY, 0.8, 1.2 },
                  { "drt" DICTIONARY, 0.8, 1.2 } };
    for (int towards = 0; towards < 2; towards++) {
        struct frame_fixture s;
        trial_window(&s, gpu, towards);
        const struct trial_irradiance expected = trial_reference(&s, -1, 1024);
        fixture_finish(&s);
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            trial_window(&s, gpu, towards);
            const double share = trial_technique(&s, cases[i].gi).mean[1] / expected.mean[1];
            fixture_finish(&s);
            print_message("%s: %s the window: %.3f of the reference's %.3f lux\n", cases[i].gi,
                          towards ? "towards" : "away from", share, expected.mean[1]);
            CHECK(share >= cases[i].least && share <= cases[i].most);
        }
    }
}
