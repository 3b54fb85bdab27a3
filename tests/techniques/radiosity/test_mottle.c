// Noise of rows of form factors where a small bright spot lights a room.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

TEST_GPU(a_small_bright_spot_lights_a_room_without_mottle)
{
    const struct trial_error e = trial_error_of(gpu, trial_bright_spot, "radiosity", 1024);
    print_message("a room lit by a spot: FLIP %.4f, energy %.3f\n", e.flip, e.energy);
    CHECK(e.flip < 0.08);
    CHECK(e.energy > 0.95 && e.energy < 1.05);
}
