// Light in scenes without a room: blocks stand for none of their surfaces.
#include "techniques/baked_fixture.h"
#include "techniques/common/probes/copy.h"
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include <math.h>

// A fifth, as in the street: points of the grid outdoors are coarse beside the objects.
TEST_GPU(objects_outdoors_have_the_light_of_the_sky_and_of_each_other)
{
    static const struct trial_bounds bounds[] = { { "mrt" TRIAL_DICTIONARY(8, 16, 12), 0.8, 1.2 },
                                                  { "drt" TRIAL_DICTIONARY(8, 16, 12), 0.8, 1.2 } };
    trial_check_energy(gpu, trial_outdoors, 256, bounds, sizeof bounds / sizeof bounds[0]);
}

// Above a ground of albedo 0.4 in a sun of 1000 lux and a sky of 100 cd/m²: upwards 100 π,
// downwards 0.4 of sun and sky, but for what the ground's border and the box leave out.
TEST_GPU(published_probes_outdoors_have_the_light_of_sky_and_ground)
{
    struct frame_fixture s;
    struct baked_fixture run;
    struct probe_volume probes;
    struct probe_copy copy;
    float up[3], down[3];
    trial_outdoors(&s, gpu, false);
    baked_fixture_open(&run, &s, "mrt:probes=true," TRIAL_DICTIONARY_OPTIONS(8, 16, 12));
    fixture_render(&s);
    CHECK(gi_probes(run.gi, &probes));
    CHECK(probe_copy_create(test_host(), gpu, &probes, frame_radiance_scale(s.frame), &copy));
    const vec3s at = vec3_of(-5, 1, 5);
    probe_copy_irradiance(&copy, at, vec3_of(0, 1, 0), up);
    probe_copy_irradiance(&copy, at, vec3_of(0, -1, 0), down);
    const double sky = 100.0 * GLM_PI, ground = 0.4 * (1000.0 * cos(GLM_PI / 4) + sky);
    print_message("up %.1f of %.1f lux, down %.1f of %.1f\n", (double)up[1], sky, (double)down[1],
                  ground);
    CHECK_RELATIVE((double)up[1], sky, 0.1);
    CHECK_RELATIVE((double)down[1], ground, 0.1);
    probe_copy_finish(test_host(), &copy);
    baked_fixture_close(&run, &s);
}
