// Volumetric obscurance against closed forms: planes and creases, at any angle, distance and sample
// set.
#include "techniques/vo/vo_fixture.h"

#include "techniques/vo/vo.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 96, HEIGHT = 61 }; // not a multiple of the eight rows of an invocation

static const int counts[] = { 5, 6, 7, 9, 12, 13, 16, 33 };
enum { COUNTS = sizeof counts / sizeof counts[0] };

static void begin(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->width = WIDTH;
    s->height = HEIGHT;
}

// ---- planes

// The camera is `height` above an infinite floor and looks `degrees` below the horizon.
static void floor_seen(struct frame_fixture *s, struct gpu *gpu, float height, float degrees)
{
    begin(s, gpu);
    fixture_floor(s, 200, fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f)));
    const float a = degrees * GLM_PIf / 180.0f;
    fixture_look(s, vec3_of(0.1f, height, 0),
                 vec3_of(0.1f + 0.3f * cosf(a), height - sinf(a), -cosf(a)));
    fixture_open(s);
}

// Largest difference from `expected` on surfaces at least `margin` pixels from the image border.
static double farthest(struct vo_fixture *fixture, float expected, uint32_t margin)
{
    float *estimate = vo_fixture_estimate(fixture),
          *depth = fixture_read(fixture->frame_fixture, READ_DEPTH);
    double most = 0.0;
    int looked_at = 0;
    for (uint32_t y = margin; y < HEIGHT - margin; y++)
        for (uint32_t x = margin; x < WIDTH - margin; x++) {
            if (depth[y * WIDTH + x] <= 0.0f) continue;
            most = fmax(most, fabs((double)(estimate[y * WIDTH + x] - expected)));
            looked_at++;
        }
    CHECK(looked_at > 500);
    free(estimate);
    free(depth);
    return most;
}

static double off(struct frame_fixture *s, const char *options, float expected, uint32_t margin)
{
    struct vo_fixture fixture = vo_fixture_create(s, options);
    const double most = farthest(&fixture, expected, margin);
    vo_fixture_destroy(&fixture);
    return most;
}

static const float slants[] = { 90, 60, 35, 20 };

TEST_GPU(vo_of_a_plane_is_exactly_half_without_the_normal)
{
    for (int i = 0; i < 4; i++) {
        struct frame_fixture s;
        floor_seen(&s, gpu, 1.5f, slants[i]);
        double most = 0.0;
        for (int k = 0; k < COUNTS; k++) {
            char options[96];
            // The sphere's radius is at most 0.1 of the height, 6.4 pixels: at seven pixels from
            // the border no line is cut off.
            snprintf(options, sizeof options, "samples=%d,radius=0.3,reach=0.1,normal=false",
                     counts[k]);
            most = fmax(most, off(&s, options, 0.5f, 11));
        }
        const double areas =
            off(&s, "mode=areas,samples=1,radius=0.3,reach=0.1,normal=false", 0.5f, 24);
        print_message("slant %2.0f: half to %.1e, an area to %.1e\n", (double)slants[i], most,
                      areas);
        CHECK(most < 1e-4);
        // Hardware divides with an error: a quarter of a step of 8 bits on grazing planes.
        CHECK(areas < (test_gpu_is_software(gpu) ? 1e-4 : 1e-3));
        fixture_finish(&s);
    }
}

TEST_GPU(vo_of_a_plane_is_one_up_to_the_image_border)
{
    for (int i = 0; i < 4; i++) {
        struct frame_fixture s;
        floor_seen(&s, gpu, 1.5f, slants[i]);
        double most = 0.0;
        for (int k = 0; k < COUNTS; k++) {
            char options[96];
            snprintf(options, sizeof options, "samples=%d,radius=0.5,thickness=%d", counts[k],
                     k % 3);
            most = fmax(most, off(&s, options, 1.0f, 0));
            snprintf(options, sizeof options, "mode=points,samples=%d,radius=0.5", counts[k]);
            most = fmax(most, off(&s, options, 1.0f, 0));
        }
        print_message("slant %2.0f: all to %.1e\n", (double)slants[i], most);
        CHECK(most < 1e-4);
        fixture_finish(&s);
    }
}

// ---- a crease

// Two walls that meet at a right angle along the y axis, z = 0 and x = 0, viewed from between them.
static void crease(struct frame_fixture *s, struct gpu *gpu)
{
    begin(s, gpu);
    fixture_open_two_walls(s);
}

// Volume of the sphere that is on the open side of a plane at the distance a (radii) from its
// middle: with the height h = 1 + a of the cap, h² (3 − h)/4 of it. The wall that the point is on
// halves what is left, by symmetry.
static double open_share(double a)
{
    return a < 1.0 ? (2.0 + 3.0 * a - a * a * a) / 4.0 : 1.0;
}

// Means over the points of each of BINS distances up to 1.2 radii, over all rotations of the
// pattern.
enum { BINS = 8 };
static void by_distance(struct vo_fixture *fixture, float radius_m, double mean[BINS],
                        double exact[BINS], int count[BINS])
{
    float *estimate = vo_fixture_estimate(fixture),
          *at = fixture_read(fixture->frame_fixture, READ_POSITION);
    for (int b = 0; b < BINS; b++) mean[b] = exact[b] = count[b] = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double a = (double)fmaxf(at[3 * i], at[3 * i + 2]) / (double)radius_m;
        const int b = (int)(a / 1.2 * BINS);
        if (b >= BINS) continue;
        mean[b] += (double)estimate[i];
        exact[b] += open_share(a);
        count[b]++;
    }
    for (int b = 0; b < BINS; b++) {
        mean[b] /= count[b];
        exact[b] /= count[b];
    }
    free(estimate);
    free(at);
}

TEST_GPU(vo_beside_a_wall_is_the_closed_form_up_to_the_sets_bias)
{
    struct frame_fixture s;
    crease(&s, gpu);
    const float radius_m = 0.6f; // a seventh of the distance, nine pixels
    for (int normal = 0; normal < 2; normal++) {
        double before = 1.0;
        for (int k = 0; k < COUNTS; k++) {
            char options[96];
            snprintf(options, sizeof options, "samples=%d,radius=%g,normal=%s,thickness=1000",
                     counts[k], (double)radius_m, normal ? "true" : "false");
            struct vo_fixture fixture = vo_fixture_create(&s, options);
            double mean[BINS], exact[BINS], squares = 0.0;
            int count[BINS];
            by_distance(&fixture, radius_m, mean, exact, count);
            printf("%2d %s:", counts[k], normal ? "hemisphere" : "sphere    ");
            for (int b = 0; b < BINS; b++) {
                CHECK(count[b] > 50);
                const double half = normal ? 1.0 : 0.5;
                printf(" %+.3f", mean[b] - half * exact[b]);
                squares += pow(mean[b] - half * exact[b], 2.0) / BINS;
            }
            printf("  rms %.4f\n", sqrt(squares));
            // The set's bias beside walls and ramps, and 0.015 for pixels and perspective.
            const double bias = (double)sample_set_at(SAMPLE_DISK, k + 1)->bias;
            CHECK(sqrt(squares) < bias + 0.015);
            before = sqrt(squares);
            vo_fixture_destroy(&fixture);
        }
        CHECK(before < 0.02); // 33
    }
    fixture_finish(&s);
}

// ---- frames

TEST_GPU(a_new_size_ends_the_history)
{
    struct frame_fixture s;
    floor_seen(&s, gpu, 1, 30);
    struct vo_fixture fixture = vo_fixture_create(&s, "temporal=true");
    s.indirect.needs |= FRAME_NEEDS_MOTION;
    const struct screen_ao *ao = &fixture.vo->ao;
    for (uint32_t frame = 0; frame < 6; frame++) {
        if (frame == 3) {
            fixture_resize(&s, WIDTH, HEIGHT); // the images of this size are new ones
            CHECK(technique_resize(&technique_vo, gpu, fixture.vo, &fixture.vo->options, 0, WIDTH,
                                   HEIGHT));
        }
        fixture_render(&s);
        assert_int_equal(ao->number, frame % 3);
        assert_int_equal((int)ao->params.has_history, frame % 3 > 0);
    }
    vo_fixture_destroy(&fixture);
    fixture_finish(&s);
}
