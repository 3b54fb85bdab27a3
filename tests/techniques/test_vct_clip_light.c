// Light in a clip map: it is as it is in one grid, thin walls keep it out better, and a picture
// does not show when grids move on.
#include "techniques/vct_rig.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FLOATS = 32 * 32 * 3 };

static const double PI = 3.14159265358979323846;

// Irradiance of one more frame, all of it finite. To be freed.
static float *irradiance(struct vct_rig *rig)
{
    fixture_render(&rig->frame_fixture);
    float *e = fixture_read(&rig->frame_fixture, READ_IRRADIANCE);
    for (int i = 0; i < FLOATS; i++) CHECK(isfinite(e[i]) && e[i] >= 0.0f);
    return e;
}

static double mean(const float *values)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) sum += (double)values[i];
    return sum / FLOATS;
}

static double mean_irradiance(struct vct_rig *rig)
{
    float *e = irradiance(rig);
    const double sum = mean(e);
    free(e);
    return sum;
}

static double apart(const float *a, const float *b)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) sum += fabs((double)a[i] - (double)b[i]);
    return sum / FLOATS;
}

// ---- Light

static void shine(struct vct_rig *rig, struct gpu *gpu, bool glows)
{
    vct_rig_init(rig, gpu);
    struct material m = material_default();
    if (glows) m.emissive = vec3_of(10, 10, 10);
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    m.metallic = 0;
    fixture_box(&rig->frame_fixture, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
                fixture_material(&rig->frame_fixture, &m));
    if (!glows) rig->frame_fixture.input.sky = vec3_of(10, 10, 10);
}

static const char *const level_options[] = { "resolution=48,levels=3", "resolution=32,levels=4",
                                             "resolution=48,levels=2,interleave=1" };

// Black walls that shine evenly: E = π L everywhere, within the bounds of one grid. From places
// where the picture shows the borders of levels.
TEST_GPU(a_furnace_has_pi_times_its_radiance_with_levels)
{
    for (int i = 0; i < 3; i++) {
        struct vct_rig rig;
        shine(&rig, gpu, true);
        vct_rig_open(&rig, level_options[i]);
        const vec3s eyes[] = { { { 2, 3, 8 } }, { { 5.5f, 4, 4.5f } }, { { 1, 1, 1 } } };
        for (int k = 0; k < 3; k++) {
            fixture_look(&rig.frame_fixture, eyes[k], vec3_of(9, 3, 1.5f));
            const double got = mean_irradiance(&rig) / (PI * 10.0);
            print_message("%s: furnace %.3f\n", level_options[i], got);
            CHECK(got > 0.93 && got < 1.01);
        }
        vct_rig_finish(&rig);
    }
}

TEST_GPU(a_closed_room_keeps_the_sky_out_with_levels)
{
    for (int i = 0; i < 3; i++) {
        struct vct_rig rig;
        shine(&rig, gpu, false);
        vct_rig_open(&rig, level_options[i]);
        fixture_look(&rig.frame_fixture, vec3_of(2, 3, 8), vec3_of(9, 3, 1.5f));
        const double got = mean_irradiance(&rig) / (PI * 10.0);
        print_message("%s: %.4f of the sky in a closed room\n", level_options[i], got);
        CHECK(got < 0.01); // as with one grid: test_vct_storage
        vct_rig_finish(&rig);
    }
}

static double mean_visibility(struct gpu *gpu, const char *options)
{
    struct vct_rig rig;
    vct_rig_hall(&rig, gpu);
    rig.technique = &technique_vctao;
    vct_rig_open(&rig, options);
    fixture_render(&rig.frame_fixture);
    float *v = fixture_read(&rig.frame_fixture, READ_VISIBILITY);
    double sum = 0.0;
    for (int i = 0; i < 32 * 32; i++) sum += (double)v[i] / (32 * 32);
    free(v);
    vct_rig_finish(&rig);
    return sum;
}

// Occlusion decays with metres in every grid: levels see what one grid as fine does.
TEST_GPU(occlusion_by_levels_is_that_of_one_fine_grid)
{
    const double fine = mean_visibility(gpu, "resolution=128"),
                 levels = mean_visibility(gpu, "resolution=32,levels=3"),
                 coarse = mean_visibility(gpu, "resolution=32");
    print_message("visibility: %.3f, with levels %.3f, with the coarse grid alone %.3f\n", fine,
                  levels, coarse);
    // Twice or half the fall-off would change it by 0.05 and more.
    CHECK_NEAR(levels, fine, 0.02);
}

// A slab of half a coarse voxel between a bright half of a room and a dark one, seen from close by
// on the dark side. In truth there is no light there.
static double leak(struct gpu *gpu, const char *options)
{
    struct vct_rig rig;
    vct_rig_init(&rig, gpu);
    struct frame_fixture *s = &rig.frame_fixture;
    const int white = fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f));
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(24, 8, 9), true, white);
    fixture_box(s, vec3_of(12.05f, 0, 0), vec3_of(12.45f, 8, 9), false, white);
    fixture_add_point(s, vec3_of(8, 4, 4.5f), vec3_of(900, 900, 900));
    vct_rig_open(&rig, options);
    fixture_look(s, vec3_of(14, 2.5f, 4.5f), vec3_of(12.45f, 1, 4.4f));
    const double e = mean_irradiance(&rig);
    CHECK(rig.vct->clips[0].grid.cell_m > 0.8f);
    vct_rig_finish(&rig);
    return e;
}

TEST_GPU(a_wall_thinner_than_a_coarse_voxel_leaks_less_with_levels)
{
    static const char *const directions[] = { "anisotropic=true", "anisotropic=false" };
    // One volume for all ways mixes what both sides of a voxel send out: there the wall has to have
    // texels of its own. Six ways keep the sides apart; what is left with levels is what cones miss
    // by its foot, and comes with a grid that is as fine everywhere too.
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

// ---- While the eye moves

static float *seen_from(struct vct_rig *rig, float x)
{
    fixture_look(&rig->frame_fixture, vec3_of(x, 5, 15), vec3_of(x + 1, 4, 4));
    return irradiance(rig);
}

static int finest_first(const struct vct_rig *rig)
{
    return rig->vct->clips[2].grid.first[0];
}

// The eye goes over the place where the finest grid moves on, by a tenth of a millimetre in all.
TEST_GPU(a_step_of_the_grids_is_not_seen)
{
    struct vct_rig rig;
    vct_rig_hall(&rig, gpu);
    vct_rig_open(&rig, "resolution=32,levels=3");
    float low = 11.0f, high = 12.1f;
    free(seen_from(&rig, high));
    const int after = finest_first(&rig);
    free(seen_from(&rig, low));
    const int before = finest_first(&rig);
    CHECK(after == before + 4); // a step
    while (high - low > 1e-4f) {
        const float middle = 0.5f * (low + high);
        free(seen_from(&rig, middle));
        *(finest_first(&rig) == before ? &low : &high) = middle;
    }
    for (int i = 0; i < 20; i++) free(seen_from(&rig, low)); // light has come to rest
    float *last = seen_from(&rig, low), *now = seen_from(&rig, high);
    CHECK(finest_first(&rig) == after);
    double most = apart(now, last) / mean(last);
    print_message("change at a step: %.5f of the mean", most);
    // The frames after it, in which light goes on from voxel to voxel.
    for (int i = 0; i < 20; i++) {
        float *then = seen_from(&rig, high);
        most = fmax(most, apart(then, last) / mean(last));
        free(then);
    }
    print_message(", of the 20 frames after it %.5f at most\n", most);
    // A grey level of 8 bits is some parts in a thousand.
    CHECK(most < 0.0005);
    free(last);
    free(now);
    vct_rig_finish(&rig);
}

struct pan {
    double worst, level; // change of a pixel's mean and of the picture's, over its mean
    int steps;
};

static struct pan pan_with(struct gpu *gpu, const char *options)
{
    struct vct_rig rig;
    vct_rig_hall(&rig, gpu);
    vct_rig_open(&rig, options);
    struct pan pan = { 0 };
    float *last = NULL;
    int first = 0;
    for (int i = 0; i < 32; i++) {
        float *now = seen_from(&rig, 5.0f + 0.1f * (float)i);
        const int clip = rig.vct->clip_count - 1;
        if (last) {
            pan.worst = fmax(pan.worst, apart(now, last) / mean(now));
            pan.level = fmax(pan.level, fabs(mean(now) / mean(last) - 1.0));
            pan.steps += rig.vct->clips[clip].grid.first[0] != first;
        }
        first = rig.vct->clips[clip].grid.first[0];
        free(last);
        last = now;
    }
    free(last);
    vct_rig_finish(&rig);
    return pan;
}

TEST_GPU(a_pan_changes_from_frame_to_frame_as_with_one_grid)
{
    const struct pan one = pan_with(gpu, "resolution=32"),
                     three = pan_with(gpu, "resolution=32,levels=3");
    print_message("worst change between frames: %.4f with one grid, %.4f with three over %d steps; "
                  "of the image's mean %.4f and %.4f\n",
                  one.worst, three.worst, three.steps, one.level, three.level);
    CHECK(three.steps >= 3);
    // Smaller voxels show more of what moves past.
    CHECK(three.worst < 1.25 * one.worst);
    CHECK(three.level < 1.25 * one.level);
}

// ---- Odd places, views

TEST_GPU(an_eye_outside_or_far_away_sees_finite_light)
{
    struct vct_rig rig;
    vct_rig_hall(&rig, gpu);
    vct_rig_open(&rig, "resolution=16,levels=6,specular=true");
    const vec3s eyes[] = { { { -5, 6, 30 } },     { { 0, 0, 0 } },    { { 13, 400, 10 } },
                           { { 1e6f, 0, 1e6f } }, { { 27, 12, 20 } }, { { 12, 5, 15 } } };
    for (int i = 0; i < 6; i++) {
        fixture_look(&rig.frame_fixture, eyes[i], vec3_of(13, 6, 10));
        mean_irradiance(&rig);
    }
    CHECK(mean_irradiance(&rig) > 0.0);
    vct_rig_finish(&rig);
}

struct viewer {
    struct vct *vct;
    gpu_image image;
    const char *view;
};

static void record_view(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct viewer *viewer = user;
    technique_vct.record(viewer->vct, cmd, view);
    technique_vct.debug_view(viewer->vct, cmd, view, viewer->view, viewer->image);
}

// Pixels of a view in red, the finest level's colour, and in others. All of it is finite.
static void count_pixels(struct vct_rig *rig, struct viewer *viewer, const char *view, int count[2])
{
    float rgba[32 * 32 * 4];
    viewer->view = view;
    fixture_render(&rig->frame_fixture);
    CHECK(gpu_image_download_float(rig->frame_fixture.gpu, viewer->image, 0, 0, rgba, 4,
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

TEST_GPU(views_show_the_finest_level_about_the_eye_and_others_beyond)
{
    struct vct_rig rig;
    vct_rig_hall(&rig, gpu);
    vct_rig_open(&rig, "resolution=32,levels=3");
    struct viewer viewer = { .vct = rig.vct };
    const struct gpu_image_desc desc = { .name = "test.view",
                                         .format = GPU_RGBA16F,
                                         .width = 32,
                                         .height = 32,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    CHECK(gpu_image_create(gpu, &desc, &viewer.image));
    rig.frame_fixture.indirect.record = record_view;
    rig.frame_fixture.indirect.user = &viewer;
    int count[2];
    fixture_look(&rig.frame_fixture, vec3_of(12, 2, 15), vec3_of(13, 0, 5));
    count_pixels(&rig, &viewer, "levels", count);
    CHECK(count[0] > 50 && count[1] > 200 && count[0] + count[1] == 32 * 32); // a closed room
    static const char *const views[] = { "reflectance", "normals", "radiance", "room" };
    for (int i = 0; i < 4; i++) {
        count_pixels(&rig, &viewer, views[i], count);
        CHECK(count[0] + count[1] > 700); // reflectance, and normals plus a half, are in all pixels
    }
    // From afar the scene's grid comes before the finer ones about the nearest place.
    fixture_look(&rig.frame_fixture, vec3_of(60, 30, 50), vec3_of(13, 6, 10));
    count_pixels(&rig, &viewer, "levels", count);
    CHECK(count[1] > 20);
    gpu_image_destroy(gpu, &viewer.image);
    vct_rig_finish(&rig);
}
