// A lit box below a ceiling, which is far brighter behind it than beside it.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"
#include "techniques/trials/share_trial.h"

#define DICTIONARY TRIAL_DICTIONARY(16, 32, 32)

// A tenth is what few modes lose. mrt has no shadows of the box in indirect light.
TEST_GPU(light_between_a_box_and_the_ceiling_stays_there)
{
    const struct {
        const char *gi;
        double least, most;
    } cases[] = { { "radiosity:texels=16384", 0.95, 1.05 },
                  { "mrt" DICTIONARY, 0.8, 1.2 },
                  { "drt" DICTIONARY, 0.85, 1.15 } };
    static const float gaps[] = { 0.05f, 0.2f };
    for (int g = 0; g < 2; g++) {
        struct frame_fixture s;
        trial_ceiling_light(&s, gpu, gaps[g]);
        const struct trial_irradiance expected = trial_reference(&s, -1, 256);
        fixture_finish(&s);
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            trial_ceiling_light(&s, gpu, gaps[g]);
            const double share = trial_technique(&s, cases[i].gi).mean[1] / expected.mean[1];
            fixture_finish(&s);
            print_message("%s: box %.2f m below the ceiling: %.3f of the reference's %.3f lux\n",
                          cases[i].gi, (double)gaps[g], share, expected.mean[1]);
            CHECK(share >= cases[i].least && share <= cases[i].most);
        }
    }
}

// A gap of 0.2 m is two to four voxels: the light that leaves it is coarse. With quality=low voxels
// are 19 cm.
TEST_GPU(a_small_box_below_a_ceiling_lights_a_room_at_its_level)
{
    const struct {
        const char *gi;
        double tolerance[2];
    } cases[] = { { "radiosity:texels=16384", { 0.05, 0.05 } },
                  { "vct:quality=low", { 0.1, 0.1 } },
                  { "vct", { 0.1, 0.05 } },
                  { "vct:quality=high", { 0.1, 0.05 } } };
    static const float gaps[] = { 0.2f, 0.5f };
    for (int g = 0; g < 2; g++) {
        struct frame_fixture s;
        trial_small_ceiling_light(&s, gpu, gaps[g]);
        const struct trial_irradiance expected = trial_reference(&s, -1, 256);
        fixture_finish(&s);
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            trial_small_ceiling_light(&s, gpu, gaps[g]);
            const double share = trial_technique(&s, cases[i].gi).mean[1] / expected.mean[1];
            fixture_finish(&s);
            print_message("%s: small box %.2f m below the ceiling: %.3f of the reference\n",
                          cases[i].gi, (double)gaps[g], share);
            CHECK_NEAR(share, 1.0, cases[i].tolerance[g]);
        }
    }
}

// Texels of 2 and 4 cm: clusters and groups of the ceiling would reach past the panel's edge. Those
// of mrt have 25 cm.
TEST_GPU(light_between_a_panel_and_the_ceiling_does_not_light_the_room)
{
    static const struct share_case cases[] = { { "radiosity:texels=65536", 0.95 },
                                               { "radiosity:texels=16384", 0.95 },
                                               { "mrt" DICTIONARY, 0.95 },
                                               { "drt" DICTIONARY, 0.95 } };
    share_trial(gpu, trial_sheet_below_ceiling, "a panel below the ceiling", -1, cases, 4, 1.05);
}
