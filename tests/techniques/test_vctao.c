// Ambient occlusion by voxel cones: against rays with the same fall-off, closed forms, and a twin.
#include "techniques/vct_twin.h"

#include "core/sampling.h"
#include "frame/scene_gpu.h"
#include "scene/raycast.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, PIXELS = SIZE * SIZE };

static const double PI = 3.14159265358979323846;

static void begin(struct vct_rig *rig, struct gpu *gpu)
{
    vct_rig_init(rig, gpu);
    rig->technique = &technique_vctao;
}

static int grey(struct vct_rig *rig)
{
    return fixture_matte(&rig->frame_fixture, vec3_of(0.5f, 0.5f, 0.5f));
}

// To be freed.
static float *seen(struct vct_rig *rig)
{
    fixture_render(&rig->frame_fixture);
    return fixture_read(&rig->frame_fixture, READ_VISIBILITY);
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

static struct span span_now(struct vct_rig *rig)
{
    float *v = seen(rig);
    const struct span s = span_of(v);
    free(v);
    return s;
}

// Of what the cosine weighs, by rays: 1 − mean of f(r) = 1/(1 + γ r) over those that meet
// something.
static double by_rays(const struct raycast *raycast, vec3s p, vec3s n, double decay)
{
    enum { SIDE = 40 };
    vec3s x, y;
    basis_of(n, &x, &y);
    double hidden = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double u = (i % SIDE + 0.5) / SIDE, phi = 2.0 * PI * (i / SIDE + 0.5) / SIDE;
        const float r = (float)sqrt(u);
        const vec3s way = glms_vec3_add(glms_vec3_scale(n, (float)sqrt(1.0 - u)),
                                        glms_vec3_add(glms_vec3_scale(x, r * (float)cos(phi)),
                                                      glms_vec3_scale(y, r * (float)sin(phi))));
        struct raycast_hit hit;
        const vec3s from = glms_vec3_muladds(n, 1e-4f, p);
        if (!raycast_closest(raycast, from, way, 1e6f, &hit)) continue;
        hidden += 1.0 / (1.0 + decay * (double)hit.distance);
    }
    return 1.0 - hidden / (SIDE * SIDE);
}

// ---- What is open, what is closed

// A square of 12 m whose normal is n, seen from above its middle.
static struct span tilted_plane(struct gpu *gpu, vec3s n, const char *options)
{
    struct vct_rig rig;
    vec3s x, y;
    begin(&rig, gpu);
    n = glms_vec3_normalize(n);
    basis_of(n, &x, &y);
    const vec3s a = glms_vec3_scale(x, 6), b = glms_vec3_scale(y, 6);
    fixture_quad(&rig.frame_fixture, glms_vec3_negate(glms_vec3_add(a, b)), glms_vec3_sub(a, b),
                 glms_vec3_add(a, b), glms_vec3_sub(b, a), grey(&rig));
    fixture_look(&rig.frame_fixture, glms_vec3_add(glms_vec3_scale(n, 4), glms_vec3_scale(x, 0.3f)),
                 vec3_of(0, 0, 0));
    vct_rig_open(&rig, options);
    const struct span s = span_now(&rig);
    vct_rig_finish(&rig);
    return s;
}

TEST_GPU(an_open_plane_is_open_however_it_leans)
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
            // Cones along a leaning plane are as wide as its texels, which have steps: they meet
            // its own sheet, and hide less than a twentieth.
            CHECK(s.least > 0.95);
        }
}

TEST_GPU(a_closed_room_is_closed_up_to_its_leaks)
{
    struct vct_rig rig;
    begin(&rig, gpu);
    fixture_box(&rig.frame_fixture, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true, grey(&rig));
    fixture_look(&rig.frame_fixture, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    vct_rig_open(&rig, "resolution=48,decay=0");
    const struct span s = span_now(&rig);
    print_message("closed room: %.4f of the sky, %.4f at most\n", s.mean, s.most);
    CHECK(s.mean < 0.01 && s.most < 0.05);
    // Nothing is in the way where nothing hides a thousandth farther off than a millimetre.
    struct vct_options options = rig.vct->options;
    options.decay = 1e6f;
    technique_vctao.set_options(rig.vct, &options);
    CHECK(span_now(&rig).least == 1.0);
    vct_rig_finish(&rig);
}

TEST_GPU(where_there_is_nothing_all_is_open)
{
    struct vct_rig rig;
    begin(&rig, gpu);
    vct_rig_open(&rig, "");
    CHECK(span_now(&rig).least == 1.0);
    vct_rig_finish(&rig);
    // Beside a surface, too; with other stages at the end.
    static const char *const options[] = { "resolution=32", "resolution=32,interleave=1",
                                           "resolution=32,temporal=true" };
    for (int o = 0; o < 3; o++) {
        begin(&rig, gpu);
        fixture_quad(&rig.frame_fixture, vec3_of(-1, -1, -9), vec3_of(1, -1, -9), vec3_of(1, 1, -9),
                     vec3_of(-1, 1, -9), grey(&rig));
        vct_rig_open(&rig, options[o]);
        float *v = seen(&rig), *depth = fixture_read(&rig.frame_fixture, READ_DEPTH);
        int beside = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (depth[i] > 0.0f) continue;
            CHECK(v[i] == 1.0f);
            beside++;
        }
        CHECK(beside > 0 && beside < PIXELS);
        free(v), free(depth);
        vct_rig_finish(&rig);
    }
}

// ---- A wall beside a floor

static const float HEIGHT_M = 3.0f, HALF_M = 60.0f;

// Along z, so long that it has no ends; at x = 0 over a floor to its right.
static void crease(struct vct_rig *rig, struct gpu *gpu)
{
    begin(rig, gpu);
    const int matte = grey(rig);
    fixture_quad(&rig->frame_fixture, vec3_of(0, 0, HALF_M), vec3_of(9, 0, HALF_M),
                 vec3_of(9, 0, -HALF_M), vec3_of(0, 0, -HALF_M), matte);
    fixture_quad(&rig->frame_fixture, vec3_of(0, 0, HALF_M), vec3_of(0, 0, -HALF_M),
                 vec3_of(0, HEIGHT_M, -HALF_M), vec3_of(0, HEIGHT_M, HALF_M), matte);
    fixture_look(&rig->frame_fixture, vec3_of(3, 7, 0.1f), vec3_of(3, 0, 0));
}

// A wall of the height h hides the directions below the angle β = atan(h/x) on its side: of a strip
// without ends that the cosine weighs, between the slopes s₁ and s₂ from the normal, (s₂ − s₁)/2 is
// filled, s the sine. From π/2 to π/2 − β that is (1 − cos β)/2, and (1 + cos β)/2 is open.
static double open_beside(double x)
{
    return 0.5 * (1.0 + x / sqrt(x * x + (double)(HEIGHT_M * HEIGHT_M)));
}

static void check_crease(struct gpu *gpu, const char *options, double decay, double worst)
{
    struct vct_rig rig;
    struct raycast raycast;
    crease(&rig, gpu);
    vct_rig_open(&rig, options);
    CHECK(raycast_init(&raycast, test_host(), &rig.frame_fixture.pose));
    float *v = seen(&rig), *at = fixture_read(&rig.frame_fixture, READ_POSITION);
    double off = 0.0, sum = 0.0, apart = 0.0;
    int count = 0;
    for (int i = 0; i < PIXELS; i += 3) {
        const vec3s p = vec3_of(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
        if (fabsf(p.y) > 1e-3f || p.x < 0.05f || p.x > 8.0f) continue; // the floor
        const double due = by_rays(&raycast, p, vec3_of(0, 1, 0), decay);
        if (decay == 0.0) apart = fmax(apart, fabs(due - open_beside((double)p.x)));
        sum += fabs((double)v[i] - due);
        off += (double)v[i] - due;
        count++;
    }
    print_message("%-60s mean error %.4f, bias %+.4f, rays from the closed form %.4f\n", options,
                  sum / count, off / count, apart);
    CHECK(count > 100);
    CHECK(apart < 0.01); // 40 × 40 rays
    CHECK(sum / count < worst);
    free(v), free(at);
    raycast_finish(&raycast);
    vct_rig_finish(&rig);
}

TEST_GPU(beside_a_wall_it_is_as_open_as_rays_say)
{
    // The grid is 120 m long: 256 voxels along it make texels of 1 m. Without the decay in the
    // cones the error would be 0.1 and more.
    static const struct {
        const char *options;
        double decay, worst;
    } cases[] = { { "resolution=256,decay=0", 0, 0.02 },
                  { "resolution=256,decay=0.25", 0.25, 0.02 },
                  { "resolution=256,decay=1", 1, 0.02 },
                  { "resolution=256,decay=4", 4, 0.02 } };
    for (int i = 0; i < 4; i++) check_crease(gpu, cases[i].options, cases[i].decay, cases[i].worst);
}

// ---- However it is kept

// A room open above, a block in it.
static void court(struct vct_rig *rig, struct gpu *gpu)
{
    begin(rig, gpu);
    struct frame_fixture *s = &rig->frame_fixture;
    const int matte = grey(rig);
    const float w = 10, h = 5;
    fixture_quad(s, vec3_of(0, 0, w), vec3_of(w, 0, w), vec3_of(w, 0, 0), vec3_of(0, 0, 0), matte);
    fixture_quad(s, vec3_of(0, 0, 0), vec3_of(w, 0, 0), vec3_of(w, h, 0), vec3_of(0, h, 0), matte);
    fixture_quad(s, vec3_of(0, 0, w), vec3_of(0, 0, 0), vec3_of(0, h, 0), vec3_of(0, h, w), matte);
    fixture_box(s, vec3_of(4, 0, 3), vec3_of(6, 2.5f, 5), false, matte);
    fixture_look(s, vec3_of(9, 6, 9), vec3_of(3, 1, 3));
}

TEST_GPU(each_storage_sees_what_rays_see_and_the_same_in_every_frame)
{
    static const struct {
        const char *options;
        double worst; // mean error
    } directions[] = {
        // All cones for each pixel: what is left is that of 25 cones and of voxels.
        { "resolution=48,interleave=1", 0.025 },
        { "resolution=48,interleave=1,storage=svo", 0.03 },
        // Five pixels of this small picture are a metre.
        { "resolution=48", 0.045 },
        { "resolution=48,storage=svo", 0.045 },
        { "resolution=48,voxels=raster", 0.045 },
        { "resolution=48,keep_static=false", 0.045 },
        // Surfaces without sides stand in the way of their own cones; not where points of
        // the octree lie in them.
        { "resolution=48,anisotropic=false", 0.2 },
        { "resolution=48,storage=svo,anisotropic=false", 0.06 }
    };
    for (size_t o = 0; o < sizeof directions / sizeof directions[0]; o++) {
        struct vct_rig rig;
        struct raycast raycast;
        court(&rig, gpu);
        vct_rig_open(&rig, directions[o].options);
        CHECK(raycast_init(&raycast, test_host(), &rig.frame_fixture.pose));
        float *v = seen(&rig), *later = seen(&rig);
        float *at = fixture_read(&rig.frame_fixture, READ_POSITION),
              *normal = fixture_read(&rig.frame_fixture, READ_NORMAL),
              *depth = fixture_read(&rig.frame_fixture, READ_DEPTH);
        double sum = 0.0, off = 0.0;
        int count = 0;
        for (int i = 0; i < PIXELS; i += 5) {
            if (depth[i] <= 0.0f) continue;
            const vec3s p = vec3_of(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
            const vec3s n = vec3_of(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]);
            const double d = (double)v[i] - by_rays(&raycast, p, n, (double)rig.vct->options.decay);
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
        vct_rig_finish(&rig);
    }
}

// ---- Cones

TEST_GPU(cones_of_occlusion_find_what_those_of_the_twin_do)
{
    struct vct_rig rig;
    court(&rig, gpu);
    vct_rig_open(&rig, "resolution=48,cones=5,interleave=1,step_size=0.5,decay=0.5");
    float *v = seen(&rig);
    const struct vct_clip *clip = &rig.vct->clips[0];
    struct vct_twin twin = vct_twin_of(&rig);
    const double texel_m = 2.0 * (double)clip->grid.cell_m;
    const double wide = 0.5 * (double)vct_cone_width(VCT_CONES_5);
    vec3s lines[VCT_MAX_CONES];
    vct_cone_axes(VCT_CONES_5, lines);
    int compared = 0;
    for (uint32_t y = 1; y < SIZE; y += 5)
        for (uint32_t x = 1; x < SIZE; x += 5) {
            if (fixture_pixel(&rig.frame_fixture, READ_DEPTH, x, y).x <= 0.0f) continue;
            const vec3s p = fixture_pixel(&rig.frame_fixture, READ_POSITION, x, y);
            const vec3s n = fixture_pixel(&rig.frame_fixture, READ_NORMAL, x, y);
            double from[3], normal[3], open = 0.0, cosines = 0.0;
            for (int a = 0; a < 3; a++) {
                normal[a] = (double)n.raw[a];
                from[a] = (double)(p.raw[a] - clip->grid.origin_m.raw[a]) / texel_m + normal[a];
            }
            for (int i = 0; i < vct_cone_count(VCT_CONES_5); i++) {
                double direction[3], sum[4];
                const double cosine = (double)glms_vec3_dot(n, lines[i]);
                for (int a = 0; a < 3; a++)
                    direction[a] = (cosine < 0.0 ? -1.0 : 1.0) * (double)lines[i].raw[a];
                vct_twin_trace(&twin, from, normal, direction, wide, sum);
                open += fabs(cosine) * (1.0 - sum[0]);
                cosines += fabs(cosine);
            }
            // 8 bits, a cone ends where the rest hides 0.005, and filters may weigh in steps of
            // 1/256.
            CHECK_NEAR((double)v[y * SIZE + x], open / cosines, 0.02);
            compared += open / cosines < 0.9;
        }
    CHECK(compared > 20);
    vct_twin_finish(&twin);
    free(v);
    vct_rig_finish(&rig);
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

TEST_GPU(what_moves_takes_its_shade_along)
{
    for (int svo = 0; svo < 2; svo++) {
        const char *options = svo ? "resolution=48,storage=svo" : "resolution=48";
        struct vct_rig rig, fresh;
        court(&rig, gpu);
        const int box = rig.frame_fixture.scene->instance_count;
        fixture_box(&rig.frame_fixture, vec3_of(7, 0.01f, 6), vec3_of(8, 1, 7), false, grey(&rig));
        vct_rig_open(&rig, options);
        float *before = seen(&rig);
        free(seen(&rig));
        CHECK(!has_pass(gpu, "vctao.fill") && !has_pass(gpu, "vctao.leaves"));
        CHECK(has_pass(gpu, "vctao.cones"));
        struct frame_fixture *s = &rig.frame_fixture;
        for (int i = box; i < s->scene->instance_count; i++) // its faces
            s->pose.world_from_node[s->scene->instances[i].node].raw[3][0] -= 5.0f;
        float *moved = seen(&rig), *later = seen(&rig);
        double change = 0.0;
        for (int i = 0; i < PIXELS; i++) change += fabs((double)(moved[i] - before[i])) / PIXELS;
        CHECK(change > 0.002);
        // All that depends on it is there at once, and nothing is left behind.
        assert_memory_equal(moved, later, PIXELS * sizeof *moved);
        court(&fresh, gpu);
        fixture_box(&fresh.frame_fixture, vec3_of(2, 0.01f, 6), vec3_of(3, 1, 7), false,
                    grey(&fresh));
        vct_rig_open(&fresh, options);
        float *due = seen(&fresh);
        double apart = 0.0;
        for (int i = 0; i < PIXELS; i++) apart += fabs((double)(moved[i] - due[i])) / PIXELS;
        print_message("%s: changed by %.4f, %.4f from where it stands there from the start\n",
                      options, change, apart);
        // Voxels of two sets that meet in a texel are not one sheet.
        CHECK(apart < 0.1 * change);
        free(before), free(moved), free(later), free(due);
        vct_rig_finish(&rig);
        vct_rig_finish(&fresh);
    }
}

// Opacity is kept from frame to frame, but for grids that follow the eye.
TEST_GPU(occlusion_is_where_the_eye_has_gone)
{
    struct vct_rig rig, fresh;
    court(&rig, gpu);
    vct_rig_open(&rig, "resolution=32,levels=3");
    float *before = seen(&rig);
    court(&fresh, gpu);
    vct_rig_open(&fresh, "resolution=32,levels=3");
    fixture_look(&rig.frame_fixture, vec3_of(1, 3, 8), vec3_of(3, 0, 1));
    fixture_look(&fresh.frame_fixture, vec3_of(1, 3, 8), vec3_of(3, 0, 1));
    float *gone = seen(&rig), *due = seen(&fresh);
    CHECK(memcmp(before, gone, PIXELS * sizeof *gone) != 0);
    assert_memory_equal(gone, due, PIXELS * sizeof *gone);
    free(before), free(gone), free(due);
    vct_rig_finish(&rig);
    vct_rig_finish(&fresh);
}

// The exposure follows the light, and with it the frame's unit; what is open has none.
TEST_GPU(history_of_occlusion_does_not_know_of_light)
{
    float *v[2];
    for (int brighter = 0; brighter < 2; brighter++) {
        struct vct_rig rig;
        court(&rig, gpu);
        fixture_add_point(&rig.frame_fixture, vec3_of(5, 4, 7), vec3_of(300, 300, 300));
        vct_rig_open(&rig, "resolution=32,temporal=true");
        for (int f = 0; f < 6; f++) {
            const float candela = brighter && f >= 3 ? 30000.0f : 300.0f;
            rig.frame_fixture.lights[0].intensity = vec3_of(candela, candela, candela);
            rig.frame_fixture.input.sky = vec3_of(0.1f * candela, 0, 0);
            fixture_render(&rig.frame_fixture);
        }
        v[brighter] = fixture_read(&rig.frame_fixture, READ_VISIBILITY);
        vct_rig_finish(&rig);
    }
    assert_memory_equal(v[0], v[1], PIXELS * sizeof *v[0]);
    free(v[0]), free(v[1]);
}

// Options that change while it lives do what they do from the start.
TEST_GPU(occlusion_changes_while_it_lives)
{
    struct vct_rig rig, fresh;
    court(&rig, gpu);
    vct_rig_open(&rig, "resolution=32");
    free(seen(&rig));
    struct vct_options options = rig.vct->options;
    options.decay = 0.1f;
    options.offset = 1.5f;
    options.step_size = 0.4f;
    options.cones = VCT_CONES_9;
    options.interleave = 3;
    technique_vctao.set_options(rig.vct, &options);
    float *got = seen(&rig);
    court(&fresh, gpu);
    vct_rig_open(&fresh, "resolution=32,decay=0.1,offset=1.5,step_size=0.4,cones=9,interleave=3");
    float *due = seen(&fresh);
    assert_memory_equal(got, due, PIXELS * sizeof *got);
    free(got), free(due);
    vct_rig_finish(&rig);
    vct_rig_finish(&fresh);
}
