// Double-sided surfaces close to others must not lose the light that arrives at them.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

// From 128 voxels on, blocks are twice as many voxels along a side.
static const char *const GI[] = { "vct:resolution=64", "vct:resolution=112", "vct:resolution=128" };
enum { COUNT = sizeof GI / sizeof GI[0], ALL_BOUNCES = 9 /* of a first frame */ };

TEST_GPU(light_of_a_room_with_furniture_of_sheets)
{
    for (int view = 0; view < 2; view++) {
        struct frame_fixture s;
        trial_sheets(&s, gpu, view);
        const double expected = trial_reference(&s, ALL_BOUNCES, 256).mean[1];
        fixture_finish(&s);
        for (int i = 0; i < COUNT; i++) {
            trial_sheets(&s, gpu, view);
            const double share = trial_technique(&s, GI[i]).mean[1] / expected;
            fixture_finish(&s);
            print_message("%s: view %d: %.3f of the reference's %.3f lux\n", GI[i], view, share,
                          expected);
            CHECK(share > 0.95 && share < 1.05);
        }
    }
}

// Equal but for the position of the voxels, which changes with the bounds of the scene.
TEST_GPU(a_hidden_wall_takes_no_light_from_the_one_before_it)
{
    static const float GAPS[] = { 0, 0.04f, 0.06f, 0.1f };
    for (int i = 0; i < COUNT; i++) {
        double alone = 0;
        for (size_t k = 0; k < sizeof GAPS / sizeof GAPS[0]; k++) {
            struct frame_fixture s;
            trial_lined_room(&s, gpu, GAPS[k]);
            const double lux = trial_technique(&s, GI[i]).mean[1];
            fixture_finish(&s);
            if (k == 0) alone = lux;
            print_message("%s: %.3f lux, a wall %.2f m behind: %.3f\n", GI[i], alone,
                          (double)GAPS[k], lux);
            CHECK_RELATIVE(lux, alone, 0.05);
        }
    }
}
