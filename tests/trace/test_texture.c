// Texture sampling against values computed by hand.
#include "framework/test.h"

#include "image/png_file.h"
#include "trace/texture.h"

#include <math.h>

enum { SIZE = 8 };

// Red grows with x, green with y, in steps of 16.
static struct scene_image ramp(uint8_t texels[SIZE * SIZE * 4])
{
    for (int i = 0; i < SIZE * SIZE; i++) {
        texels[4 * i] = (uint8_t)(16 * (i % SIZE));
        texels[4 * i + 1] = (uint8_t)(16 * (i / SIZE));
        texels[4 * i + 2] = 200;
        texels[4 * i + 3] = 128;
    }
    return (struct scene_image){ .name = "ramp", .width = SIZE, .height = SIZE, .rgba = texels };
}

struct fixture {
    uint8_t texels[SIZE * SIZE * 4];
    struct texture texture;
    struct texture_use use;
};

static void open(struct fixture *f, bool srgb)
{
    struct scene_image image = ramp(f->texels);
    texture_init(&f->texture, &image, srgb);
    assert_int_equal(f->texture.levels, 1);
    assert_true(texture_add_levels(&f->texture, test_host()));
    CHECK(f->texture.levels > 1);
    f->use = (struct texture_use){ .uv_scale = { 1, 1 } };
}

static vec4s read_at(struct fixture *f, float x, float y)
{
    struct texture_map map = texture_map_of(&f->use, &f->texture);
    return texture_sample(&map, (vec2s){ { x / SIZE, y / SIZE } }, 0);
}

TEST(filtering_is_linear_between_texel_centres)
{
    struct fixture f;
    open(&f, false);
    vec4s at = read_at(&f, 2.5f, 3.5f), between = read_at(&f, 2.75f, 4.0f);
    CHECK_NEAR(at.x, 32 / 255.0, 1e-6);
    CHECK_NEAR(at.y, 48 / 255.0, 1e-6);
    CHECK_NEAR(at.w, 128 / 255.0, 1e-6);
    CHECK_NEAR(between.x, 36 / 255.0, 1e-6);
    CHECK_NEAR(between.y, 56 / 255.0, 1e-6);
    texture_finish(&f.texture, test_host());
}

TEST(srgb_is_decoded_before_filtering)
{
    struct fixture f;
    open(&f, true);
    double low = (double)srgb_decode(32 / 255.0f), high = (double)srgb_decode(48 / 255.0f);
    CHECK_NEAR(read_at(&f, 3.0f, 0.5f).x, 0.5 * (low + high), 1e-6);
    CHECK_NEAR(read_at(&f, 3.0f, 0.5f).w, 128 / 255.0, 1e-6);
    texture_finish(&f.texture, test_host());
}

TEST(wrap_modes_repeat_mirror_and_clamp)
{
    struct fixture f;
    open(&f, false);
    CHECK_NEAR(read_at(&f, SIZE + 1.5f, 0.5f).x, 16 / 255.0, 1e-6);
    CHECK_NEAR(read_at(&f, -0.5f, 0.5f).x, 112 / 255.0, 1e-6);
    CHECK_NEAR(read_at(&f, 0.0f, 0.5f).x, 56 / 255.0, 1e-6); // half of the first, half of the last
    f.use.wrap_u = WRAP_MIRROR;
    CHECK_NEAR(read_at(&f, -1.5f, 0.5f).x, 16 / 255.0, 1e-6);
    CHECK_NEAR(read_at(&f, SIZE + 1.5f, 0.5f).x, 96 / 255.0, 1e-6);
    f.use.wrap_u = WRAP_CLAMP;
    CHECK_NEAR(read_at(&f, -50.0f, 0.5f).x, 0, 0);
    CHECK_NEAR(read_at(&f, 1e30f, 0.5f).x, 112 / 255.0, 1e-6);
    texture_finish(&f.texture, test_host());
}

TEST(nearest_filter_returns_one_texel)
{
    struct fixture f;
    open(&f, false);
    f.use.nearest = true;
    CHECK_NEAR(read_at(&f, 2.99f, 3.01f).x, 32 / 255.0, 1e-6);
    CHECK_NEAR(read_at(&f, 2.99f, 3.01f).y, 48 / 255.0, 1e-6);
    texture_finish(&f.texture, test_host());
}

TEST(texture_transform_scales_rotates_and_translates)
{
    struct fixture f;
    open(&f, false);
    f.use.uv_scale[0] = 0.5f;
    f.use.uv_offset[0] = 0.25f;
    CHECK_NEAR(read_at(&f, 1.0f, 2.5f).x, 32 / 255.0, 1e-6); // 0.5 · 1 + 2 = 2.5 texels
    f.use = (struct texture_use){ .uv_scale = { 1, 1 }, .uv_rotation_rad = GLM_PI_2f };
    // A rotation by 90 degrees: u' = v, v' = −u.
    CHECK_NEAR(read_at(&f, 1.5f, 2.5f).x, 32 / 255.0, 1e-5);
    CHECK_NEAR(read_at(&f, 1.5f, 2.5f).y, 96 / 255.0, 1e-5);
    texture_finish(&f.texture, test_host());
}

TEST(a_footprint_of_the_whole_image_returns_its_mean)
{
    struct fixture f;
    open(&f, false);
    struct texture_map map = texture_map_of(&f.use, &f.texture);
    vec2s at = { { 0.3f, 0.6f } }, wide = { { 1, 0 } }, narrow = { { 0.25f, 0 } },
          zero = { { 0, 0 } };
    CHECK_NEAR(texture_sample(&map, at, texture_level(&map, wide, zero)).x, 56 / 255.0, 1.0 / 255);
    CHECK_NEAR(texture_sample(&map, at, texture_level(&map, zero, wide)).y, 56 / 255.0, 1.0 / 255);
    // Two texels per pixel: level 1, the means of 2 × 2 texels.
    vec2s centre = { { 0.125f, 0.125f } };
    CHECK_NEAR(texture_sample(&map, centre, texture_level(&map, narrow, zero)).x, 8 / 255.0, 1e-6);
    texture_finish(&f.texture, test_host());
}
