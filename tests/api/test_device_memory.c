// Device memory from the program's callbacks: all of it, wholly returned, and refused at every
// call.
#include "api/renderer_fixture.h"
#include "framework/shared_pipelines.h"

#include <stdatomic.h>
#include <string.h>

// ---- Vulkan calls of the library

static long memories, views, wrong_allocators;
static const VkAllocationCallbacks *expected_allocator;
static bool share_pipelines; // of the devices of a test

static VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device,
                                                      const VkMemoryAllocateInfo *info,
                                                      const VkAllocationCallbacks *allocator,
                                                      VkDeviceMemory *out)
{
    memories++;
    return vkAllocateMemory(device, info, allocator, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_image_view(VkDevice device,
                                                        const VkImageViewCreateInfo *info,
                                                        const VkAllocationCallbacks *allocator,
                                                        VkImageView *out)
{
    views++;
    wrong_allocators += (allocator != NULL) != (expected_allocator != NULL);
    return vkCreateImageView(device, info, allocator, out);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char *name)
{
    if (strcmp(name, "vkAllocateMemory") == 0) return (PFN_vkVoidFunction)allocate_memory;
    if (strcmp(name, "vkCreateImageView") == 0) return (PFN_vkVoidFunction)create_image_view;
    const PFN_vkVoidFunction shared = share_pipelines ? shared_pipelines_function(name) : NULL;
    if (shared) return shared;
    return vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance,
                                                                  const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (PFN_vkVoidFunction)device_function;
    return vkGetInstanceProcAddr(instance, name);
}

static struct ag_device_adopt lend(struct own_device *own)
{
    struct ag_device_adopt adopt = fixture_lend(own);
    adopt.get_instance_proc_addr = (void (*)(void))instance_function;
    return adopt;
}

// ---- The program's memory

enum way { WHOLE, PARTS }; // of a VkDeviceMemory
struct program_memory {
    struct own_device *own;
    enum way way;
    uint64_t most_bytes; // of a request; 0: any
    long refuse_at;      // this call; 0: none
    bool refuse_rest;    // and all later ones
    long calls, blocks, memories;
    uint64_t bytes; // given and not returned
};

// In parts, the library's block begins after one alignment.
static bool allocate(void *user, const struct ag_memory_request *request,
                     struct ag_memory_block *out)
{
    struct program_memory *m = user;
    VkDeviceMemory memory;
    assert_true(request->bytes > 0 && request->alignment > 0);
    for (int i = 0; i < 4; i++) assert_true(request->reserved[i] == 0);
    if (m->most_bytes && request->bytes > m->most_bytes) return false;
    m->calls++;
    if (m->refuse_at && (m->refuse_rest ? m->calls >= m->refuse_at : m->calls == m->refuse_at))
        return false;
    const uint64_t offset = m->way == PARTS ? request->alignment : 0;
    const VkMemoryAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = offset + request->bytes,
                                        .memoryTypeIndex = request->vk_memory_type };
    assert_int_equal(vkAllocateMemory(m->own->device, &info, NULL, &memory), VK_SUCCESS);
    out->vk_memory = (void *)memory;
    out->offset = offset;
    out->handle = m;
    char *mapped = NULL;
    if (request->mapped)
        assert_int_equal(vkMapMemory(m->own->device, memory, 0, VK_WHOLE_SIZE, 0, (void **)&mapped),
                         VK_SUCCESS);
    out->mapped = mapped ? mapped + offset : NULL;
    m->blocks++;
    m->bytes += request->bytes;
    return true;
}

static void give_back(void *user, const struct ag_memory_request *request,
                      const struct ag_memory_block *block)
{
    struct program_memory *m = user;
    assert_ptr_equal(block->handle, m);
    assert_true(block->offset == (m->way == PARTS ? request->alignment : 0));
    vkFreeMemory(m->own->device, (VkDeviceMemory)block->vk_memory, NULL);
    m->blocks--;
    m->bytes -= request->bytes;
}

static struct ag_memory_callbacks callbacks_of(struct program_memory *m)
{
    return (struct ag_memory_callbacks){ .allocate = allocate, .free = give_back, .user = m };
}

static uint64_t bytes_in_use(struct ag_device *device)
{
    struct ag_memory owners[64];
    uint64_t bytes = 0;
    for (int i = 0, n = ag_device_memory(device, owners, 64); i < n; i++) bytes += owners[i].bytes;
    return bytes;
}

// ---- Images

enum { FLOATS = 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT };

static void render(const struct ag_device_adopt *adopt, const struct program_memory *m,
                   float out[FLOATS])
{
    struct renderer_fixture s = fixture_open("lpv:dim=8,cascades=1", adopt);
    for (int i = 0; i < 3; i++) assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_image *color = fixture_read(&s, "color");
    if (m) CHECK(m->blocks > 2 && m->bytes >= bytes_in_use(s.device));
    memcpy(out, color->pixels, sizeof(float) * FLOATS);
    ag_image_destroy(s.context, color);
    fixture_close(&s);
}

TEST(all_device_memory_is_the_programs_and_is_returned)
{
    static const struct {
        enum way way;
        uint64_t most_bytes;
    } ways[] = { { WHOLE, 0 }, { PARTS, 0 }, { WHOLE, 32u << 20 }, { PARTS, 32u << 20 } };
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_device_adopt adopt = lend(&own);
    static float expected[FLOATS], got[FLOATS];
    memories = 0;
    render(&adopt, NULL, expected);
    CHECK(memories > 2);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        struct program_memory m = { .own = &own,
                                    .way = ways[i].way,
                                    .most_bytes = ways[i].most_bytes };
        const struct ag_memory_callbacks callbacks = callbacks_of(&m);
        adopt.memory = &callbacks;
        memories = 0;
        render(&adopt, &m, got);
        assert_int_equal(memories, 0); // none but those of the callback
        CHECK(m.calls > 2 && m.blocks == 0 && m.bytes == 0);
        CHECK(memcmp(got, expected, sizeof got) == 0);
    }
    own_device_close(&own);
}

// ---- Refusals

// Stops at the first failure.
static enum ag_result use_renderer(struct ag_context *context, struct ag_device *device)
{
    struct ag_scene *scene = NULL;
    struct ag_renderer *renderer = NULL;
    struct ag_image *image = NULL;
    struct ag_layer_handle handle;
    struct ag_frame_desc frame;
    const int pick[2] = { 3, 4 };
    const float turned[16] = { 0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0.1f, 0, 1 };
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv:dim=8,cascades=1");
    ag_frame_desc_default(&frame);
    assert_int_equal(ag_scene_load(context, "@cornell:light=point", &scene), AG_OK);
    assert_int_equal(ag_scene_camera(scene, "main", 0, 0, &frame.camera), AG_OK);
    enum ag_result result = ag_renderer_create(device, scene, &desc, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &frame);
    assert_int_equal(ag_scene_set_instance_transform(scene, 1, turned), AG_OK);
    frame.pick = pick;
    if (result == AG_OK) result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_layer_handle(renderer, "visibility", &handle);
    if (result == AG_OK) result = ag_renderer_set_gi(renderer, "ambient+ssao", NULL, 0);
    if (result == AG_OK) result = ag_renderer_resize(renderer, 20, 30);
    if (result == AG_OK) result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "color", &image);
    ag_image_destroy(context, image);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    return result;
}

static enum ag_result use_device(struct ag_context *context, const struct ag_device_adopt *adopt)
{
    struct ag_device *device = NULL;
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.adopt = adopt;
    desc.validation = true;
    enum ag_result result = ag_device_create(context, &desc, &device);
    if (result != AG_OK) return result;
    result = use_renderer(context, device);
    if (ag_device_validation_messages(device)) fail_msg("validation: %s", fixture_last_warning);
    ag_device_destroy(device);
    return result;
}

static void check_every_refusal(bool rest, uint64_t most_bytes)
{
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_context *context = fixture_context();
    struct program_memory m = { .own = &own, .most_bytes = most_bytes };
    const struct ag_memory_callbacks callbacks = callbacks_of(&m);
    struct ag_device_adopt adopt = lend(&own);
    adopt.memory = &callbacks;
    share_pipelines = true;
    if (use_device(context, &adopt) != AG_OK) fail_msg("%s", ag_context_last_error(context));
    const long calls = m.calls;
    CHECK(calls > 2);
    for (long k = 1; k <= calls; k++) {
        m = (struct program_memory){
            .own = &own, .most_bytes = most_bytes, .refuse_at = k, .refuse_rest = rest
        };
        const enum ag_result result = use_device(context, &adopt);
        if (m.blocks != 0 || m.bytes != 0)
            fail_msg("refusal %ld of %ld keeps %ld blocks", k, calls, m.blocks);
        // A single refusal may be made up for by fewer bytes.
        if (result != AG_ERROR_MEMORY && (rest || result != AG_OK))
            fail_msg("refusal %ld of %ld gives \"%s\"", k, calls, ag_result_string(result));
    }
    share_pipelines = false;
    ag_context_destroy(context);
    shared_pipelines_close(own.device);
    own_device_close(&own);
}

TEST(every_refusal_is_a_memory_error_and_keeps_nothing)
{
    check_every_refusal(true, 0);
    check_every_refusal(false, 0);
}

// Each resource asks for memory of its own.
TEST(every_refusal_of_small_blocks_is_a_memory_error_and_keeps_nothing)
{
    check_every_refusal(true, 32u << 20);
}

TEST(wrong_blocks_are_refused_and_returned)
{
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, 0);
    struct ag_context *context = fixture_context();
    struct program_memory m = { .own = &own };
    struct ag_memory_callbacks callbacks = callbacks_of(&m);
    struct ag_device_adopt adopt = lend(&own);
    struct ag_device_desc desc;
    struct ag_device *device;
    ag_device_desc_default(&desc);
    adopt.memory = &callbacks;
    desc.adopt = &adopt;
    callbacks.free = NULL;
    assert_int_equal(ag_device_create(context, &desc, &device), AG_ERROR_ARGUMENT);
    callbacks = callbacks_of(&m);
    callbacks.reserved[3] = 1;
    assert_int_equal(ag_device_create(context, &desc, &device), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "newer library"));
    CHECK(m.calls == 0);
    ag_context_destroy(context);
    own_device_close(&own);
}

// ---- Host memory of Vulkan objects

struct host_memory {
    atomic_long blocks, calls; // drivers have threads of their own
};

static void *VKAPI_PTR host_allocate(void *user, size_t size, size_t alignment,
                                     VkSystemAllocationScope scope)
{
    struct host_memory *m = user;
    (void)scope;
    atomic_fetch_add(&m->blocks, 1);
    atomic_fetch_add(&m->calls, 1);
    if (alignment < sizeof(void *)) alignment = sizeof(void *);
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void VKAPI_PTR host_free_block(void *user, void *block)
{
    if (block) atomic_fetch_sub(&((struct host_memory *)user)->blocks, 1);
    free(block);
}

static void *VKAPI_PTR host_reallocate(void *user, void *old, size_t size, size_t alignment,
                                       VkSystemAllocationScope scope)
{
    if (!old) return host_allocate(user, size, alignment, scope);
    if (!size) {
        host_free_block(user, old);
        return NULL;
    }
    assert_true(alignment <= _Alignof(max_align_t));
    return realloc(old, size);
}

TEST(host_memory_of_vulkan_objects_is_the_programs)
{
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct host_memory m = { 0 };
    const VkAllocationCallbacks callbacks = { .pUserData = &m,
                                              .pfnAllocation = host_allocate,
                                              .pfnReallocation = host_reallocate,
                                              .pfnFree = host_free_block };
    struct ag_device_adopt adopt = lend(&own);
    adopt.vk_allocation_callbacks = &callbacks;
    expected_allocator = &callbacks;
    views = wrong_allocators = 0;
    static float image[FLOATS];
    render(&adopt, NULL, image);
    expected_allocator = NULL;
    CHECK(views > 10 && wrong_allocators == 0);
    CHECK(m.calls > 100);
    assert_int_equal(m.blocks, 0);
    own_device_close(&own);
}
