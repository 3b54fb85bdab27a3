// The reference through the public API: layers, progress, checkpoints, wrong arguments.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CHECK_REFUSED(context, call)                                                               \
    do {                                                                                           \
        assert_int_equal((call), AG_ERROR_ARGUMENT);                                               \
        if (context) CHECK(ag_context_last_error(context)[0]);                                     \
    } while (0)

struct fixture {
    struct ag_context *context;
    struct ag_scene *scene;
    struct ag_reference_desc desc;
};

static void open_scene(struct fixture *f, const char *name)
{
    assert_int_equal(ag_scene_load(f->context, name, &f->scene), AG_OK);
    ag_reference_desc_default(&f->desc);
    assert_int_equal(f->desc.bounces, -1);
    f->desc.width = 24;
    f->desc.height = 18;
    assert_int_equal(ag_scene_camera(f->scene, "main", 0, 0, &f->desc.camera), AG_OK);
}

static void open(struct fixture *f, const char *name)
{
    assert_int_equal(ag_context_create(NULL, &f->context), AG_OK);
    open_scene(f, name);
}

static void close(struct fixture *f)
{
    ag_scene_destroy(f->scene);
    ag_context_destroy(f->context);
}

static struct ag_reference *create(struct fixture *f)
{
    struct ag_reference *r = NULL;
    assert_int_equal(ag_reference_create(f->scene, &f->desc, &r), AG_OK);
    return r;
}

static struct ag_image *read_layer(struct ag_reference *r, const char *name)
{
    struct ag_image *image = NULL;
    assert_int_equal(ag_reference_read(r, name, &image), AG_OK);
    return image;
}

static size_t float_count(const struct ag_image *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

TEST(every_named_layer_can_be_read)
{
    struct fixture f;
    open(&f, "@cornell");
    struct ag_reference *r = create(&f);
    struct ag_reference_info info;
    assert_int_equal(ag_reference_get_info(r, &info), AG_OK);
    assert_int_equal(info.samples, 0);
    assert_int_equal(ag_reference_render(r, 2, NULL, NULL), AG_OK);
    assert_int_equal(ag_reference_render(r, 2, NULL, NULL), AG_OK);
    assert_int_equal(ag_reference_get_info(r, &info), AG_OK);
    assert_int_equal(info.samples, 4);
    CHECK(info.rays > 4 * 24 * 18 && info.mean > 0 && info.error > 0 && isfinite(info.error));
    int count = 0;
    for (const char *name; (name = ag_reference_layer_name(count)); count++) {
        struct ag_image *image = read_layer(r, name);
        static const char *const singles[] = { "depth", "samples", "obscurance",
                                               "ambient_occlusion" };
        bool single = false;
        for (int i = 0; i < 4; i++) single |= strcmp(name, singles[i]) == 0;
        assert_int_equal(image->channels, single ? 1 : 3);
        assert_int_equal(image->width, 24);
        for (size_t i = 0; i < float_count(image); i++) CHECK(isfinite(image->pixels[i]));
        if (strcmp(name, "samples") == 0) CHECK_NEAR(image->pixels[0], 4, 0);
        ag_image_destroy(f.context, image);
    }
    assert_int_equal(count, 14);
    assert_null(ag_reference_layer_name(-1));
    ag_reference_destroy(r);
    close(&f);
}

// Form factor from a point to a parallel rectangle at distance 1 with a corner above the point
// (Siegel & Howell, configuration 11).
static double corner_factor(double x, double y)
{
    double a = sqrt(1 + x * x), b = sqrt(1 + y * y);
    return (x / a * atan(y / a) + y / b * atan(x / b)) / (2 * 3.14159265358979);
}

static void add_floor(struct ag_scene *scene)
{
    static const float CORNERS[12] = { -9, 0, -9, -9, 0, 9, 9, 0, 9, 9, 0, -9 };
    static const uint32_t INDICES[6] = { 0, 1, 2, 0, 2, 3 };
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    struct ag_mesh_desc mesh = {
        .positions = CORNERS, .vertex_count = 4, .indices = INDICES, .index_count = 6
    };
    int index = -1;
    assert_int_equal(ag_scene_add_material(scene, &material, &mesh.material), AG_OK);
    assert_int_equal(ag_scene_add_mesh(scene, &mesh, &index), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, index, NULL, NULL), AG_OK);
}

TEST(an_area_light_has_the_irradiance_of_its_form_factor)
{
    struct fixture f;
    assert_int_equal(ag_context_create(NULL, &f.context), AG_OK);
    assert_int_equal(ag_scene_create(f.context, &f.scene), AG_OK);
    add_floor(f.scene);
    struct ag_area_light_desc light;
    ag_area_light_desc_default(&light);
    light.position[1] = 2;
    light.width = 3;
    light.height = 1;
    light.radiance[1] = 100;
    assert_int_equal(ag_scene_add_area_light(f.scene, &light, NULL), AG_OK);
    ag_reference_desc_default(&f.desc);
    f.desc.width = f.desc.height = 1; // the floor under the middle, aslant past the light
    f.desc.bounces = 0;
    const float eye[3] = { 0, 1, 4 }, target[3] = { 0, 0, 0 };
    assert_int_equal(ag_scene_look_at(f.scene, eye, target, 0.1f, &f.desc.camera), AG_OK);
    struct ag_reference *r = create(&f);
    assert_int_equal(ag_reference_render(r, 4096, NULL, NULL), AG_OK);
    struct ag_image *direct = read_layer(r, "direct"), *error = read_layer(r, "error");
    // E = π L F of four quarters. What the floor reflects is albedo / π of it, and its rough gloss
    // (4 % head on) adds some two percent.
    double irradiance = 3.14159265358979 * 100 * 4 * corner_factor(0.75, 0.25);
    CHECK_RELATIVE((double)direct->pixels[1], 0.8 / 3.14159265358979 * irradiance, 0.03);
    CHECK_RELATIVE((double)direct->pixels[0], (double)direct->pixels[1] / 100, 1e-3);
    CHECK((double)error->pixels[1] < 0.01 * (double)direct->pixels[1]);
    ag_image_destroy(f.context, direct);
    ag_image_destroy(f.context, error);
    ag_reference_destroy(r);
    close(&f);
}

static bool stop(void *user, double done)
{
    *(double *)user = done;
    return false;
}

TEST(progress_can_cancel)
{
    struct fixture f;
    open(&f, "@cornell");
    struct ag_reference *r = create(&f);
    double done = 0;
    assert_int_equal(ag_reference_render(r, 100, stop, &done), AG_ERROR_CANCELLED);
    CHECK(done > 0 && done < 1);
    assert_int_equal(ag_reference_render(r, 1, NULL, NULL), AG_OK);
    ag_reference_destroy(r);
    close(&f);
}

enum { KEPT_LAYERS = 7 };
static const char *const kept_layers[KEPT_LAYERS] = {
    "direct", "indirect", "indirect_emitters_sky", "irradiance", "irradiance_emitters_sky",
    "error",  "samples"
};

static void write_layers(struct fixture *f, struct ag_reference *r, const char *path,
                         const char *const names[KEPT_LAYERS], const char *checkpoint)
{
    struct ag_image_layer layers[KEPT_LAYERS];
    struct ag_image *images[KEPT_LAYERS];
    for (int i = 0; i < KEPT_LAYERS; i++) {
        images[i] = read_layer(r, names[i]);
        layers[i] = (struct ag_image_layer){ names[i], images[i] };
    }
    struct ag_attribute attribute = { AG_REFERENCE_CHECKPOINT, checkpoint };
    assert_int_equal(ag_image_write_exr(f->context, path, layers, KEPT_LAYERS, &attribute, 1),
                     AG_OK);
    for (int i = 0; i < KEPT_LAYERS; i++) ag_image_destroy(f->context, images[i]);
}

static void write_checkpoint(struct fixture *f, struct ag_reference *r, const char *path)
{
    write_layers(f, r, path, kept_layers, ag_reference_checkpoint(r));
}

TEST(an_attribute_of_a_file_is_read_back)
{
    struct fixture f;
    open(&f, "@cornell");
    struct ag_reference *r = create(&f);
    char path[512], text[64], narrow[4];
    snprintf(path, sizeof path, "%s", test_path("attribute.exr"));
    assert_int_equal(ag_reference_render(r, 1, NULL, NULL), AG_OK);
    write_checkpoint(&f, r, path);
    const char *name = AG_REFERENCE_CHECKPOINT;
    assert_int_equal(ag_image_read_attribute(f.context, path, name, text, sizeof text), AG_OK);
    CHECK_STRING(text, ag_reference_checkpoint(r));
    assert_int_equal(ag_image_read_attribute(f.context, path, name, narrow, sizeof narrow), AG_OK);
    CHECK_STRING(narrow, "ref");
    assert_int_equal(ag_image_read_attribute(f.context, path, "other", text, sizeof text), AG_OK);
    CHECK_STRING(text, "");
    assert_int_equal(ag_image_read_attribute(f.context, path, "compression", text, sizeof text),
                     AG_OK); // it has one, which is not text
    CHECK_STRING(text, "");
    CHECK_REFUSED(f.context, ag_image_read_attribute(f.context, path, "", text, sizeof text));
    CHECK_REFUSED(f.context, ag_image_read_attribute(f.context, "", name, text, sizeof text));
    assert_int_equal(
        ag_image_read_attribute(f.context, test_path("none.exr"), name, text, sizeof text),
        AG_ERROR_FILE);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs("no picture", file) >= 0 && fclose(file) == 0);
    assert_int_equal(ag_image_read_attribute(f.context, path, name, text, sizeof text),
                     AG_ERROR_FORMAT);
    CHECK_STRING(text, "");
    ag_reference_destroy(r);
    close(&f);
}

TEST(a_checkpoint_of_another_version_is_refused_for_that_reason)
{
    struct fixture f;
    open(&f, "@cornell");
    char path[512];
    snprintf(path, sizeof path, "%s", test_path("older.exr"));
    struct ag_reference *r = create(&f);
    assert_int_equal(ag_reference_render(r, 1, NULL, NULL), AG_OK);
    write_layers(&f, r, path, kept_layers, "reference 2 0123456789abcdef");
    CHECK_REFUSED(f.context, ag_reference_resume(r, path));
    CHECK(strstr(ag_context_last_error(f.context), "another version of the path tracer"));
    ag_reference_destroy(r);
    close(&f);
}

TEST(only_a_checkpoint_of_the_same_image_is_resumed)
{
    struct fixture f;
    open(&f, "@cornell");
    char path[512];
    snprintf(path, sizeof path, "%s", test_path("checkpoint.exr"));
    struct ag_reference *first = create(&f), *second = create(&f);
    assert_int_equal(ag_reference_render(first, 3, NULL, NULL), AG_OK);
    write_checkpoint(&f, first, path);
    assert_int_equal(ag_reference_resume(second, path), AG_OK);
    struct ag_reference_info info;
    assert_int_equal(ag_reference_get_info(second, &info), AG_OK);
    assert_int_equal(info.samples, 3);
    struct ag_image *a = read_layer(first, "color"), *b = read_layer(second, "color");
    for (size_t i = 0; i < float_count(a); i++) CHECK_RELATIVE(a->pixels[i], b->pixels[i], 1e-6);
    ag_image_destroy(f.context, a);
    ag_image_destroy(f.context, b);
    f.desc.seed = 1;
    struct ag_reference *other = create(&f);
    CHECK_REFUSED(f.context, ag_reference_resume(other, path));
    CHECK(strstr(ag_context_last_error(f.context), "checkpoint.exr"));
    assert_int_equal(ag_reference_resume(other, test_path("none.exr")), AG_ERROR_FILE);
    CHECK_REFUSED(f.context, ag_reference_resume(other, ""));
    ag_reference_destroy(first);
    ag_reference_destroy(second);
    ag_reference_destroy(other);
    close(&f);
}

static void count_warnings(void *user, enum ag_log_level level, const char *message)
{
    if (level == AG_LOG_WARNING && strstr(message, "is now")) ++*(int *)user;
}

static bool images_are_equal(const struct ag_image *a, const struct ag_image *b)
{
    return float_count(a) == float_count(b) &&
           memcmp(a->pixels, b->pixels, float_count(a) * sizeof *a->pixels) == 0;
}

TEST(former_layer_names_are_accepted_with_one_warning)
{
    static const char *const former[KEPT_LAYERS] = {
        "direct", "indirect", "gathered", "irradiance", "gathered_irradiance", "error", "samples"
    };
    struct fixture f;
    int warnings = 0;
    struct ag_context_desc desc;
    ag_context_desc_default(&desc);
    desc.log = count_warnings;
    desc.user = &warnings;
    assert_int_equal(ag_context_create(&desc, &f.context), AG_OK);
    open_scene(&f, "@cornell");
    char path[512];
    snprintf(path, sizeof path, "%s", test_path("former.exr"));
    struct ag_reference *first = create(&f), *second = create(&f);
    assert_int_equal(ag_reference_render(first, 2, NULL, NULL), AG_OK);
    write_layers(&f, first, path, former, ag_reference_checkpoint(first));
    assert_int_equal(warnings, 1);
    assert_int_equal(ag_reference_resume(second, path), AG_OK);
    struct ag_image *a = NULL, *b = read_layer(first, "indirect_emitters_sky");
    assert_int_equal(ag_image_read(f.context, path, "indirect_emitters_sky", &a), AG_OK);
    CHECK(images_are_equal(a, b));
    ag_image_destroy(f.context, a);
    write_checkpoint(&f, first, path);
    assert_int_equal(ag_image_read(f.context, path, "gathered", &a), AG_OK);
    CHECK(images_are_equal(a, b));
    assert_int_equal(warnings, 1);
    ag_image_destroy(f.context, a);
    ag_image_destroy(f.context, b);
    ag_reference_destroy(first);
    ag_reference_destroy(second);
    close(&f);
}

TEST(a_null_object_is_refused)
{
    struct fixture f;
    open(&f, "@cornell");
    struct ag_reference *r = (struct ag_reference *)1;
    struct ag_image *image = (struct ag_image *)1;
    struct ag_reference_info info;
    ag_reference_desc_default(NULL);
    ag_reference_destroy(NULL);
    CHECK_REFUSED(NULL, ag_reference_create(NULL, &f.desc, &r));
    assert_null(r);
    CHECK_REFUSED(f.context, ag_reference_create(f.scene, NULL, &r));
    CHECK_REFUSED(f.context, ag_reference_create(f.scene, &f.desc, NULL));
    CHECK_REFUSED(NULL, ag_reference_render(NULL, 1, NULL, NULL));
    CHECK_REFUSED(NULL, ag_reference_read(NULL, "color", &image));
    assert_null(image);
    CHECK_REFUSED(NULL, ag_reference_get_info(NULL, &info));
    CHECK_REFUSED(NULL, ag_reference_resume(NULL, "a.exr"));
    CHECK_STRING(ag_reference_checkpoint(NULL), "");
    r = create(&f);
    CHECK_REFUSED(f.context, ag_reference_read(r, "color", NULL));
    CHECK_REFUSED(f.context, ag_reference_read(r, NULL, &image));
    CHECK_REFUSED(f.context, ag_reference_read(r, "colour", &image));
    CHECK(strstr(ag_context_last_error(f.context), "did you mean color"));
    CHECK_REFUSED(f.context, ag_reference_get_info(r, NULL));
    CHECK_REFUSED(f.context, ag_reference_resume(r, NULL));
    CHECK_REFUSED(f.context, ag_reference_render(r, 0, NULL, NULL));
    ag_reference_destroy(r);
    close(&f);
}

TEST(wrong_descriptions_are_refused)
{
    struct fixture f;
    open(&f, "@cornell");
    struct ag_reference *r = NULL;
    struct ag_reference_desc d[] = { f.desc, f.desc, f.desc, f.desc, f.desc,
                                     f.desc, f.desc, f.desc, f.desc };
    d[0].width = 0;
    d[1].height = 16385;
    d[2].bounces = -2;
    d[3].direct_only = d[3].indirect_only = true;
    d[4].animation = 3;
    d[5].time_s = (double)NAN;
    d[6].camera.vertical_fov_rad = 0;
    d[7].camera.near_m = (float)INFINITY;
    memcpy(d[8].camera.target, d[8].camera.eye, sizeof d[8].camera.eye);
    for (size_t i = 0; i < sizeof d / sizeof d[0]; i++) {
        CHECK_REFUSED(f.context, ag_reference_create(f.scene, &d[i], &r));
        assert_null(r);
    }
    close(&f);
}

// The largest triangle and the brightest sky that are accepted, seen by the default camera.
TEST(the_reference_of_the_largest_scene_ends_and_is_finite)
{
    struct fixture f;
    const float positions[9] = { -1e8f, -1e8f, 0, 1e8f, -1e8f, 0, 0, 1e8f, -1e8f };
    const uint32_t indices[3] = { 0, 1, 2 };
    const float sky[3] = { 1e15f, 1e15f, 1e15f };
    assert_int_equal(ag_context_create(NULL, &f.context), AG_OK);
    assert_int_equal(ag_scene_create(f.context, &f.scene), AG_OK);
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    assert_int_equal(ag_scene_add_material(f.scene, &material, NULL), AG_OK);
    struct ag_mesh_desc mesh = {
        .positions = positions, .vertex_count = 3, .indices = indices, .index_count = 3
    };
    assert_int_equal(ag_scene_add_mesh(f.scene, &mesh, NULL), AG_OK);
    assert_int_equal(ag_scene_add_instance(f.scene, 0, NULL, NULL), AG_OK);
    assert_int_equal(ag_scene_set_sky(f.scene, sky), AG_OK);
    ag_reference_desc_default(&f.desc);
    f.desc.width = f.desc.height = 24;
    assert_int_equal(ag_scene_default_camera(f.scene, 0, 0, &f.desc.camera, NULL), AG_OK);
    for (int turned = 0; turned < 2; turned++) {
        struct ag_reference *r = create(&f);
        assert_int_equal(ag_reference_render(r, 2, NULL, NULL), AG_OK);
        struct ag_image *image = read_layer(r, "color");
        for (size_t i = 0; i < float_count(image); i++)
            CHECK(isfinite(image->pixels[i]) && image->pixels[i] >= 0.0f);
        ag_image_destroy(f.context, image);
        ag_reference_destroy(r);
        for (int k = 0; k < 3; k++) { // now behind the triangle: its back faces are culled
            f.desc.camera.eye[k] *= -1.0f;
            f.desc.camera.target[k] *= -1.0f;
        }
    }
    close(&f);
}

// ---- samples by a bake

static struct ag_bake *create_bake(struct fixture *f, int samples, int shard, int shard_count)
{
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.threads = 2;
    desc.shard = shard;
    desc.shard_count = shard_count;
    assert_int_equal(ag_bake_create_reference(f->scene, &f->desc, samples, &desc, &bake), AG_OK);
    return bake;
}

static struct ag_reference *reference_of(struct ag_bake *bake)
{
    struct ag_reference *r = NULL;
    assert_int_equal(ag_reference_from_bake(bake, &r), AG_OK);
    ag_bake_destroy(bake);
    return r;
}

static void check_equal_layers(struct fixture *f, struct ag_reference *a, struct ag_reference *b)
{
    for (int i = 0; ag_reference_layer_name(i); i++) {
        struct ag_image *of_a = read_layer(a, ag_reference_layer_name(i));
        struct ag_image *of_b = read_layer(b, ag_reference_layer_name(i));
        assert_memory_equal(of_a->pixels, of_b->pixels, float_count(of_a) * sizeof(float));
        ag_image_destroy(f->context, of_a);
        ag_image_destroy(f->context, of_b);
    }
}

// The image cuts tiles. More samples than a task looks at in one go, and further ones.
TEST(samples_of_a_bake_are_those_of_a_render)
{
    struct fixture f;
    open(&f, "@cornell");
    f.desc.antialias = true;
    f.desc.seed = 3;
    for (int samples = 5; samples <= 300; samples += 295) {
        struct ag_reference *plain = create(&f);
        assert_int_equal(ag_reference_render(plain, samples, NULL, NULL), AG_OK);
        struct ag_bake *bake = create_bake(&f, samples, 0, 0);
        assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
        struct ag_reference *baked = reference_of(bake);
        assert_string_equal(ag_reference_checkpoint(plain), ag_reference_checkpoint(baked));
        check_equal_layers(&f, plain, baked);
        assert_int_equal(ag_reference_render(plain, 2, NULL, NULL), AG_OK);
        assert_int_equal(ag_reference_render(baked, 2, NULL, NULL), AG_OK);
        check_equal_layers(&f, plain, baked);
        ag_reference_destroy(plain);
        ag_reference_destroy(baked);
    }
    close(&f);
}

TEST(shards_of_a_reference_are_merged)
{
    struct fixture f;
    open(&f, "@cornell");
    static const char *const parts[2] = { "part0.safetensors", "part1.safetensors" };
    struct ag_reference *plain = create(&f);
    assert_int_equal(ag_reference_render(plain, 150, NULL, NULL), AG_OK);
    for (int i = 0; i < 2; i++) {
        struct ag_bake *shard = create_bake(&f, 150, i, 2);
        assert_int_equal(ag_bake_run(shard, NULL, NULL), AG_OK);
        assert_int_equal(ag_bake_save_partial(shard, test_path(parts[i])), AG_OK);
        ag_bake_destroy(shard);
    }
    struct ag_bake *bake = create_bake(&f, 150, 0, 0);
    for (int i = 0; i < 2; i++) assert_int_equal(ag_bake_merge(bake, test_path(parts[i])), AG_OK);
    struct ag_bake_info info;
    assert_int_equal(ag_bake_get_info(bake, &info), AG_OK);
    CHECK(info.complete);
    assert_string_equal(info.technique, "reference");
    const char *report = NULL;
    assert_int_equal(ag_bake_report(bake, &report), AG_OK);
    CHECK(strstr(report, "\"samples\": 150"));
    assert_int_equal(ag_bake_remove_checkpoint(bake), AG_OK);
    struct ag_reference *baked = reference_of(bake);
    check_equal_layers(&f, plain, baked);
    ag_reference_destroy(plain);
    ag_reference_destroy(baked);
    close(&f);
}

TEST(wrong_bakes_of_a_reference_are_refused)
{
    struct fixture f;
    open(&f, "@cornell");
    struct ag_bake *bake = NULL, *other = NULL;
    struct ag_reference *r = NULL;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = 4;
    CHECK_REFUSED(f.context, ag_bake_create_reference(f.scene, &f.desc, 0, NULL, &bake));
    CHECK_REFUSED(f.context, ag_bake_create_reference(f.scene, &f.desc, 1, &desc, &bake));
    assert_null(bake);
    bake = create_bake(&f, 1, 0, 0);
    CHECK_REFUSED(f.context, ag_reference_from_bake(bake, &r)); // it is incomplete
    CHECK_REFUSED(f.context, ag_bake_export(bake, "."));
    assert_int_equal(ag_bake_create(f.scene, "radiosity:density=1", NULL, &other), AG_OK);
    CHECK_REFUSED(f.context, ag_reference_from_bake(other, &r));
    assert_null(r);
    ag_bake_destroy(bake);
    ag_bake_destroy(other);
    close(&f);
}
