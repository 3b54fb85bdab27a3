// Renders: the bytes choose a small scene, a GI spec, cameras, lights and movements. Three frames
// are rendered, with changes in between. What the library refuses is refused; the pixels of all
// other frames are finite, and the validation layers have no message.
#include "fuzz/fuzz.h"
#include "fuzz/render_input.h"

#include "framework/drivers.h"

#include <math.h>
#include <string.h>

enum { MAX_MOVED = 3, FRAMES = 3, PATH_SIZE = 512 };

struct render {
    struct render_input in;
    struct ag_scene *scene;
    struct ag_renderer *renderer;
    struct ag_frame_desc frame;
    int mesh, moved[MAX_MOVED], moved_count;
    int light;
};

// ---- device

// Shaders are compiled once for many inputs. A new device frees what the driver keeps of old ones.
enum { INPUTS_OF_A_DEVICE = 64 };
static struct ag_context *context;
static struct ag_device *device;

static void close_device(void)
{
    ag_device_destroy(device);
    ag_context_destroy(context);
    device = NULL;
    context = NULL;
}

static void create_device(void)
{
    static bool loaded;
    struct ag_device_desc desc;
    context = fuzz_context();
    ag_device_desc_default(&desc);
    desc.validation = true;
    if (!loaded) drivers_load_begin();
    if (ag_device_create(context, &desc, &device) != AG_OK) {
        desc.validation = false; // there are no layers
        (void)ag_device_create(context, &desc, &device);
    }
    if (!loaded) drivers_load_end();
    loaded = true;
}

static bool open_device(void)
{
    static int inputs;
    if (device && ++inputs % INPUTS_OF_A_DEVICE > 0) return true;
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
           0);
    close_device();
    create_device();
    if (!device) fprintf(stderr, "nothing is rendered: %s\n", ag_context_last_error(context));
    return device != NULL;
}

// ---- scene

static const char *const scenes[] = { "@cornell:light=point",
                                      "@cornell:light=quad,blocks=false",
                                      "@maze:blocks=2,light=point",
                                      "@tunnel:pieces=2,light=point",
                                      "@maze:blocks=1,pillars=1",
                                      "@diagonal",
                                      NULL };
enum { SCENES = sizeof scenes / sizeof *scenes };

static const float corners[24] = { -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                   -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1 };
static const uint32_t faces[36] = { 0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                    3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5 };

static bool add_box_mesh(struct render *r)
{
    struct ag_material_desc material;
    struct ag_mesh_desc mesh = {
        .positions = corners, .vertex_count = 8, .indices = faces, .index_count = 36
    };
    input_material(&r->in, &material);
    return ag_scene_add_material(r->scene, &material, &mesh.material) == AG_OK &&
           ag_scene_add_mesh(r->scene, &mesh, &r->mesh) == AG_OK;
}

static void add_boxes(struct render *r, bool movable)
{
    for (int n = input_choice(&r->in, MAX_MOVED + 1); n > 0; n--) {
        float matrix[16];
        int instance;
        input_matrix(&r->in, matrix);
        if (ag_scene_add_instance(r->scene, r->mesh, matrix, &instance) != AG_OK || !movable)
            continue;
        if (r->moved_count == MAX_MOVED ||
            ag_scene_set_instance_mobility(r->scene, instance, AG_MOBILITY_MOVABLE) != AG_OK)
            continue;
        r->moved[r->moved_count++] = instance;
    }
}

static void add_lights(struct render *r)
{
    const uint8_t which = input_byte(&r->in);
    float sky[3];
    if (which & 1) ag_scene_remove_lights(r->scene);
    for (int n = which >> 1 & 3; n > 0; n--) {
        struct ag_light_desc light;
        int index;
        input_punctual(&r->in, &light);
        if (ag_scene_add_light(r->scene, &light, &index) == AG_OK) r->light = index;
    }
    if (which & 8) input_light(&r->in, sky);
    if (which & 8) ag_scene_set_sky(r->scene, sky);
    if (which & 16) {
        struct ag_area_light_desc area;
        ag_area_light_desc_default(&area);
        input_vector(&r->in, area.position);
        area.width = input_size(&r->in);
        input_light(&r->in, area.radiance);
        ag_scene_add_area_light(r->scene, &area, NULL);
    }
}

static bool make_scene(struct render *r)
{
    const int kind = input_choice(&r->in, SCENES + 1);
    r->light = -1;
    if (kind < SCENES && scenes[kind]) {
        if (ag_scene_load(context, scenes[kind], &r->scene) != AG_OK) return false;
    } else if (ag_scene_create(context, &r->scene) != AG_OK) {
        return false;
    }
    if (!add_box_mesh(r)) return false;
    add_boxes(r, true);
    if (kind >= SCENES - 1) add_boxes(r, false);
    add_lights(r);
    return true;
}

// ---- renderer

// A dictionary of mrt is the same for all scenes of a kind: it is kept for later inputs.
static bool finish_bake(struct ag_bake *bake)
{
    struct ag_bake_info info;
    char path[PATH_SIZE];
    if (ag_bake_get_info(bake, &info) != AG_OK) return false;
    if (strcmp(info.technique, "mrt") != 0) return ag_bake_run(bake, NULL, NULL) == AG_OK;
    snprintf(path, sizeof path, "%s/%s.safetensors", fuzz_folder(), info.key);
    FILE *file = fopen(path, "rb");
    if (file) fclose(file);
    if (file) return ag_bake_load(bake, path) == AG_OK;
    return ag_bake_run(bake, NULL, NULL) == AG_OK && ag_bake_save(bake, path, false) == AG_OK;
}

enum { MAX_BAKES = 3 };

static int make_bakes(struct render *r, const char *gi, struct ag_bake *bakes[MAX_BAKES])
{
    struct ag_bake_desc desc;
    int count = 0;
    ag_bake_desc_default(&desc);
    desc.threads = 1;
    for (int i = 0; count < MAX_BAKES; i++) {
        if (ag_bake_technique(context, gi, i, &desc.technique) != AG_OK || !desc.technique) break;
        if (ag_bake_create(r->scene, gi, &desc, &bakes[count]) != AG_OK) continue;
        if (finish_bake(bakes[count]))
            count++;
        else
            ag_bake_destroy(bakes[count]);
    }
    return count;
}

static bool make_renderer(struct render *r)
{
    static const char *const frame_options[] = { NULL, "shadow_size=256,rsm_size=64" };
    char gi[INPUT_SPEC_SIZE];
    struct ag_bake *bakes[MAX_BAKES] = { NULL };
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = 8 + input_choice(&r->in, 57);
    desc.height = 8 + input_choice(&r->in, 57);
    const uint8_t layers = input_byte(&r->in);
    desc.indirect_layer = layers & 1;
    desc.motion_layer = layers & 2;
    desc.id_layer = layers & 4;
    desc.frame_options = frame_options[!(layers & 8)];
    input_spec(&r->in, gi);
    desc.gi = gi;
    desc.bake_count = make_bakes(r, gi, bakes);
    desc.bakes = (const struct ag_bake *const *)bakes;
    const bool ok = ag_renderer_create(device, r->scene, &desc, &r->renderer) == AG_OK;
    for (int i = 0; i < desc.bake_count; i++) ag_bake_destroy(bakes[i]);
    if (getenv("FUZZ_RENDER_SHOW"))
        fprintf(stderr, "%dx%d %s: %s\n", desc.width, desc.height, gi,
                ok ? "renders" : ag_context_last_error(context));
    return ok;
}

// ---- frames

static void change_object(struct render *r)
{
    float matrix[16];
    input_matrix(&r->in, matrix);
    if (r->moved_count == 0) return;
    const int instance = r->moved[input_choice(&r->in, r->moved_count)];
    ag_scene_set_instance_transform(r->scene, instance, matrix);
}

static void change_light(struct render *r)
{
    struct ag_light_desc light;
    input_punctual(&r->in, &light);
    if (r->light >= 0)
        ag_scene_set_light(r->scene, r->light, &light);
    else
        ag_scene_add_light(r->scene, &light, &r->light);
}

static void change_scene(struct render *r)
{
    struct ag_material_desc material;
    float matrix[16], sky[3], positions[24];
    int instance;
    switch (input_choice(&r->in, 6)) {
    case 0:
        input_light(&r->in, sky);
        ag_scene_set_sky(r->scene, sky);
        break;
    case 1:
        input_material(&r->in, &material);
        ag_scene_set_material(r->scene, 0, &material);
        break;
    case 2:
        input_matrix(&r->in, matrix);
        ag_scene_add_instance(r->scene, r->mesh, matrix, &instance);
        break;
    case 3:
        ag_scene_remove_instance(r->scene, input_choice(&r->in, 8));
        break;
    case 4:
        for (int i = 0; i < 24; i++) positions[i] = input_number(&r->in);
        ag_scene_update_mesh(r->scene, r->mesh, positions, NULL);
        break;
    case 5:
        ag_renderer_resize(r->renderer, 8 + input_choice(&r->in, 57), 16);
        break;
    }
}

static void change(struct render *r)
{
    const uint8_t what = input_byte(&r->in);
    if (what & 1) change_object(r);
    if (what & 2) input_camera(&r->in, &r->frame.camera);
    if (what & 4) change_light(r);
    if (what & 8) change_scene(r);
    r->frame.camera_cut = what & 16;
}

static void check_layer(struct render *r, const char *layer)
{
    struct ag_image *image = NULL;
    if (ag_renderer_read(r->renderer, layer, &image) != AG_OK) return;
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(image->pixels[i])) continue;
        fprintf(stderr, "%s: value %zu is %g\n", layer, i, (double)image->pixels[i]);
        abort();
    }
    ag_image_destroy(context, image);
}

static void render_frames(struct render *r)
{
    ag_frame_desc_default(&r->frame);
    input_camera(&r->in, &r->frame.camera);
    r->frame.auto_exposure = input_bool(&r->in);
    for (int i = 0; i < FRAMES; i++) {
        if (i > 0) change(r);
        if (ag_renderer_render(r->renderer, &r->frame) != AG_OK) continue;
        for (int k = 0; ag_layer_name(k); k++) check_layer(r, ag_layer_name(k));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct render r = { .in = { data, size, 0 } };
    if (!open_device()) return 0;
    if (make_scene(&r) && make_renderer(&r)) render_frames(&r);
    ag_renderer_destroy(r.renderer);
    ag_scene_destroy(r.scene);
    FUZZ_CHECK(ag_device_validation_messages(device) == 0);
    return 0;
}
