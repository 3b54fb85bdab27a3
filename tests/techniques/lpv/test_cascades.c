// Cascades: placement, the light that the finer ones start from, and independence of earlier
// frames.
#include "techniques/lpv/lpv_fixture.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 16, WIDTH = 16, PIXELS = WIDTH * WIDTH };

static const struct box3 HALL = { { { -7.3f, 0.1f, -3.2f } }, { { 8.9f, 4.7f, 5.1f } } };

static bool inside(const struct lpv_grid *inner, const struct lpv_grid *outer)
{
    for (int axis = 0; axis < 3; axis++) {
        const double low = (double)inner->origin_m.raw[axis],
                     high = low + (double)inner->cell_m * inner->cells[axis];
        const double outer_low = (double)outer->origin_m.raw[axis],
                     outer_high = outer_low + (double)outer->cell_m * outer->cells[axis];
        if (low < outer_low - 1e-5 || high > outer_high + 1e-5) return false;
    }
    return true;
}

TEST(lpv_cascades_are_nested_and_the_coarsest_contains_the_scene)
{
    struct rng rng = rng_for(3, 0, 0);
    for (int i = 0; i < 200; i++) {
        const vec3s camera = vec3_of(30 * rng_float(&rng) - 15, 20 * rng_float(&rng) - 10,
                                     20 * rng_float(&rng) - 10);
        struct lpv_grid grids[4];
        for (int k = 0; k < 4; k++) {
            lpv_grid_around(HALL, 16, 0.5f * (float)(i % 3), ldexpf(0.27f, k), camera, &grids[k]);
            for (int axis = 0; axis < 3; axis++)
                CHECK(grids[k].cells[axis] >= 1 && grids[k].cells[axis] <= 16);
            if (k > 0) CHECK(inside(&grids[k - 1], &grids[k]));
        }
        CHECK(grids[0].open != 0);
        CHECK(grids[3].open == 0);
        const vec3s size = glms_vec3_scale(
            vec3_of((float)grids[3].cells[0], (float)grids[3].cells[1], (float)grids[3].cells[2]),
            grids[3].cell_m);
        const vec3s end = glms_vec3_add(grids[3].origin_m, size);
        for (int axis = 0; axis < 3; axis++)
            CHECK(grids[3].origin_m.raw[axis] <= HALL.min.raw[axis] &&
                  end.raw[axis] >= HALL.max.raw[axis]);
    }
}

TEST(lpv_cascades_have_one_to_dim_cells_along_an_axis_however_small_these_are)
{
    struct rng rng = rng_for(4, 0, 0);
    for (float cell_m = 1e-44f; cell_m < 1e4f; cell_m *= 3.7f)
        for (int i = 0; i < 32; i++) {
            const vec3s camera = vec3_of(30 * rng_float(&rng) - 15, 20 * rng_float(&rng) - 10,
                                         i % 4 ? 20 * rng_float(&rng) - 10 : 1e9f);
            struct lpv_grid grid;
            lpv_grid_around(HALL, 16, 0.5f * (float)(i % 3), cell_m, camera, &grid);
            CHECK(grid.cell_m >= cell_m);
            for (int axis = 0; axis < 3; axis++)
                CHECK(grid.cells[axis] >= 1 && grid.cells[axis] <= 16);
        }
}

TEST(lpv_cascade_moves_by_two_cells_at_a_time)
{
    struct lpv_grid a, b, c;
    lpv_grid_around(HALL, 8, 0, 0.25f, vec3_of(0.1f, 2.1f, 0.1f), &a);
    lpv_grid_around(HALL, 8, 0, 0.25f, vec3_of(-0.1f, 1.9f, -0.1f), &b);
    lpv_grid_around(HALL, 8, 0, 0.25f, vec3_of(0.6f, 2.1f, 0.1f), &c);
    assert_memory_equal(&a, &b, sizeof a);
    CHECK(c.origin_m.x == a.origin_m.x + 0.5f && c.origin_m.y == a.origin_m.y);
    // Sides within the scene are open, sides of the scene closed.
    CHECK(a.open == (LPV_OPEN(0, 0) | LPV_OPEN(0, 1) | LPV_OPEN(1, 0) | LPV_OPEN(1, 1) |
                     LPV_OPEN(2, 0) | LPV_OPEN(2, 1)));
    lpv_grid_around(HALL, 8, 0, 0.25f, vec3_of(-50, 2, 0), &a);
    CHECK((a.open & LPV_OPEN(0, 0)) == 0 && (a.open & LPV_OPEN(0, 1)) != 0);
}

// A hall of 16 m with a lit patch on its floor; the camera sees the adjacent wall. All is
// translated by `shift`, the camera also by `step`.
static void show_hall(struct rsm_fixture *rsm, struct gpu *gpu, vec3s shift, vec3s step,
                      float patch_x)
{
    rsm_fixture_init(rsm, gpu, WIDTH, WIDTH, SIZE, 1);
    rsm->view.bounds = (struct box3){ glms_vec3_add(vec3_of(0, 0, 0), shift),
                                      glms_vec3_add(vec3_of(16, 4, 8), shift) };
    rsm->constants.camera_position =
        glms_vec3_add(glms_vec3_add(vec3_of(5.2f, 2.1f, 4.3f), shift), step);
    rsm_fixture_set_face(rsm, 0, glms_vec3_add(vec3_of(patch_x, 0, 2), shift), vec3_of(2, 0, 0),
                         vec3_of(0, 0, 2), vec3_of(0, 1e-3f, 0), vec3_of(3, 2, 1));
    rsm_fixture_fill_face(rsm, 0,
                          (struct rsm_fixture_texel){ .depth = 1,
                                                      .normal = vec3_of(0, 1, 0),
                                                      .reflectance = { 255, 200, 90 } });
    rsm_fixture_show_wall(rsm, glms_vec3_add(vec3_of(0.1f, 0.1f, 0.05f), shift),
                          vec3_of(15.8f, 0, 0), vec3_of(0, 3.8f, 0), vec3_of(0, 0, 1));
    rsm_fixture_upload(rsm);
}

static void render(struct lpv *lpv, struct rsm_fixture *rsm, float out[PIXELS * 3])
{
    lpv_fixture_render(lpv, rsm);
    rsm_fixture_read_irradiance(rsm, out);
}

static const char *const GIS[] = { "lpv:dim=16,cascades=3,steps=5",
                                   "holpv:dim=16,cascades=4,steps=4" };

// Relative to the largest value; half floats and cell sizes cause differences.
static void check_same(const float *a, const float *b, double tolerance)
{
    double most = 0.0;
    for (int i = 0; i < PIXELS * 3; i++) most = fmax(most, (double)a[i]);
    CHECK(most > 0.0);
    for (int i = 0; i < PIXELS * 3; i++) CHECK_NEAR((double)a[i], (double)b[i], tolerance * most);
}

TEST_GPU(lpv_cascades_of_a_static_scene_are_equal_in_every_frame)
{
    for (int i = 0; i < 2; i++) {
        struct rsm_fixture rsm;
        float first[PIXELS * 3], second[PIXELS * 3];
        show_hall(&rsm, gpu, vec3_of(0, 0, 0), vec3_of(0, 0, 0), 3);
        struct lpv *lpv = lpv_fixture_create(gpu, GIS[i]);
        render(lpv, &rsm, first);
        render(lpv, &rsm, second);
        check_same(first, second, 0.0);
        lpv_fixture_destroy(lpv);
        rsm_fixture_finish(&rsm);
    }
}

TEST_GPU(lpv_cascades_keep_no_light_of_earlier_frames)
{
    for (int i = 0; i < 2; i++) {
        struct rsm_fixture there, here;
        float moved[PIXELS * 3], fresh[PIXELS * 3];
        show_hall(&there, gpu, vec3_of(0, 0, 0), vec3_of(0, 0, 0), 12);
        show_hall(&here, gpu, vec3_of(0, 0, 0), vec3_of(0, 0, 0), 3);
        struct lpv *lpv = lpv_fixture_create(gpu, GIS[i]), *other = lpv_fixture_create(gpu, GIS[i]);
        render(lpv, &there, moved);
        render(lpv, &here, moved);
        render(other, &here, fresh);
        check_same(moved, fresh, 0.0);
        lpv_fixture_destroy(lpv);
        lpv_fixture_destroy(other);
        rsm_fixture_finish(&there);
        rsm_fixture_finish(&here);
    }
}

TEST_GPU(lpv_cascades_are_invariant_to_translation)
{
    for (int i = 0; i < 2; i++) {
        struct rsm_fixture rsm, shifted;
        float a[PIXELS * 3], b[PIXELS * 3];
        show_hall(&rsm, gpu, vec3_of(0, 0, 0), vec3_of(0, 0, 0), 3);
        struct lpv *lpv = lpv_fixture_create(gpu, GIS[i]);
        render(lpv, &rsm, a);
        const struct lpv_cascade *coarsest = lpv->cascades;
        while (coarsest->coarser) coarsest = coarsest->coarser;
        const float cell = 2.0f * coarsest->grid.cell_m;
        show_hall(&shifted, gpu, vec3_of(3 * cell, -2 * cell, cell), vec3_of(0, 0, 0), 3);
        render(lpv, &shifted, b);
        check_same(a, b, 2e-3);
        lpv_fixture_destroy(lpv);
        rsm_fixture_finish(&rsm);
        rsm_fixture_finish(&shifted);
    }
}

// Whether a pixel of the wall is lit by the finest cascade alone.
static bool shows_finest(const struct lpv_grid *grid, int pixel)
{
    const double wall[3] = { 0.1 + 15.8 * (pixel % WIDTH + 0.5) / WIDTH,
                             0.1 + 3.8 * (pixel / WIDTH + 0.5) / WIDTH, 0.05 };
    for (int axis = 0; axis < 3; axis++) {
        const double at = (wall[axis] - (double)grid->origin_m.raw[axis]) / (double)grid->cell_m;
        if ((grid->open & LPV_OPEN(axis, 0)) && at < 1.0 + LPV_TRANSITION) return false;
        if ((grid->open & LPV_OPEN(axis, 1)) && at > grid->cells[axis] - 1.0 - LPV_TRANSITION)
            return false;
    }
    return true;
}

// The finest grid follows the camera by whole cells, so that the light on surfaces is stable. The
// remaining difference comes from the open sides, where the coarser light enters.
TEST_GPU(lpv_cascades_are_stable_when_the_camera_moves_by_whole_cells)
{
    static const char *const gis[] = { "lpv:dim=32,cascades=2,steps=8",
                                       "holpv:dim=32,cascades=2,steps=6" };
    for (int i = 0; i < 2; i++) {
        struct rsm_fixture rsm, near, next;
        float a[PIXELS * 3], b[PIXELS * 3], c[PIXELS * 3];
        show_hall(&rsm, gpu, vec3_of(0, 0, 0), vec3_of(0, 0, 0), 3);
        struct lpv *lpv = lpv_fixture_create(gpu, gis[i]);
        render(lpv, &rsm, a);
        const struct lpv_grid before = lpv->cascades[0].grid;
        show_hall(&near, gpu, vec3_of(0, 0, 0), vec3_of(0.05f, 0.01f, 0.02f), 3);
        render(lpv, &near, b);
        check_same(a, b, 0.0); // less than a cell: no change
        show_hall(&next, gpu, vec3_of(0, 0, 0), vec3_of(2.0f * before.cell_m, 0, 0), 3);
        render(lpv, &next, c);
        CHECK_NEAR((double)lpv->cascades[0].grid.origin_m.x,
                   (double)(before.origin_m.x + 2.0f * before.cell_m), 1e-5);
        double most = 0.0, worst = 0.0;
        int seen = 0;
        for (int k = 0; k < PIXELS * 3; k++) {
            if (!shows_finest(&before, k / 3) || !shows_finest(&lpv->cascades[0].grid, k / 3))
                continue;
            most = fmax(most, (double)a[k]);
            worst = fmax(worst, fabs((double)a[k] - (double)c[k]));
            seen++;
        }
        print_message("%s: %d values, largest difference %.4f of the maximum\n", gis[i], seen,
                      worst / most);
        CHECK(seen > PIXELS / 2);
        CHECK(worst < 0.01 * most);
        lpv_fixture_destroy(lpv);
        rsm_fixture_finish(&rsm);
        rsm_fixture_finish(&near);
        rsm_fixture_finish(&next);
    }
}

// ---- comparison with the twin

// The coarser light at the centre of a cell, filtered, for cells of half the size.
static void refine_twin(const struct lpv *lpv, const float *coarser, double (*out)[9])
{
    const struct lpv_grid *fine = &lpv->cascades[0].grid, *coarse = &lpv->cascades[1].grid;
    const int count = SH_COUNT(lpv->options.bands);
    for (int i = 0; i < fine->cells[0] * fine->cells[1] * fine->cells[2]; i++) {
        const int cell[3] = { i % fine->cells[0], i / fine->cells[0] % fine->cells[1],
                              i / fine->cells[0] / fine->cells[1] };
        double at[3];
        for (int axis = 0; axis < 3; axis++) {
            const double m =
                (double)fine->origin_m.raw[axis] + (cell[axis] + 0.5) * (double)fine->cell_m;
            at[axis] = (m - (double)coarse->origin_m.raw[axis]) / (double)coarse->cell_m - 0.5;
            at[axis] = fmin(fmax(at[axis], 0.0), coarse->cells[axis] - 1.0);
        }
        for (int k = 0; k < 9; k++) out[i][k] = 0.0;
        for (int corner = 0; corner < 8; corner++) {
            double weight = 0.25; // intensities of equal radiance are ∝ the squared cell size
            int index[3];
            for (int axis = 0; axis < 3; axis++) {
                const double low = floor(at[axis]);
                const int high = corner >> axis & 1;
                weight *= high ? at[axis] - low : 1.0 - (at[axis] - low);
                index[axis] = (int)fmin(low + high, coarse->cells[axis] - 1.0);
            }
            const int from = (index[2] * coarse->cells[1] + index[1]) * coarse->cells[0] + index[0];
            for (int k = 0; k < count; k++) out[i][k] += weight * (double)coarser[from * count + k];
        }
    }
}

static bool is_boundary(const struct lpv_grid *grid, int i)
{
    const int cell[3] = { i % grid->cells[0], i / grid->cells[0] % grid->cells[1],
                          i / grid->cells[0] / grid->cells[1] };
    for (int axis = 0; axis < 3; axis++) {
        if ((grid->open & LPV_OPEN(axis, 0)) && cell[axis] == 0) return true;
        if ((grid->open & LPV_OPEN(axis, 1)) && cell[axis] == grid->cells[axis] - 1) return true;
    }
    return false;
}

static void refinement_equals_the_twin(struct gpu *gpu, const char *gi)
{
    struct rsm_fixture rsm;
    show_hall(&rsm, gpu, vec3_of(0.2f, 0, 0.1f), vec3_of(0, 0, 0), 3);
    struct lpv *lpv = lpv_fixture_create(gpu, gi);
    lpv_fixture_render(lpv, &rsm);
    CHECK(lpv->cascades[0].grid.open != 0 && lpv->cascades[1].grid.open == 0);
    float *coarser =
        lpv_fixture_read_cascade(lpv, lpv->cascades[0].coarser, lpv->cascades[1].light, 1);
    float *got = lpv_fixture_read(lpv, lpv->cascades[0].light, 1);
    struct twin twin;
    twin_init_as(&twin, lpv);
    const int count = (int)twin_cells(&twin), coefficients = SH_COUNT(lpv->options.bands);
    double(*injected)[9] = calloc((size_t)count, sizeof *injected),
    (*begin)[9] = calloc((size_t)count, sizeof *begin);
    lpv_fixture_inject_twin(&twin, &rsm, 1);
    memcpy(injected, twin.light, (size_t)count * sizeof *injected);
    refine_twin(lpv, coarser, begin);
    memcpy(twin.light, begin, (size_t)count * sizeof *begin);
    for (int step = 0; step < lpv->options.steps; step++) {
        twin_propagate(&twin, &lpv->options);
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 9; k++)
                twin.light[i][k] = is_boundary(&lpv->cascades[0].grid, i)
                                       ? begin[i][k]
                                       : twin.light[i][k] + injected[i][k];
    }
    double most = 0.0;
    for (int i = 0; i < count; i++) most = fmax(most, fabs(twin.light[i][0]));
    CHECK(most > 0.0);
    for (int i = 0; i < count * coefficients; i++)
        CHECK_NEAR((double)got[i], twin.light[i / coefficients][i % coefficients], 2e-3 * most);
    free(injected);
    free(begin);
    free(coarser);
    free(got);
    twin_finish(&twin);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

TEST_GPU(lpv_cascade_starts_from_the_coarser_light_and_propagates_as_the_twin)
{
    refinement_equals_the_twin(gpu, "lpv:dim=8,cascades=2,steps=1,precision=float");
    refinement_equals_the_twin(gpu, "lpv:dim=8,cascades=2,steps=4,precision=half");
    refinement_equals_the_twin(gpu, "holpv:dim=8,cascades=2,steps=3,precision=float");
    refinement_equals_the_twin(gpu, "holpv:dim=8,cascades=2,steps=4,precision=half");
}
