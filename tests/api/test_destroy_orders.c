// Objects are destroyed in every order: what others use stays until they are gone, and nothing is
// left then. The address sanitizer sees any use of freed memory.
#include "api/counting_allocator.h"
#include "api/renderer_fixture.h"
#include "framework/shared_pipelines.h"

#include <stdio.h>
#include <string.h>

enum kind {
    CONTEXT,
    SCENE,
    DEVICE,
    RENDERER,
    VIEW,
    PREPARATION,
    ENVIRONMENT,
    REFERENCE,
    BAKE,
    LIGHTMAP,
    KINDS
};

enum { SIZE = 16, MOST = 5 };

struct objects {
    struct ag_context *context;
    struct ag_scene *scene;
    struct ag_device *device;
    struct ag_renderer *renderer;
    struct ag_view *view;
    struct ag_preparation *preparation;
    struct ag_environment *environment;
    struct ag_reference *reference;
    struct ag_bake *bake;
    struct ag_lightmap *lightmap;
    struct ag_camera camera;
    const struct ag_device_adopt *adopt; // NULL: the library opens a device
    bool gone[KINDS];
};

struct setting {
    const enum kind *kinds; // which are created, and then destroyed in each order
    int count;
    void (*create)(struct objects *o);
    void (*use)(struct objects *o);      // calls what is left
    const struct ag_device_adopt *adopt; // in most orders; NULL: in none
};

static void destroy(struct objects *o, enum kind kind)
{
    o->gone[kind] = true;
    switch (kind) {
    case CONTEXT:
        ag_context_destroy(o->context);
        break;
    case SCENE:
        ag_scene_destroy(o->scene);
        break;
    case DEVICE:
        ag_device_destroy(o->device);
        break;
    case RENDERER:
        ag_renderer_destroy(o->renderer);
        break;
    case VIEW:
        ag_view_destroy(o->view);
        break;
    case PREPARATION:
        ag_preparation_destroy(o->preparation);
        break;
    case ENVIRONMENT:
        ag_environment_destroy(o->environment);
        break;
    case REFERENCE:
        ag_reference_destroy(o->reference);
        break;
    case BAKE:
        ag_bake_destroy(o->bake);
        break;
    case LIGHTMAP:
        ag_lightmap_destroy(o->lightmap);
        break;
    case KINDS:
        break;
    }
}

// The order of that number, of all orders of `count` elements.
static void order_of(int number, int count, int order[MOST])
{
    for (int i = 0; i < count; i++) order[i] = i;
    for (int left = count; left > 1; left--) {
        const int at = count - left, take = at + number % left;
        number /= left;
        const int taken = order[take];
        memmove(order + at + 1, order + at, (size_t)(take - at) * sizeof *order);
        order[at] = taken;
    }
}

static void destroy_in_order(const struct setting *setting, int number)
{
    struct counting_allocator allocator = { 0 };
    struct objects o = { 0 };
    struct ag_context_desc desc;
    int order[MOST];
    ag_context_desc_default(&desc);
    desc.reallocate = counting_reallocate;
    desc.user = &allocator;
    assert_int_equal(ag_context_create(&desc, &o.context), AG_OK);
    // Each kind of object is the last to go in some order of the devices that the library opens.
    if (number % 6 != 0) o.adopt = setting->adopt;
    setting->create(&o);
    order_of(number, setting->count, order);
    for (int i = 0; i < setting->count; i++) {
        setting->use(&o);
        destroy(&o, setting->kinds[order[i]]);
    }
    if (allocator.blocks) fail_msg("order %d: %ld blocks are left", number, allocator.blocks);
}

static void destroy_in_all_orders(const struct setting *setting)
{
    int orders = 1;
    for (int i = 2; i <= setting->count; i++) orders *= i;
    for (int number = 0; number < orders; number++) destroy_in_order(setting, number);
    print_message("%d orders\n", orders);
}

// ---- on the CPU

static struct ag_scene *small_scene(struct objects *o)
{
    static const float positions[9] = { -1, 0, 0, 1, 0, 0, 0, 1, 0 };
    static const uint32_t indices[3] = { 0, 1, 2 };
    const struct ag_mesh_desc mesh = {
        .positions = positions, .vertex_count = 3, .indices = indices, .index_count = 3
    };
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    assert_int_equal(ag_scene_create(o->context, &o->scene), AG_OK);
    assert_int_equal(ag_scene_add_material(o->scene, &material, NULL), AG_OK);
    assert_int_equal(ag_scene_add_mesh(o->scene, &mesh, NULL), AG_OK);
    assert_int_equal(ag_scene_add_instance(o->scene, 0, NULL, NULL), AG_OK);
    static const float sky[3] = { 100, 100, 100 };
    assert_int_equal(ag_scene_set_sky(o->scene, sky), AG_OK);
    assert_int_equal(ag_scene_default_camera(o->scene, 0, 0.0, &o->camera, NULL), AG_OK);
    return o->scene;
}

static void create_reference(struct objects *o)
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.camera = o->camera;
    desc.width = desc.height = 2;
    desc.guiding = false;
    assert_int_equal(ag_reference_create(o->scene, &desc, &o->reference), AG_OK);
}

static void create_bake(struct objects *o, int lightmap_samples)
{
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = lightmap_samples;
    if (ag_bake_create(o->scene, "radiosity:texels=2048,rays=16", &desc, &o->bake) != AG_OK)
        fail_msg("%s", ag_context_last_error(o->context));
}

static void create_on_cpu(struct objects *o)
{
    static float pixels[2 * 3] = { 1, 2, 3, 4, 5, 6 };
    const struct ag_image sky = { 2, 1, 3, pixels };
    small_scene(o);
    assert_int_equal(ag_environment_from_image(o->context, &sky, &o->environment), AG_OK);
    assert_int_equal(ag_scene_set_environment(o->scene, o->environment, NULL), AG_OK);
    create_reference(o);
    create_bake(o, 0);
}

static void use_on_cpu(struct objects *o)
{
    struct ag_environment_info environment;
    struct ag_bake_info bake;
    struct ag_image *copy;
    if (!o->gone[ENVIRONMENT])
        assert_int_equal(ag_environment_get_info(o->environment, &environment), AG_OK);
    if (!o->gone[BAKE]) assert_int_equal(ag_bake_get_info(o->bake, &bake), AG_OK);
    if (o->gone[REFERENCE]) return;
    assert_int_equal(ag_reference_read(o->reference, "albedo", &copy), AG_OK);
    ag_image_destroy(NULL, copy);
    // Threads take most of the time: once in an order.
    const bool last = o->gone[CONTEXT] && o->gone[SCENE] && o->gone[BAKE];
    if (last) assert_int_equal(ag_reference_render(o->reference, 1, NULL, NULL), AG_OK);
}

TEST(objects_of_the_cpu)
{
    static const enum kind kinds[] = { CONTEXT, SCENE, ENVIRONMENT, REFERENCE, BAKE };
    const struct setting setting = { kinds, 5, create_on_cpu, use_on_cpu, NULL };
    destroy_in_all_orders(&setting);
}

static void create_lightmap(struct objects *o)
{
    small_scene(o);
    create_bake(o, 1);
    assert_int_equal(ag_bake_run(o->bake, NULL, NULL), AG_OK);
    if (ag_lightmap_from_bake(o->bake, NULL, &o->lightmap) != AG_OK)
        fail_msg("%s", ag_context_last_error(o->context));
}

static void use_lightmap(struct objects *o)
{
    struct ag_image *map;
    const char *report;
    if (!o->gone[BAKE]) assert_int_equal(ag_bake_report(o->bake, &report), AG_OK);
    if (o->gone[LIGHTMAP]) return;
    assert_int_equal(ag_lightmap_read(o->lightmap, false, &map), AG_OK);
    ag_image_destroy(NULL, map);
    if (ag_lightmap_write(o->lightmap, test_path(".")) != AG_OK)
        fail_msg("%s", ag_context_last_error(o->context));
}

TEST(light_maps)
{
    static const enum kind kinds[] = { CONTEXT, SCENE, BAKE, LIGHTMAP };
    const struct setting setting = { kinds, 4, create_lightmap, use_lightmap, NULL };
    destroy_in_all_orders(&setting);
}

// ---- on the GPU

static void create_renderer(struct objects *o, const char *gi)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = desc.height = SIZE;
    desc.gi = gi;
    desc.frame_options = "shadow_size=256,rsm_size=64";
    if (ag_renderer_create(o->device, o->scene, &desc, &o->renderer) != AG_OK)
        fail_msg("%s", ag_context_last_error(o->context));
}

// Drivers take most of the time to compile: pipelines of adopted devices are compiled once.
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char *name)
{
    const PFN_vkVoidFunction shared = shared_pipelines_function(name);
    return shared ? shared : vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance,
                                                                  const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (PFN_vkVoidFunction)device_function;
    return vkGetInstanceProcAddr(instance, name);
}

static void create_on_gpu(struct objects *o)
{
    struct ag_device_desc device;
    ag_device_desc_default(&device);
    device.adopt = o->adopt;
    small_scene(o);
    assert_int_equal(ag_device_create(o->context, &device, &o->device), AG_OK);
    create_renderer(o, "none");
    struct ag_view_desc desc;
    ag_view_desc_default(&desc);
    desc.width = desc.height = SIZE;
    assert_int_equal(ag_view_create(o->renderer, &desc, &o->view), AG_OK);
}

static void render(struct objects *o)
{
    struct ag_frame_desc frame;
    struct ag_view_frame view;
    ag_frame_desc_default(&frame);
    ag_view_frame_default(&view);
    view.view = o->view;
    view.camera = frame.camera = o->camera;
    frame.views = &view;
    frame.view_count = !o->gone[VIEW];
    assert_int_equal(ag_renderer_render(o->renderer, &frame), AG_OK);
}

static void use_on_gpu(struct objects *o)
{
    struct ag_image *image;
    struct ag_device_info info;
    if (!o->gone[DEVICE]) ag_device_get_info(o->device, &info);
    if (!o->gone[RENDERER]) render(o);
    if (o->gone[VIEW]) return;
    assert_int_equal(ag_view_read(o->view, "color", &image), AG_OK);
    ag_image_destroy(NULL, image);
}

static void create_preparation(struct objects *o)
{
    assert_int_equal(ag_device_create(o->context, NULL, &o->device), AG_OK);
    small_scene(o);
    create_renderer(o, "none");
    ag_scene_destroy(o->scene); // the renderer keeps it
    assert_int_equal(ag_preparation_create(o->renderer, "ambient", &o->preparation), AG_OK);
}

static void use_preparation(struct objects *o)
{
    if (o->gone[PREPARATION]) return;
    assert_int_equal(ag_preparation_run(o->preparation, NULL, NULL, NULL), AG_OK);
    CHECK(ag_preparation_pipelines(o->preparation) > 0);
}

TEST(preparations_and_what_they_are_of)
{
    static const enum kind kinds[] = { CONTEXT, DEVICE, RENDERER, PREPARATION };
    const struct setting setting = { kinds, 4, create_preparation, use_preparation, NULL };
    test_gpu_require();
    destroy_in_all_orders(&setting);
}

TEST(objects_of_the_gpu)
{
    static const enum kind kinds[] = { CONTEXT, SCENE, DEVICE, RENDERER, VIEW };
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, 0);
    struct ag_device_adopt adopt = fixture_lend(&own);
    adopt.get_instance_proc_addr = (void (*)(void))instance_function;
    const struct setting setting = { kinds, 5, create_on_gpu, use_on_gpu, &adopt };
    destroy_in_all_orders(&setting);
    shared_pipelines_close(own.device);
    own_device_close(&own);
}

// ---- what a program may rely on

TEST(a_renderer_shows_the_same_without_the_handles_of_its_scene_device_and_context)
{
    struct renderer_fixture s = fixture_open_alone("lpv:probes=true,dim=16");
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_image *before = fixture_read(&s, "color");
    struct ag_probes *probes = NULL;
    assert_int_equal(ag_renderer_read_probes(s.renderer, &probes), AG_OK);
    ag_scene_destroy(s.scene);
    ag_device_destroy(s.device);
    ag_context_destroy(s.context);
    s.frame.camera_cut = true;
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_image *after = fixture_read(&s, "color");
    const size_t bytes = 3 * sizeof(float) * (size_t)before->width * (size_t)before->height;
    assert_memory_equal(before->pixels, after->pixels, bytes);
    ag_renderer_destroy(s.renderer);
    CHECK_STRING(fixture_last_warning, "");
    assert_true(probes->coefficients[0] > 0.0f);
    ag_image_destroy(s.context, before);
    ag_image_destroy(s.context, after);
    ag_probes_destroy(s.context, probes);
}

TEST(a_second_call_while_others_use_the_object_has_no_effect)
{
    struct objects o = { .context = fixture_context() };
    small_scene(&o);
    create_reference(&o);
    for (int i = 0; i < 3; i++) {
        ag_scene_destroy(o.scene);
        ag_context_destroy(o.context);
    }
    assert_int_equal(ag_reference_render(o.reference, 1, NULL, NULL), AG_OK);
    ag_reference_destroy(o.reference);
}

TEST(an_adopted_device_that_is_in_use_is_a_warning)
{
    test_gpu_require();
    struct own_device own;
    own_device_open(&own, 0);
    const struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("none", &adopt);
    ag_device_destroy(s.device);
    CHECK(strstr(fixture_last_warning, "preparations still use the device (1)"));
    ag_renderer_destroy(s.renderer);
    ag_scene_destroy(s.scene);
    ag_context_destroy(s.context);
    own_device_close(&own);
}

static void drop_log(void *user, enum ag_log_level level, const char *message)
{
    if (level == AG_LOG_DEBUG) snprintf(user, 512, "%s", message);
}

TEST(a_context_tells_what_it_waits_for)
{
    char last[512] = "";
    struct objects o = { 0 };
    struct ag_context_desc desc;
    ag_context_desc_default(&desc);
    desc.log = drop_log;
    desc.log_up_to = AG_LOG_DEBUG;
    desc.user = last;
    assert_int_equal(ag_context_create(&desc, &o.context), AG_OK);
    small_scene(&o);
    ag_context_destroy(o.context);
    CHECK(strstr(last, "objects still use the context (1)"));
    ag_scene_destroy(o.scene);
}
