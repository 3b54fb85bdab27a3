// A program's own G-buffer in other formats and encodings, against the frame's own: to the bit
// where the format holds all of it, else within what the format rounds.
#include "api/camera_matrices.h"
#include "api/renderer_fixture.h"
#include "framework/own_image.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MARGIN = 5, TEXELS = (FIXTURE_WIDTH + MARGIN) * (FIXTURE_HEIGHT + MARGIN) };
static const char GI[] = "lpv:dim=16+vo:temporal=true";

// A texel of a layer of the own renderer, four floats, as bytes of the format.
typedef void encoder(const float *value, void *texel);

static uint32_t unorm(float v, uint32_t most)
{
    return (uint32_t)lroundf(fminf(fmaxf(v, 0.0f), 1.0f) * (float)most);
}

static int32_t snorm(float v, int32_t most)
{
    return (int32_t)lroundf(fminf(fmaxf(v, -1.0f), 1.0f) * (float)most);
}

static uint16_t half_of(float v)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000u;
    const float magnitude = fabsf(v);
    if (magnitude < 6.103515625e-5f)
        return (uint16_t)(sign | (uint32_t)lrintf(magnitude * 0x1p24f));
    bits = (bits & 0x7fffffffu) + 0xfffu + (bits >> 13 & 1u); // to the nearest, even
    return (uint16_t)(sign | ((bits >> 13) - (112u << 10)));
}

static float srgb(float v)
{
    return v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
}

static void octahedral(const float *n, float out[2])
{
    const float sum = fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]);
    const float x = sum > 0 ? n[0] / sum : 0, y = sum > 0 ? n[1] / sum : 0;
    const bool lower = n[2] < 0;
    out[0] = lower ? (1 - fabsf(y)) * (x < 0 ? -1.0f : 1.0f) : x;
    out[1] = lower ? (1 - fabsf(x)) * (y < 0 ? -1.0f : 1.0f) : y;
}

#define ENCODER(name, type, count, expression)                                                     \
    static void name(const float *v, void *texel)                                                  \
    {                                                                                              \
        type out[count];                                                                           \
        for (int i = 0; i < (count); i++) out[i] = (type)(expression);                             \
        memcpy(texel, out, sizeof out);                                                            \
    }
ENCODER(float_1, float, 1, v[i])
ENCODER(float_2, float, 2, v[i])
ENCODER(float_4, float, 4, v[i])
ENCODER(half_2, uint16_t, 2, half_of(v[i]))
ENCODER(half_4, uint16_t, 4, half_of(v[i]))
ENCODER(unorm16_1, uint16_t, 1, unorm(v[i], 65535))
ENCODER(unorm24_1, uint32_t, 1, unorm(v[i], 16777215))
ENCODER(biased8_4, uint8_t, 4, unorm(0.5f * v[i] + 0.5f, 255))
ENCODER(biased16_4, uint16_t, 4, unorm(0.5f * v[i] + 0.5f, 65535))
ENCODER(snorm8_4, int8_t, 4, snorm(v[i], 127))
ENCODER(snorm16_4, int16_t, 4, snorm(v[i], 32767))
ENCODER(linear8_4, uint8_t, 4, unorm(v[i], 255))
ENCODER(srgb8_4, uint8_t, 4, unorm(i < 3 ? srgb(v[i]) : v[i], 255))
ENCODER(bgra_srgb8_4, uint8_t, 4, unorm(i < 3 ? srgb(v[2 - i]) : v[i], 255))
ENCODER(linear16_4, uint16_t, 4, unorm(v[i], 65535))

static void biased10_3(const float *v, void *texel)
{
    uint32_t word = 0;
    for (int i = 0; i < 3; i++) word |= unorm(0.5f * v[i] + 0.5f, 1023) << 10 * i;
    memcpy(texel, &word, sizeof word);
}

static void octahedral_half(const float *v, void *texel)
{
    float at[2];
    octahedral(v, at);
    half_2(at, texel);
}

static void octahedral_float(const float *v, void *texel)
{
    float at[2];
    octahedral(v, at);
    float_2(at, texel);
}

static void octahedral_snorm16(const float *v, void *texel)
{
    float at[2];
    octahedral(v, at);
    const int16_t out[2] = { (int16_t)snorm(at[0], 32767), (int16_t)snorm(at[1], 32767) };
    memcpy(texel, out, sizeof out);
}

// Pixels, +y down, from now to the last frame.
static void motion_pixels(const float *v, void *texel)
{
    const float at[2] = { -v[0] * FIXTURE_WIDTH, -v[1] * FIXTURE_HEIGHT };
    float_2(at, texel);
}

static void motion_half(const float *v, void *texel)
{
    half_4((const float[4]){ v[0], v[1], v[2], 1 }, texel);
}

enum encoded { DEPTH, NORMAL, ALBEDO, MOTION, ENCODED };
static const char *const layer_of[ENCODED] = { "depth", "normal", "albedo", "motion" };

struct format_case {
    const char *name;
    enum encoded layer;
    VkFormat format;
    size_t bytes; // of a texel
    encoder *encode;
    double bound; // relative difference of the colour
    struct matrix_options depth;
    void (*set)(struct ag_gbuffer_layout *layout);
};

static void set_biased(struct ag_gbuffer_layout *layout)
{
    layout->normal_octahedral = false;
    layout->normal_scale = 2;
    layout->normal_bias = -1;
}

static void set_xyz(struct ag_gbuffer_layout *layout)
{
    layout->normal_octahedral = false;
}

static void set_in_view_space(struct ag_gbuffer_layout *layout)
{
    layout->normal_octahedral = false;
    layout->normal_in_view_space = true;
}

static void set_pixels(struct ag_gbuffer_layout *layout)
{
    layout->motion_scale[0] = -1.0f / FIXTURE_WIDTH;
    layout->motion_scale[1] = -1.0f / FIXTURE_HEIGHT;
    layout->motion_distance = false;
}

static void set_nothing(struct ag_gbuffer_layout *layout)
{
    (void)layout;
}

// Bounds: rounding moves a normal of b bits by up to √3 / 2^b, which changes the light from an
// angle of incidence of cosine c by that / c; most pixels have c above 0.2. Albedo of 8 linear bits
// has steps of 1/255. Depth of 16 bits, forward, has steps of d²/(65535 n): 0.7 mm at 14 m with a
// near plane of 4 m. With one of 25 cm they are 11 mm, and surfaces shadow themselves.
static const struct format_case cases[] = {
    { "depth R32F, reversed", DEPTH, VK_FORMAT_R32_SFLOAT, 4, float_1, 1e-4, { 0 }, set_nothing },
    { "depth D32F, forward",
      DEPTH,
      VK_FORMAT_D32_SFLOAT,
      4,
      float_1,
      2e-3,
      { .depth = FORWARD_FINITE },
      set_nothing },
    { "depth D32F, forward without a far plane",
      DEPTH,
      VK_FORMAT_D32_SFLOAT,
      4,
      float_1,
      2e-3,
      { .depth = FORWARD_INFINITE },
      set_nothing },
    { "depth D32F S8, reversed with a far plane",
      DEPTH,
      VK_FORMAT_D32_SFLOAT_S8_UINT,
      4,
      float_1,
      1e-3,
      { .depth = REVERSED_FINITE },
      set_nothing },
    { "depth D24 S8, forward",
      DEPTH,
      VK_FORMAT_D24_UNORM_S8_UINT,
      4,
      unorm24_1,
      2e-3,
      { .depth = FORWARD_FINITE },
      set_nothing },
    { "depth D16, forward",
      DEPTH,
      VK_FORMAT_D16_UNORM,
      2,
      unorm16_1,
      0.02,
      { .depth = FORWARD_FINITE },
      set_nothing },
    { "normal RG16F",
      NORMAL,
      VK_FORMAT_R16G16_SFLOAT,
      4,
      octahedral_half,
      1e-4,
      { 0 },
      set_nothing },
    { "normal RG32F",
      NORMAL,
      VK_FORMAT_R32G32_SFLOAT,
      8,
      octahedral_float,
      1e-4,
      { 0 },
      set_nothing },
    { "normal RG16 SNORM",
      NORMAL,
      VK_FORMAT_R16G16_SNORM,
      4,
      octahedral_snorm16,
      2e-3,
      { 0 },
      set_nothing },
    { "normal A2B10G10R10",
      NORMAL,
      VK_FORMAT_A2B10G10R10_UNORM_PACK32,
      4,
      biased10_3,
      0.01,
      { 0 },
      set_biased },
    { "normal RGBA8", NORMAL, VK_FORMAT_R8G8B8A8_UNORM, 4, biased8_4, 0.04, { 0 }, set_biased },
    { "normal RGBA16",
      NORMAL,
      VK_FORMAT_R16G16B16A16_UNORM,
      8,
      biased16_4,
      2e-3,
      { 0 },
      set_biased },
    { "normal RGBA8 SNORM", NORMAL, VK_FORMAT_R8G8B8A8_SNORM, 4, snorm8_4, 0.04, { 0 }, set_xyz },
    { "normal RGBA16 SNORM",
      NORMAL,
      VK_FORMAT_R16G16B16A16_SNORM,
      8,
      snorm16_4,
      2e-3,
      { 0 },
      set_xyz },
    { "normal RGBA32F", NORMAL, VK_FORMAT_R32G32B32A32_SFLOAT, 16, float_4, 2e-3, { 0 }, set_xyz },
    { "normal RGBA16F in view space",
      NORMAL,
      VK_FORMAT_R16G16B16A16_SFLOAT,
      8,
      half_4,
      2e-3,
      { 0 },
      set_in_view_space },
    { "albedo RGBA8 SRGB", ALBEDO, VK_FORMAT_R8G8B8A8_SRGB, 4, srgb8_4, 0.0, { 0 }, set_nothing },
    { "albedo BGRA8 SRGB",
      ALBEDO,
      VK_FORMAT_B8G8R8A8_SRGB,
      4,
      bgra_srgb8_4,
      0.0,
      { 0 },
      set_nothing },
    { "albedo RGBA8", ALBEDO, VK_FORMAT_R8G8B8A8_UNORM, 4, linear8_4, 0.035, { 0 }, set_nothing },
    { "albedo RGBA16F",
      ALBEDO,
      VK_FORMAT_R16G16B16A16_SFLOAT,
      8,
      half_4,
      2e-3,
      { 0 },
      set_nothing },
    { "albedo RGBA16",
      ALBEDO,
      VK_FORMAT_R16G16B16A16_UNORM,
      8,
      linear16_4,
      2e-3,
      { 0 },
      set_nothing },
    { "motion RGBA16F",
      MOTION,
      VK_FORMAT_R16G16B16A16_SFLOAT,
      8,
      motion_half,
      1e-3,
      { 0 },
      set_nothing },
    { "motion RG32F in pixels",
      MOTION,
      VK_FORMAT_R32G32_SFLOAT,
      8,
      motion_pixels,
      1e-3,
      { 0 },
      set_pixels },
};

// The texels of a layer as the case has them, with a margin at the right and the bottom.
static void encode(const struct format_case *c, const struct renderer_fixture *s,
                   const struct ag_image *layer, const struct ag_image *distance, uint8_t *out)
{
    struct matrix_options depth = matrix_options_default();
    depth.depth = c->depth.depth;
    const struct ag_view_matrices m =
        matrices_of(&s->frame.camera, FIXTURE_WIDTH, FIXTURE_HEIGHT, &depth);
    for (int y = 0; y < FIXTURE_HEIGHT; y++)
        for (int x = 0; x < FIXTURE_WIDTH; x++) {
            const int at = y * FIXTURE_WIDTH + x;
            const bool surface = distance->pixels[at] > 0;
            float value[4] = { 0, 0, 0, surface ? 1.0f : 0.0f };
            for (int k = 0; k < layer->channels; k++)
                value[k] = layer->pixels[at * layer->channels + k];
            if (c->layer == DEPTH)
                value[0] = surface ? depth_at(&s->frame.camera, &depth, value[0])
                                   : depth_at(&s->frame.camera, &depth, 1e30f);
            if (c->layer == DEPTH && !surface) value[0] = roundf(value[0]);
            if (c->set == set_in_view_space) {
                const float world[3] = { value[0], value[1], value[2] };
                for (int r = 0; r < 3; r++)
                    value[r] = world[0] * m.view_from_world[r] +
                               world[1] * m.view_from_world[4 + r] +
                               world[2] * m.view_from_world[8 + r];
            }
            c->encode(value, out + c->bytes * (size_t)(y * (FIXTURE_WIDTH + MARGIN) + x));
        }
}

static struct ag_layer_handle handle_of(const struct own_image *image)
{
    return (struct ag_layer_handle){ .vk_image = (void *)image->image,
                                     .vk_format = (uint32_t)image->format,
                                     .vk_usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                     .vk_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     .width = image->width,
                                     .height = image->height,
                                     .scale = 1 };
}

static struct ag_layer_handle layer(struct renderer_fixture *s, const char *name)
{
    struct ag_layer_handle handle;
    if (ag_renderer_layer_handle(s->renderer, name, &handle) != AG_OK)
        fail_msg("%s: %s", name, ag_context_last_error(s->context));
    return handle;
}

// All but one layer are the own renderer's.
static void hand_over(struct renderer_fixture *s, struct own_device *own,
                      const struct format_case *c, struct ag_renderer *hosted,
                      const struct ag_view_matrices *matrices)
{
    static uint8_t texels[16 * TEXELS];
    struct ag_image *distance = fixture_read(s, "depth");
    struct ag_image *read = fixture_read(s, layer_of[c->layer]);
    struct ag_gbuffer gbuffer = { .depth = layer(s, "depth"),
                                  .normal = layer(s, "normal"),
                                  .albedo = layer(s, "albedo"),
                                  .emissive = layer(s, "emissive"),
                                  .motion = layer(s, "motion") };
    struct ag_layer_handle *const members[ENCODED] = { &gbuffer.depth, &gbuffer.normal,
                                                       &gbuffer.albedo, &gbuffer.motion };
    memset(texels, 0x5a, sizeof texels);
    encode(c, s, read, distance, texels);
    struct own_image image =
        own_image_create(own, c->format, FIXTURE_WIDTH + MARGIN, FIXTURE_HEIGHT + MARGIN, texels,
                         c->bytes * (size_t)TEXELS);
    *members[c->layer] = handle_of(&image);
    struct ag_frame_desc frame = s->frame;
    frame.gbuffer = &gbuffer;
    frame.matrices = c->layer == DEPTH ? matrices : NULL;
    if (ag_renderer_render(hosted, &frame) != AG_OK)
        fail_msg("%s: %s", c->name, ag_context_last_error(s->context));
    assert_int_equal(ag_renderer_wait(hosted), AG_OK);
    own_image_destroy(own, &image);
    ag_image_destroy(s->context, distance);
    ag_image_destroy(s->context, read);
}

static int by_size(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

// Relative difference that 98 % of the values do not exceed. The others are beside the light, 2 cm
// below the ceiling, where a pixel is a hundred times as bright as most and any error of its
// position shows.
static double difference_of_most(const struct ag_image *a, const struct ag_image *b)
{
    static double differences[3 * FIXTURE_WIDTH * FIXTURE_HEIGHT];
    const int count = 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT;
    for (int i = 0; i < count; i++) {
        const double difference = fabs((double)a->pixels[i] - (double)b->pixels[i]);
        differences[i] = difference > 0 ? difference / fmax((double)b->pixels[i], 1e-3) : 0.0;
    }
    qsort(differences, (size_t)count, sizeof *differences, by_size);
    return differences[count * 98 / 100];
}

static void check_case(struct renderer_fixture *s, struct own_device *own,
                       const struct format_case *c)
{
    struct ag_gbuffer_layout layout;
    struct ag_renderer_desc desc = fixture_renderer_desc(GI);
    struct ag_renderer *hosted = NULL;
    ag_gbuffer_layout_default(&layout);
    c->set(&layout);
    desc.host_gbuffer = true;
    desc.gbuffer_layout = &layout;
    if (ag_renderer_create(s->device, s->scene, &desc, &hosted) != AG_OK)
        fail_msg("%s: %s", c->name, ag_context_last_error(s->context));
    const struct ag_camera before = s->frame.camera;
    struct matrix_options depth = matrix_options_default();
    depth.depth = c->depth.depth;
    for (int i = 0; i < 2; i++) {
        const struct ag_view_matrices m =
            matrices_of(&s->frame.camera, FIXTURE_WIDTH, FIXTURE_HEIGHT, &depth);
        s->frame.camera_cut = i == 0;
        assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
        hand_over(s, own, c, hosted, &m);
        s->frame.camera.eye[0] += 0.02f; // the history is reprojected
    }
    s->frame.camera = before;
    struct ag_image *expected = fixture_read(s, "color");
    struct ag_image *image = fixture_read_from(s, hosted, "color");
    const double difference = difference_of_most(image, expected);
    print_message("%s: differs by %.2g\n", c->name, difference);
    if (!(difference <= c->bound)) fail_msg("%s: differs by %g", c->name, difference);
    ag_image_destroy(s->context, expected);
    ag_image_destroy(s->context, image);
    ag_renderer_destroy(hosted);
}

TEST(gbuffers_in_other_formats_give_the_picture_of_the_own_one)
{
    struct own_device own;
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    const struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open(GI, &adopt);
    s.frame.auto_exposure = false;
    s.frame.camera.near_m = 4; // the nearest surface is 8 m away
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (own_image_supported(&own, cases[i].format))
            check_case(&s, &own, &cases[i]);
        else
            print_message("%s: the device has no such images\n", cases[i].name);
    }
    fixture_close(&s);
    own_device_close(&own);
}

TEST(wrong_layouts_are_refused)
{
    struct renderer_fixture s = fixture_open_lit("none");
    struct ag_gbuffer_layout layout;
    ag_gbuffer_layout_default(&layout);
    struct ag_renderer_desc desc = fixture_renderer_desc("none");
    struct ag_renderer *hosted = NULL;
    desc.gbuffer_layout = &layout;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "but not host_gbuffer"));
    desc.host_gbuffer = true;
    layout.metallic_channel = 4;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_ERROR_ARGUMENT);
    layout.metallic_channel = -1;
    layout.normal_scale = NAN;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_ERROR_ARGUMENT);
    layout.normal_scale = 1;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_OK);

    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_gbuffer gbuffer = { .depth = layer(&s, "depth"),
                                  .normal = layer(&s, "normal"),
                                  .albedo = layer(&s, "normal") };
    struct ag_frame_desc frame = s.frame;
    frame.gbuffer = &gbuffer;
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "gbuffer.albedo: its VkFormat"));
    CHECK(strstr(ag_context_last_error(s.context), "b10g11r11f"));
    gbuffer.albedo = layer(&s, "albedo");
    gbuffer.albedo.width--;
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "or larger"));
    gbuffer.albedo = layer(&s, "albedo");
    gbuffer.motion_offset[1] = INFINITY;
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_ERROR_ARGUMENT);
    gbuffer.motion_offset[1] = 0;
    gbuffer.motion = layer(&s, "motion");
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_OK);
    ag_renderer_destroy(hosted);

    // In place, forward depth cannot be read.
    struct matrix_options options = matrix_options_default();
    options.depth = FORWARD_FINITE;
    const struct ag_view_matrices m =
        matrices_of(&s.frame.camera, FIXTURE_WIDTH, FIXTURE_HEIGHT, &options);
    desc.gbuffer_layout = NULL;
    frame.matrices = &m;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_OK);
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "not reversed"));
    ag_renderer_destroy(hosted);
    fixture_close(&s);
}
