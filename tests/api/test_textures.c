// Textured scenes built by calls: they look as those of files, and wrong contents are refused.
#include "api/renderer_fixture.h"
#include "api/scene_copy.h"

#include "api/objects.h"
#include "image/png_file.h"

#include <stdio.h>
#include <string.h>

enum { PIXELS = FIXTURE_WIDTH * FIXTURE_HEIGHT };

struct session {
    struct ag_context *context;
    struct ag_device *device;
    struct ag_scene *scene;
};

static void ok(struct session *s, enum ag_result result)
{
    if (result != AG_OK) fail_msg("%s", ag_context_last_error(s->context));
}

static struct session open_session(bool gpu, const char *scene)
{
    if (gpu) test_gpu_require();
    struct session s = { .context = fixture_context() };
    struct ag_device_desc device;
    ag_device_desc_default(&device);
    device.validation = true;
    if (gpu) ok(&s, ag_device_create(s.context, &device, &s.device));
    ok(&s,
       scene ? ag_scene_load(s.context, scene, &s.scene) : ag_scene_create(s.context, &s.scene));
    return s;
}

static void close_session(struct session *s)
{
    if (s->device && ag_device_validation_messages(s->device))
        fail_msg("validation says: %s", fixture_last_warning);
    ag_scene_destroy(s->scene);
    ag_device_destroy(s->device);
    ag_context_destroy(s->context);
}

// ---- Images

static struct ag_image *rendered(struct session *s, struct ag_scene *scene, const char *gi,
                                 const struct ag_camera *camera, const char *layer)
{
    struct ag_renderer *renderer = NULL;
    struct ag_image *image = NULL;
    const struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    struct ag_frame_desc frame;
    ag_frame_desc_default(&frame);
    frame.camera = *camera;
    frame.animation = -1;
    ok(s, ag_renderer_create(s->device, scene, &desc, &renderer));
    for (int i = 0; i < 2; i++) ok(s, ag_renderer_render(renderer, &frame));
    ok(s, ag_renderer_read(renderer, layer, &image));
    ag_renderer_destroy(renderer);
    return image;
}

static struct ag_image *traced(struct session *s, struct ag_scene *scene,
                               const struct ag_camera *camera)
{
    struct ag_reference *reference = NULL;
    struct ag_image *image = NULL;
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = FIXTURE_WIDTH;
    desc.height = FIXTURE_HEIGHT;
    desc.camera = *camera;
    desc.animation = -1;
    ok(s, ag_reference_create(scene, &desc, &reference));
    ok(s, ag_reference_render(reference, 4, NULL, NULL));
    ok(s, ag_reference_read(reference, "color", &image));
    ag_reference_destroy(reference);
    return image;
}

static double mean_of(const struct ag_image *image)
{
    double sum = 0;
    for (int i = 0; i < 3 * PIXELS; i++) sum += (double)image->pixels[i];
    return sum / (3 * PIXELS);
}

// Takes both.
static void check_equal(struct session *s, const char *what, struct ag_image *a, struct ag_image *b)
{
    int different = 0;
    for (int i = 0; i < 3 * PIXELS; i++)
        different += memcmp(&a->pixels[i], &b->pixels[i], sizeof(float)) != 0;
    if (different > 0) fail_msg("%s: %d of %d values differ", what, different, 3 * PIXELS);
    CHECK(mean_of(a) > 0);
    ag_image_destroy(s->context, a);
    ag_image_destroy(s->context, b);
}

static void check_copy(const char *name)
{
    struct session s = open_session(true, name);
    struct ag_camera camera;
    ok(&s, ag_scene_default_camera(s.scene, -1, 0.0, &camera, NULL));
    ok(&s, ag_scene_add_default_lighting(s.scene, NULL));
    struct ag_scene *copy = scene_copy_by_calls(s.scene);
    check_equal(&s, name, rendered(&s, s.scene, "lpv", &camera, "color"),
                rendered(&s, copy, "lpv", &camera, "color"));
    check_equal(&s, name, traced(&s, s.scene, &camera), traced(&s, copy, &camera));
    ag_scene_destroy(copy);
    close_session(&s);
}

// Images, tiling, normals of textures; lights and a camera of the scene.
TEST(a_builtin_scene_rebuilt_by_calls_gives_the_same_image)
{
    check_copy("@atrium");
}

// Six materials with all maps of glTF, tangents of the file, alpha blending.
TEST(a_file_with_tangents_rebuilt_by_calls_gives_the_same_image)
{
    check_copy(test_scene_path("flight-helmet.glb"));
}

// Emissive textures, computed tangents, a second set of texture coordinates.
TEST(an_emissive_file_rebuilt_by_calls_gives_the_same_image)
{
    check_copy(test_scene_path("circuit-emissive-sun.glb"));
}

// ---- A square that faces the camera

static const float CORNERS[12] = { -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0 };
static const float UVS[8] = { 0, 1, 1, 1, 1, 0, 0, 0 };
static const uint32_t FACES[6] = { 0, 1, 2, 0, 2, 3 };
static const struct ag_camera IN_FRONT = {
    .eye = { 0, 0, 3 }, .up = { 0, 1, 0 }, .vertical_fov_rad = 0.6f, .near_m = 0.1f
};

static struct ag_mesh_desc square(int material)
{
    return (struct ag_mesh_desc){ .positions = CORNERS,
                                  .vertex_count = 4,
                                  .indices = FACES,
                                  .index_count = 6,
                                  .material = material,
                                  .uv = { UVS } };
}

static int add_image(struct session *s, struct ag_scene_image_desc desc)
{
    int index = -1;
    ok(s, ag_scene_add_image(s->scene, &desc, &index));
    return index;
}

static struct ag_scene_image_desc texels(const uint8_t *pixels, int width, int height, int channels)
{
    return (struct ag_scene_image_desc){
        .pixels = pixels, .width = width, .height = height, .channels = channels
    };
}

static void add_square(struct session *s, const struct ag_material_desc *material)
{
    int index = -1, mesh = -1;
    ok(s, ag_scene_add_material(s->scene, material, &index));
    const struct ag_mesh_desc desc = square(index);
    ok(s, ag_scene_add_mesh(s->scene, &desc, &mesh));
    ok(s, ag_scene_add_instance(s->scene, mesh, NULL, NULL));
}

// A white square with an image as its base colour.
static void add_textured_square(struct session *s, int image, enum ag_alpha_mode alpha,
                                bool nearest)
{
    struct ag_material_desc material;
    struct ag_material_maps maps;
    ag_material_desc_default(&material);
    ag_material_maps_default(&maps);
    for (int i = 0; i < 3; i++) material.base_color[i] = 1;
    material.alpha_mode = alpha;
    material.maps = &maps;
    maps.base_color.image = image;
    maps.base_color.nearest = nearest;
    maps.base_color.wrap_u = maps.base_color.wrap_v = AG_WRAP_CLAMP;
    add_square(s, &material);
}

// One channel of the albedo; x and y from 0 to 1.
static float albedo_at(const struct ag_image *albedo, float x, float y, int channel)
{
    const int column = (int)(x * FIXTURE_WIDTH), row = (int)(y * FIXTURE_HEIGHT);
    return albedo->pixels[3 * (row * FIXTURE_WIDTH + column) + channel];
}

// Half of the byte range is 0.216 in sRGB.
TEST(colours_are_sRGB_unless_the_image_says_linear)
{
    static const uint8_t grey[1] = { 128 };
    for (int linear = 0; linear < 2; linear++) {
        struct session s = open_session(true, NULL);
        struct ag_scene_image_desc desc = texels(grey, 1, 1, 1);
        desc.linear = linear;
        add_textured_square(&s, add_image(&s, desc), AG_ALPHA_OPAQUE, false);
        const float expected = linear ? 128.0f / 255.0f : srgb_decode(128.0f / 255.0f);
        struct ag_image *albedo = rendered(&s, s.scene, "none", &IN_FRONT, "albedo");
        CHECK_NEAR(albedo_at(albedo, 0.5f, 0.5f, 0), expected, 0.004);
        ag_image_destroy(s.context, albedo);
        close_session(&s);
    }
}

// An emissive square beside a floor, by a texture of 128/255 or by that factor.
static void add_lamp(struct session *s, bool textured)
{
    static const uint8_t half[1] = { 128 };
    const float down[16] = { 1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, -1, 1, 1 };
    struct ag_material_desc material;
    struct ag_material_maps maps;
    ag_material_desc_default(&material);
    ag_material_maps_default(&maps);
    struct ag_scene_image_desc desc = texels(half, 1, 1, 1);
    desc.linear = true;
    if (textured) maps.emissive.image = add_image(s, desc);
    for (int c = 0; c < 3; c++) material.emissive[c] = textured ? 100 : 100 * (128.0f / 255.0f);
    material.maps = &maps;
    add_square(s, &material);
    ag_material_desc_default(&material);
    add_square(s, &material);
    ok(s, ag_scene_set_instance_transform(s->scene, 1, down));
}

TEST(linear_emissive_maps_light_the_scene_as_their_values_do)
{
    struct session a = open_session(true, NULL), b = open_session(true, NULL);
    add_lamp(&a, true);
    add_lamp(&b, false);
    struct ag_image *first = rendered(&a, a.scene, "lpv", &IN_FRONT, "irradiance"),
                    *second = rendered(&b, b.scene, "lpv", &IN_FRONT, "irradiance");
    CHECK(mean_of(second) > 0);
    CHECK_RELATIVE(mean_of(first), mean_of(second), 0.005);
    ag_image_destroy(a.context, first);
    ag_image_destroy(b.context, second);
    first = traced(&a, a.scene, &IN_FRONT);
    second = traced(&b, b.scene, &IN_FRONT);
    CHECK_RELATIVE(mean_of(first), mean_of(second), 0.005);
    ag_image_destroy(a.context, first);
    ag_image_destroy(b.context, second);
    close_session(&a);
    close_session(&b);
}

// Rows from the top; the left texel of the upper row is a hole.
TEST(masks_cut_holes_and_rows_start_at_the_top)
{
    static const uint8_t pixels[16] = { 255, 0, 0,   0,   0,   255, 0,   255,
                                        0,   0, 255, 255, 255, 255, 255, 255 };
    struct session s = open_session(true, NULL);
    add_textured_square(&s, add_image(&s, texels(pixels, 2, 2, 4)), AG_ALPHA_MASK, true);
    struct ag_image *albedo = rendered(&s, s.scene, "none", &IN_FRONT, "albedo");
    static const float places[4][2] = {
        { 0.4f, 0.3f }, { 0.6f, 0.3f }, { 0.4f, 0.7f }, { 0.6f, 0.7f }
    };
    static const float expected[4][3] = { { 0, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 1, 1 } };
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(albedo_at(albedo, places[i][0], places[i][1], c), expected[i][c], 0.004);
    ag_image_destroy(s.context, albedo);
    close_session(&s);
}

TEST(vertex_colours_multiply_the_base_colour)
{
    static const float colors[16] = { 1, 0.5f, 0.25f, 1, 1, 0.5f, 0.25f, 1,
                                      1, 0.5f, 0.25f, 1, 1, 0.5f, 0.25f, 1 };
    struct session s = open_session(true, NULL);
    struct ag_material_desc material;
    ag_material_desc_default(&material); // 0.8
    int mesh = -1;
    ok(&s, ag_scene_add_material(s.scene, &material, NULL));
    struct ag_mesh_desc desc = square(0);
    desc.colors = colors;
    ok(&s, ag_scene_add_mesh(s.scene, &desc, &mesh));
    ok(&s, ag_scene_add_instance(s.scene, mesh, NULL, NULL));
    struct ag_image *albedo = rendered(&s, s.scene, "none", &IN_FRONT, "albedo");
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(albedo_at(albedo, 0.5f, 0.5f, c), 0.8f * colors[c], 0.004);
    ag_image_destroy(s.context, albedo);
    close_session(&s);
}

// ---- While a renderer uses the scene

TEST(textured_objects_that_come_later_look_as_in_a_new_renderer)
{
    static const uint8_t checks[4] = { 255, 60, 60, 255 };
    struct renderer_fixture f = fixture_open("lpv", NULL);
    struct session s = { f.context, f.device, f.scene };
    ok(&s, ag_renderer_render(f.renderer, &f.frame));
    struct ag_image *before = fixture_read(&f, "color"), *after = NULL;
    add_textured_square(&s, add_image(&s, texels(checks, 2, 2, 1)), AG_ALPHA_OPAQUE, true);
    const float up[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 1 }, sky[3] = { 5, 5, 5 };
    struct ag_scene_info info;
    ok(&s, ag_scene_get_info(s.scene, 0, 0, &info));
    ok(&s, ag_scene_set_instance_transform(s.scene, info.instances - 1, up));
    ok(&s, ag_scene_set_sky(s.scene, sky));
    for (int i = 0; i < 2; i++) ok(&s, ag_renderer_render(f.renderer, &f.frame));
    after = fixture_read(&f, "color");
    CHECK(memcmp(before->pixels, after->pixels, 3 * PIXELS * sizeof(float)) != 0);
    check_equal(&s, "textured square", after,
                rendered(&s, s.scene, "lpv", &f.frame.camera, "color"));
    ag_image_destroy(s.context, before);
    fixture_close(&f);
}

// Alpha moves from one side of the cutoff to the other: shadows and volumes follow.
TEST(a_mask_that_closes_or_opens_looks_as_in_a_new_renderer)
{
    static const char *const gi[] = { "none", "lpv" };
    for (int i = 0; i < 2; i++) {
        struct renderer_fixture f = fixture_open(gi[i], NULL);
        struct session s = { f.context, f.device, f.scene };
        const float up[16] = { 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 2, 0, 1 };
        struct ag_material_info info;
        struct ag_scene_info counts;
        struct ag_material_desc material;
        ag_material_desc_default(&material);
        material.alpha_mode = AG_ALPHA_MASK;
        material.double_sided = true;
        material.base_color[3] = 0.9f;
        add_square(&s, &material);
        ok(&s, ag_scene_get_info(s.scene, 0, 0, &counts));
        ok(&s, ag_scene_set_instance_transform(s.scene, counts.instances - 1, up));
        ok(&s, ag_scene_set_instance_mobility(s.scene, counts.instances - 1, AG_MOBILITY_STATIC));
        for (int k = 0; k < 3; k++) ok(&s, ag_renderer_render(f.renderer, &f.frame));
        struct ag_image *closed = fixture_read(&f, "color");
        ok(&s, ag_scene_get_material(s.scene, counts.materials - 1, &info));
        info.material.base_color[3] = 0.1f;
        ok(&s, ag_scene_set_material(s.scene, counts.materials - 1, &info.material));
        ok(&s, ag_renderer_render(f.renderer, &f.frame));
        struct ag_image *open = fixture_read(&f, "color");
        CHECK(memcmp(closed->pixels, open->pixels, 3 * PIXELS * sizeof(float)) != 0);
        check_equal(&s, gi[i], open, rendered(&s, s.scene, gi[i], &f.frame.camera, "color"));
        ag_image_destroy(s.context, closed);
        fixture_close(&f);
    }
}

// ---- Images of scenes

TEST(missing_channels_are_grey_and_opaque)
{
    static const uint8_t bytes[] = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 };
    static const uint8_t expected[4][8] = { { 1, 1, 1, 255, 6, 6, 6, 255 },
                                            { 1, 1, 1, 2, 6, 6, 6, 7 },
                                            { 1, 2, 3, 255, 6, 7, 8, 255 },
                                            { 1, 2, 3, 4, 6, 7, 8, 9 } };
    struct session s = open_session(false, NULL);
    for (int channels = 1; channels <= 4; channels++) {
        struct ag_scene_image_desc desc = texels(bytes, 1, 2, channels);
        desc.row_bytes = 5;
        const int i = add_image(&s, desc);
        assert_memory_equal(s.scene->scene->images[i].rgba, expected[channels - 1], 8);
        assert_int_equal(s.scene->scene->images[i].has_alpha, channels == 2 || channels == 4);
    }
    close_session(&s);
}

static size_t read_bytes(const char *path, uint8_t *out, size_t most)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size = fread(out, 1, most, file);
    fclose(file);
    return size;
}

TEST(an_encoded_image_has_the_pixels_that_were_encoded)
{
    enum { WIDTH = 5, HEIGHT = 3 };
    uint8_t file[4096];
    struct session s = open_session(false, NULL);
    struct ag_image *image = NULL;
    ok(&s, ag_image_create(s.context, WIDTH, HEIGHT, 3, &image));
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image->pixels[i] = srgb_decode((float)(5 * i) / 255.0f);
    ok(&s, ag_image_write_png(s.context, test_path("image.png"), image));
    const size_t size = read_bytes(test_path("image.png"), file, sizeof file);
    const int i =
        add_image(&s, (struct ag_scene_image_desc){ .encoded = file, .encoded_bytes = size });
    const struct scene_image *made = &s.scene->scene->images[i];
    assert_int_equal(made->width, WIDTH);
    assert_int_equal(made->height, HEIGHT);
    for (int p = 0; p < WIDTH * HEIGHT; p++)
        for (int c = 0; c < 3; c++) assert_int_equal(made->rgba[4 * p + c], 5 * (3 * p + c));
    // Truncated at each byte: refused, or decoded as far as it goes; never a fault.
    for (size_t cut = 1; cut < size; cut++) {
        const struct ag_scene_image_desc desc = { .encoded = file, .encoded_bytes = cut };
        const enum ag_result result = ag_scene_add_image(s.scene, &desc, NULL);
        if (result != AG_OK && result != AG_ERROR_FORMAT)
            fail_msg("%zu bytes: %s", cut, ag_context_last_error(s.context));
        if (cut < 33) assert_int_equal(result, AG_ERROR_FORMAT);
    }
    ag_image_destroy(s.context, image);
    close_session(&s);
}

#define CHECK_REFUSED(s, call, result, words)                                                      \
    do {                                                                                           \
        assert_int_equal((call), (result));                                                        \
        if (!strstr(ag_context_last_error((s).context), (words)))                                  \
            fail_msg("no \"%s\" in: %s", (words), ag_context_last_error((s).context));             \
    } while (0)

TEST(wrong_images_are_refused)
{
    static const uint8_t pixels[64] = { 0 };
    struct session s = open_session(false, NULL);
    int index = 3;
    struct ag_scene_image_desc desc = { 0 };
    CHECK_REFUSED(s, ag_scene_add_image(s.scene, &desc, &index), AG_ERROR_ARGUMENT,
                  "exactly one of pixels and encoded");
    assert_int_equal(index, -1);
    desc = texels(pixels, 4, 4, 4);
    desc.encoded = pixels;
    CHECK_REFUSED(s, ag_scene_add_image(s.scene, &desc, NULL), AG_ERROR_ARGUMENT, "exactly one");
    static const int wrong[][3] = { { 0, 4, 4 }, { 4, -1, 4 }, { 8193, 1, 1 }, { 1, 8193, 1 } };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        desc = texels(pixels, wrong[i][0], wrong[i][1], wrong[i][2]);
        CHECK_REFUSED(s, ag_scene_add_image(s.scene, &desc, NULL), AG_ERROR_ARGUMENT, "1 to 8192");
    }
    desc = texels(pixels, 4, 4, 5);
    CHECK_REFUSED(s, ag_scene_add_image(s.scene, &desc, NULL), AG_ERROR_ARGUMENT, "channels");
    desc = texels(pixels, 4, 4, 4);
    desc.row_bytes = 15;
    CHECK_REFUSED(s, ag_scene_add_image(s.scene, &desc, NULL), AG_ERROR_ARGUMENT, "row_bytes 15");
    desc = (struct ag_scene_image_desc){ .encoded = "GIF89a", .encoded_bytes = 6 };
    CHECK_REFUSED(s, ag_scene_add_image(s.scene, &desc, NULL), AG_ERROR_FORMAT,
                  "neither JPEG nor PNG");
    desc.encoded_bytes = 0;
    CHECK_REFUSED(s, ag_scene_add_image(s.scene, &desc, NULL), AG_ERROR_ARGUMENT, "encoded_bytes");
    assert_int_equal(s.scene->scene->image_count, 0);
    close_session(&s);
}

TEST(wrong_maps_are_refused)
{
    static const uint8_t white[1] = { 255 };
    struct session s = open_session(false, NULL);
    struct ag_material_desc material;
    struct ag_material_maps good, maps;
    ag_material_desc_default(&material);
    ag_material_maps_default(&good);
    material.maps = &maps;
    good.normal.image = add_image(&s, texels(white, 1, 1, 1));
#define CHECK_MAP(member, value, words)                                                            \
    do {                                                                                           \
        maps = good;                                                                               \
        maps.member = (value);                                                                     \
        CHECK_REFUSED(s, ag_scene_add_material(s.scene, &material, NULL), AG_ERROR_ARGUMENT,       \
                      words);                                                                      \
    } while (0)
    CHECK_MAP(normal.image, 1, "maps->normal: image 1 is not one of 1");
    CHECK_MAP(emissive.image, -2, "maps->emissive: image -2");
    CHECK_MAP(base_color.uv_set, 2, "maps->base_color: uv_set must be 0 or 1");
    CHECK_MAP(specular.wrap_v, (enum ag_wrap)3, "maps->specular: wrap_u 0 or wrap_v 3");
    CHECK_MAP(specular_color.uv_scale[1], NAN, "maps->specular_color: uv_offset");
    CHECK_MAP(metallic_roughness.uv_rotation_rad, INFINITY, "maps->metallic_roughness");
    CHECK_MAP(normal_scale, NAN, "normal_scale");
    maps = good;
    ok(&s, ag_scene_add_material(s.scene, &material, NULL));
    struct ag_material_maps kept;
    ok(&s, ag_scene_get_material_maps(s.scene, 0, &kept));
    assert_memory_equal(&kept, &good, sizeof kept);
    assert_int_equal(ag_scene_get_material_maps(s.scene, 1, &kept), AG_ERROR_ARGUMENT);
    material.alpha_mode = (enum ag_alpha_mode)4;
    CHECK_REFUSED(s, ag_scene_add_material(s.scene, &material, NULL), AG_ERROR_ARGUMENT,
                  "alpha_mode 4");
    material.alpha_mode = AG_ALPHA_MASK;
    material.alpha_cutoff = -1;
    CHECK_REFUSED(s, ag_scene_add_material(s.scene, &material, NULL), AG_ERROR_ARGUMENT,
                  "alpha_cutoff");
    close_session(&s);
}

// Factors change, the rest stays.
TEST(a_material_keeps_its_textures_and_its_alpha_mode)
{
    static const uint8_t white[1] = { 255 };
    struct session s = open_session(false, NULL);
    struct ag_material_info info;
    struct ag_material_maps maps;
    add_textured_square(&s, add_image(&s, texels(white, 1, 1, 1)), AG_ALPHA_MASK, true);
    ok(&s, ag_scene_get_material(s.scene, 0, &info));
    assert_int_equal(info.material.alpha_mode, AG_ALPHA_MASK);
    assert_null(info.material.maps);
    info.material.base_color[1] = 0.5f;
    ok(&s, ag_scene_set_material(s.scene, 0, &info.material));
    ag_material_desc_default(&info.material);
    ok(&s, ag_scene_set_material(s.scene, 0, &info.material));
    ok(&s, ag_scene_get_material(s.scene, 0, &info));
    CHECK_STRING(info.alpha_mode, "mask");
    CHECK(info.base_color_map);
    info.material.alpha_mode = AG_ALPHA_OPAQUE;
    CHECK_REFUSED(s, ag_scene_set_material(s.scene, 0, &info.material), AG_ERROR_ARGUMENT,
                  "add another material");
    ag_material_desc_default(&info.material);
    ag_material_maps_default(&maps);
    info.material.maps = &maps;
    CHECK_REFUSED(s, ag_scene_set_material(s.scene, 0, &info.material), AG_ERROR_ARGUMENT,
                  "add another material");
    close_session(&s);
}

TEST(wrong_vertices_are_refused)
{
    struct session s = open_session(false, NULL);
    struct ag_material_desc material;
    float values[16];
    ag_material_desc_default(&material);
    ok(&s, ag_scene_add_material(s.scene, &material, NULL));
    for (int i = 0; i < 16; i++) values[i] = 0.5f;
    struct ag_mesh_desc desc = square(0);
    values[7] = NAN;
    desc.uv[1] = values;
    CHECK_REFUSED(s, ag_scene_add_mesh(s.scene, &desc, NULL), AG_ERROR_ARGUMENT,
                  "a texture coordinate is not finite");
    desc = square(0);
    desc.colors = values;
    CHECK_REFUSED(s, ag_scene_add_mesh(s.scene, &desc, NULL), AG_ERROR_ARGUMENT,
                  "the colour of vertex 1");
    values[7] = 1.5f;
    CHECK_REFUSED(s, ag_scene_add_mesh(s.scene, &desc, NULL), AG_ERROR_ARGUMENT,
                  "the colour of vertex 1");
    assert_int_equal(s.scene->scene->mesh_count, 0);
    close_session(&s);
}

// Exporters' tangents need not be unit vectors, nor orthogonal to the normal.
TEST(tangents_become_unit_vectors_and_good_ones_stay)
{
    static const float normals[12] = { 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1 };
    static const float tangents[16] = { 1, 0, 0, -1, 3, 0, 4, 1, 0, 0, 0, 1, 0.6f, 0.8f, 0, 1 };
    static const uint8_t flat[3] = { 128, 128, 255 };
    struct session s = open_session(false, NULL);
    struct ag_material_desc material;
    struct ag_material_maps maps;
    ag_material_desc_default(&material);
    ag_material_maps_default(&maps);
    maps.normal.image = add_image(&s, texels(flat, 1, 1, 3));
    material.maps = &maps;
    ok(&s, ag_scene_add_material(s.scene, &material, NULL));
    struct ag_mesh_desc desc = square(0);
    desc.normals = normals;
    desc.tangents = tangents;
    ok(&s, ag_scene_add_mesh(s.scene, &desc, NULL));
    const vec4s *made = s.scene->scene->meshes[0].tangents;
    assert_memory_equal(&made[0], &tangents[0], 16);
    assert_memory_equal(&made[3], &tangents[12], 16);
    CHECK_NEAR(made[1].x, 1, 1e-6);
    CHECK_NEAR(made[1].z, 0, 1e-6);
    CHECK_NEAR(made[2].x * made[2].x + made[2].y * made[2].y, 1, 1e-6);
    // Without tangents they are computed, along u.
    desc.tangents = NULL;
    ok(&s, ag_scene_add_mesh(s.scene, &desc, NULL));
    made = s.scene->scene->meshes[1].tangents;
    for (int v = 0; v < 4; v++) CHECK_NEAR(made[v].x, 1, 1e-6);
    close_session(&s);
}
