// Physical trials of the sources that trace light through the scene: thin walls, a plane's own
// light, an empty room. Each prints its figures.
#include "techniques/trials/light_trial_scenes.h"
#include "techniques/trials/plane_trial.h"
#include "techniques/trials/share_trial.h"
#include "techniques/trials/trial_bakes.h"

static double dark_room_share(struct gpu *gpu, const char *gi)
{
    struct trial_irradiance e[2];
    for (int dark = 0; dark < 2; dark++) {
        struct frame_fixture s;
        trial_two_rooms(&s, gpu, dark);
        e[dark] = trial_technique(&s, gi);
        fixture_finish(&s);
    }
    print_message("%s: dark room %.4f of the sunlit one (%.3f lux)\n", gi,
                  e[1].mean[1] / e[0].mean[1], e[0].mean[1]);
    return e[1].mean[1] / e[0].mean[1];
}

// Texels of ort that reach through the wall have light of both sides: 0.001 to 0.04, by their size
// and place, which is a fault of ort (its README, "Limits"). 8192 texels lie well.
TEST_GPU(a_closed_room_beside_a_sunlit_one_stays_dark)
{
    const struct {
        const char *gi;
        double most;
    } cases[] = { { "lpv", 0.005 },
                  { "holpv", 0.002 },
                  { "vct:trace=cones,bounces=1", 0.05 },
                  { "vct:trace=cones", 0.04 },
                  { "vct:trace=cones,resolution=128", 0.042 },
                  { "vct:quality=low", 0.005 },
                  { "vct", 0.005 },
                  { "vct:quality=high", 0.005 },
                  { RADIOSITY, 0.005 },
                  { ORT_FINE, 0.005 },
                  { PRT, 0.005 },
                  { MRT, 1e-4 },
                  { DRT, 1e-4 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        CHECK(dark_room_share(gpu, cases[i].gi) <= cases[i].most);
}

// Radians.
static const float PLANE_TILT = 0.35f;

// Below a sky, and with other tilts: test_planes.c.
TEST_GPU(an_open_plane_in_the_sun_gets_nothing_of_its_own_light)
{
    plane_trial_own_light(gpu, PLANE_TILT);
}

// Offsets of ort meet a spot by chance: twice the error of 5.6 % that spots have between two
// squares at 400 offsets.
TEST_GPU(light_crosses_an_empty_room)
{
    static const struct share_case cases[] = { { "lpv", 0.8 },      { "holpv", 0.9 },
                                               { "vct", 0.9 },      { "vct:trace=cones", 0.85 },
                                               { RADIOSITY, 0.95 }, { ORT, 0.89 },
                                               { MRT, 0.95 },       { DRT, 0.95 } };
    share_trial(gpu, trial_empty_room, "across an empty room", 1, cases,
                sizeof cases / sizeof cases[0], 1.3);
}
