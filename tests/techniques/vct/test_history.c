// History of cone tracing after a change of light: error of each frame against the settled image,
// the mean of 200 later frames.
#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum change { LIGHT_MOVES, BOX_MOVES, LIGHT_JUMPS };

// Ten frames of motion, the last one of which is not rendered; or one jump.
static void change_scene(struct vct_fixture *fixture, int box, enum change change)
{
    struct frame_fixture *s = &fixture->frame_fixture;
    const int steps = change == LIGHT_JUMPS ? 1 : 10;
    for (int i = 0; i < steps; i++) {
        if (i > 0) fixture_render(s);
        if (change == BOX_MOVES)
            vct_fixture_move_box(fixture, box, vec3_of(-0.15f, 0.3f, 0.2f));
        else
            s->lights[0].position.x += change == LIGHT_MOVES ? 0.4f : 4.0f;
    }
}

// Prints the error of the frames after the change, and returns that of the fourth.
static double error_after(struct gpu *gpu, const char *options, uint32_t size, enum change change)
{
    static const char *const names[] = { "a moving light", "a moving box", "a jump of the light" };
    enum { BEFORE = 40, SHOWN = 8, SETTLED = 200 };
    struct vct_fixture fixture;
    const int box = vct_fixture_room(&fixture, gpu);
    fixture.frame_fixture.width = fixture.frame_fixture.height = size;
    vct_fixture_open(&fixture, options);
    const size_t count = (size_t)fixture.frame_fixture.width * fixture.frame_fixture.height * 3;
    float *e[SHOWN], *before = vct_fixture_irradiance_after(&fixture, BEFORE);
    change_scene(&fixture, box, change);
    for (int i = 0; i < SHOWN; i++) e[i] = vct_fixture_irradiance_after(&fixture, 1);
    float *settled = vct_fixture_irradiance_after(&fixture, SETTLED);
    const double changed = vct_fixture_difference(before, settled, count),
                 fourth = vct_fixture_difference(e[3], settled, count);
    print_message("%s: %s by %.1f %%; then", options, names[change], 100.0 * changed);
    for (int i = 0; i < SHOWN; i++) {
        print_message(" %.2f", 100.0 * vct_fixture_difference(e[i], settled, count));
        free(e[i]);
    }
    print_message(" %%\n");
    CHECK(changed > 0.1); // without a change the test is void
    free(before), free(settled);
    vct_fixture_finish(&fixture);
    return fourth;
}

// The error of rays is noise, which is averaged over more pixels of a surface in a larger image.
TEST_GPU(history_follows_a_change_within_four_frames)
{
    static const struct {
        const char *options;
        uint32_t size;
        double most;
    } cases[] = {
        { "resolution=32,temporal=true", 64, 0.02 },
        { "resolution=128,temporal=true", 64, 0.02 },
        { "resolution=128,temporal=true,trace=rays,interleave=3,half_resolution=true", 160, 0.04 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (enum change change = LIGHT_MOVES; change <= LIGHT_JUMPS; change++)
            CHECK(error_after(gpu, cases[i].options, cases[i].size, change) <= cases[i].most);
}

static double mean_of(const float *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i];
    return sum / (double)count;
}

// Rays of a frame alone are not filtered: their mean over pixels has the light that the filter is
// to keep.
TEST_GPU(the_filter_of_rays_keeps_their_light)
{
    static const char *const options[] = { "resolution=64,trace=rays,interleave=3",
                                           "resolution=64,trace=rays,interleave=3,temporal=true" };
    double mean[2];
    for (int i = 0; i < 2; i++) {
        struct vct_fixture fixture;
        vct_fixture_room(&fixture, gpu);
        fixture.frame_fixture.width = fixture.frame_fixture.height = 96;
        vct_fixture_open(&fixture, options[i]);
        float *e = vct_fixture_irradiance_after(&fixture, 8);
        mean[i] = mean_of(e, (size_t)96 * 96 * 3);
        free(e);
        vct_fixture_finish(&fixture);
    }
    print_message("light of a frame %.4f, filtered %.4f\n", mean[0], mean[1]);
    CHECK_RELATIVE(mean[1], mean[0], 0.03);
}

// Against the mean of 200 later frames.
TEST_GPU(rays_have_little_noise_after_eight_frames)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    fixture.frame_fixture.width = fixture.frame_fixture.height = 160;
    vct_fixture_open(&fixture,
                     "resolution=64,temporal=true,trace=rays,interleave=3,half_resolution=true");
    const size_t count = (size_t)fixture.frame_fixture.width * fixture.frame_fixture.height * 3;
    float *eighth = vct_fixture_irradiance_after(&fixture, 8),
          *settled = vct_fixture_irradiance_after(&fixture, 200);
    const double error = vct_fixture_difference(eighth, settled, count);
    print_message("after eight frames %.2f %% from the settled image\n", 100.0 * error);
    CHECK(error <= 0.02);
    free(eighth), free(settled);
    vct_fixture_finish(&fixture);
}

// Errors after 1, 2, 4, 8 and 16 frames against the mean of 200 later ones, and that of one frame
// that is not filtered.
enum { COUNTS = 5 };
static void errors_by_frames(struct gpu *gpu, uint32_t size, double errors[COUNTS], double *alone)
{
    static const char *const OPTIONS[] = { "resolution=64,trace=rays",
                                           "resolution=64,trace=rays,temporal=true" };
    const size_t count = (size_t)size * size * 3;
    float *e[COUNTS + 1] = { NULL }, *settled = NULL;
    for (int filtered = 0; filtered < 2; filtered++) {
        struct vct_fixture fixture;
        vct_fixture_room(&fixture, gpu);
        fixture.frame_fixture.width = fixture.frame_fixture.height = size;
        vct_fixture_open(&fixture, OPTIONS[filtered]);
        if (!filtered) e[COUNTS] = vct_fixture_irradiance_after(&fixture, 1);
        for (int i = 0; filtered && i < COUNTS; i++)
            e[i] = vct_fixture_irradiance_after(&fixture, i == 0 ? 1 : 1 << (i - 1));
        if (filtered) settled = vct_fixture_irradiance_after(&fixture, 200);
        vct_fixture_finish(&fixture);
    }
    for (int i = 0; i < COUNTS; i++) errors[i] = vct_fixture_difference(e[i], settled, count);
    *alone = vct_fixture_difference(e[COUNTS], settled, count);
    for (int i = 0; i <= COUNTS; i++) free(e[i]);
    free(settled);
}

// Small images, too: there a filter as wide as noise of one frame needs averages light and shadow.
TEST_GPU(the_error_of_rays_falls_with_the_number_of_frames)
{
    static const uint32_t SIZES[] = { 48, 96, 160 };
    for (size_t k = 0; k < sizeof SIZES / sizeof SIZES[0]; k++) {
        double errors[COUNTS], alone;
        errors_by_frames(gpu, SIZES[k], errors, &alone);
        print_message("%ux%u: a frame alone %.2f %%; after 1, 2, 4, 8, 16 frames", SIZES[k],
                      SIZES[k], 100.0 * alone);
        for (int i = 0; i < COUNTS; i++) print_message(" %.2f", 100.0 * errors[i]);
        print_message(" %%\n");
        CHECK(errors[0] < 0.95 * alone);
        for (int i = 1; i < COUNTS; i++) CHECK(errors[i] < 0.97 * errors[i - 1]);
    }
}

// A room with a bright spot on its ceiling: few rays of a frame meet it.
enum { SPOT_WIDTH = 320, SPOT_HEIGHT = 180 };
static float *room_with_a_spot(struct gpu *gpu, const char *options)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    struct frame_fixture *s = &fixture.frame_fixture;
    s->width = SPOT_WIDTH;
    s->height = SPOT_HEIGHT;
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(5, 2.6f, 4.2f), true,
                fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f)));
    fixture_add_spot(s, vec3_of(1.5f, 2, 1.5f), vec3_of(0, 1, 0), 0.5f, 0.6f,
                     vec3_of(1000, 1000, 1000));
    fixture_look(s, vec3_of(4.6f, 1.6f, 3.8f), vec3_of(1.5f, 0.6f, 0.5f));
    vct_fixture_open(&fixture, options);
    float *e = vct_fixture_irradiance_after(&fixture, 1);
    vct_fixture_finish(&fixture);
    return e;
}

// Mean second difference between pixels of a row, more than a block apart, over the mean.
static double spots_of(const float *e)
{
    enum { STEP = 8 };
    double sum = 0.0;
    size_t count = 0;
    for (int y = 0; y < SPOT_HEIGHT; y++)
        for (int x = STEP; x < SPOT_WIDTH - STEP; x++, count++) {
            const float *here = e + ((size_t)y * SPOT_WIDTH + (size_t)x) * 3;
            sum += fabs(2.0 * (double)here[0] - (double)here[-STEP * 3] - (double)here[STEP * 3]);
        }
    return sum / (double)count / mean_of(e, (size_t)SPOT_WIDTH * SPOT_HEIGHT * 3);
}

// A mean of 25 pixels alone left a star of bright spots around each block that met the spot: .33 of
// the differences.
TEST_GPU(a_small_bright_spot_leaves_no_stars_in_the_first_frame)
{
    const size_t count = (size_t)SPOT_WIDTH * SPOT_HEIGHT * 3;
    float *alone = room_with_a_spot(gpu, "trace=rays"),
          *first = room_with_a_spot(gpu, "trace=rays,temporal=true");
    const double noise = spots_of(alone), left = spots_of(first),
                 light = mean_of(first, count) / mean_of(alone, count);
    print_message("differences of %.3f, filtered %.3f; %.3f of the light\n", noise, left, light);
    CHECK(noise > 0.2); // without noise the test is void
    CHECK(left < 0.2 * noise);
    CHECK_NEAR(light, 1.0, 0.03);
    free(alone), free(first);
}
