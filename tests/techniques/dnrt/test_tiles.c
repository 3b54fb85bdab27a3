// Tiles of the image that objects reach: no camera and no object leads to one outside of it.
#include "framework/test.h"
#include "techniques/dnrt/dnrt_state.h"

#include <math.h>
#include <string.h>

enum { PIXELS = 64, TILES = PIXELS / DNRT_TILE, STRIDE = DNRT_TILE_BITS + 1 };
enum { COUNT = TILES * TILES * STRIDE, GUARD = 64 };
static const uint32_t UNTOUCHED = 0x5a5a5a5a;

// One object of half an edge of 1 m, seen from the origin along −z.
struct tile_fixture {
    struct dnrt state;
    struct dnrt_object object;
    struct dnrt_gpu_object gpu_object;
    struct frame_constants constants;
    struct frame_view view;
    uint32_t words[GUARD + COUNT + GUARD];
};

static void place(struct tile_fixture *f, vec3s centre, float half_m, float fov_rad)
{
    const struct world_camera camera = { .forward = vec3_of(0, 0, -1),
                                         .up = vec3_of(0, 1, 0),
                                         .vertical_fov_rad = fov_rad,
                                         .near_m = 0.01f };
    *f = (struct tile_fixture){
        .gpu_object = { .centre = centre, .half_m = half_m, .rotation = { 0, 0, 0, 1 } }
    };
    const struct frame_camera projected = frame_camera_of(&camera, PIXELS, PIXELS);
    frame_camera_constants(&projected, PIXELS, PIXELS, &f->constants);
    f->state.options = (struct dnrt_options){ .fade = 2, .reach = 2 };
    f->state.objects.at = &f->object;
    f->state.objects.count = 1;
    f->state.gpu_objects = &f->gpu_object;
    f->view = (struct frame_view){
        .width = PIXELS, .height = PIXELS, .constants = &f->constants, .camera = projected
    };
    memset(f->words, 0x5a, sizeof f->words);
}

static struct dnrt_tile_counts find(struct tile_fixture *f)
{
    const struct dnrt_tile_counts counts =
        dnrt_find_tiles(&f->state, &f->view, 1, f->words + GUARD);
    for (int i = 0; i < GUARD; i++)
        CHECK(f->words[i] == UNTOUCHED && f->words[GUARD + COUNT + i] == UNTOUCHED);
    CHECK(counts.own <= counts.all && counts.all <= TILES * TILES);
    CHECK((counts.all > 0) == dnrt_in_view(&f->state, &f->view, 0));
    return counts;
}

TEST(an_object_in_the_view_reaches_the_tiles_of_its_outer_volume)
{
    struct tile_fixture f;
    place(&f, vec3_of(0, 0, -20), 1, GLM_PI_2f); // a tenth of the image, about its middle
    assert_int_equal(find(&f).all, 4);
    place(&f, vec3_of(0, 0, -3), 1, GLM_PI_2f);
    assert_int_equal(find(&f).all, TILES * TILES);
}

TEST(an_object_beside_the_view_reaches_no_tile_however_far_and_narrow_that_is)
{
    static const float FOV_RAD[] = { 1.7453e-5f, 1e-3f, 0.1f, 1, 3 };
    for (int axis = 0; axis < 2; axis++)
        for (int sign = -1; sign <= 1; sign += 2)
            for (size_t i = 0; i < sizeof FOV_RAD / sizeof *FOV_RAD; i++)
                for (float distance_m = 3e4f; distance_m < 2e9f; distance_m *= 10) {
                    struct tile_fixture f;
                    vec3s centre = vec3_of(0, 0, -distance_m * 1e-4f);
                    centre.raw[axis] = (float)sign * distance_m;
                    place(&f, centre, 0.5f, FOV_RAD[i]);
                    if (distance_m * 1e-4f > 2) assert_int_equal(find(&f).all, 0);
                }
}

TEST(tiles_are_of_the_image_whatever_the_size_of_an_object)
{
    static const float FOV_RAD[] = { 1e-38f, 1e-20f, 1.7453e-5f, 1, 3.1415f };
    for (size_t i = 0; i < sizeof FOV_RAD / sizeof *FOV_RAD; i++)
        for (float half_m = 1e-30f; half_m < 1e38f; half_m *= 1000)
            for (float depth_m = 1e-20f; depth_m < 1e38f; depth_m *= 1000) {
                struct tile_fixture f;
                place(&f, vec3_of(depth_m, 1, -depth_m), half_m, FOV_RAD[i]);
                find(&f);
            }
}
