// Scene files in memory: they give the scenes of the same files, read nothing else, and are refused
// as those are.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include "api/objects.h"
#include "bake/scene_key.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct ag_context *open_context(void)
{
    struct ag_context *context = NULL;
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    return context;
}

// ---- Files

static void write_file(const char *name, const void *data, size_t size)
{
    FILE *file = fopen(test_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

struct file_copy {
    unsigned char *bytes;
    size_t size;
};

static struct file_copy read_whole(const char *path)
{
    struct file_copy copy = { 0 };
    struct stat info;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fstat(fileno(file), &info), 0);
    copy.size = (size_t)info.st_size;
    copy.bytes = malloc(copy.size + 1);
    assert_non_null(copy.bytes);
    assert_int_equal(fread(copy.bytes, 1, copy.size, file), copy.size);
    fclose(file);
    return copy;
}

static const char GLTF[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3]}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},"
    "\"emissiveTexture\":{\"index\":0}}],"
    "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"grey.png\"}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[0,0,0],\"max\":[1,1,0]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"./three%20corners.bin\"}]}";
static const float TRIANGLE[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
static const char PLY[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
static const char OBJ[] = "mtllib red.mtl\nv 0 0 0\nv 2 0 0\nv 0 3 0\nusemtl red\nf 1 2 3\n";
static const char MTL[] = "newmtl red\nKd 0.8 0.1 0.2\n";

static void write_files(struct ag_context *context)
{
    struct ag_image *image = NULL;
    assert_int_equal(ag_image_create(context, 2, 2, 3, &image), AG_OK);
    for (int i = 0; i < 12; i++) image->pixels[i] = (float)i / 11.0f;
    assert_int_equal(ag_image_write_png(context, test_path("grey.png"), image), AG_OK);
    ag_image_destroy(context, image);
    write_file("scene.gltf", GLTF, sizeof GLTF - 1);
    write_file("three corners.bin", TRIANGLE, sizeof TRIANGLE);
    write_file("scene.ply", PLY, sizeof PLY - 1);
    write_file("scene.obj", OBJ, sizeof OBJ - 1);
    write_file("red.mtl", MTL, sizeof MTL - 1);
}

// ---- Equal scenes

static struct hash128 key_of(struct ag_scene *scene)
{
    struct scene_pose pose = { 0 };
    assert_true(api_pose_at(scene, &pose, -1, 0.0));
    const struct hash128 key = scene_key(&pose, SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS);
    pose_finish(&pose);
    return key;
}

static void check_equal(struct ag_scene *a, struct ag_scene *b)
{
    const struct scene *x = a->scene, *y = b->scene;
    const struct hash128 first = key_of(a), second = key_of(b);
    assert_memory_equal(&first, &second, sizeof first);
    assert_true(x->content_hash == y->content_hash);
    assert_int_equal(x->node_count, y->node_count);
    assert_int_equal(x->instance_count, y->instance_count);
    assert_int_equal(x->image_count, y->image_count);
    assert_int_equal(x->light_count, y->light_count);
    assert_int_equal(x->camera_count, y->camera_count);
    assert_int_equal(x->animation_count, y->animation_count);
    assert_true(scene_triangle_count(x) > 0);
}

// `name` NULL: the format is found from the bytes.
static void check_file(const char *path, const char *name)
{
    struct ag_context *context = open_context();
    struct ag_scene *from_file = NULL, *from_memory = NULL;
    struct file_copy copy = read_whole(path);
    char folder[512];
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    const struct ag_scene_memory_desc desc = {
        .bytes = copy.bytes, .size = copy.size, .name = name, .folder = folder
    };
    if (ag_scene_load(context, path, &from_file) != AG_OK ||
        ag_scene_load_memory(context, &desc, &from_memory) != AG_OK)
        fail_msg("%s: %s", path, ag_context_last_error(context));
    check_equal(from_file, from_memory);
    ag_scene_destroy(from_file);
    ag_scene_destroy(from_memory);
    ag_context_destroy(context);
    free(copy.bytes);
}

TEST(a_file_in_memory_gives_the_scene_of_the_file)
{
    struct ag_context *context = open_context();
    write_files(context);
    ag_context_destroy(context);
    check_file(test_path("scene.gltf"), NULL);
    check_file(test_path("scene.gltf"), "another/folder/scene.gltf");
    check_file(test_path("scene.ply"), NULL);
    check_file(test_path("scene.obj"), "scene.obj");
}

TEST(files_of_other_programs_in_memory_give_the_scene_of_the_file)
{
    check_file(test_scene_path("flight-helmet.glb"), NULL);
    check_file(test_scene_path("fox.glb"), "fox.GLB");
    check_file(test_scene_path("box-animated.gltf"), NULL);
}

// ---- Where other files come from

struct finder {
    char asked[256];
    const char *absent;
};

static bool find(void *user, const char *path, const void **bytes, size_t *size)
{
    static struct file_copy last[2];
    struct finder *finder = user;
    const size_t used = strlen(finder->asked);
    snprintf(finder->asked + used, sizeof finder->asked - used, "%s;", path);
    if (finder->absent && strcmp(path, finder->absent) == 0) return false;
    struct file_copy *copy = &last[strcmp(path, "grey.png") == 0];
    free(copy->bytes);
    *copy = read_whole(test_path(path));
    *bytes = copy->bytes;
    *size = copy->size;
    return true;
}

static char warning[512];

static void listen(void *user, enum ag_log_level level, const char *message)
{
    (void)user;
    if (level == AG_LOG_WARNING) snprintf(warning, sizeof warning, "%s", message);
}

static struct ag_context *listening_context(void)
{
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    ag_context_desc_default(&desc);
    desc.log = listen;
    warning[0] = 0;
    assert_int_equal(ag_context_create(&desc, &context), AG_OK);
    return context;
}

static struct ag_scene_memory_desc gltf_with(struct finder *finder)
{
    return (struct ag_scene_memory_desc){ .bytes = GLTF,
                                          .size = sizeof GLTF - 1,
                                          .name = "scene",
                                          .read = finder ? find : NULL,
                                          .user = finder };
}

TEST(a_callback_finds_each_file_once)
{
    struct ag_context *context = listening_context();
    struct ag_scene *from_file = NULL, *from_memory = NULL;
    struct finder finder = { 0 };
    const struct ag_scene_memory_desc desc = gltf_with(&finder);
    write_files(context);
    assert_int_equal(ag_scene_load(context, test_path("scene.gltf"), &from_file), AG_OK);
    assert_int_equal(ag_scene_load_memory(context, &desc, &from_memory), AG_OK);
    check_equal(from_file, from_memory);
    CHECK_STRING(finder.asked, "three corners.bin;grey.png;");
    CHECK_STRING(warning, "");
    ag_scene_destroy(from_file);
    ag_scene_destroy(from_memory);
    ag_context_destroy(context);
}

TEST(a_missing_buffer_is_an_error_and_a_missing_image_a_warning)
{
    struct ag_context *context = listening_context();
    struct ag_scene *scene = NULL;
    struct finder no_image = { .absent = "grey.png" },
                  no_buffer = { .absent = "three corners.bin" };
    struct ag_scene_memory_desc desc = gltf_with(&no_image);
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_OK);
    CHECK(strstr(warning, "image grey.png (no such file)"));
    assert_int_equal(scene->scene->image_count, 0);
    ag_scene_destroy(scene);
    desc = gltf_with(&no_buffer);
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_FILE);
    assert_null(scene);
    CHECK(strstr(ag_context_last_error(context), "refers to three corners.bin"));
    desc = gltf_with(NULL);
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_FILE);
    CHECK(strstr(ag_context_last_error(context), "neither a folder nor a callback"));
    ag_context_destroy(context);
}

// Not the working directory either.
TEST(without_a_folder_no_other_file_is_read)
{
    char before[4096], folder[512];
    struct ag_context *context = listening_context();
    struct ag_scene *scene = NULL;
    struct ag_material_info info;
    const struct ag_scene_memory_desc desc = { .bytes = OBJ,
                                               .size = sizeof OBJ - 1,
                                               .name = "scene.obj" };
    write_files(context);
    snprintf(folder, sizeof folder, "%s", test_path("scene.obj"));
    *strrchr(folder, '/') = 0;
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    const enum ag_result result = ag_scene_load_memory(context, &desc, &scene);
    assert_int_equal(chdir(before), 0);
    if (result != AG_OK) fail_msg("%s", ag_context_last_error(context));
    for (int i = 0; ag_scene_get_material(scene, i, &info) == AG_OK; i++)
        CHECK(info.material.base_color[0] == info.material.base_color[1]); // red.mtl was not read
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST(a_scale_multiplies_what_is_loaded)
{
    struct ag_context *context = listening_context();
    struct finder finder = { 0 };
    struct ag_scene_memory_desc desc = gltf_with(&finder);
    const struct ag_scene_load_desc load = { .scale = 2 };
    struct ag_scene_info plain, scaled;
    struct ag_scene *scene = NULL;
    write_files(context);
    for (int i = 0; i < 2; i++) { // of a file, then of memory
        assert_int_equal(ag_scene_load(context, test_path("scene.gltf"), &scene), AG_OK);
        assert_int_equal(ag_scene_get_info(scene, -1, 0, &plain), AG_OK);
        ag_scene_destroy(scene);
        desc.scale = load.scale;
        assert_int_equal(i ? ag_scene_load_memory(context, &desc, &scene)
                           : ag_scene_load_with(context, test_path("scene.gltf"), &load, &scene),
                         AG_OK);
        assert_int_equal(ag_scene_get_info(scene, -1, 0, &scaled), AG_OK);
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(scaled.bounds_min[k], 2 * plain.bounds_min[k], 0);
            CHECK_NEAR(scaled.bounds_max[k], 2 * plain.bounds_max[k], 0);
        }
        CHECK(plain.bounds_max[0] > plain.bounds_min[0]);
        ag_scene_destroy(scene);
    }
    ag_context_destroy(context);
}

// ---- What is refused

TEST(wrong_scales_are_refused)
{
    static const float wrong[] = { -1, 1e-7f, 1e7f, (float)NAN, (float)INFINITY };
    struct ag_context *context = open_context();
    struct ag_scene *scene = (struct ag_scene *)1;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct ag_scene_load_desc load = { .scale = wrong[i] };
        struct ag_scene_memory_desc desc = gltf_with(NULL);
        desc.scale = wrong[i];
        assert_int_equal(ag_scene_load_with(context, "@cornell", &load, &scene), AG_ERROR_ARGUMENT);
        assert_null(scene);
        CHECK(strstr(ag_context_last_error(context), "is not within 1e-06 to 1e+06"));
        assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_ARGUMENT);
    }
    const struct ag_scene_load_desc newer = { .reserved = { 1 } };
    assert_int_equal(ag_scene_load_with(context, "@cornell", &newer, &scene), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "newer library"));
    ag_context_destroy(context);
}

TEST(wrong_bytes_in_memory_are_refused)
{
    struct ag_context *context = open_context();
    struct ag_scene *scene = (struct ag_scene *)1;
    struct ag_scene_memory_desc desc = { 0 };
    struct finder finder = { 0 };
    assert_int_equal(ag_scene_load_memory(context, NULL, &scene), AG_ERROR_ARGUMENT);
    assert_null(scene);
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "there are no bytes"));
    desc = gltf_with(&finder);
    desc.folder = "here";
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "both folder and read"));
    desc = gltf_with(NULL);
    desc.folder = "";
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_ARGUMENT);
    desc = gltf_with(NULL);
    desc.reserved[6] = 1;
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "newer library"));
    desc = (struct ag_scene_memory_desc){ .bytes = OBJ, .size = sizeof OBJ - 1 };
    assert_int_equal(ag_scene_load_memory(context, &desc, &scene), AG_ERROR_UNSUPPORTED);
    CHECK(strstr(ag_context_last_error(context), "memory: unknown kind of scene file"));
    ag_context_destroy(context);
}

TEST(a_file_in_memory_may_end_anywhere)
{
    struct ag_context *context = open_context();
    write_files(context);
    for (size_t size = 1; size < sizeof GLTF; size++) {
        struct ag_scene *scene = NULL;
        struct finder finder = { 0 };
        char *cut = malloc(size); // a read beyond the end is seen by the sanitizer
        assert_non_null(cut);
        memcpy(cut, GLTF, size);
        struct ag_scene_memory_desc desc = gltf_with(&finder);
        desc.bytes = cut;
        desc.size = size;
        const enum ag_result result = ag_scene_load_memory(context, &desc, &scene);
        assert_int_equal(result == AG_OK, size == sizeof GLTF - 1);
        ag_scene_destroy(scene);
        free(cut);
    }
    for (size_t size = 1; size < sizeof PLY; size++) {
        struct ag_scene *scene = NULL;
        const struct ag_scene_memory_desc desc = { .bytes = PLY, .size = size, .name = "a.ply" };
        (void)ag_scene_load_memory(context, &desc, &scene);
        ag_scene_destroy(scene);
    }
    ag_context_destroy(context);
}
