// Energy: what is injected stays in the grid, and what comes out of it is near form factors.
#include "techniques/lpv_fixture.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 64, WIDTH = 16, PIXELS = WIDTH * WIDTH };

static double flux_of(struct lpv *lpv, gpu_image volume)
{
    float *cells = lpv_fixture_read(lpv, volume, 1);
    double sum = 0.0;
    for (int i = 0; i < lpv->grid.cells[0] * lpv->grid.cells[1] * lpv->grid.cells[2]; i++)
        sum += (double)cells[SH_COUNT(lpv->options.bands) * i];
    free(cells);
    return sum * sqrt(4.0 * GLM_PI);
}

TEST_GPU(lpv_flux_is_conserved_over_sixteen_steps)
{
    struct stage stage;
    stage_init(&stage, gpu, 8, 8, SIZE, 1);
    // 39 cells fit exactly; the light is near the middle and reaches the outermost cells in the
    // 19th step at the earliest.
    stage.view.bounds = (struct box3){ vec3_of(0, 0, 0), vec3_of(39, 39, 39) };
    stage_set_face(&stage, 0, vec3_of(0, 0, 0), vec3_of(64, 0, 0), vec3_of(0, 64, 0),
                   vec3_of(0, 0, 39), vec3_of(1, 700, 1));
    stage_fill_face(&stage, 0, (struct stage_texel){ .depth = 0 });
    *stage_texel(&stage, 0, 19, 19) =
        (struct stage_texel){ .depth = 0.5f,
                              .normal = glms_vec3_normalize(vec3_of(1, 2, 3)),
                              .reflectance = { 255, 255, 255 } };
    stage_show_wall(&stage, vec3_of(0, 0, 0), vec3_of(1, 0, 0), vec3_of(0, 1, 0), vec3_of(0, 0, 1));
    stage_upload(&stage);
    const struct {
        const char *gi;
        double rounding; // of the 15 steps: floats; halves, which keep 11 bits of what is summed up
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
        lpv_fixture_render(lpv, &stage);
        assert_int_equal(lpv->grid.cells[0], 39);
        const double injected = flux_of(lpv, lpv->volumes.injected);
        // All but the last step, each of which holds the injected flux once; then the last, in 16
        // bits.
        const double sum = flux_of(lpv, lpv->volumes.steps[0]),
                     last = flux_of(lpv, lpv->volumes.light);
        print_message("%s: flux %.6f, over 15 steps %.6f, rounded to 16 bits %.6f of it\n",
                      cases[i].gi, injected, sum / (16.0 * injected), last / (17.0 * injected));
        CHECK_RELATIVE(injected, 700.0, cases[i].rounding);
        CHECK_RELATIVE(sum, 16.0 * injected, cases[i].rounding);
        CHECK_RELATIVE(last, 17.0 * injected, 2e-3);
        lpv_fixture_destroy(lpv);
    }
    stage_finish(&stage);
}

// Irradiance at p (normal n) from the square [a,b]² in the plane z = 0 that sends out 1 lumen/m².
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
    double facing, side, own; // mean irradiance over the mean true one; own: of the lit wall, in
                              // units of its exitance
    double relative;          // mean |error| over mean truth, all walls
};

static const vec3s CORNERS[3] = { { { 0.02f, 0.02f, 9.99f } },
                                  { { 0.01f, 0.02f, 0.02f } },
                                  { { 0.02f, 0.02f, 0.01f } } };
static const vec3s ACROSS[3] = { { { 9.96f, 0, 0 } }, { { 0, 9.96f, 0 } }, { { 9.96f, 0, 0 } } };
static const vec3s DOWN[3] = { { { 0, 9.96f, 0 } }, { { 0, 0, 9.96f } }, { { 0, 9.96f, 0 } } };
static const vec3s NORMALS[3] = { { { 0, 0, -1 } }, { { 1, 0, 0 } }, { { 0, 0, 1 } } };

// A black room of 10 m; of its wall z = 0 the square [a,b]² sends out 1 lumen/m².
static struct room_error room(struct gpu *gpu, const char *options, float a, float b)
{
    struct stage stage;
    stage_init(&stage, gpu, WIDTH, WIDTH, SIZE, 1);
    stage.view.bounds = (struct box3){ vec3_of(0, 0, 0), vec3_of(10, 10, 10) };
    const float texel = (b - a) / SIZE;
    const float lumen = texel * texel;
    stage_set_face(&stage, 0, vec3_of(a, a, 0), vec3_of(b - a, 0, 0), vec3_of(0, b - a, 0),
                   vec3_of(0, 0, 1e-3f), vec3_of(lumen, lumen, lumen));
    stage_fill_face(&stage, 0,
                    (struct stage_texel){
                        .depth = 1, .normal = vec3_of(0, 0, 1), .reflectance = { 255, 255, 255 } });
    struct lpv *lpv = lpv_fixture_create(gpu, options);
    double mean[3] = { 0 }, truth[3] = { 0 }, error = 0.0, all = 0.0;
    for (int wall = 0; wall < 3; wall++) {
        float got[PIXELS * 3];
        const double weight = wall == 1 ? 4.0 : 1.0; // four side walls
        stage_show_wall(&stage, CORNERS[wall], ACROSS[wall], DOWN[wall], NORMALS[wall]);
        stage_upload(&stage);
        lpv_fixture_render(lpv, &stage);
        stage_read_irradiance(&stage, got);
        for (int i = 0; i < PIXELS; i++) {
            const float u = ((float)(i % WIDTH) + 0.5f) / WIDTH,
                        v = ((float)(i / WIDTH) + 0.5f) / WIDTH;
            const vec3s p =
                glms_vec3_add(CORNERS[wall], glms_vec3_add(glms_vec3_scale(ACROSS[wall], u),
                                                           glms_vec3_scale(DOWN[wall], v)));
            const double expected =
                wall == 2 ? 0.0 : wall_irradiance((double)a, (double)b, p, NORMALS[wall]);
            mean[wall] += (double)got[3 * i] / PIXELS;
            truth[wall] += expected / PIXELS;
            error += weight * fabs((double)got[3 * i] - expected);
            all += weight * expected;
        }
    }
    lpv_fixture_destroy(lpv);
    stage_finish(&stage);
    return (struct room_error){ mean[0] / truth[0], mean[1] / truth[1], mean[2], error / all };
}

static struct room_error print_room(struct gpu *gpu, const char *options, float a, float b)
{
    const struct room_error r = room(gpu, options, a, b);
    print_message(
        "%-48s lit %4.1f m: facing %.2f, side %.2f of the truth, own wall %.3f, error %.2f\n",
        options, (double)(b - a), r.facing, r.side, r.own, r.relative);
    return r;
}

// Without the window nothing but the method itself stands between the grid and the form factors, so
// this is where the factor from intensity to irradiance must show right. Light spreads too much on
// its way: the far wall gets less than its share.
TEST_GPU(lpv_of_a_lit_wall_is_near_form_factors)
{
    const struct {
        const char *gi;
        double facing; // at least; the narrower the cells, the more steps spread the light
    } cases[] = { { "lpv:dim=24,window=1,offset=0.5", 0.4 },
                  { "lpv:dim=16,window=1,offset=0.5", 0.55 },
                  { "holpv:dim=24,window=1,offset=0.5", 0.35 },
                  { "holpv:dim=16,window=1,offset=0.5", 0.45 } };
    for (int i = 0; i < 4; i++) {
        const struct room_error r = print_room(gpu, cases[i].gi, 0, 10);
        CHECK(r.facing > cases[i].facing && r.facing < 1.1);
        CHECK(r.side > 0.8 && r.side < 1.2);
        CHECK(r.own < 0.1);
        CHECK(r.relative < 0.3);
    }
}

// The window gives a part of the light back to the wall that it came from.
TEST_GPU(lpv_defaults_are_within_a_half_of_form_factors)
{
    const char *options[] = { "lpv:dim=24",
                              "lpv:dim=16",
                              "holpv:dim=24",
                              "holpv:dim=16",
                              "lpv:dim=16,cascades=3,steps=5",
                              "holpv:dim=16,cascades=3,steps=5" };
    for (int i = 0; i < 6; i++) {
        const struct room_error r = print_room(gpu, options[i], 0, 10);
        CHECK(r.relative < 0.5);
        CHECK(r.side > 0.75 && r.side < 1.25);
        CHECK(r.own < 0.25);
    }
}

// What a wall is lit by itself lessens along its normal; what comes from elsewhere does not.
TEST_GPU(lpv_damping_takes_a_walls_own_light_and_leaves_that_of_others)
{
    const struct room_error all = print_room(gpu, "lpv:dim=16,damping=0", 0, 10),
                            damped = print_room(gpu, "lpv:dim=16,damping=1", 0, 10);
    CHECK(damped.own < 0.8 * all.own);
    CHECK(damped.facing > 0.95 * all.facing && damped.side > 0.95 * all.side);
    CHECK(damped.relative < all.relative);
}

TEST_GPU(lpv_defaults_beat_the_papers_lobe_and_the_other_orientation)
{
    const float lit[2][2] = { { 0, 10 }, { 3, 7 } };
    for (int i = 0; i < 2; i++) {
        const struct room_error ours = print_room(gpu, "lpv:dim=16", lit[i][0], lit[i][1]);
        const struct room_error cosine =
            print_room(gpu, "lpv:dim=16,focus=0.6666667", lit[i][0], lit[i][1]);
        const struct room_error normal =
            print_room(gpu, "lpv:dim=16,lobe=normal", lit[i][0], lit[i][1]);
        CHECK(ours.relative < cosine.relative);
        CHECK(cosine.relative < normal.relative);
    }
}

// A floor of 10 m; near its corner a panel of 2 m × 1.6 m stands upright, faces along the diagonal
// and sends out 1 lumen/m² (Martin 2012, sec. 5.2).
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

// The relative mean squared error where the floor sees the panel; it is limited as that of `diff`.
static double diagonal_relmse(struct gpu *gpu, const char *gi)
{
    struct stage stage;
    stage_init(&stage, gpu, WIDTH, WIDTH, SIZE, 1);
    stage.view.bounds = (struct box3){ vec3_of(0, -0.4f, 0), vec3_of(10, 1.8f, 10) };
    const float lumen = 1.98f * 1.6f / (SIZE * SIZE); // √(1.4² + 1.4²) = 1.98
    stage_set_face(&stage, 0, PANEL, PANEL_ACROSS, PANEL_UP, glms_vec3_scale(PANEL_NORMAL, 1e-3f),
                   vec3_of(lumen, lumen, lumen));
    stage_fill_face(&stage, 0,
                    (struct stage_texel){
                        .depth = 1, .normal = PANEL_NORMAL, .reflectance = { 255, 255, 255 } });
    stage_show_wall(&stage, vec3_of(0.1f, 0, 0.1f), vec3_of(9.8f, 0, 0), vec3_of(0, 0, 9.8f),
                    vec3_of(0, 1, 0));
    stage_upload(&stage);
    struct lpv *lpv = lpv_fixture_create(gpu, gi);
    lpv_fixture_render(lpv, &stage);
    float got[PIXELS * 3];
    stage_read_irradiance(&stage, got);
    double truth[PIXELS], mean = 0.0, sum = 0.0;
    int lit = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float x = ((float)(i % WIDTH) + 0.5f) / WIDTH,
                    z = ((float)(i / WIDTH) + 0.5f) / WIDTH;
        truth[i] = panel_irradiance(vec3_of(0.1f + 9.8f * x, 0, 0.1f + 9.8f * z));
        mean += truth[i];
        lit += truth[i] > 0.0;
    }
    mean /= lit;
    for (int i = 0; i < PIXELS; i++) {
        const double error = (double)got[3 * i] - truth[i];
        if (truth[i] > 0.0) sum += error * error / (truth[i] * truth[i] + 0.01 * mean * mean);
    }
    lpv_fixture_destroy(lpv);
    stage_finish(&stage);
    print_message("%s: relmse %.3f on the diagonal's lit floor\n", gi, sum / lit);
    return sum / lit;
}

TEST_GPU(lpv_of_higher_order_is_nearer_to_the_truth_along_a_diagonal_at_equal_steps)
{
    const char *gis[][2] = { { "lpv:dim=32,steps=10", "holpv:dim=32,steps=10" },
                             { "lpv:dim=32,steps=20", "holpv:dim=32,steps=20" },
                             { "lpv:dim=32,steps=40", "holpv:dim=32,steps=40" } };
    for (int i = 0; i < 3; i++)
        CHECK(diagonal_relmse(gpu, gis[i][1]) < diagonal_relmse(gpu, gis[i][0]));
}
