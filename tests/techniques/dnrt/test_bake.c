// Bakes of dnrt: their bytes, on any number of threads, and what they say before and meanwhile.
#include "framework/test.h"
#include "techniques/dnrt/sphere_fixture.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"

#include "core/files/file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct baked_ball {
    struct scene *scene;
    struct scene_pose pose;
    struct gi_spec spec;
    struct technique_bake how;
    struct bake *bake;
};

static void ball_open(struct baked_ball *b, const char *options)
{
    char text[128];
    struct material material = material_default();
    material.base_color = vec4_of(vec3_of(0.2f, 0.4f, 0.9f), 1);
    b->scene = scene_create(test_host(), "ball");
    const int mesh = sphere_fixture_add(b->scene, scene_add_material(b->scene, &material));
    const struct node node = node_default();
    const struct instance it = {
        .node = scene_add_node(b->scene, &node), .mesh = mesh, .skin = -1, .movable = true
    };
    CHECK(scene_add_instance(b->scene, &it) == 0);
    CHECK(pose_init(&b->pose, b->scene, -1, 0));
    snprintf(text, sizeof text, "lpv+dnrt:%s", options);
    CHECK(gi_spec_parse(&b->spec, test_host(), text));
    b->how = (struct technique_bake){ .pose = &b->pose, .options = b->spec.options[1] };
    const struct bake_identity identity = { .program = "" };
    b->bake = gi_bake_create(test_host(), b->spec.technique[1], &b->how, identity);
    assert_non_null(b->bake);
}

static void ball_close(struct baked_ball *b)
{
    bake_destroy(b->bake);
    gi_spec_finish(&b->spec);
    pose_finish(&b->pose);
    scene_destroy(b->scene);
}

// The file of a bake.
static const char *write_bake(const char *options, int threads)
{
    struct baked_ball b;
    ball_open(&b, options);
    const char *path = test_path("dnrt.safetensors");
    CHECK(bake_run(b.bake, &(struct bake_run_options){ .threads = threads }));
    CHECK(bake_save(b.bake, path, false));
    ball_close(&b);
    return path;
}

static void check_bytes(const char *options, size_t bytes)
{
    struct baked_ball b;
    const char *path = write_bake(options, 0);
    ball_open(&b, options);
    CHECK(bake_load(b.bake, path) && bake_is_complete(b.bake)); // without a ray
    const struct tensor *volume = baked_tensor(bake_tensors(b.bake), "volume");
    assert_non_null(volume);
    print_message("dnrt:%s: %zu bytes\n", options, volume->bytes);
    assert_int_equal(volume->bytes, bytes);
    ball_close(&b);
}

TEST(volumes_have_the_bytes_of_the_paper)
{
    check_bytes("size=32,coefficients=4,bits=8,rays=16", 393216);
    check_bytes("size=32,coefficients=9,bits=8,rays=16", 884736);
    check_bytes("size=32,coefficients=4,bits=16,rays=16", 2 * 393216);
    check_bytes("size=32,coefficients=4,bits=8,direct=true,rays=16", 393216 * 4 / 3); // and k
}

static struct file_bytes bytes_on(int threads)
{
    struct file_bytes bytes;
    const char *path = write_bake("size=16,coefficients=9,rays=64", threads);
    CHECK(file_read(test_host(), path, SIZE_MAX, &bytes));
    return bytes;
}

TEST(a_bake_has_the_same_bytes_on_1_2_and_4_threads)
{
    struct file_bytes one = bytes_on(1);
    for (int threads = 2; threads <= 4; threads *= 2) {
        struct file_bytes many = bytes_on(threads);
        CHECK(one.size == many.size && memcmp(one.data, many.data, one.size) == 0);
        file_bytes_finish(test_host(), &many);
    }
    file_bytes_finish(test_host(), &one);
}

struct seen {
    int calls;
    double done;
};

static bool watch(void *user, const struct bake_progress *progress)
{
    struct seen *seen = user;
    seen->done = progress->done;
    seen->calls++;
    return true;
}

TEST(a_bake_tells_what_it_takes_and_how_far_it_is)
{
    enum { SAMPLES = 32 * 32 * 32, RAYS = 256 };
    struct baked_ball b;
    struct bake_estimate estimate;
    struct seen seen = { 0 };
    const struct bake_run_options run = { .threads = 2, .progress = watch, .user = &seen };
    ball_open(&b, "size=32,rays=256");
    CHECK(bake_estimate(b.bake, &run, true, &estimate));
    assert_int_equal((int)estimate.rays, SAMPLES * RAYS);
    CHECK(estimate.seconds > 0 && estimate.file_bytes >= SAMPLES * 3 * 4 * 2);
    CHECK(bake_run(b.bake, &run));
    CHECK(seen.calls > 0 && seen.done > 0 && seen.done <= 1);
    ball_close(&b);
}
