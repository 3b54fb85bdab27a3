// Rooms with objects: energy of indirect light in rooms that are no cubes.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

// Eight bounces of albedo 0.7 lack 3 % of the light.
#define DICTIONARY TRIAL_DICTIONARY(16, 32, 32) ",bounces=16"

// A tenth: mrt has no light of objects and no shadows of them in indirect light.
static const struct trial_bounds BOUNDS[] = { { "radiosity:texels=16384", 0.95, 1.05 },
                                              { "mrt" DICTIONARY, 0.9, 1.1 },
                                              { "drt" DICTIONARY, 0.95, 1.05 } };
enum { COUNT = sizeof BOUNDS / sizeof BOUNDS[0] };

TEST_GPU(light_of_a_room_with_a_wardrobe_close_to_a_wall)
{
    trial_check_energy(gpu, trial_wardrobe, 256, BOUNDS, COUNT);
}

// Light crosses the opening between two blocks that are no cubes.
TEST_GPU(light_of_a_room_of_two_blocks)
{
    static const struct trial_bounds bounds[] = { { "radiosity:texels=16384", 0.95, 1.05 },
                                                  { "mrt" DICTIONARY, 0.95, 1.05 } };
    trial_check_energy(gpu, trial_long_room, 256, bounds, sizeof bounds / sizeof bounds[0]);
}

// A lit patch on the border of two blocks: what it sends through the opening is a part of the fit
// of direct light, else a tenth of the light is missing.
TEST_GPU(light_of_a_patch_between_two_blocks)
{
    static const struct trial_bounds bounds = { "mrt" DICTIONARY, 0.95, 1.05 };
    trial_check_energy(gpu, trial_patch_between_blocks, 256, &bounds, 1);
}

// Walls are solids, and furniture is large: neither is a block of its own. In mrt furniture does
// not darken the room.
TEST_GPU(light_of_a_furnished_room_between_thick_walls)
{
    static const struct trial_bounds bounds[] = { { "radiosity:texels=16384", 0.95, 1.05 },
                                                  { "drt" DICTIONARY, 0.95, 1.05 } };
    trial_check_energy(gpu, trial_thick_walls, 256, bounds, sizeof bounds / sizeof bounds[0]);
}

// mrt takes the inside of the shade, which is the brightest surface, for a wall.
TEST_GPU(light_of_a_shade)
{
    static const struct trial_bounds bounds[] = { { "radiosity:texels=16384", 0.95, 1.05 },
                                                  { "drt" DICTIONARY, 0.95, 1.05 } };
    trial_check_energy(gpu, trial_shade, 256, bounds, sizeof bounds / sizeof bounds[0]);
    trial_check_energy(gpu, trial_sheet_shade, 256, bounds, sizeof bounds / sizeof bounds[0]);
}

TEST_GPU(light_of_a_room_with_a_curtain)
{
    trial_check_energy(gpu, trial_curtain, 256, BOUNDS, COUNT);
}
