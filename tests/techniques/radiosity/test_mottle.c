// Noise of rows of form factors where a small bright spot lights a room.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include "techniques/gi_fixture.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 48, REACH = 4 };

// Relative difference of a pixel from the mean of the square around it.
static double difference_at(const float *e, int x, int y)
{
    double sum = 0;
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++) sum += (double)e[3 * ((y + dy) * SIZE + x + dx)];
    const double mean = sum / ((2 * REACH + 1) * (2 * REACH + 1));
    return (double)e[3 * (y * SIZE + x)] / mean - 1;
}

// The far wall of the room, on which no shadow falls: its light changes slowly. The square is
// some 40 cm wide, ten texels.
TEST_GPU(light_of_a_small_bright_spot_is_even_on_a_far_wall)
{
    struct frame_fixture s;
    double squares = 0, count = 0;
    trial_bright_spot(&s, gpu);
    s.width = s.height = SIZE;
    fixture_look(&s, vec3_of(-0.6f, 1.9f, 0.4f), vec3_of(-3, 1.9f, 0.4f));
    s.input.camera.vertical_fov_rad = 0.8f;
    fixture_open(&s);
    struct gi *gi = gi_fixture_light(&s, "radiosity");
    fixture_render(&s);
    float *e = fixture_read(&s, READ_IRRADIANCE);
    for (int y = REACH; y < SIZE - REACH; y++)
        for (int x = REACH; x < SIZE - REACH; x++, count++)
            squares += difference_at(e, x, y) * difference_at(e, x, y);
    print_message("a wall lit by a spot: deviation %.4f\n", sqrt(squares / count));
    CHECK(sqrt(squares / count) < 0.02);
    free(e);
    gi_destroy(gi);
    fixture_finish(&s);
}

TEST_GPU(a_small_bright_spot_lights_a_room_without_mottle)
{
    const struct trial_error e = trial_error_of(gpu, trial_bright_spot, "radiosity", 1024);
    print_message("a room lit by a spot: FLIP %.4f, energy %.3f\n", e.flip, e.energy);
    CHECK(e.flip < 0.07);
    CHECK(e.energy > 0.95 && e.energy < 1.05);
}
