// Noise of rows of form factors where a small bright spot lights a room.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include <stdlib.h>

enum { SIZE = 48 };

// The least contrast that an observer sees is 1 % or so (Weber fraction).
static const double VISIBLE = 0.01;

// The far wall of the room, on which no shadow falls: its light changes slowly. The camera looks at
// it from a distance in metres. `reach` makes the square some 35 cm wide, nine texels.
static void check_wall(struct gpu *gpu, float height, float distance, float fov_rad, int reach)
{
    struct frame_fixture s;
    trial_bright_spot(&s, gpu);
    s.width = s.height = SIZE;
    fixture_look(&s, vec3_of(distance - 3, height, 0.4f), vec3_of(-3, height, 0.4f));
    s.input.camera.vertical_fov_rad = fov_rad;
    float *e = trial_pixels(&s, "radiosity");
    const double mottle = trial_mottle(e, SIZE, reach);
    print_message("a wall lit by a spot, at %.2f m: deviation %.4f\n", (double)height, mottle);
    CHECK(mottle < VISIBLE);
    free(e);
    fixture_finish(&s);
}

TEST_GPU(light_of_a_small_bright_spot_is_even_on_a_far_wall)
{
    check_wall(gpu, 1.9f, 2.4f, 0.8f, 4);
}

// Between 5 cm and 95 cm below the ceiling, where neighbours differ by contacts.
TEST_GPU(light_of_a_small_bright_spot_is_even_below_a_ceiling)
{
    check_wall(gpu, 2.5f, 1.8f, 0.5f, 8);
}

TEST_GPU(a_small_bright_spot_lights_a_room_without_mottle)
{
    const struct trial_error e = trial_error_of(gpu, trial_bright_spot, "radiosity", 1024);
    print_message("a room lit by a spot: FLIP %.4f, energy %.3f\n", e.flip, e.energy);
    CHECK(e.flip < 0.062);
    CHECK(e.energy > 0.95 && e.energy < 1.05);
}
