// Light in a clip map: equal to that of one grid, less leaking through thin walls, and no visible
// change when a level moves.
#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FLOATS = 32 * 32 * 3 };

static const double PI = 3.14159265358979323846;

// Irradiance of one more frame, all of it finite. To be freed.
static float *irradiance(struct vct_fixture *fixture)
{
    fixture_render(&fixture->frame_fixture);
    float *e = fixture_read(&fixture->frame_fixture, READ_IRRADIANCE);
    for (int i = 0; i < FLOATS; i++) CHECK(isfinite(e[i]) && e[i] >= 0.0f);
    return e;
}

static double mean(const float *values)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) sum += (double)values[i];
    return sum / FLOATS;
}

static double mean_irradiance(struct vct_fixture *fixture)
{
    float *e = irradiance(fixture);
    const double sum = mean(e);
    free(e);
    return sum;
}

static double mean_difference(const float *a, const float *b)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) sum += fabs((double)a[i] - (double)b[i]);
    return sum / FLOATS;
}

// ---- Light

static void make_closed_room(struct vct_fixture *fixture, struct gpu *gpu, bool emissive)
{
    vct_fixture_init(fixture, gpu);
    struct material m = material_default();
    if (emissive) m.emissive = vec3_of(10, 10, 10);
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    m.metallic = 0;
    m.specular = 0; // reflects nothing
    fixture_box(&fixture->frame_fixture, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
                fixture_material(&fixture->frame_fixture, &m));
    if (!emissive) fixture->frame_fixture.input.environment.sky = vec3_of(10, 10, 10);
}

static const char *const level_options[] = { "resolution=48,levels=3", "resolution=32,levels=4",
                                             "resolution=48,levels=2,interleave=1" };

// Black walls of uniform radiance: E = π L, within the bounds of one grid. The cameras see borders
// of levels.
TEST_GPU(furnace_irradiance_is_pi_times_radiance_with_levels)
{
    for (int i = 0; i < 3; i++) {
        struct vct_fixture fixture;
        make_closed_room(&fixture, gpu, true);
        vct_fixture_open(&fixture, level_options[i]);
        const vec3s cameras[] = { { { 2, 3, 8 } }, { { 5.5f, 4, 4.5f } }, { { 1, 1, 1 } } };
        for (int k = 0; k < 3; k++) {
            fixture_look(&fixture.frame_fixture, cameras[k], vec3_of(9, 3, 1.5f));
            const double got = mean_irradiance(&fixture) / (PI * 10.0);
            print_message("%s: furnace %.3f\n", level_options[i], got);
            CHECK(got > 0.98 && got < 1.005);
        }
        vct_fixture_finish(&fixture);
    }
}

TEST_GPU(a_closed_room_occludes_the_sky_with_levels)
{
    for (int i = 0; i < 3; i++) {
        struct vct_fixture fixture;
        make_closed_room(&fixture, gpu, false);
        vct_fixture_open(&fixture, level_options[i]);
        fixture_look(&fixture.frame_fixture, vec3_of(2, 3, 8), vec3_of(9, 3, 1.5f));
        const double got = mean_irradiance(&fixture) / (PI * 10.0);
        print_message("%s: %.4f of the sky in a closed room\n", level_options[i], got);
        CHECK(got < 0.01); // as with one grid: techniques.vct.storage
        vct_fixture_finish(&fixture);
    }
}

static double mean_visibility(struct gpu *gpu, const char *options)
{
    struct vct_fixture fixture;
    vct_fixture_hall(&fixture, gpu);
    fixture.technique = &technique_vctao;
    vct_fixture_open(&fixture, options);
    fixture_render(&fixture.frame_fixture);
    float *v = fixture_read(&fixture.frame_fixture, READ_VISIBILITY);
    double sum = 0.0;
    for (int i = 0; i < 32 * 32; i++) sum += (double)v[i] / (32 * 32);
    free(v);
    vct_fixture_finish(&fixture);
    return sum;
}

// Occlusion decays per metre in every grid: the levels equal one grid as fine.
TEST_GPU(occlusion_of_levels_equals_one_fine_grid)
{
    const double fine = mean_visibility(gpu, "resolution=128"),
                 levels = mean_visibility(gpu, "resolution=32,levels=3"),
                 coarse = mean_visibility(gpu, "resolution=32");
    print_message("visibility: %.3f, with levels %.3f, with the coarse grid alone %.3f\n", fine,
                  levels, coarse);
    // Twice or half the decay would change it by 0.05 and more.
    CHECK_NEAR(levels, fine, 0.02);
}

// A slab of half a coarse voxel between a lit and a dark half of a room, seen from the dark side.
// The reference is 0 there.
static double leak(struct gpu *gpu, const char *options)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    struct frame_fixture *s = &fixture.frame_fixture;
    const int white = fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f));
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(24, 8, 9), true, white);
    fixture_box(s, vec3_of(12.05f, 0, 0), vec3_of(12.45f, 8, 9), false, white);
    fixture_add_point(s, vec3_of(8, 4, 4.5f), vec3_of(900, 900, 900));
    vct_fixture_open(&fixture, options);
    fixture_look(s, vec3_of(14, 2.5f, 4.5f), vec3_of(12.45f, 1, 4.4f));
    const double e = mean_irradiance(&fixture);
    CHECK(fixture.vct->clipmap.levels[0].grid.cell_m > 0.8f);
    vct_fixture_finish(&fixture);
    return e;
}

TEST_GPU(a_wall_thinner_than_a_coarse_voxel_leaks_less_with_levels)
{
    static const char *const directions[] = { "anisotropic=true", "anisotropic=false" };
    // Isotropic voxels mix the radiance of both sides of a wall unless it has texels of its own.
    // Anisotropic voxels separate the sides; what still leaks with levels passes at the foot of the
    // wall, as with one grid as fine.
    const double most[] = { 0.7, 0.3 };
    for (int i = 0; i < 2; i++) {
        double got[2];
        for (int k = 0; k < 2; k++) {
            char options[96];
            snprintf(options, sizeof options, "resolution=32,bounces=1,levels=%d,%s", 1 + 2 * k,
                     directions[i]);
            got[k] = leak(gpu, options);
        }
        print_message("%s: %.3f lx behind a thin wall with one grid, %.3f with three\n",
                      directions[i], got[0], got[1]);
        CHECK(got[1] < most[i] * got[0]);
    }
}

// ---- Camera motion

static float *irradiance_from(struct vct_fixture *fixture, float x)
{
    fixture_look(&fixture->frame_fixture, vec3_of(x, 5, 15), vec3_of(x + 1, 4, 4));
    return irradiance(fixture);
}

static int finest_first(const struct vct_fixture *fixture)
{
    return fixture->vct->clipmap.levels[2].grid.first[0];
}

// The camera moves by 0.1 mm across the position where the finest grid moves.
TEST_GPU(a_moving_level_does_not_change_the_image)
{
    struct vct_fixture fixture;
    vct_fixture_hall(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,levels=3");
    float low = 11.0f, high = 12.1f;
    free(irradiance_from(&fixture, high));
    const int after = finest_first(&fixture);
    free(irradiance_from(&fixture, low));
    const int before = finest_first(&fixture);
    CHECK(after == before + 4); // a step
    while (high - low > 1e-4f) {
        const float middle = 0.5f * (low + high);
        free(irradiance_from(&fixture, middle));
        *(finest_first(&fixture) == before ? &low : &high) = middle;
    }
    for (int i = 0; i < 20; i++) free(irradiance_from(&fixture, low)); // until converged
    float *last = irradiance_from(&fixture, low), *now = irradiance_from(&fixture, high);
    CHECK(finest_first(&fixture) == after);
    double most = mean_difference(now, last) / mean(last);
    print_message("change at a step: %.5f of the mean", most);
    // The next frames, in which bounced irradiance adapts.
    for (int i = 0; i < 20; i++) {
        float *then = irradiance_from(&fixture, high);
        most = fmax(most, mean_difference(then, last) / mean(last));
        free(then);
    }
    print_message(", of the 20 frames after it %.5f at most\n", most);
    // One step of 8 bits is some parts in a thousand.
    CHECK(most < 0.0005);
    free(last);
    free(now);
    vct_fixture_finish(&fixture);
}

struct pan {
    double worst, level; // mean change of pixels, change of the image's mean; over that mean
    int steps;
};

static struct pan pan_with(struct gpu *gpu, const char *options)
{
    struct vct_fixture fixture;
    vct_fixture_hall(&fixture, gpu);
    vct_fixture_open(&fixture, options);
    struct pan pan = { 0 };
    float *last = NULL;
    int first = 0;
    for (int i = 0; i < 32; i++) {
        float *now = irradiance_from(&fixture, 5.0f + 0.1f * (float)i);
        const int clip = fixture.vct->clipmap.count - 1;
        if (last) {
            pan.worst = fmax(pan.worst, mean_difference(now, last) / mean(now));
            pan.level = fmax(pan.level, fabs(mean(now) / mean(last) - 1.0));
            pan.steps += fixture.vct->clipmap.levels[clip].grid.first[0] != first;
        }
        first = fixture.vct->clipmap.levels[clip].grid.first[0];
        free(last);
        last = now;
    }
    free(last);
    vct_fixture_finish(&fixture);
    return pan;
}

TEST_GPU(levels_do_not_flicker_more_than_one_grid_in_a_pan)
{
    const struct pan one = pan_with(gpu, "resolution=32"),
                     three = pan_with(gpu, "resolution=32,levels=3");
    print_message("worst change between frames: %.4f with one grid, %.4f with three over %d steps; "
                  "of the image's mean %.4f and %.4f\n",
                  one.worst, three.worst, three.steps, one.level, three.level);
    CHECK(three.steps >= 3);
    // Smaller voxels resolve more parallax.
    CHECK(three.worst < 1.25 * one.worst);
    CHECK(three.level < 1.25 * one.level);
}

// ---- Cameras outside, debug views

TEST_GPU(cameras_outside_of_the_scene_have_finite_light)
{
    struct vct_fixture fixture;
    vct_fixture_hall(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=16,levels=6,specular=true");
    const vec3s cameras[] = { { { -5, 6, 30 } },     { { 0, 0, 0 } },    { { 13, 400, 10 } },
                              { { 1e6f, 0, 1e6f } }, { { 27, 12, 20 } }, { { 12, 5, 15 } } };
    for (int i = 0; i < 6; i++) {
        fixture_look(&fixture.frame_fixture, cameras[i], vec3_of(13, 6, 10));
        mean_irradiance(&fixture);
    }
    CHECK(mean_irradiance(&fixture) > 0.0);
    vct_fixture_finish(&fixture);
}

struct viewer {
    struct vct *vct;
    gpu_image image;
    const char *view;
};

static void record_view(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct viewer *viewer = user;
    technique_vct.update(viewer->vct, cmd, view);
    technique_vct.record(viewer->vct, cmd, view);
    technique_vct.debug_view(viewer->vct, cmd, view, viewer->view, viewer->image);
}

// Pixels of a view in red, the finest level's colour, and in others. All of it is finite.
static void count_pixels(struct vct_fixture *fixture, struct viewer *viewer, const char *view,
                         int count[2])
{
    float rgba[32 * 32 * 4];
    viewer->view = view;
    fixture_render(&fixture->frame_fixture);
    CHECK(gpu_image_download_float(fixture->frame_fixture.gpu, viewer->image, 0, 0, rgba, 4,
                                   sizeof rgba / sizeof *rgba));
    count[0] = count[1] = 0;
    for (int i = 0; i < 32 * 32; i++) {
        const float *p = rgba + 4 * i;
        CHECK(p[3] == 1.0f);
        for (int k = 0; k < 3; k++) CHECK(isfinite(p[k]) && p[k] >= 0.0f);
        count[0] += p[0] > 4.0f * p[1];
        count[1] += p[0] > 0.0f && p[0] < 4.0f * p[1];
    }
}

TEST_GPU(debug_views_show_the_finest_level_near_the_camera)
{
    struct vct_fixture fixture;
    vct_fixture_hall(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,levels=3");
    struct viewer viewer = { .vct = fixture.vct };
    const struct gpu_image_desc desc = { .name = "test.view",
                                         .format = GPU_RGBA16F,
                                         .width = 32,
                                         .height = 32,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    CHECK(gpu_image_create(gpu, &desc, &viewer.image));
    fixture.frame_fixture.indirect.record = record_view;
    fixture.frame_fixture.indirect.user = &viewer;
    int count[2];
    fixture_look(&fixture.frame_fixture, vec3_of(12, 2, 15), vec3_of(13, 0, 5));
    count_pixels(&fixture, &viewer, "levels", count);
    CHECK(count[0] > 50 && count[1] > 200 && count[0] + count[1] == 32 * 32); // a closed room
    static const char *const views[] = { "reflectance", "normals", "radiance", "overflow" };
    for (int i = 0; i < 4; i++) {
        count_pixels(&fixture, &viewer, views[i], count);
        CHECK(count[0] + count[1] > 700); // reflectance, and normals plus a half, are in all pixels
    }
    // From a distance the coarsest grid is in front of the finer ones.
    fixture_look(&fixture.frame_fixture, vec3_of(60, 30, 50), vec3_of(13, 6, 10));
    count_pixels(&fixture, &viewer, "levels", count);
    CHECK(count[1] > 20);
    gpu_image_destroy(gpu, &viewer.image);
    vct_fixture_finish(&fixture);
}
