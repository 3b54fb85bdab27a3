// Light of the sky, which enters through the border of the grid.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/lpv/lpv_fixture.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 8, PIXELS = WIDTH * WIDTH, DIRECTIONS = 5 };

static const vec3s SKY = { { 1, 10, 200 } };

static void set_sky(struct rsm_fixture *rsm)
{
    rsm->constants.sky = SKY;
    rsm->constants.environment_sh[0] = glms_vec3_scale(SKY, sqrtf(4.0f * GLM_PIf));
}

// No lights and no occluders: the sky fills the sphere, so that E = π L for every normal.
static void check_furnace(struct rsm_fixture *rsm, struct lpv *lpv, double tolerance)
{
    static const float normals[DIRECTIONS][3] = {
        { 0, 1, 0 }, { 0, -1, 0 }, { 1, 0, 0 }, { 1, 2, -3 }, { -1, -1, 1 }
    };
    for (int i = 0; i < DIRECTIONS; i++) {
        const vec3s n = glms_vec3_normalize(vec3_of(normals[i][0], normals[i][1], normals[i][2]));
        float got[3 * PIXELS];
        // From corner to corner of the box and slightly beyond.
        rsm_fixture_show_wall(rsm, vec3_of(-2, -1, -3), vec3_of(4, 0, 6), vec3_of(0, 2, 0), n);
        rsm_fixture_upload(rsm);
        lpv_fixture_render(lpv, rsm);
        rsm_fixture_read_irradiance(rsm, got);
        for (int k = 0; k < 3 * PIXELS; k++)
            CHECK_RELATIVE((double)got[k], GLM_PI * (double)SKY.raw[k % 3], tolerance);
    }
}

// The light of the border converges towards the central cells; after 128 steps the remainder is
// below the rounding of half floats.
TEST_GPU(lpv_passes_the_furnace_test_of_the_sky)
{
    const char *cases[] = { "lpv:dim=16,steps=128,sky=true",
                            "lpv:dim=16,steps=128,sky=true,bands=3,lobe=normal",
                            "lpv:dim=16,steps=128,sky=true,focus=0.6666667,precision=float",
                            "holpv:dim=16,steps=128,sky=true" };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct rsm_fixture rsm;
        rsm_fixture_init(&rsm, gpu, WIDTH, WIDTH, 8, 0);
        rsm.view.bounds = (struct box3){ vec3_of(-2, -1, -3), vec3_of(2, 1, 3) };
        set_sky(&rsm);
        struct lpv *lpv = lpv_fixture_create(gpu, cases[i]);
        check_furnace(&rsm, lpv, 5e-3);
        lpv_fixture_destroy(lpv);
        rsm_fixture_finish(&rsm);
    }
}

TEST_GPU(lpv_without_the_option_ignores_the_sky)
{
    struct rsm_fixture rsm;
    float got[3 * PIXELS];
    rsm_fixture_init(&rsm, gpu, WIDTH, WIDTH, 8, 0);
    rsm.view.bounds = (struct box3){ vec3_of(-2, -1, -3), vec3_of(2, 1, 3) };
    set_sky(&rsm);
    rsm_fixture_show_wall(&rsm, vec3_of(-1, 0, -1), vec3_of(1, 0, 1), vec3_of(0, 1, 0),
                          vec3_of(0, 1, 0));
    rsm_fixture_upload(&rsm);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=16,sky=false");
    lpv_fixture_render(lpv, &rsm);
    rsm_fixture_read_irradiance(&rsm, got);
    for (int k = 0; k < 3 * PIXELS; k++) CHECK(got[k] == 0.0f);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

// Sky plus lights equals the sum of both, on the same grid: a sky implies a margin of one cell.
TEST_GPU(lpv_sky_adds_to_other_light)
{
    float sum[3 * PIXELS] = { 0 }, both[3 * PIXELS], got[3 * PIXELS];
    struct frame_emitter point = { .position = vec3_of(0.5f, -0.9f, 0.2f),
                                   .normal = vec3_of(0, 1, 0),
                                   .flux = vec3_of(500, 20, 1) };
    for (int which = 1; which <= 3; which++) {
        struct rsm_fixture rsm;
        rsm_fixture_init(&rsm, gpu, WIDTH, WIDTH, 8, 0);
        rsm.view.bounds = (struct box3){ vec3_of(-2, -1, -3), vec3_of(2, 1, 3) };
        if (which & 1) set_sky(&rsm);
        rsm_fixture_set_emitters(&rsm, &point, which & 2 ? 1 : 0);
        rsm_fixture_show_wall(&rsm, vec3_of(-2, 0.9f, -3), vec3_of(4, 0, 0), vec3_of(0, 0, 6),
                              vec3_of(0, -1, 0));
        rsm_fixture_upload(&rsm);
        struct lpv *lpv = lpv_fixture_create(
            gpu, "lpv:dim=16,sky=true,cell_margin=1,precision=float,closure=linear");
        lpv_fixture_render(lpv, &rsm);
        rsm_fixture_read_irradiance(&rsm, which == 3 ? both : got);
        for (int k = 0; k < 3 * PIXELS && which < 3; k++) {
            CHECK(got[k] > 0.0f);
            sum[k] += got[k];
        }
        lpv_fixture_destroy(lpv);
        rsm_fixture_finish(&rsm);
    }
    for (int k = 0; k < 3 * PIXELS; k++) // 11 bits of three results
        CHECK_RELATIVE((double)both[k], (double)sum[k], 3e-3);
}

// Range of irradiance over πL in the middle of an unoccluded floor of 6 m.
static void floor_under_sky(struct gpu *gpu, const char *text, double *least, double *most)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_floor(&s, 3, fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_look(&s, vec3_of(0, 2, 0.1f), vec3_of(0, 0, 0));
    s.input.environment.sky = SKY;
    fixture_open(&s);
    struct gi *gi = gi_fixture_light(&s, text);
    fixture_render(&s);
    float *e = fixture_read(&s, READ_IRRADIANCE), *depth = fixture_read(&s, READ_DEPTH);
    *least = HUGE_VAL;
    *most = 0;
    for (uint32_t k = 0; k < s.width * s.height; k++)
        for (uint32_t c = 0; c < 3 && depth[k] > 0; c++) {
            const double share = (double)e[3 * k + c] / (GLM_PI * (double)SKY.raw[c]);
            *least = fmin(*least, share);
            *most = fmax(*most, share);
        }
    free(e);
    free(depth);
    gi_destroy(gi);
    fixture_finish(&s);
}

#define LPV   "cascades=1,steps=64,bounces=0,"
#define HOLPV "cascades=1,steps=32,bounces=0,"

// Without geometry the light is isotropic, which the bands represent exactly. With geometry the
// floor occludes the lower hemisphere, which two or three bands approximate and the window blurs:
// two bands give 1/2 + w/2 of a hemisphere.
TEST_GPU(lpv_lights_an_open_floor_with_the_sky)
{
    const struct {
        const char *gi;
        double least, most;
    } cases[] = {
        { "lpv:" LPV "geometry=off", 0.99, 1.01 },
        { "holpv:" HOLPV "geometry=off", 0.99, 1.01 },
        { "lpv:" LPV "window=1", 0.8, 1.1 },
        { "holpv:" HOLPV "window=1", 0.8, 1.1 },
        { "lpv:" LPV "sky=true", 0.8 * 0.75, 1.01 },
        { "holpv:" HOLPV "sky=true", 0.8 * 0.93, 1.01 },
        { "lpv:bounces=0", 0.8 * 0.75, 1.01 },
        { "holpv:bounces=0", 0.8 * 0.93, 1.01 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double least, most;
        floor_under_sky(gpu, cases[i].gi, &least, &most);
        print_message("%s: %.3f to %.3f of the irradiance\n", cases[i].gi, least, most);
        CHECK(least >= cases[i].least && most <= cases[i].most);
    }
}
