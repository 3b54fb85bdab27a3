// Blocks of a sun's shadow maps: the image is that of the whole shadow test, to the bit.
#include "frame/frame_fixture.h"
#include "frame/frame_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const vec3s LUX = { { 1000, 1000, 1000 } };
static const uint32_t SIZE = 128;

// Edges, contacts, a thin sheet over the floor, a round surface, and slanted planes.
static void make_scene(struct frame_fixture *s, float tilt)
{
    const int matte = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
    fixture_floor(s, 5, matte);
    fixture_box(s, vec3_of(-1, 0, -0.6f), vec3_of(-0.3f, 0.7f, 0.4f), false, matte);
    fixture_box(s, vec3_of(0.6f, 0, -1.5f), vec3_of(2.4f, 1.4f, 0.5f), true, matte);
    const float x = cosf(tilt), y = sinf(tilt);
    fixture_quad(s, vec3_of(-x, 0.9f - y, 0.5f), vec3_of(x, 0.9f + y, 0.5f),
                 vec3_of(x, 0.9f + y, -0.5f), vec3_of(-x, 0.9f - y, -0.5f), matte);
    for (int i = 0; i < 24; i++) {
        const float a = 0.2618f * (float)i, b = 0.2618f * (float)(i + 1);
        fixture_quad(s, vec3_of(0.4f * cosf(b), 0, 1 + 0.4f * sinf(b)),
                     vec3_of(0.4f * cosf(a), 0, 1 + 0.4f * sinf(a)),
                     vec3_of(0.3f * cosf(a), 0.6f, 1 + 0.3f * sinf(a)),
                     vec3_of(0.3f * cosf(b), 0.6f, 1 + 0.3f * sinf(b)), matte);
    }
}

static uint32_t undecided_pixels(struct frame_fixture *s)
{
    struct direct_list_header header = { 0 };
    CHECK(gpu_buffer_download(s->gpu, s->frame->common->direct.list, 0, &header, sizeof header));
    return header.count;
}

// The first frame draws the maps and makes the whole test, the second has blocks.
static uint32_t compare_frames(struct gpu *gpu, int i)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    make_scene(&s, 0.15f * (float)i);
    const float azimuth = 0.7f * (float)i;
    fixture_add_sun(&s, vec3_of(cosf(azimuth), -0.2f - 0.25f * (float)i, sinf(azimuth)), LUX);
    fixture_look(&s, vec3_of(2.5f * cosf(2 * azimuth), 0.4f + 0.4f * (float)i, 2.5f),
                 vec3_of(0, 0.3f, 0));
    s.width = s.height = SIZE;
    s.options.shadow_size = 300 << (i % 4); // not a whole number of blocks
    s.options.cascades = 1 + i % 4;
    fixture_open(&s);
    fixture_render(&s);
    CHECK(!s.frame->has_blocks);
    float *whole = fixture_read(&s, READ_DIRECT);
    fixture_render(&s);
    CHECK(s.frame->has_blocks);
    float *with_blocks = fixture_read(&s, READ_DIRECT);
    CHECK(memcmp(whole, with_blocks, sizeof(float) * 3 * SIZE * SIZE) == 0);
    const uint32_t undecided = undecided_pixels(&s);
    free(whole);
    free(with_blocks);
    fixture_finish(&s);
    return undecided;
}

TEST_GPU(blocks_do_not_change_the_image)
{
    uint32_t undecided = 0;
    const int scenes = 12;
    for (int i = 0; i < scenes; i++) undecided += compare_frames(gpu, i);
    const uint32_t pixels = (uint32_t)scenes * SIZE * SIZE;
    printf("blocks: %u of %u pixels undecided\n", undecided, pixels);
    // Interpolated depths deviate from planes, by driver: 9 % (Mesa 22.3) and 32 % (Mesa 25).
    CHECK(undecided > 0 && undecided < pixels * 2 / 5);
}

// Blocks belong to a map: a map that is drawn again has none, and gets new ones.
TEST_GPU(blocks_follow_the_maps)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    make_scene(&s, 0.2f);
    struct world_light *sun = fixture_add_sun(&s, vec3_of(0.3f, -1, 0.2f), LUX);
    fixture_look(&s, vec3_of(0, 1.5f, 3), vec3_of(0, 0.3f, 0));
    s.width = s.height = SIZE;
    fixture_open(&s);
    for (int i = 0; i < 2; i++) fixture_render(&s);
    sun->direction = glms_vec3_normalize(vec3_of(-0.6f, -1, 0.1f));
    fixture_render(&s);
    CHECK(!s.frame->has_blocks);
    float *whole = fixture_read(&s, READ_DIRECT);
    fixture_render(&s);
    CHECK(s.frame->has_blocks);
    float *with_blocks = fixture_read(&s, READ_DIRECT);
    CHECK(memcmp(whole, with_blocks, sizeof(float) * 3 * SIZE * SIZE) == 0);
    free(whole);
    free(with_blocks);
    fixture_finish(&s);
}
