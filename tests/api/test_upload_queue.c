// An upload queue of the program changes no image. It is a second queue where the device has one.
#include "api/renderer_fixture.h"

#include <string.h>

enum { IMAGES = 4, BYTES = FIXTURE_WIDTH * FIXTURE_HEIGHT * 3 * sizeof(float) };

struct way {
    bool upload_queue;
    bool recorded;  // into the program's command buffers
    bool unchecked; // by validation layers: with two queues also where older ones cannot follow
};

struct session {
    struct way way;
    struct own_device own;
    struct renderer_fixture s;
    float images[IMAGES][FIXTURE_WIDTH * FIXTURE_HEIGHT * 3];
    int count;
};

static void open_session(struct session *o, struct way way, const char *gi)
{
    *o = (struct session){ .way = way };
    test_gpu_require();
    own_device_open(&o->own, way.unchecked ? 0 : OWN_DEVICE_VALIDATION);
    struct ag_device_adopt adopt = fixture_lend(&o->own);
    if (way.upload_queue) adopt.upload_queue = o->own.upload_queue;
    o->s = fixture_open(gi, &adopt);
}

static void close_session(struct session *o)
{
    fixture_close(&o->s);
    assert_int_equal(o->own.held, 0);
    own_device_close(&o->own);
}

static struct ag_device_counters counters(const struct session *o)
{
    struct ag_device_counters out;
    ag_device_get_counters(o->s.device, &out);
    return out;
}

// Renders a frame, with those before still in flight. Returns its number if it was recorded.
static uint64_t begin_frame(struct session *o)
{
    uint64_t number = 0;
    if (!o->way.recorded) {
        assert_int_equal(ag_renderer_render(o->s.renderer, &o->s.frame), AG_OK);
        return 0;
    }
    VkCommandBuffer commands = own_device_begin(&o->own);
    assert_int_equal(ag_renderer_record(o->s.renderer, &o->s.frame, commands, &number), AG_OK);
    own_device_submit(&o->own, commands);
    return number;
}

static void keep_picture(struct session *o, uint64_t number)
{
    if (o->way.recorded) {
        vkQueueWaitIdle(o->own.queue);
        assert_int_equal(ag_renderer_recorded_done(o->s.renderer, number), AG_OK);
    }
    struct ag_image *color = fixture_read(&o->s, "color");
    memcpy(o->images[o->count++], color->pixels, BYTES);
    ag_image_destroy(o->s.context, color);
}

// ---- Changes with uploads

static int add_image(struct ag_scene *scene)
{
    uint8_t pixels[8 * 8 * 4];
    int index;
    for (int i = 0; i < 8 * 8 * 4; i++) pixels[i] = (uint8_t)(37 * i);
    const struct ag_scene_image_desc desc = {
        .pixels = pixels, .width = 8, .height = 8, .channels = 4
    };
    assert_int_equal(ag_scene_add_image(scene, &desc, &index), AG_OK);
    return index;
}

// A square in the box: a mesh, a material and a texture.
static void add_textured_square(struct ag_scene *scene)
{
    static const float positions[12] = { -1, 0, 0, 1, 0, 0, 1, 2, 0, -1, 2, 0 };
    static const float uv[8] = { 0, 1, 1, 1, 1, 0, 0, 0 };
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    static const float placed[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0, 1 };
    struct ag_material_desc material;
    struct ag_material_maps maps;
    ag_material_desc_default(&material);
    ag_material_maps_default(&maps);
    maps.base_color.image = add_image(scene);
    material.maps = &maps;
    struct ag_mesh_desc mesh = { .positions = positions,
                                 .vertex_count = 4,
                                 .indices = indices,
                                 .index_count = 6,
                                 .uv = { uv } };
    assert_int_equal(ag_scene_add_material(scene, &material, &mesh.material), AG_OK);
    int index;
    assert_int_equal(ag_scene_add_mesh(scene, &mesh, &index), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, index, placed, NULL), AG_OK);
}

static void check_uploads(const struct session *o, const struct ag_device_counters *before)
{
    const struct ag_device_counters now = counters(o);
    const uint64_t transfers = now.transfers - before->transfers;
    assert_true(transfers > 0);
    assert_true(now.upload_queue_transfers - before->upload_queue_transfers ==
                (o->way.upload_queue ? transfers : 0));
}

static void add_to_scene(struct session *o)
{
    begin_frame(o);
    const struct ag_device_counters before = counters(o);
    const int locks = o->own.locks;
    add_textured_square(o->s.scene);
    const uint64_t number = begin_frame(o);
    check_uploads(o, &before);
    // Each upload; the frame, which the program submits in the other way; there, what waits.
    const uint64_t submissions =
        counters(o).transfers - before.transfers + (o->way.recorded ? o->way.upload_queue : 1);
    assert_true((uint64_t)(o->own.locks - locks) == submissions);
    keep_picture(o, number);
}

// A second renderer is created while the frame of the first is in flight.
static void add_renderer(struct session *o)
{
    struct ag_renderer *second = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc("ambient+ssao");
    const uint64_t first_number = begin_frame(o);
    const struct ag_device_counters before = counters(o);
    assert_int_equal(ag_renderer_create(o->s.device, o->s.scene, &desc, &second), AG_OK);
    check_uploads(o, &before);
    keep_picture(o, first_number);
    struct ag_renderer *first = o->s.renderer;
    o->s.renderer = second;
    keep_picture(o, begin_frame(o));
    o->s.renderer = first;
    ag_renderer_destroy(second);
}

static void render_changes(struct session *o, struct way way)
{
    open_session(o, way, "lpv");
    struct ag_device_counters before = { 0 };
    check_uploads(o, &before);
    keep_picture(o, begin_frame(o));
    before = counters(o);
    add_to_scene(o);
    add_renderer(o);
    // Objects that frames have used are read on the main queue.
    before = counters(o);
    ag_image_destroy(o->s.context, fixture_read(&o->s, "color"));
    assert_true(counters(o).transfers == before.transfers + 1);
    assert_true(counters(o).upload_queue_transfers == before.upload_queue_transfers);
    close_session(o);
    assert_int_equal(o->count, IMAGES);
}

TEST(an_upload_queue_changes_no_picture)
{
    static struct session plain, other;
    static const struct way ways[] = {
        { .upload_queue = true },
        { .recorded = true },
        { .upload_queue = true, .recorded = true },
        { .upload_queue = true, .unchecked = true },
        { .upload_queue = true, .recorded = true, .unchecked = true },
    };
    render_changes(&plain, (struct way){ 0 });
    CHECK(memcmp(plain.images[0], plain.images[1], BYTES) != 0);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        render_changes(&other, ways[i]);
        CHECK(memcmp(plain.images, other.images, sizeof plain.images) == 0);
    }
}

// ---- A technique with data of a bake

static int radiosity(struct ag_technique_info *info)
{
    int i = 0;
    while (ag_technique_get(i, info) && strcmp(info->name, "radiosity") != 0) i++;
    return i;
}

static void render_bake(struct session *o, struct way way)
{
    char gi[FIXTURE_SPEC];
    struct ag_technique_info info;
    open_session(o, way, "none");
    fixture_print_base(radiosity(&info), &info, gi);
    struct ag_bake *bake = fixture_bake(&o->s, gi, &info);
    const struct ag_bake *bakes[] = { bake };
    uint64_t number = begin_frame(o);
    if (way.recorded) { // set_gi is refused meanwhile
        vkQueueWaitIdle(o->own.queue);
        assert_int_equal(ag_renderer_recorded_done(o->s.renderer, number), AG_OK);
    }
    const struct ag_device_counters before = counters(o);
    if (ag_renderer_set_gi(o->s.renderer, gi, bakes, 1) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(o->s.context));
    check_uploads(o, &before);
    for (int i = 0; i < 2; i++) {
        begin_frame(o);
        keep_picture(o, begin_frame(o));
    }
    ag_bake_destroy(bake);
    close_session(o);
}

TEST(a_switch_to_a_technique_with_a_bake_uploads_on_the_upload_queue)
{
    static struct session plain, other;
    render_bake(&plain, (struct way){ 0 });
    for (int recorded = 0; recorded < 2; recorded++) {
        render_bake(&other, (struct way){ .upload_queue = true, .recorded = recorded });
        CHECK(memcmp(plain.images, other.images, sizeof plain.images) == 0);
    }
}
