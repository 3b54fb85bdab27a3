// Physical trials of small bright surfaces and of a hidden one, for the sources that trace light
// through the scene. Each prints its figures.
#include "techniques/trials/light_trial_scenes.h"
#include "techniques/trials/share_trial.h"
#include "techniques/trials/trial_bakes.h"

// A scene of few surfaces; coarser texels would rather mix the light of both sides of a wall.
#define RADIOSITY_COARSE "radiosity:texels=4096"
// Also of ort: a patch of 0.5 m is seen by texels of less than that.
#define MRT_FINE "mrt" DICTIONARY(16)
#define DRT_FINE "drt" DICTIONARY(16)

TEST_GPU(a_small_sunlit_patch_lights_its_room)
{
    static const struct share_case cases[] = { { "lpv", 0.85 },    { "holpv", 0.95 },
                                               { "vct", 0.5 },     { "vct:trace=cones", 0.5 },
                                               { RADIOSITY, 0.9 }, { ORT_FINE, 0.9 },
                                               { MRT_FINE, 0.95 }, { DRT_FINE, 0.95 } };
    share_trial(gpu, trial_small_patch, "small patch", -1, cases, sizeof cases / sizeof cases[0],
                1.5);
}

// Modes of few numbers ring around a patch that is far brighter than the rest of its room: one
// bounce was black at the feet of walls.
TEST_GPU(walls_are_not_dark_beside_a_lit_patch)
{
    static const struct {
        const char *gi;
        int bounces;
        double least, most;
    } cases[] = { { "lpv", -1, 0.5, 2.0 },
                  { "holpv", -1, 0.5, 2.0 },
                  { "vct", -1, 0.5, 2.0 },
                  { RADIOSITY, -1, 0.8, 1.25 },
                  { MRT_FINE, -1, 0.8, 1.25 },
                  { DRT_FINE, -1, 0.8, 1.25 },
                  { MRT_FINE ",bounces=1", 1, 0.5, 2.0 },
                  { DRT_FINE ",bounces=1", 1, 0.5, 2.0 } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct trial_squares e =
            trial_squares_of(gpu, trial_patch_beside_corner, cases[i].gi, cases[i].bounces, 512, 8);
        print_message("%s: squares of pixels have %.2f to %.2f of their light, mean %.2f\n",
                      cases[i].gi, e.least, e.most, e.mean);
        CHECK(e.least > cases[i].least && e.most < cases[i].most);
    }
}

TEST_GPU(many_small_emitters_give_their_light)
{
    static const struct share_case cases[] = { { "lpv", 0.8 },  { "holpv", 0.9 },
                                               { "vct", 0.85 }, { RADIOSITY, 0.95 },
                                               { ORT, 0.95 },   { PRT, 0.95 },
                                               { MRT, 0.97 },   { DRT, 0.97 } };
    share_trial(gpu, trial_strips, "strips", -1, cases, sizeof cases / sizeof cases[0], 1.6);
}

// Bands that ring leave black spots where light from the walls arrives.
TEST_GPU(nothing_is_black_beside_a_panel)
{
    const struct {
        const char *gi;
        double least;
    } cases[] = { { "holpv:closure=linear", 0 },
                  { "holpv", 0.2 },
                  { "lpv", 0.004 },
                  { "vct", 0.1 },
                  { RADIOSITY, 0.1 },
                  { ORT, 0.1 },
                  { PRT, 0.1 },
                  { MRT, 0.6 },
                  { DRT, 0.6 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct frame_fixture s;
        trial_panel(&s, gpu);
        const struct trial_irradiance e = trial_technique(&s, cases[i].gi);
        fixture_finish(&s);
        print_message("%s: beside a panel at least %.4f of the mean irradiance\n", cases[i].gi,
                      e.least / e.mean[1]);
        CHECK(i == 0 ? e.least == 0 : e.least > cases[i].least * e.mean[1]);
    }
}

static double red_over_green(struct gpu *gpu, const char *gi, float gap)
{
    struct frame_fixture s;
    trial_wall_before_slab(&s, gpu, gap);
    const struct trial_irradiance e = gi ? trial_technique(&s, gi) : trial_reference(&s, -1, 64);
    fixture_finish(&s);
    return e.mean[0] / e.mean[1];
}

// A hidden white slab must not change the colour that the wall before it reflects.
TEST_GPU(a_hidden_surface_does_not_dilute_the_colour_before_it)
{
    const struct {
        const char *gi;
        double tolerance;
    } cases[] = { { "lpv", 0.3 }, { "holpv", 0.15 }, { "vct", 0.03 }, { RADIOSITY_COARSE, 0.02 },
                  { ORT, 0.02 },  { MRT, 0.01 },     { DRT, 0.01 } };
    const double expected = red_over_green(gpu, NULL, 0.02f);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double alone = red_over_green(gpu, cases[i].gi, 0),
                     hidden = red_over_green(gpu, cases[i].gi, 0.02f);
        print_message("%s: red over green %.3f, with a white slab behind %.3f; reference %.3f\n",
                      cases[i].gi, alone, hidden, expected);
        CHECK_RELATIVE(alone, hidden, cases[i].tolerance);
    }
}
