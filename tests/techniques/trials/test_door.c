// Light of a lit room behind a door.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#define DICTIONARY TRIAL_DICTIONARY(16, 16, 12)

// A tenth is what a few modes lose at the second bounce, a fifth what coarse cells and cones do.
TEST_GPU(light_of_a_room_passes_a_door)
{
    static const struct trial_bounds bounds[] = { { "lpv", 0.75, 1.25 },
                                                  { "vct", 0.75, 1.25 },
                                                  { "radiosity:texels=16384", 0.95, 1.05 },
                                                  { "mrt" DICTIONARY, 0.8, 1.2 },
                                                  { "drt" DICTIONARY, 0.8, 1.2 } };
    trial_check_energy(gpu, trial_door, 256, bounds, sizeof bounds / sizeof bounds[0]);
}
