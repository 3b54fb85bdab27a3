// Voxel cone traced ambient occlusion against ray casting with the same decay, closed forms, and a
// twin.
#include "techniques/vct/vct_twin.h"

#include "core/sampling.h"
#include "frame/scene/scene_gpu.h"
#include "scene/view/raycast.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, PIXELS = SIZE * SIZE };

static const double PI = 3.14159265358979323846;

static void begin(struct vct_fixture *fixture, struct gpu *gpu)
{
    vct_fixture_init(fixture, gpu);
    fixture->technique = &technique_vctao;
}

static int grey(struct vct_fixture *fixture)
{
    return fixture_matte(&fixture->frame_fixture, vec3_of(0.5f, 0.5f, 0.5f));
}

// To be freed.
static float *visibility(struct vct_fixture *fixture)
{
    fixture_render(&fixture->frame_fixture);
    return fixture_read(&fixture->frame_fixture, READ_VISIBILITY);
}

struct span {
    double least, mean, most;
};

static struct span span_of(const float *v)
{
    struct span s = { 1.0, 0.0, 0.0 };
    for (int i = 0; i < PIXELS; i++) {
        s.least = fmin(s.least, (double)v[i]);
        s.most = fmax(s.most, (double)v[i]);
        s.mean += (double)v[i] / PIXELS;
    }
    return s;
}

static struct span span_now(struct vct_fixture *fixture)
{
    float *v = visibility(fixture);
    const struct span s = span_of(v);
    free(v);
    return s;
}

// Cosine-weighted visibility by ray casting: 1 − mean of f(r) = 1/(1 + γ r) over the hits. Rays
// begin farther from the surface than the rounding of a position of the G-buffer.
static double visibility_by_rays(const struct raycast *raycast, vec3s p, vec3s n, double decay)
{
    enum { SIDE = 40 };
    vec3s x, y;
    basis_of(n, &x, &y);
    double hidden = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double u = (i % SIDE + 0.5) / SIDE, phi = 2.0 * PI * (i / SIDE + 0.5) / SIDE;
        const float r = (float)sqrt(u);
        const vec3s direction =
            glms_vec3_add(glms_vec3_scale(n, (float)sqrt(1.0 - u)),
                          glms_vec3_add(glms_vec3_scale(x, r * (float)cos(phi)),
                                        glms_vec3_scale(y, r * (float)sin(phi))));
        struct raycast_hit hit;
        const vec3s from = glms_vec3_muladds(n, 5e-3f, p);
        if (!raycast_closest(raycast, from, direction, 1e6f, &hit)) continue;
        hidden += 1.0 / (1.0 + decay * (double)hit.distance);
    }
    return 1.0 - hidden / (SIDE * SIDE);
}

// ---- Fully open and fully closed scenes

// Visibility of a square of 12 m with normal n, seen from above its middle.
static struct span tilted_plane(struct gpu *gpu, vec3s n, const char *options)
{
    struct vct_fixture fixture;
    vec3s x, y;
    begin(&fixture, gpu);
    n = glms_vec3_normalize(n);
    basis_of(n, &x, &y);
    const vec3s a = glms_vec3_scale(x, 6), b = glms_vec3_scale(y, 6);
    fixture_quad(&fixture.frame_fixture, glms_vec3_negate(glms_vec3_add(a, b)), glms_vec3_sub(a, b),
                 glms_vec3_add(a, b), glms_vec3_sub(b, a), grey(&fixture));
    fixture_look(&fixture.frame_fixture,
                 glms_vec3_add(glms_vec3_scale(n, 4), glms_vec3_scale(x, 0.3f)), vec3_of(0, 0, 0));
    vct_fixture_open(&fixture, options);
    const struct span s = span_now(&fixture);
    vct_fixture_finish(&fixture);
    return s;
}

TEST_GPU(a_tilted_plane_is_unoccluded)
{
    static const float directions[][3] = { { 0, 1, 0 },       { 0, 0, 1 }, { 1, 1, 0 },
                                           { 0.3f, 1, 0.1f }, { 1, 1, 1 }, { -1, 0.4f, 0.7f },
                                           { 0.05f, 1, 0 } };
    static const char *const options[] = { "resolution=32,decay=0",
                                           "resolution=32,decay=0,storage=svo" };
    for (int o = 0; o < 2; o++)
        for (size_t i = 0; i < sizeof directions / sizeof directions[0]; i++) {
            const struct span s = tilted_plane(
                gpu, vec3_of(directions[i][0], directions[i][1], directions[i][2]), options[o]);
            print_message("%s, normal %g %g %g: %.3f, %.3f at least\n", options[o],
                          (double)directions[i][0], (double)directions[i][1],
                          (double)directions[i][2], s.mean, s.least);
            // Cones along a tilted plane intersect the staircase of its own voxels: less than a
            // twentieth is occluded.
            CHECK(s.least > 0.95);
        }
}

TEST_GPU(a_closed_room_is_fully_occluded)
{
    struct vct_fixture fixture;
    begin(&fixture, gpu);
    fixture_box(&fixture.frame_fixture, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true, grey(&fixture));
    fixture_look(&fixture.frame_fixture, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    vct_fixture_open(&fixture, "resolution=48,decay=0");
    const struct span s = span_now(&fixture);
    print_message("closed room: %.4f of the sky, %.4f at most\n", s.mean, s.most);
    CHECK(s.mean < 0.01 && s.most < 0.05);
    // With this decay an occluder hides a thousandth only within a millimetre.
    struct vct_options options = fixture.vct->options;
    options.decay = 1e6f;
    technique_set_options(&technique_vctao, fixture.vct, &options);
    CHECK(span_now(&fixture).least == 1.0);
    vct_fixture_finish(&fixture);
}

TEST_GPU(the_background_is_unoccluded)
{
    struct vct_fixture fixture;
    begin(&fixture, gpu);
    vct_fixture_open(&fixture, "");
    CHECK(span_now(&fixture).least == 1.0);
    vct_fixture_finish(&fixture);
    // Background pixels next to a surface, with each final pass.
    static const char *const options[] = { "resolution=32", "resolution=32,interleave=1",
                                           "resolution=32,temporal=true" };
    for (int o = 0; o < 3; o++) {
        begin(&fixture, gpu);
        fixture_quad(&fixture.frame_fixture, vec3_of(-1, -1, -9), vec3_of(1, -1, -9),
                     vec3_of(1, 1, -9), vec3_of(-1, 1, -9), grey(&fixture));
        vct_fixture_open(&fixture, options[o]);
        float *v = visibility(&fixture), *depth = fixture_read(&fixture.frame_fixture, READ_DEPTH);
        int beside = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (depth[i] > 0.0f) continue;
            CHECK(v[i] == 1.0f);
            beside++;
        }
        CHECK(beside > 0 && beside < PIXELS);
        free(v), free(depth);
        vct_fixture_finish(&fixture);
    }
}

// ---- A wall beside a floor

static const float HEIGHT_M = 3.0f, HALF_M = 60.0f;

// A wall along z, long enough to have no ends, at x = 0 beside a floor.
static void crease(struct vct_fixture *fixture, struct gpu *gpu)
{
    begin(fixture, gpu);
    const int matte = grey(fixture);
    fixture_quad(&fixture->frame_fixture, vec3_of(0, 0, HALF_M), vec3_of(9, 0, HALF_M),
                 vec3_of(9, 0, -HALF_M), vec3_of(0, 0, -HALF_M), matte);
    fixture_quad(&fixture->frame_fixture, vec3_of(0, 0, HALF_M), vec3_of(0, 0, -HALF_M),
                 vec3_of(0, HEIGHT_M, -HALF_M), vec3_of(0, HEIGHT_M, HALF_M), matte);
    fixture_look(&fixture->frame_fixture, vec3_of(3, 7, 0.1f), vec3_of(3, 0, 0));
}

// Closed form for an infinite wall of height h: it occludes elevations below β = atan(h/x) on its
// side. A strip between the angles with sines s₁ and s₂ from the normal has the cosine-weighted
// share (s₂ − s₁)/2. From π/2 − β to π/2 that is (1 − cos β)/2; (1 + cos β)/2 is visible.
static double open_beside(double x)
{
    return 0.5 * (1.0 + x / sqrt(x * x + (double)(HEIGHT_M * HEIGHT_M)));
}

static void check_crease(struct gpu *gpu, const char *options, double decay, double worst)
{
    struct vct_fixture fixture;
    struct raycast raycast;
    crease(&fixture, gpu);
    vct_fixture_open(&fixture, options);
    CHECK(raycast_init(&raycast, test_host(), &fixture.frame_fixture.pose));
    float *v = visibility(&fixture), *at = fixture_read(&fixture.frame_fixture, READ_POSITION);
    double off = 0.0, sum = 0.0, difference = 0.0;
    int count = 0;
    for (int i = 0; i < PIXELS; i += 3) {
        const vec3s p = vec3_of(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
        if (fabsf(p.y) > 1e-3f || p.x < 0.05f || p.x > 8.0f) continue; // the floor
        const double due = visibility_by_rays(&raycast, p, vec3_of(0, 1, 0), decay);
        if (decay == 0.0) difference = fmax(difference, fabs(due - open_beside((double)p.x)));
        sum += fabs((double)v[i] - due);
        off += (double)v[i] - due;
        count++;
    }
    print_message("%-60s mean error %.4f, bias %+.4f, rays from the closed form %.4f\n", options,
                  sum / count, off / count, difference);
    CHECK(count > 100);
    CHECK(difference < 0.01); // 40 × 40 rays
    CHECK(sum / count < worst);
    free(v), free(at);
    raycast_finish(&raycast);
    vct_fixture_finish(&fixture);
}

// Voxels of 2 m are enough for rays. Most of the error is the noise of 25 of them.
TEST_GPU(rays_beside_a_wall_match_ray_casting)
{
    check_crease(gpu, "trace=rays,decay=0", 0, 0.04);
    check_crease(gpu, "trace=rays,decay=0.25", 0.25, 0.04);
}

TEST_GPU(visibility_beside_a_wall_matches_ray_casting)
{
    // The grid is 120 m long: 256 voxels make texels of 1 m. Without decay in the cones the error
    // would be 0.1 and more.
    static const struct {
        const char *options;
        double decay, worst;
    } cases[] = { { "resolution=256,decay=0", 0, 0.02 },
                  { "resolution=256,decay=0.25", 0.25, 0.02 },
                  { "resolution=256,decay=1", 1, 0.02 },
                  { "resolution=256,decay=4", 4, 0.02 } };
    for (int i = 0; i < 4; i++) check_crease(gpu, cases[i].options, cases[i].decay, cases[i].worst);
}

// ---- Storages and options

// A room without a ceiling, with a block.
static void courtyard(struct vct_fixture *fixture, struct gpu *gpu)
{
    begin(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
    const int matte = grey(fixture);
    const float w = 10, h = 5;
    fixture_quad(s, vec3_of(0, 0, w), vec3_of(w, 0, w), vec3_of(w, 0, 0), vec3_of(0, 0, 0), matte);
    fixture_quad(s, vec3_of(0, 0, 0), vec3_of(w, 0, 0), vec3_of(w, h, 0), vec3_of(0, h, 0), matte);
    fixture_quad(s, vec3_of(0, 0, w), vec3_of(0, 0, 0), vec3_of(0, h, 0), vec3_of(0, h, w), matte);
    fixture_box(s, vec3_of(4, 0, 3), vec3_of(6, 2.5f, 5), false, matte);
    fixture_look(s, vec3_of(9, 6, 9), vec3_of(3, 1, 3));
}

TEST_GPU(each_storage_matches_ray_casting_and_is_static)
{
    static const struct {
        const char *options;
        double worst; // mean error
    } directions[] = {
        // All cones at each pixel: the error of 25 cones and of voxels.
        { "resolution=48,interleave=1", 0.025 },
        { "resolution=48,interleave=1,storage=svo", 0.03 },
        // Five pixels of this small image are one metre.
        { "resolution=48", 0.045 },
        { "resolution=48,storage=svo", 0.045 },
        { "resolution=48,voxels=raster", 0.045 },
        // Isotropic voxels occlude their own cones, except where points of the octree lie in the
        // surface.
        { "resolution=48,anisotropic=false", 0.2 },
        { "resolution=48,storage=svo,anisotropic=false", 0.06 }
    };
    for (size_t o = 0; o < sizeof directions / sizeof directions[0]; o++) {
        struct vct_fixture fixture;
        struct raycast raycast;
        courtyard(&fixture, gpu);
        vct_fixture_open(&fixture, directions[o].options);
        CHECK(raycast_init(&raycast, test_host(), &fixture.frame_fixture.pose));
        float *v = visibility(&fixture), *later = visibility(&fixture);
        float *at = fixture_read(&fixture.frame_fixture, READ_POSITION),
              *normal = fixture_read(&fixture.frame_fixture, READ_NORMAL),
              *depth = fixture_read(&fixture.frame_fixture, READ_DEPTH);
        double sum = 0.0, off = 0.0;
        int count = 0;
        for (int i = 0; i < PIXELS; i += 5) {
            if (depth[i] <= 0.0f) continue;
            const vec3s p = vec3_of(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
            const vec3s n = vec3_of(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]);
            const double d = (double)v[i] -
                             visibility_by_rays(&raycast, p, n, (double)fixture.vct->options.decay);
            sum += fabs(d);
            off += d;
            count++;
        }
        print_message("%-48s mean error %.4f, bias %+.4f\n", directions[o].options, sum / count,
                      off / count);
        CHECK(count > 100 && sum / count < directions[o].worst);
        assert_memory_equal(v, later, PIXELS * sizeof *v);
        free(v), free(later), free(at), free(normal), free(depth);
        raycast_finish(&raycast);
        vct_fixture_finish(&fixture);
    }
}

// ---- Cones

TEST_GPU(occlusion_cones_match_the_twin)
{
    struct vct_fixture fixture;
    courtyard(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=48,cones=5,interleave=1,step_size=0.5,decay=0.5");
    float *v = visibility(&fixture);
    const struct vct_clip *clip = &fixture.vct->clipmap.levels[0];
    struct vct_twin twin = vct_twin_of(&fixture);
    const double texel_m = 2.0 * (double)clip->grid.cell_m;
    const double wide = 0.5 * (double)vct_cone_width(VCT_CONES_5);
    vec3s lines[VCT_MAX_CONES];
    vct_cone_axes(VCT_CONES_5, lines);
    int compared = 0;
    for (uint32_t y = 1; y < SIZE; y += 5)
        for (uint32_t x = 1; x < SIZE; x += 5) {
            if (fixture_pixel(&fixture.frame_fixture, READ_DEPTH, x, y).x <= 0.0f) continue;
            const vec3s p = fixture_pixel(&fixture.frame_fixture, READ_POSITION, x, y);
            const vec3s n = fixture_pixel(&fixture.frame_fixture, READ_NORMAL, x, y);
            double at[3], normal[3], open = 0.0, cosines = 0.0;
            for (int a = 0; a < 3; a++) {
                normal[a] = (double)n.raw[a];
                at[a] = (double)(p.raw[a] - clip->grid.origin_m.raw[a]) / texel_m;
            }
            for (int i = 0; i < vct_cone_count(VCT_CONES_5); i++) {
                double direction[3], sum[4];
                const double cosine = (double)glms_vec3_dot(n, lines[i]);
                for (int a = 0; a < 3; a++)
                    direction[a] = (cosine < 0.0 ? -1.0 : 1.0) * (double)lines[i].raw[a];
                vct_twin_trace(&twin, at, normal, direction, wide, sum);
                open += fabs(cosine) * (1.0 - sum[0]);
                cosines += fabs(cosine);
            }
            // 8 bits, early termination at 0.005, texture filters with weights of 8 bits.
            CHECK_NEAR((double)v[y * SIZE + x], open / cosines, 0.02);
            compared += open / cosines < 0.9;
        }
    CHECK(compared > 20);
    vct_twin_finish(&twin);
    free(v);
    vct_fixture_finish(&fixture);
}

// ---- Frames

static bool has_pass(const struct gpu *gpu, const char *name)
{
    struct gpu_timing timings[64];
    const int count = gpu_frame_timings(gpu, timings, 64);
    for (int i = 0; i < count && i < 64; i++)
        if (strcmp(timings[i].name, name) == 0) return true;
    return false;
}

TEST_GPU(occlusion_follows_moving_objects)
{
    for (int svo = 0; svo < 2; svo++) {
        const char *options = svo ? "resolution=48,storage=svo" : "resolution=48";
        struct vct_fixture fixture, fresh;
        courtyard(&fixture, gpu);
        const int box = fixture.frame_fixture.scene->instance_count;
        fixture_box(&fixture.frame_fixture, vec3_of(7, 0.01f, 6), vec3_of(8, 1, 7), false,
                    grey(&fixture));
        vct_fixture_open(&fixture, options);
        float *before = visibility(&fixture);
        free(visibility(&fixture));
        CHECK(!has_pass(gpu, "vctao.fill") && !has_pass(gpu, "vctao.leaves"));
        CHECK(has_pass(gpu, "vctao.cones"));
        struct frame_fixture *s = &fixture.frame_fixture;
        for (int i = box; i < s->scene->instance_count; i++) // its faces
            s->pose.world_from_node[s->scene->instances[i].node].raw[3][0] -= 5.0f;
        float *moved = visibility(&fixture), *later = visibility(&fixture);
        double change = 0.0;
        for (int i = 0; i < PIXELS; i++) change += fabs((double)(moved[i] - before[i])) / PIXELS;
        CHECK(change > 0.002);
        // The update is complete after one frame, without a trail.
        assert_memory_equal(moved, later, PIXELS * sizeof *moved);
        courtyard(&fresh, gpu);
        fixture_box(&fresh.frame_fixture, vec3_of(2, 0.01f, 6), vec3_of(3, 1, 7), false,
                    grey(&fresh));
        vct_fixture_open(&fresh, options);
        float *due = visibility(&fresh);
        double difference = 0.0;
        for (int i = 0; i < PIXELS; i++) difference += fabs((double)(moved[i] - due[i])) / PIXELS;
        print_message("%s: change %.4f, difference to a static scene %.4f\n", options, change,
                      difference);
        // Static and dynamic voxels in one texel are not composited as one sheet.
        CHECK(difference < 0.1 * change);
        free(before), free(moved), free(later), free(due);
        vct_fixture_finish(&fixture);
        vct_fixture_finish(&fresh);
    }
}

// Opacity is kept from frame to frame except in grids that follow the camera.
TEST_GPU(occlusion_follows_the_camera_in_clip_levels)
{
    struct vct_fixture fixture, fresh;
    courtyard(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,levels=3");
    float *before = visibility(&fixture);
    courtyard(&fresh, gpu);
    vct_fixture_open(&fresh, "resolution=32,levels=3");
    fixture_look(&fixture.frame_fixture, vec3_of(1, 3, 8), vec3_of(3, 0, 1));
    fixture_look(&fresh.frame_fixture, vec3_of(1, 3, 8), vec3_of(3, 0, 1));
    float *gone = visibility(&fixture), *due = visibility(&fresh);
    CHECK(memcmp(before, gone, PIXELS * sizeof *gone) != 0);
    assert_memory_equal(gone, due, PIXELS * sizeof *gone);
    free(before), free(gone), free(due);
    vct_fixture_finish(&fixture);
    vct_fixture_finish(&fresh);
}

// The exposure and with it the frame's unit follow the light; visibility has no unit.
TEST_GPU(occlusion_history_is_independent_of_exposure)
{
    float *v[2];
    for (int brighter = 0; brighter < 2; brighter++) {
        struct vct_fixture fixture;
        courtyard(&fixture, gpu);
        fixture_add_point(&fixture.frame_fixture, vec3_of(5, 4, 7), vec3_of(300, 300, 300));
        vct_fixture_open(&fixture, "resolution=32,temporal=true");
        for (int f = 0; f < 6; f++) {
            const float candela = brighter && f >= 3 ? 30000.0f : 300.0f;
            fixture.frame_fixture.lights[0].intensity = vec3_of(candela, candela, candela);
            fixture.frame_fixture.input.environment.sky = vec3_of(0.1f * candela, 0, 0);
            fixture_render(&fixture.frame_fixture);
        }
        v[brighter] = fixture_read(&fixture.frame_fixture, READ_VISIBILITY);
        vct_fixture_finish(&fixture);
    }
    assert_memory_equal(v[0], v[1], PIXELS * sizeof *v[0]);
    free(v[0]), free(v[1]);
}

// Options changed at run time have the effect of options at creation.
TEST_GPU(occlusion_options_change_at_run_time)
{
    struct vct_fixture fixture, fresh;
    courtyard(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32");
    free(visibility(&fixture));
    struct vct_options options = fixture.vct->options;
    options.decay = 0.1f;
    options.offset = 1.5f;
    options.step_size = 0.4f;
    options.cones = VCT_CONES_9;
    options.interleave = 3;
    technique_set_options(&technique_vctao, fixture.vct, &options);
    float *got = visibility(&fixture);
    courtyard(&fresh, gpu);
    vct_fixture_open(&fresh,
                     "resolution=32,decay=0.1,offset=1.5,step_size=0.4,cones=9,interleave=3");
    float *due = visibility(&fresh);
    assert_memory_equal(got, due, PIXELS * sizeof *got);
    free(got), free(due);
    vct_fixture_finish(&fixture);
    vct_fixture_finish(&fresh);
}
