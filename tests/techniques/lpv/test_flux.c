// Energy: the injected flux is conserved, and irradiance is close to form factors.
#include "techniques/lpv/lpv_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 64, WIDTH = 16, PIXELS = WIDTH * WIDTH };

static double flux_of(struct lpv *lpv, gpu_image volume)
{
    float *cells = lpv_fixture_read(lpv, volume, 1);
    double sum = 0.0;
    for (int i = 0; i < lpv->cascades[0].grid.cells[0] * lpv->cascades[0].grid.cells[1] *
                            lpv->cascades[0].grid.cells[2];
         i++)
        sum += (double)cells[SH_COUNT(lpv->options.bands) * i];
    free(cells);
    return sum * sqrt(4.0 * GLM_PI);
}

TEST_GPU(lpv_flux_is_conserved_over_sixteen_steps)
{
    struct rsm_fixture rsm;
    rsm_fixture_init(&rsm, gpu, 8, 8, SIZE, 1);
    // 39 cells fit exactly; the light is near the centre and cannot reach the outermost cells
    // before the 19th step.
    rsm.view.bounds = (struct box3){ vec3_of(0, 0, 0), vec3_of(39, 39, 39) };
    rsm_fixture_set_face(&rsm, 0, vec3_of(0, 0, 0), vec3_of(64, 0, 0), vec3_of(0, 64, 0),
                         vec3_of(0, 0, 39), vec3_of(1, 700, 1));
    rsm_fixture_fill_face(&rsm, 0, (struct rsm_fixture_texel){ .depth = 0 });
    *rsm_fixture_texel(&rsm, 0, 19, 19) =
        (struct rsm_fixture_texel){ .depth = 0.5f,
                                    .normal = glms_vec3_normalize(vec3_of(1, 2, 3)),
                                    .reflectance = { 255, 255, 255 } };
    rsm_fixture_show_wall(&rsm, vec3_of(0, 0, 0), vec3_of(1, 0, 0), vec3_of(0, 1, 0),
                          vec3_of(0, 0, 1));
    rsm_fixture_upload(&rsm);
    const struct {
        const char *gi;
        double rounding; // of 15 steps in floats, or in halves of 11 bits
    } cases[] = { { "lpv:dim=40,steps=16,precision=float", 1e-5 },
                  { "lpv:dim=40,steps=16,precision=float,focus=0.6666667", 1e-5 },
                  { "lpv:dim=40,steps=16,precision=float,lobe=normal", 1e-5 },
                  { "lpv:dim=40,steps=16,precision=half", 2e-3 },
                  { "holpv:dim=40,steps=16,precision=float", 1e-5 },
                  { "holpv:dim=40,steps=16,precision=float,focus=0.6666667", 1e-5 },
                  { "holpv:dim=40,steps=16,precision=float,lobe=normal", 1e-5 },
                  { "holpv:dim=40,steps=16,precision=half", 2e-3 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct lpv *lpv = lpv_fixture_create(gpu, cases[i].gi);
        lpv_fixture_render(lpv, &rsm);
        assert_int_equal(lpv->cascades[0].grid.cells[0], 39);
        const double injected = flux_of(lpv, lpv->injection.injected);
        // Each step adds the injected flux once; the last step is stored in 16 bits.
        const double sum = flux_of(lpv, lpv->propagation.steps[0]),
                     last = flux_of(lpv, lpv->cascades[0].light);
        print_message("%s: flux %.6f, after 15 steps %.6f, in 16 bits %.6f of it\n", cases[i].gi,
                      injected, sum / (16.0 * injected), last / (17.0 * injected));
        CHECK_RELATIVE(injected, 700.0, cases[i].rounding);
        CHECK_RELATIVE(sum, 16.0 * injected, cases[i].rounding);
        CHECK_RELATIVE(last, 17.0 * injected, 2e-3);
        lpv_fixture_destroy(lpv);
    }
    rsm_fixture_finish(&rsm);
}

// Irradiance at p (normal n) from the square [a,b]² in the plane z = 0 that emits 1 lumen/m².
static double wall_irradiance(double a, double b, vec3s p, vec3s n)
{
    enum { N = 120 };
    const double step = (b - a) / N;
    double sum = 0.0;
    for (int i = 0; i < N * N; i++) {
        const double d[3] = { a + (i % N + 0.5) * step - (double)p.x,
                              a + (i / N + 0.5) * step - (double)p.y, -(double)p.z };
        const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        const double here = d[0] * (double)n.x + d[1] * (double)n.y + d[2] * (double)n.z;
        if (here > 0.0) sum += here * (double)p.z / (r2 * r2);
    }
    return sum * step * step / GLM_PI;
}

struct room_error {
    double facing, side; // mean irradiance over the reference
    double own;          // of the lit wall, in units of its exitance
    double relative;     // mean |error| over the mean reference, all walls
};

static const vec3s CORNERS[3] = { { { 0.02f, 0.02f, 9.99f } },
                                  { { 0.01f, 0.02f, 0.02f } },
                                  { { 0.02f, 0.02f, 0.01f } } };
static const vec3s ACROSS[3] = { { { 9.96f, 0, 0 } }, { { 0, 9.96f, 0 } }, { { 9.96f, 0, 0 } } };
static const vec3s DOWN[3] = { { { 0, 9.96f, 0 } }, { { 0, 0, 9.96f } }, { { 0, 9.96f, 0 } } };
static const vec3s NORMALS[3] = { { { 0, 0, -1 } }, { { 1, 0, 0 } }, { { 0, 0, 1 } } };

// A black room of 10 m; the square [a,b]² of its wall z = 0 emits 1 lumen/m².
static struct room_error room(struct gpu *gpu, const char *options, float a, float b)
{
    struct rsm_fixture rsm;
    rsm_fixture_init(&rsm, gpu, WIDTH, WIDTH, SIZE, 1);
    rsm.view.bounds = (struct box3){ vec3_of(0, 0, 0), vec3_of(10, 10, 10) };
    const float texel = (b - a) / SIZE;
    const float lumen = texel * texel;
    rsm_fixture_set_face(&rsm, 0, vec3_of(a, a, 0), vec3_of(b - a, 0, 0), vec3_of(0, b - a, 0),
                         vec3_of(0, 0, 1e-3f), vec3_of(lumen, lumen, lumen));
    rsm_fixture_fill_face(&rsm, 0,
                          (struct rsm_fixture_texel){ .depth = 1,
                                                      .normal = vec3_of(0, 0, 1),
                                                      .reflectance = { 255, 255, 255 } });
    char text[128]; // there are no triangles that would occlude the light behind the wall
    snprintf(text, sizeof text, "%s,geometry=off", options);
    struct lpv *lpv = lpv_fixture_create(gpu, text);
    double mean[3] = { 0 }, reference[3] = { 0 }, error = 0.0, all = 0.0;
    for (int wall = 0; wall < 3; wall++) {
        float got[PIXELS * 3];
        const double weight = wall == 1 ? 4.0 : 1.0; // four side walls
        rsm_fixture_show_wall(&rsm, CORNERS[wall], ACROSS[wall], DOWN[wall], NORMALS[wall]);
        rsm_fixture_upload(&rsm);
        lpv_fixture_render(lpv, &rsm);
        rsm_fixture_read_irradiance(&rsm, got);
        for (int i = 0; i < PIXELS; i++) {
            const float u = ((float)(i % WIDTH) + 0.5f) / WIDTH,
                        v = ((float)(i / WIDTH) + 0.5f) / WIDTH;
            const vec3s p =
                glms_vec3_add(CORNERS[wall], glms_vec3_add(glms_vec3_scale(ACROSS[wall], u),
                                                           glms_vec3_scale(DOWN[wall], v)));
            const double expected =
                wall == 2 ? 0.0 : wall_irradiance((double)a, (double)b, p, NORMALS[wall]);
            mean[wall] += (double)got[3 * i] / PIXELS;
            reference[wall] += expected / PIXELS;
            error += weight * fabs((double)got[3 * i] - expected);
            all += weight * expected;
        }
    }
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
    return (struct room_error){ mean[0] / reference[0], mean[1] / reference[1], mean[2],
                                error / all };
}

static struct room_error print_room(struct gpu *gpu, const char *options, float a, float b)
{
    const struct room_error r = room(gpu, options, a, b);
    print_message(
        "%-48s lit %4.1f m: facing %.2f, side %.2f of the form factor, own wall %.3f, error %.2f\n",
        options, (double)(b - a), r.facing, r.side, r.own, r.relative);
    return r;
}

// A lookup reads the flux across a side of its cell: a wall receives none of its own light, but
// what focus < 1 scatters back, with the positive closures. Light spreads during propagation: the
// facing wall receives less than its form factor.
TEST_GPU(lpv_of_a_lit_wall_is_close_to_form_factors)
{
    const struct {
        const char *gi;
        double facing; // at least; smaller cells mean more steps, which spread the light
        double own;
    } cases[] = { { "lpv:dim=24", 0.58, 0.03 },
                  { "lpv:dim=16", 0.58, 0.03 },
                  { "lpv:dim=24,closure=linear,focus=0.96", 0.6, 0.01 },
                  { "lpv:dim=16,closure=linear,focus=0.96", 0.89, 0.01 },
                  { "holpv:dim=24", 0.75, 0.03 },
                  { "holpv:dim=16", 0.8, 0.03 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct room_error r = print_room(gpu, cases[i].gi, 0, 10);
        CHECK(r.facing > cases[i].facing && r.facing < 1.1);
        CHECK(r.side > 0.8 && r.side < 1.2);
        CHECK(r.own < cases[i].own);
        CHECK(r.relative < 0.25);
    }
}

TEST_GPU(lpv_cascades_are_close_to_form_factors)
{
    const char *options[] = { "lpv:dim=16,cascades=3,steps=5", "holpv:dim=16,cascades=3,steps=5" };
    for (int i = 0; i < 2; i++) {
        const struct room_error r = print_room(gpu, options[i], 0, 10);
        CHECK(r.relative < 0.25);
        CHECK(r.side > 0.8 && r.side < 1.2);
        CHECK(r.own < (i == 0 ? 0.02 : 0.03));
    }
}

// A wall's own light, which a smaller window returns, decreases along its normal; light from
// elsewhere does not.
TEST_GPU(lpv_damping_removes_a_walls_own_light_only)
{
    const struct room_error all = print_room(
                                gpu, "lpv:dim=16,closure=linear,focus=0.96,window=0.5,damping=0", 0,
                                10),
                            damped = print_room(
                                gpu, "lpv:dim=16,closure=linear,focus=0.96,window=0.5,damping=1", 0,
                                10);
    CHECK(damped.own < 0.8 * all.own);
    CHECK(damped.facing > 0.95 * all.facing && damped.side > 0.95 * all.side);
}

TEST_GPU(lpv_defaults_beat_the_papers_lobe_and_the_other_orientation)
{
    const float lit[2][2] = { { 0, 10 }, { 3, 7 } };
    for (int i = 0; i < 2; i++) {
        const struct room_error ours =
            print_room(gpu, "lpv:dim=16,closure=linear,focus=0.96", lit[i][0], lit[i][1]);
        const struct room_error cosine =
            print_room(gpu, "lpv:dim=16,closure=linear,focus=0.6666667", lit[i][0], lit[i][1]);
        const struct room_error normal = print_room(
            gpu, "lpv:dim=16,closure=linear,focus=0.96,lobe=normal", lit[i][0], lit[i][1]);
        CHECK(ours.relative < cosine.relative);
        CHECK(cosine.relative < normal.relative);
    }
}

// A floor of 10 m; near its corner an upright panel of 2 m × 1.6 m faces along the diagonal and
// emits 1 lumen/m² (Martin 2012, sec. 5.2).
static const vec3s PANEL = { { 1.5f, 0.2f, 2.9f } }, PANEL_ACROSS = { { 1.4f, 0, -1.4f } },
                   PANEL_UP = { { 0, 1.6f, 0 } },
                   PANEL_NORMAL = { { 0.70710678f, 0, 0.70710678f } };

static double panel_irradiance(vec3s p)
{
    enum { N = 40 };
    double sum = 0.0;
    for (int i = 0; i < N * N; i++) {
        const float u = ((float)(i % N) + 0.5f) / N, v = ((float)(i / N) + 0.5f) / N;
        const vec3s at = glms_vec3_add(
            PANEL, glms_vec3_add(glms_vec3_scale(PANEL_ACROSS, u), glms_vec3_scale(PANEL_UP, v)));
        const vec3s to = glms_vec3_sub(at, p);
        const double r2 = (double)glms_vec3_norm2(to);
        const double leaves = -(double)glms_vec3_dot(to, PANEL_NORMAL);
        if (leaves > 0.0) sum += (double)to.y * leaves / (r2 * r2);
    }
    return sum / (N * N) * (double)glms_vec3_norm(PANEL_ACROSS) * (double)PANEL_UP.y / GLM_PI;
}

// Relative mean squared error where the floor sees the panel, regularised as in `afterglow diff`.
static double diagonal_relmse(struct gpu *gpu, const char *gi)
{
    struct rsm_fixture rsm;
    rsm_fixture_init(&rsm, gpu, WIDTH, WIDTH, SIZE, 1);
    rsm.view.bounds = (struct box3){ vec3_of(0, -0.4f, 0), vec3_of(10, 1.8f, 10) };
    const float lumen = 1.98f * 1.6f / (SIZE * SIZE); // √(1.4² + 1.4²) = 1.98
    rsm_fixture_set_face(&rsm, 0, PANEL, PANEL_ACROSS, PANEL_UP,
                         glms_vec3_scale(PANEL_NORMAL, 1e-3f), vec3_of(lumen, lumen, lumen));
    rsm_fixture_fill_face(&rsm, 0,
                          (struct rsm_fixture_texel){ .depth = 1,
                                                      .normal = PANEL_NORMAL,
                                                      .reflectance = { 255, 255, 255 } });
    rsm_fixture_show_wall(&rsm, vec3_of(0.1f, 0, 0.1f), vec3_of(9.8f, 0, 0), vec3_of(0, 0, 9.8f),
                          vec3_of(0, 1, 0));
    rsm_fixture_upload(&rsm);
    struct lpv *lpv = lpv_fixture_create(gpu, gi);
    lpv_fixture_render(lpv, &rsm);
    float got[PIXELS * 3];
    rsm_fixture_read_irradiance(&rsm, got);
    double reference[PIXELS], mean = 0.0, sum = 0.0;
    int lit = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float x = ((float)(i % WIDTH) + 0.5f) / WIDTH,
                    z = ((float)(i / WIDTH) + 0.5f) / WIDTH;
        reference[i] = panel_irradiance(vec3_of(0.1f + 9.8f * x, 0, 0.1f + 9.8f * z));
        mean += reference[i];
        lit += reference[i] > 0.0;
    }
    mean /= lit;
    for (int i = 0; i < PIXELS; i++) {
        const double error = (double)got[3 * i] - reference[i];
        if (reference[i] > 0.0)
            sum += error * error / (reference[i] * reference[i] + 0.01 * mean * mean);
    }
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
    print_message("%s: relmse %.3f on the diagonal's lit floor\n", gi, sum / lit);
    return sum / lit;
}

TEST_GPU(lpv_of_higher_order_has_less_error_along_a_diagonal_at_equal_steps)
{
    const char *gis[][2] = {
        { "lpv:dim=32,steps=10,closure=linear", "holpv:dim=32,steps=10,closure=linear" },
        { "lpv:dim=32,steps=20,closure=linear", "holpv:dim=32,steps=20,closure=linear" },
        { "lpv:dim=32,steps=40,closure=linear", "holpv:dim=32,steps=40,closure=linear" }
    };
    for (int i = 0; i < 3; i++)
        CHECK(diagonal_relmse(gpu, gis[i][1]) < diagonal_relmse(gpu, gis[i][0]));
}
