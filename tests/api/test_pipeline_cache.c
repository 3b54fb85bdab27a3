// A pipeline cache of the program: bytes from one device are used by the next; others are ignored.
#include "api/renderer_fixture.h"

#include "core/hash.h"

#include <stdio.h>
#include <string.h>

enum { OWN_HEADER = 32, VULKAN_HEADER = 32 };

static void listen(void *user, enum ag_log_level level, const char *message)
{
    (void)level;
    if (strstr(message, "pipeline cache")) snprintf(user, 256, "%s", message);
}

struct session {
    struct ag_context *context;
    char said[256]; // about the cache; "" at first
};

static void open_session(struct session *s)
{
    struct ag_context_desc desc;
    test_gpu_require();
    ag_context_desc_default(&desc);
    desc.log = listen;
    desc.user = s->said;
    desc.log_up_to = AG_LOG_INFO;
    s->said[0] = 0;
    assert_int_equal(ag_context_create(&desc, &s->context), AG_OK);
}

static struct ag_device *open_device(struct session *s, const void *cache, size_t bytes)
{
    struct ag_device_desc desc;
    struct ag_device *device = NULL;
    ag_device_desc_default(&desc);
    desc.validation = true;
    desc.pipeline_cache = cache;
    desc.pipeline_cache_bytes = bytes;
    s->said[0] = 0;
    if (ag_device_create(s->context, &desc, &device) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return device;
}

static void close_device(struct ag_device *device)
{
    assert_int_equal(ag_device_validation_messages(device), 0);
    ag_device_destroy(device);
}

static void render(struct session *s, struct ag_device *device)
{
    struct ag_scene *scene;
    struct ag_renderer *renderer;
    struct ag_frame_desc frame;
    const struct ag_renderer_desc desc = fixture_renderer_desc("none");
    assert_int_equal(ag_scene_load(s->context, "@cornell:light=point", &scene), AG_OK);
    assert_int_equal(ag_renderer_create(device, scene, &desc, &renderer), AG_OK);
    ag_frame_desc_default(&frame);
    assert_int_equal(ag_scene_camera(scene, "main", 0, 0, &frame.camera), AG_OK);
    assert_int_equal(ag_renderer_render(renderer, &frame), AG_OK);
    assert_int_equal(ag_renderer_wait(renderer), AG_OK);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
}

static unsigned char *read_cache(struct ag_device *device, size_t *bytes)
{
    assert_int_equal(ag_device_pipeline_cache(device, NULL, 0, bytes), AG_OK);
    CHECK(*bytes >= OWN_HEADER + VULKAN_HEADER);
    unsigned char *out = malloc(*bytes);
    assert_int_equal(ag_device_pipeline_cache(device, out, *bytes, bytes), AG_OK);
    return out;
}

TEST(a_cache_is_used_by_the_next_device)
{
    struct session s;
    open_session(&s);
    struct ag_device *device = open_device(&s, NULL, 0);
    CHECK(!s.said[0]);
    size_t bytes, again;
    render(&s, device);
    unsigned char *cache = read_cache(device, &bytes);
    assert_int_equal(ag_device_pipeline_cache(device, cache, bytes - 1, &again), AG_ERROR_ARGUMENT);
    assert_int_equal(again, bytes);
    close_device(device);

    device = open_device(&s, cache, bytes);
    CHECK(strstr(s.said, "it is used"));
    free(cache); // needed during the call only
    render(&s, device);
    unsigned char *second = read_cache(device, &again);
    CHECK(again >= bytes);
    free(second);
    close_device(device);
    ag_context_destroy(s.context);
}

// Changes the byte at `at`, if there is one: the cache is ignored for this reason.
static void check_ignored(struct session *s, const unsigned char *cache, size_t bytes, size_t at,
                          const char *why)
{
    unsigned char *copy = malloc(bytes + 1);
    memcpy(copy + 1, cache, bytes); // an odd address
    if (at < bytes) copy[1 + at] ^= 0x5a;
    close_device(open_device(s, copy + 1, bytes));
    if (!strstr(s->said, why)) fail_msg("byte %zu of %zu: %s", at, bytes, s->said);
    free(copy);
}

TEST(damaged_bytes_are_ignored)
{
    struct session s;
    open_session(&s);
    struct ag_device *device = open_device(&s, NULL, 0);
    size_t bytes;
    unsigned char *cache = read_cache(device, &bytes);
    close_device(device);
    check_ignored(&s, cache, bytes, bytes, "it is used");
    check_ignored(&s, cache, bytes, 0, "not a pipeline cache");
    for (size_t at = 8; at < OWN_HEADER + VULKAN_HEADER; at += 8)
        check_ignored(&s, cache, bytes, at, at == 24 ? "not a pipeline cache" : "damaged");
    check_ignored(&s, cache, 1, 1, "not a pipeline cache");
    check_ignored(&s, cache, OWN_HEADER, bytes, "damaged");
    check_ignored(&s, cache, bytes - 1, bytes, "damaged");
    free(cache);
    ag_context_destroy(s.context);
}

// Whole, but with another value in Vulkan's header.
static void check_misfit(struct session *s, const unsigned char *cache, size_t bytes, size_t at,
                         const char *why)
{
    unsigned char *copy = malloc(bytes);
    memcpy(copy, cache, bytes);
    copy[OWN_HEADER + at] ^= 0x5a;
    const uint64_t hash = hash_bytes(copy + OWN_HEADER, bytes - OWN_HEADER, 0);
    memcpy(copy + 16, &hash, sizeof hash);
    close_device(open_device(s, copy, bytes));
    if (!strstr(s->said, why)) fail_msg("%zu: %s", at, s->said);
    free(copy);
}

TEST(bytes_of_another_device_or_driver_are_ignored)
{
    struct session s;
    open_session(&s);
    struct ag_device *device = open_device(&s, NULL, 0);
    size_t bytes;
    unsigned char *cache = read_cache(device, &bytes);
    close_device(device);
    check_misfit(&s, cache, bytes, 3, "unknown version"); // size of the header
    check_misfit(&s, cache, bytes, 4, "unknown version");
    check_misfit(&s, cache, bytes, 8, "another device"); // vendor
    check_misfit(&s, cache, bytes, 12, "another device");
    check_misfit(&s, cache, bytes, 16, "another driver");
    check_misfit(&s, cache, bytes, 31, "another driver");
    free(cache);
    ag_context_destroy(s.context);
}

TEST(a_size_without_bytes_is_refused)
{
    struct session s;
    open_session(&s);
    struct ag_device_desc desc;
    struct ag_device *device = NULL;
    ag_device_desc_default(&desc);
    desc.pipeline_cache_bytes = 1;
    assert_int_equal(ag_device_create(s.context, &desc, &device), AG_ERROR_ARGUMENT);
    assert_null(device);
    ag_context_destroy(s.context);
}
