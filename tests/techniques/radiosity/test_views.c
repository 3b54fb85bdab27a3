// Debug views of radiosity.
#include "frame/frame_fixture.h"
#include "techniques/baked_fixture.h"

#include <math.h>
#include <stdlib.h>

#define SPEC "radiosity:texels=2048,rays=64,sources=8"

static int matte(struct frame_fixture *s)
{
    return fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
}

// A closed room, seen from a corner; three walls meet in the middle of the image.
static void room(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, matte(s));
    fixture_look(s, vec3_of(1.5f, 2.5f, 1.5f), vec3_of(-2, 0, -2));
}

// Owned by the caller: [height][width][3].
static float *view_of(struct baked_fixture *run, struct frame_fixture *s, const char *name)
{
    const size_t count = 3 * (size_t)s->width * s->height;
    float *rgb = malloc(count * sizeof *rgb);
    assert_non_null(rgb);
    CHECK(gi_set_debug_view(run->gi, name));
    fixture_render(s);
    CHECK(gpu_image_download_float(s->gpu, gi_debug_image(run->gi), 0, 0, rgb, 3, count));
    return rgb;
}

// Colour over its brightest channel, so that the shading does not count.
static vec3s hue_of(const float *rgb)
{
    const vec3s c = vec3_of(rgb[0], rgb[1], rgb[2]);
    return glms_vec3_divs(c, fmaxf(glms_vec3_max(c), 1e-6f));
}

static int count_hues(const float *rgb, size_t pixels)
{
    enum { MOST = 4096 };
    static vec3s seen[MOST];
    int count = 0;
    for (size_t p = 0; p < pixels; p++) {
        const vec3s hue = hue_of(rgb + 3 * p);
        int i = 0;
        while (i < count && glms_vec3_distance(seen[i], hue) > 0.02f) i++;
        if (i == count && count < MOST) seen[count++] = hue;
    }
    return count;
}

static size_t count_grey(const float *rgb, size_t pixels)
{
    size_t count = 0;
    for (size_t p = 0; p < pixels; p++)
        count += glms_vec3_distance(hue_of(rgb + 3 * p), vec3_of(1, 1, 1)) < 0.02f;
    return count;
}

TEST_GPU(charts_have_a_colour_each_and_clusters_are_parts_of_them)
{
    struct frame_fixture s;
    struct baked_fixture run;
    room(&s, gpu);
    baked_fixture_open(&run, &s, SPEC);
    const size_t pixels = (size_t)s.width * s.height;
    float *charts = view_of(&run, &s, "charts"),
          *clusters = view_of(&run, &s, "radiosity.clusters");
    print_message("%d charts, %d clusters\n", count_hues(charts, pixels),
                  count_hues(clusters, pixels));
    CHECK(count_hues(charts, pixels) == 3); // two walls and the floor
    CHECK(count_hues(clusters, pixels) > 30);
    free(charts);
    free(clusters);
    baked_fixture_close(&run, &s);
}

// Along a wall the checkerboard changes once for each texel.
TEST_GPU(texels_are_as_wide_as_the_density_says)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init(&s, gpu);
    fixture_quad(&s, vec3_of(-4, -4, -2), vec3_of(4, -4, -2), vec3_of(4, 4, -2), vec3_of(-4, 4, -2),
                 matte(&s));
    fixture_look(&s, vec3_of(0, 0, 0), vec3_of(0, 0, -2));
    baked_fixture_open(&run, &s, "radiosity:density=4,rays=16,sources=8");
    float *rgb = view_of(&run, &s, "texels");
    const size_t row = (size_t)(s.height / 2) * s.width;
    int changes = 0;
    for (uint32_t x = 1; x < s.width; x++) {
        const float a = rgb[3 * (row + x - 1)], b = rgb[3 * (row + x)];
        changes += fmaxf(a, b) > 2.0f * fminf(a, b);
    }
    const float low = fixture_ray(&s, 0, 0).x, high = fixture_ray(&s, (float)s.width, 0).x;
    CHECK_NEAR(changes, 2 * 4 * (high - low), 1.0); // at 2 m
    free(rgb);
    baked_fixture_close(&run, &s);
}

// Texels are 0.25 m wide; the block ends behind the middles of some.
TEST_GPU(validity_marks_texels_that_a_block_covers)
{
    struct frame_fixture s;
    struct baked_fixture run;
    for (int block = 0; block < 2; block++) {
        room(&s, gpu);
        if (block)
            fixture_box(&s, vec3_of(-1.1f, -0.3f, -1.1f), vec3_of(0.15f, 0.9f, 0.15f), false,
                        matte(&s));
        fixture_look(&s, vec3_of(1.5f, 1.5f, 1.5f), vec3_of(0.2f, 0, 0.2f));
        baked_fixture_open(&run, &s, "radiosity:density=4,rays=64,sources=8");
        const size_t pixels = (size_t)s.width * s.height;
        float *rgb = view_of(&run, &s, "validity");
        const size_t marked = pixels - count_grey(rgb, pixels);
        print_message("%zu of %zu pixels are marked\n", marked, pixels);
        CHECK(block ? marked > 0 && marked < pixels / 4 : marked == 0);
        free(rgb);
        baked_fixture_close(&run, &s);
    }
}
