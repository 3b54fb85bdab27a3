// Light of sunlit ground, which enters a room by its window.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#define DICTIONARY TRIAL_DICTIONARY(16, 32, 32)

// radiosity has .98 to 1.05 with 8192 to 65536 texels, by the place of those at the window's edges.
// A fifth is what coarse places outdoors and few modes indoors lose. Cells of lpv are as large as
// the window.
TEST_GPU(light_of_sunlit_ground_enters_by_a_window)
{
    static const struct trial_bounds bounds[] = { { "radiosity", 0.95, 1.05 },
                                                  { "lpv", 0.7, 1.2 },
                                                  { "holpv", 0.9, 1.4 },
                                                  { "mrt" DICTIONARY, 0.8, 1.2 },
                                                  { "drt" DICTIONARY, 0.8, 1.2 } };
    trial_check_energy(gpu, trial_window, 1024, bounds, sizeof bounds / sizeof bounds[0]);
}
