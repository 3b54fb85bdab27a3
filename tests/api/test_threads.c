// Scenes loaded and built on other threads while a renderer runs. The thread sanitizer watches
// (preset tsan); without it the contents are checked.
#include "api/counting_allocator.h"
#include "api/renderer_fixture.h"
#include "api/scene_copy.h"

#include "api/objects.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

enum { PIXELS = FIXTURE_WIDTH * FIXTURE_HEIGHT, FRAMES = 50 };

// A thread with a context of its own that loads scenes until it is stopped.
struct loader {
    const char *name;
    pthread_t thread;
    struct ag_context *context;
    struct ag_scene *scene; // the last one
    atomic_bool stop, loaded;
    int loads;
    bool failed;
};

static void *load(void *user)
{
    struct loader *l = user;
    l->failed = ag_context_create(NULL, &l->context) != AG_OK;
    while (!l->failed && (l->loads == 0 || !atomic_load(&l->stop))) {
        ag_scene_destroy(l->scene);
        l->failed = ag_scene_load(l->context, l->name, &l->scene) != AG_OK;
        l->loads++;
        atomic_store(&l->loaded, true);
    }
    return NULL;
}

static void start(struct loader *l, const char *name)
{
    *l = (struct loader){ .name = name };
    assert_int_equal(pthread_create(&l->thread, NULL, load, l), 0);
}

static void join(struct loader *l)
{
    atomic_store(&l->stop, true);
    assert_int_equal(pthread_join(l->thread, NULL), 0);
    assert_false(l->failed);
}

static void check_same(struct ag_context *context, struct ag_image *a, struct ag_image *b)
{
    assert_memory_equal(a->pixels, b->pixels, 3 * PIXELS * sizeof(float));
    ag_image_destroy(context, a);
    ag_image_destroy(context, b);
}

// Renders until `frames` frames are done and each loader has loaded once.
static void render_beside(struct renderer_fixture *f, struct loader *loaders, int count, int frames)
{
    bool waiting = true;
    for (int i = 0; i < frames || waiting; i++) {
        assert_int_equal(ag_renderer_render(f->renderer, &f->frame), AG_OK);
        waiting = false;
        for (int k = 0; k < count; k++) waiting |= !atomic_load(&loaders[k].loaded);
    }
}

static struct ag_image *image_of(struct renderer_fixture *f, struct ag_scene *scene)
{
    struct ag_renderer *renderer = NULL;
    struct ag_image *image = NULL;
    struct ag_frame_desc frame;
    const struct ag_renderer_desc desc = fixture_renderer_desc("lpv");
    ag_frame_desc_default(&frame);
    assert_int_equal(ag_scene_default_camera(scene, 0, 0.0, &frame.camera, NULL), AG_OK);
    assert_int_equal(ag_renderer_create(f->device, scene, &desc, &renderer), AG_OK);
    assert_int_equal(ag_renderer_render(renderer, &frame), AG_OK);
    assert_int_equal(ag_renderer_read(renderer, "color", &image), AG_OK);
    ag_renderer_destroy(renderer);
    return image;
}

TEST(two_contexts_load_while_a_third_renders)
{
    struct renderer_fixture f = fixture_open("lpv", NULL);
    struct loader loaders[2];
    assert_int_equal(ag_renderer_render(f.renderer, &f.frame), AG_OK);
    struct ag_image *before = fixture_read(&f, "color");
    start(&loaders[0], "@atrium");
    start(&loaders[1], "@spheres");
    render_beside(&f, loaders, 2, FRAMES);
    for (int k = 0; k < 2; k++) {
        join(&loaders[k]);
        ag_scene_destroy(loaders[k].scene);
        ag_context_destroy(loaders[k].context);
    }
    check_same(f.context, before, fixture_read(&f, "color"));
    fixture_close(&f);
}

TEST(a_scene_of_another_thread_is_transferred_to_the_renderer)
{
    struct renderer_fixture f = fixture_open("lpv", NULL);
    struct loader loader;
    struct ag_scene *here = NULL;
    start(&loader, "@atrium");
    render_beside(&f, &loader, 1, FRAMES);
    join(&loader);
    assert_int_equal(ag_scene_transfer(loader.scene, f.context), AG_OK);
    ag_context_destroy(loader.context);
    assert_int_equal(ag_scene_load(f.context, "@atrium", &here), AG_OK);
    check_same(f.context, image_of(&f, loader.scene), image_of(&f, here));
    // Failures of the scene are those of its new context.
    assert_int_equal(ag_scene_add_mesh(loader.scene, NULL, NULL), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(f.context), "ag_scene_add_mesh"));
    ag_scene_destroy(loader.scene);
    ag_scene_destroy(here);
    fixture_close(&f);
}

// Builds a scene by calls, as an engine with assets of its own.
static void *build(void *user)
{
    struct loader *l = user;
    struct ag_scene *from = NULL;
    l->failed = ag_context_create(NULL, &l->context) != AG_OK ||
                ag_scene_load(l->context, l->name, &from) != AG_OK;
    if (!l->failed) l->scene = scene_copy_by_calls(from);
    ag_scene_destroy(from);
    atomic_store(&l->loaded, true);
    return NULL;
}

TEST(a_scene_built_by_calls_on_another_thread_is_transferred)
{
    struct renderer_fixture f = fixture_open("lpv", NULL);
    struct loader loader = { .name = "@spheres" };
    struct ag_scene *here = NULL;
    assert_int_equal(pthread_create(&loader.thread, NULL, build, &loader), 0);
    render_beside(&f, &loader, 1, 1);
    join(&loader);
    assert_int_equal(ag_scene_load(f.context, "@spheres", &here), AG_OK);
    struct ag_scene *copy = scene_copy_by_calls(here);
    assert_int_equal(ag_scene_transfer(loader.scene, f.context), AG_OK);
    check_same(f.context, image_of(&f, loader.scene), image_of(&f, copy));
    ag_scene_destroy(loader.scene);
    ag_scene_destroy(copy);
    ag_scene_destroy(here);
    ag_context_destroy(loader.context);
    fixture_close(&f);
}

#define CHECK_IN_USE(scene, to, words)                                                             \
    do {                                                                                           \
        struct ag_context *owner = (scene)->context;                                               \
        assert_int_equal(ag_scene_transfer((scene), (to)), AG_ERROR_ARGUMENT);                     \
        CHECK(strstr(ag_context_last_error(owner), (words)));                                      \
        assert_ptr_equal((scene)->context, owner);                                                 \
    } while (0)

TEST(a_scene_in_use_is_not_transferred)
{
    struct renderer_fixture f = fixture_open("none", NULL);
    struct ag_context *other = fixture_context();
    struct ag_reference *reference = NULL;
    struct ag_reference_desc desc;
    CHECK_IN_USE(f.scene, other, "in use by 1 renderers");
    ag_renderer_destroy(f.renderer);
    f.renderer = NULL;
    ag_reference_desc_default(&desc);
    desc.camera = f.frame.camera;
    desc.width = desc.height = 4;
    assert_int_equal(ag_reference_create(f.scene, &desc, &reference), AG_OK);
    CHECK_IN_USE(f.scene, other, "1 references");
    ag_reference_destroy(reference);
    CHECK_IN_USE(f.scene, NULL, "to is NULL");
    assert_int_equal(ag_scene_transfer(NULL, other), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_transfer(f.scene, other), AG_OK);
    assert_int_equal(ag_scene_transfer(f.scene, f.context), AG_OK);
    ag_context_destroy(other);
    fixture_close(&f);
}

static struct ag_context *counting_context(struct counting_allocator *memory)
{
    struct ag_context *context = NULL;
    struct ag_context_desc desc;
    ag_context_desc_default(&desc);
    desc.reallocate = counting_reallocate;
    desc.user = memory;
    assert_int_equal(ag_context_create(&desc, &context), AG_OK);
    return context;
}

TEST(a_transferred_scene_is_freed_by_the_shared_allocator)
{
    struct counting_allocator memory = { 0 }, other_memory = { 0 };
    struct ag_context *from = counting_context(&memory), *to = counting_context(&memory);
    struct ag_context *other = counting_context(&other_memory);
    struct ag_scene *scene = NULL;
    struct ag_scene_info info;
    assert_int_equal(ag_scene_load(from, "@cornell", &scene), AG_OK);
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK); // has a pose now
    CHECK_IN_USE(scene, other, "different allocators");
    assert_int_equal(ag_scene_transfer(scene, to), AG_OK);
    ag_context_destroy(from);
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    CHECK(info.triangles > 0);
    ag_scene_destroy(scene);
    ag_context_destroy(to);
    ag_context_destroy(other);
    CHECK(memory.blocks == 0 && other_memory.blocks == 0);
}
