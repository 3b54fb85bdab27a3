// Visibility against closed forms and sums over directions: planes, a wall, a pit.
#include "techniques/gtao/gtao_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

static void begin(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->width = WIDTH;
    s->height = HEIGHT;
}

// ---- planes

TEST_GPU(a_plane_is_open_at_any_slant_and_number_of_slices)
{
    static const float degrees[] = { 90, 60, 30, 10, 3 };
    static const char *const options[] = { "slices=1,steps=1,falloff=0",
                                           "slices=2,steps=4,radius=2,reach=1",
                                           "slices=3,steps=16,falloff=0,radius=5,reach=1",
                                           "slices=1,bitmask=true,falloff=0",
                                           "slices=4,steps=9,bitmask=true,thickness=5,radius=2" };
    for (int k = 0; k < 5; k++) {
        struct frame_fixture s;
        begin(&s, gpu);
        fixture_floor(&s, 2000, fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f)));
        const float a = degrees[k] * GLM_PIf / 180.0f;
        fixture_look(&s, vec3_of(0.1f, 1.5f, 0),
                     vec3_of(0.1f + 0.3f * cosf(a), 1.5f - sinf(a), -cosf(a)));
        fixture_open(&s);
        for (size_t o = 0; o < sizeof options / sizeof *options; o++) {
            float *v = gtao_visibility(&s, options[o]);
            for (int i = 0; i < PIXELS; i++)
                if (v[i] < 1.0f)
                    fail_msg("%s: %g at %d, %d", options[o], (double)v[i], i % WIDTH, i / WIDTH);
            free(v);
        }
        fixture_finish(&s);
    }
}

// ---- a wall

// Directions of the hemisphere around z whose x exceeds a: a segment of the disk.
static double segment(double a)
{
    return a < 1.0 ? (acos(a) - a * sqrt(1.0 - a * a)) / GLM_PI : 0.0;
}

// A perpendicular wall at the distance a (radii) is a/x away along a direction. The linear falloff
// is the mean of sharp ends between 1 − falloff and 1.
static double occluded_by_wall(double a, double falloff)
{
    enum { ENDS = 64 };
    double sum = 0.0;
    for (int i = 0; i < ENDS; i++) sum += segment(a / (1.0 - falloff * (i + 0.5) / ENDS)) / ENDS;
    return sum;
}

// Differences from the closed form up to 1.2 radii: mean and root mean square.
static void check_wall(struct frame_fixture *s, const char *options, double radius_m,
                       double falloff, double mean_bound, double rms_bound)
{
    float *v = gtao_visibility(s, options), *at = fixture_read(s, READ_POSITION);
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (int k = 0; k < PIXELS; k++) {
        const double a = (double)fmaxf(at[3 * k], at[3 * k + 2]) / radius_m;
        if (a > 1.2) continue;
        const double off = (double)v[k] - (1.0 - occluded_by_wall(a, falloff));
        sum += off;
        squares += off * off;
        count++;
    }
    print_message("%s: mean %+.4f, rms %.4f of %d\n", options, sum / count, sqrt(squares / count),
                  count);
    CHECK(count > 500);
    CHECK(fabs(sum / count) < mean_bound && sqrt(squares / count) < rms_bound);
    free(v);
    free(at);
}

// The closed form falls from
// 1 to ½; its mean is 0.82. Steps of a pixel are a tenth of the radius.
TEST_GPU(visibility_beside_a_wall_is_the_closed_form)
{
    struct frame_fixture s;
    begin(&s, gpu);
    fixture_open_two_walls(&s);
    check_wall(&s, "radius=0.9,reach=1,falloff=0,slices=16,steps=32", 0.9, 0.0, 0.012, 0.03);
    check_wall(&s, "radius=0.9,reach=1,falloff=1,slices=16,steps=32", 0.9, 1.0, 0.012, 0.03);
    check_wall(&s, "radius=0.9,reach=1,falloff=0.6,slices=16,steps=32", 0.9, 0.6, 0.012, 0.03);
    // Few samples: noise of the pattern, which the blur removes, and the same mean.
    check_wall(&s, "radius=0.9,reach=1,falloff=0.6", 0.9, 0.6, 0.03, 0.12);
    // Sheets thicker than the radius close what horizons close.
    check_wall(&s, "radius=0.9,reach=1,falloff=0,slices=16,steps=32,bitmask=true,thickness=2", 0.9,
               0.0, 0.012, 0.03);
    fixture_finish(&s);
}

// ---- a pit

static const float PIT_HALF_M = 1.0f, PIT_DEPTH_M = 0.8f;

// From a point of the floor; the direction has z upwards, the scene y.
static bool opening(vec3s direction, const void *user)
{
    const vec3s *from = user;
    const vec3s turned = vec3_of(direction.x, direction.z, direction.y);
    const float t = PIT_DEPTH_M / turned.y;
    return fabsf(from->x + t * turned.x) < PIT_HALF_M && fabsf(from->z + t * turned.z) < PIT_HALF_M;
}

static void make_pit(struct frame_fixture *s, struct gpu *gpu)
{
    const float h = PIT_HALF_M, d = PIT_DEPTH_M;
    begin(s, gpu);
    s->width = s->height = 96;
    const int matte = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
    fixture_quad(s, vec3_of(-h, -d, h), vec3_of(h, -d, h), vec3_of(h, -d, -h), vec3_of(-h, -d, -h),
                 matte);
    fixture_quad(s, vec3_of(-h, -d, -h), vec3_of(h, -d, -h), vec3_of(h, 0, -h), vec3_of(-h, 0, -h),
                 matte);
    fixture_quad(s, vec3_of(h, -d, h), vec3_of(-h, -d, h), vec3_of(-h, 0, h), vec3_of(h, 0, h),
                 matte);
    fixture_quad(s, vec3_of(h, -d, -h), vec3_of(h, -d, h), vec3_of(h, 0, h), vec3_of(h, 0, -h),
                 matte);
    fixture_quad(s, vec3_of(-h, -d, h), vec3_of(-h, -d, -h), vec3_of(-h, 0, -h), vec3_of(-h, 0, h),
                 matte);
    fixture_look(s, vec3_of(0, 1, 0.001f), vec3_of(0, 0, 0));
    s->input.camera.vertical_fov_rad = 1.75f; // the rim is visible on all sides
    fixture_open(s);
}

TEST_GPU(the_floor_of_a_pit_sees_the_opening)
{
    struct frame_fixture s;
    make_pit(&s, gpu);
    float *v = gtao_visibility(&s, "radius=1000,reach=1,falloff=0,slices=16,steps=64"),
          *at = fixture_read(&s, READ_POSITION), *depth = fixture_read(&s, READ_DEPTH);
    double sum = 0.0, squares = 0.0, mean = 0.0;
    int count = 0;
    for (uint32_t i = 0; i < s.width * s.height; i += 7) {
        const vec3s from = vec3_of(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
        if (depth[i] <= 0.0f || from.y > -PIT_DEPTH_M + 1e-3f) continue;
        const double expected = gtao_share(opening, &from), off = (double)v[i] - expected;
        sum += off;
        squares += off * off;
        mean += expected;
        count++;
    }
    print_message("floor of a pit: %.3f expected, mean %+.4f, rms %.4f of %d\n", mean / count,
                  sum / count, sqrt(squares / count), count);
    CHECK(count > 200);
    // A pixel of the rim is 0.02 m.
    CHECK(fabs(sum / count) < 0.015 && sqrt(squares / count) < 0.025);
    free(v);
    free(at);
    free(depth);
    fixture_finish(&s);
}
