// Noise of rows of form factors where a small bright spot lights a room.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include <stdlib.h>

enum { SIZE = 48, REACH = 4 };

// The far wall of the room, on which no shadow falls: its light changes slowly. The square is
// some 40 cm wide, ten texels.
TEST_GPU(light_of_a_small_bright_spot_is_even_on_a_far_wall)
{
    struct frame_fixture s;
    trial_bright_spot(&s, gpu);
    s.width = s.height = SIZE;
    fixture_look(&s, vec3_of(-0.6f, 1.9f, 0.4f), vec3_of(-3, 1.9f, 0.4f));
    s.input.camera.vertical_fov_rad = 0.8f;
    float *e = trial_pixels(&s, "radiosity");
    const double mottle = trial_mottle(e, SIZE, REACH);
    print_message("a wall lit by a spot: deviation %.4f\n", mottle);
    CHECK(mottle < 0.02);
    free(e);
    fixture_finish(&s);
}

TEST_GPU(a_small_bright_spot_lights_a_room_without_mottle)
{
    const struct trial_error e = trial_error_of(gpu, trial_bright_spot, "radiosity", 1024);
    print_message("a room lit by a spot: FLIP %.4f, energy %.3f\n", e.flip, e.energy);
    CHECK(e.flip < 0.07);
    CHECK(e.energy > 0.95 && e.energy < 1.05);
}
