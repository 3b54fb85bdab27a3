// Open planes in the sun and below a sky; test_light.c has one of another tilt in the sun.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/plane_trial.h"

TEST_GPU(a_level_plane_gets_the_sky_and_nothing_of_its_own_light)
{
    plane_trial_own_light(gpu, 0);
    plane_trial_sky(gpu, 0);
}

TEST_GPU(a_plane_of_45_degrees_gets_the_sky_and_nothing_of_its_own_light)
{
    plane_trial_own_light(gpu, 0.7853982f);
    plane_trial_sky(gpu, 0.7853982f);
}

TEST_GPU(a_plane_of_20_degrees_gets_the_sky)
{
    plane_trial_sky(gpu, 0.35f);
}
