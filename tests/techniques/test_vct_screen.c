// Pixels that share cones: against pixels that trace them all, in what they find and in what it
// takes.
#include "techniques/vct_rig.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 96, VALUES = WIDTH * HEIGHT * 3 };

// A room with a block and a ball in it, a point light, a little light from all sides.
static void furnish(struct vct_rig *rig, struct gpu *gpu)
{
    vct_rig_init(rig, gpu);
    struct frame_fixture *s = &rig->frame_fixture;
    s->width = WIDTH;
    s->height = HEIGHT;
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
                fixture_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    fixture_box(s, vec3_of(6, 0.1f, 3), vec3_of(8, 4, 5), false,
                fixture_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    fixture_add_point(s, vec3_of(3, 7, 5), vec3_of(300, 500, 200));
    fixture_look(s, vec3_of(1, 6, 8), vec3_of(8, 2, 3));
}

// A curtain before the far wall, in pleats of half the size of a texel of the light volume (0.7 m
// with 32 voxels), whose sides are 30° from the whole.
static void hang_curtain(struct vct_rig *rig)
{
    struct frame_fixture *s = &rig->frame_fixture;
    const int cloth = fixture_matte(s, vec3_of(0.6f, 0.6f, 0.6f));
    const float half = 0.18f, deep = 0.104f;
    for (int i = 0; i < 35; i++) {
        const float z = 1.0f + half * (float)i, near = i % 2 ? 0.0f : deep, far = deep - near;
        fixture_quad(s, vec3_of(10 + near, 0.5f, z), vec3_of(10 + far, 0.5f, z + half),
                     vec3_of(10 + far, 6, z + half), vec3_of(10 + near, 6, z), cloth);
    }
    fixture_look(s, vec3_of(6, 4, 4), vec3_of(10, 3, 4));
}

struct look {
    float *irradiance;
    double ms; // of the stages over pixels, the least of some frames
};

static double stages_ms(const struct gpu *gpu)
{
    static const char *const stages[] = { "vct.cones", "vct.edges", "vct.gather", "vct.blur",
                                          "vct.fit" };
    struct gpu_timing timings[64];
    const int count = gpu_frame_timings(gpu, timings, 64);
    double sum = 0.0;
    for (int i = 0; i < count && i < 64; i++)
        for (int k = 0; k < 5; k++)
            sum += strcmp(timings[i].name, stages[k]) == 0 ? timings[i].ms : 0.0;
    return sum;
}

static struct look look_at_room(struct gpu *gpu, const char *options, bool curtain)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    if (curtain) hang_curtain(&rig);
    vct_rig_open(&rig, options);
    struct look look = { .ms = 1e30 };
    for (int f = 0; f < 10; f++) {
        fixture_render(&rig.frame_fixture);
        look.ms = fmin(look.ms, stages_ms(gpu));
    }
    look.irradiance = fixture_read(&rig.frame_fixture, READ_IRRADIANCE);
    vct_rig_finish(&rig);
    return look;
}

static struct look look_with(struct gpu *gpu, const char *options)
{
    return look_at_room(gpu, options, false);
}

// Mean of |a − b| over that of b.
static double difference(const float *a, const float *b)
{
    double off = 0.0, sum = 0.0;
    for (int i = 0; i < VALUES; i++) {
        off += fabs((double)(a[i] - b[i]));
        sum += (double)b[i];
    }
    return off / sum;
}

TEST_GPU(blocks_that_share_cones_find_what_each_pixel_would)
{
    struct look raw = look_with(gpu, "resolution=32,interleave=1");
    // A block of 5 × 5 is a 16th of this small picture's width: the light changes within it by some
    // percent. Where sub-images are not interpolated it is 7 %, where each cone turns with its
    // pixel's normal more.
    static const struct {
        const char *options;
        double most;
    } shared[] = { { "resolution=32,interleave=2", 0.02 },
                   { "resolution=32,interleave=3", 0.03 },
                   { "resolution=32,interleave=5", 0.045 } };
    for (int i = 0; i < 3; i++) {
        struct look look = look_with(gpu, shared[i].options);
        const double off = difference(look.irradiance, raw.irradiance);
        print_message("%s: %.4f off, %.1f times faster\n", shared[i].options, off,
                      raw.ms / look.ms);
        CHECK(off < shared[i].most);
        // At 640x360 25 cones that are shared take an eighth to a fifteenth of the time; here
        // pixels without neighbours to share with are many.
        if (i == 2) CHECK(look.ms < 0.25 * raw.ms);
        free(look.irradiance);
    }
    free(raw.irradiance);
}

// What is smaller than the light volume's texels does not turn cones' starts from pixel to pixel.
TEST_GPU(pleats_share_cones_as_well)
{
    struct look raw = look_at_room(gpu, "resolution=32,interleave=1", true);
    struct look shared = look_at_room(gpu, "resolution=32,interleave=5", true);
    const double off = difference(shared.irradiance, raw.irradiance);
    print_message("%.4f off\n", off);
    // 0.022; where each cone starts along its pixel's own normal, and 45° are the end of a surface,
    // 0.045.
    CHECK(off < 0.035);
    free(raw.irradiance);
    free(shared.irradiance);
}

// Cones at every second pixel of every second row: a quarter of them.
TEST_GPU(half_the_size_is_as_good_nearly)
{
    struct look full = look_with(gpu, "resolution=32,half=false");
    struct look half = look_with(gpu, "resolution=32,half=true");
    const double off = difference(half.irradiance, full.irradiance);
    print_message("%.4f off, %.1f times faster\n", off, full.ms / half.ms);
    // Within a block, which is twice as wide, light changes as much again as in the test above.
    CHECK(off < 0.045);
    // No pixel is left dark between surfaces: each has a tenth of what it should have and more.
    int dark = 0;
    for (int i = 0; i < VALUES; i++) dark += half.irradiance[i] < 0.1f * full.irradiance[i];
    print_message("%d of %d values dark\n", dark, VALUES);
    CHECK(dark < VALUES / 1000);
    // Four times less of everything but the last step, which is for all pixels: 0.3 to 0.4 of the
    // time, but a host that others share has made 0.6 of it.
    CHECK(half.ms < 0.85 * full.ms);
    free(full.irradiance);
    free(half.irradiance);
}

// Options that change while it lives do what they do from the start.
TEST_GPU(cones_change_while_it_lives)
{
    struct look due = look_with(gpu, "resolution=32,cones=9,interleave=3");
    struct vct_rig rig;
    furnish(&rig, gpu);
    vct_rig_open(&rig, "resolution=32,cones=25,interleave=5");
    fixture_render(&rig.frame_fixture);
    struct vct_options options = rig.vct->options;
    options.cones = VCT_CONES_9;
    options.interleave = 3;
    technique_vct.set_options(rig.vct, &options);
    fixture_render(&rig.frame_fixture);
    float *got = fixture_read(&rig.frame_fixture, READ_IRRADIANCE);
    assert_memory_equal(got, due.irradiance, VALUES * sizeof *got);
    free(got), free(due.irradiance);
    vct_rig_finish(&rig);
}

// ---- Lines

// Whatever the normal: the mean of |n·d| is a half, as it is over all directions.
TEST(lines_are_spread_evenly)
{
    static const double most[] = { [VCT_CONES_5] = 0.13,
                                   [VCT_CONES_6] = 0.06,
                                   [VCT_CONES_9] = 0.06,
                                   [VCT_CONES_16] = 0.04,
                                   [VCT_CONES_25] = 0.03 };
    for (int choice = VCT_CONES_5; choice <= VCT_CONES_25; choice++) {
        vec3s lines[VCT_MAX_CONES];
        vct_cone_axes(choice, lines);
        const int count = vct_cone_count(choice);
        double worst = 0.0;
        for (int k = 0; k < 500; k++) {
            const double z = (k + 0.5) / 500.0, r = sqrt(1.0 - z * z), phi = 2.39996323 * k;
            const vec3s n = vec3_of((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
            double sum = 0.0;
            for (int i = 0; i < count; i++) sum += fabs((double)glms_vec3_dot(n, lines[i])) / count;
            worst = fmax(worst, fabs(sum - 0.5));
        }
        double nearest = 1.0; // cosine
        for (int i = 0; i < count; i++) {
            CHECK_NEAR((double)glms_vec3_norm(lines[i]), 1.0, 1e-5);
            for (int k = 0; k < i; k++)
                nearest = fmin(nearest, 1.0 - fabs((double)glms_vec3_dot(lines[i], lines[k])));
        }
        print_message("%d lines: mean |n·d| within %.3f, %.1f degrees apart\n", count, worst,
                      acos(1.0 - nearest) * 180.0 / 3.14159265);
        CHECK(worst < most[choice]);
        // Round caps that touch fill a part of the half sphere, at most 0.91 of it in the plane; 5
        // lines fill 0.65.
        CHECK(count * (1.0 - cos(0.5 * acos(1.0 - nearest))) > 0.6);
    }
}
