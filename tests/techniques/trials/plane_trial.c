#include "techniques/trials/plane_trial.h"

#include "techniques/trials/light_trial_scenes.h"
#include "techniques/trials/trial_bakes.h"

#include <math.h>

static struct trial_irradiance irradiance_of(struct gpu *gpu, const char *gi,
                                             struct trial_plane plane)
{
    struct frame_fixture s;
    trial_open_plane(&s, gpu, &plane);
    const struct trial_irradiance e = trial_technique(&s, gi);
    fixture_finish(&s);
    return e;
}

static const char *sides_of(bool double_sided)
{
    return double_sided ? "double-sided" : "single-sided";
}

// Mean irradiance over that by the sun.
static double own_light(struct gpu *gpu, const char *gi, float tilt, bool double_sided)
{
    const struct trial_irradiance e =
        irradiance_of(gpu, gi, (struct trial_plane){ tilt, double_sided, .sun = true });
    print_message("%s: plane, tilt %.2f, %s: %.4f of the sun, at most %.4f\n", gi, (double)tilt,
                  sides_of(double_sided), e.mean[1] / 1000, e.most / 1000);
    return e.mean[1] / 1000;
}

// To mrt a plane inside a block is a part of its walls; to drt it is clutter.
void plane_trial_own_light(struct gpu *gpu, float tilt)
{
    const struct {
        const char *gi;
        double most;
    } cases[] = { { "lpv", 0.01 },  { "holpv", 0.015 },
                  { "vct", 0.01 },  { "vct:resolution=128", 0.01 },
                  { RADIOSITY, 0 }, { ORT, 0 },
                  { PRT, 0 },       { MRT, 0.15 },
                  { DRT, 0 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int sides = 1; sides <= 2; sides++)
            CHECK(own_light(gpu, cases[i].gi, tilt, sides == 2) <= cases[i].most);
}

// Least and largest irradiance of a pixel, largest error of the mean of a plane, relative to πL.
struct sky_range {
    double least, most, mean_error;
};

static struct sky_range sky_share(struct gpu *gpu, const char *gi, float tilt)
{
    struct sky_range range = { HUGE_VAL, 0, 0 };
    for (int sides = 1; sides <= 2; sides++) {
        const struct trial_irradiance e =
            irradiance_of(gpu, gi, (struct trial_plane){ tilt, sides == 2, .sun = false });
        // A tilted plane's sky fills the sphere: a half of it is above the plane.
        print_message("%s: sky, tilt %.2f, %s: %.4f, %.4f to %.4f of its irradiance\n", gi,
                      (double)tilt, sides_of(sides == 2), e.mean[1] / GLM_PI, e.least / GLM_PI,
                      e.most / GLM_PI);
        range.least = fmin(range.least, e.least / GLM_PI);
        range.most = fmax(range.most, e.most / GLM_PI);
        range.mean_error = fmax(range.mean_error, fabs(e.mean[1] / GLM_PI - 1));
    }
    return range;
}

void plane_trial_sky(struct gpu *gpu, float tilt)
{
    const struct {
        const char *gi;
        struct sky_range bound;
    } cases[] = { { "lpv", { 0.77, 1.05, 0.08 } },  { "holpv", { 0.83, 1.13, 0.035 } },
                  { "vct", { 0.98, 1.01, 0.02 } },  { RADIOSITY, { 0.999, 1.001, 0.001 } },
                  { ORT, { 0.999, 1.001, 0.001 } }, { PRT, { 0.999, 1.001, 0.001 } },
                  { MRT, { 0.44, 1.57, 0.34 } },    { DRT, { 0.999, 1.001, 0.001 } } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct sky_range got = sky_share(gpu, cases[i].gi, tilt), bound = cases[i].bound;
        CHECK(got.least >= bound.least && got.most <= bound.most);
        CHECK(got.mean_error <= bound.mean_error);
    }
}
