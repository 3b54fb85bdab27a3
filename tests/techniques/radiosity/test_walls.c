// A partition of 20 cm that stands in a room of 12 × 3 × 8, at texels of up to 40 cm: lookups
// beside it show the light of their own side.
#include "techniques/trials/light_trial.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 96 };

// A point light on the left of the partition, which is at x = 0 and ends at `end` along z, and the
// camera on its right, towards its foot, or on the left.
static void build(struct frame_fixture *s, struct gpu *gpu, float end, bool lit)
{
    const float x = lit ? -4.5f : 4.5f;
    fixture_init(s, gpu);
    s->width = s->height = SIZE;
    const int grey = fixture_matte(s, vec3_of(0.6f, 0.6f, 0.6f));
    fixture_box(s, vec3_of(-6, 0, -4), vec3_of(6, 3, 4), true, grey);
    fixture_box(s, vec3_of(-0.1f, 0, -4), vec3_of(0.1f, 3, end), false, grey);
    fixture_add_point(s, vec3_of(-3, 2.5f, 0), vec3_of(800, 800, 800));
    fixture_look(s, vec3_of(x, 2.4f, 3), vec3_of(0, 0.3f, -1.5f));
}

// [SIZE · SIZE] irradiance of green, lux. Owned by the caller.
static double *irradiance_of(struct gpu *gpu, const char *gi, float end, bool lit)
{
    struct frame_fixture s;
    double *out = calloc((size_t)SIZE * SIZE, sizeof *out);
    assert_non_null(out);
    build(&s, gpu, end, lit);
    float *e = trial_pixels(&s, gi);
    for (int i = 0; i < SIZE * SIZE; i++) out[i] = (double)e[3 * i + 1];
    free(e);
    fixture_finish(&s);
    return out;
}

static double mean_of(const double *e)
{
    double sum = 0.0;
    for (int i = 0; i < SIZE * SIZE; i++) sum += e[i];
    return sum / (SIZE * SIZE);
}

static double most_of(const double *e)
{
    double most = 0.0;
    for (int i = 0; i < SIZE * SIZE; i++) most = fmax(most, e[i]);
    return most;
}

// Whatever the place of the partition in the texels.
TEST_GPU(no_light_passes_a_partition)
{
    static const int TEXELS[] = { 2048, 3000, 3500, 4096 };
    for (size_t i = 0; i < sizeof TEXELS / sizeof TEXELS[0]; i++) {
        char gi[48];
        snprintf(gi, sizeof gi, "radiosity:texels=%d,rays=128", TEXELS[i]);
        double *lit = irradiance_of(gpu, gi, 4, true), *dark = irradiance_of(gpu, gi, 4, false);
        print_message("%s: behind a partition %.5f of the light, %.4f in the worst pixel\n", gi,
                      mean_of(dark) / mean_of(lit), most_of(dark) / mean_of(lit));
        CHECK(mean_of(lit) > 0.0);
        CHECK(mean_of(dark) < 1e-3 * mean_of(lit));
        CHECK(most_of(dark) < 0.01 * mean_of(lit));
        free(lit);
        free(dark);
    }
}

// Light comes past the end of the partition. Texels of 40 cm against those of 7 cm.
TEST_GPU(coarse_texels_show_no_line_round_a_partition)
{
    double *fine = irradiance_of(gpu, "radiosity", 2.5f, false);
    double *coarse = irradiance_of(gpu, "radiosity:texels=2048", 2.5f, false);
    double most = 0.0;
    for (int i = 0; i < SIZE * SIZE; i++) most = fmax(most, (coarse[i] - fine[i]) / mean_of(fine));
    print_message("coarse texels: %.3f of the light of fine ones; %.2f of the mean more at worst\n",
                  mean_of(coarse) / mean_of(fine), most);
    CHECK_RELATIVE(mean_of(coarse), mean_of(fine), 0.1);
    CHECK(most < 1.0);
    free(fine);
    free(coarse);
}
