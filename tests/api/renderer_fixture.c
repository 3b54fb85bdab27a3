#include "api/renderer_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

char fixture_last_warning[512];

static void listen(void *user, enum ag_log_level level, const char *message)
{
    (void)user;
    if (level <= AG_LOG_WARNING)
        snprintf(fixture_last_warning, sizeof fixture_last_warning, "%s", message);
}

struct ag_device_adopt fixture_lend(struct own_device *own)
{
    return (struct ag_device_adopt){ .instance = own->instance,
                                     .physical_device = own->physical,
                                     .device = own->device,
                                     .queue = own->queue,
                                     .queue_family = own->family,
                                     .lock_queue = own_device_lock,
                                     .unlock_queue = own_device_unlock,
                                     .user = own };
}

struct ag_context *fixture_context(void)
{
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    ag_context_desc_default(&desc);
    desc.log = listen;
    assert_int_equal(ag_context_create(&desc, &context), AG_OK);
    return context;
}

struct ag_renderer_desc fixture_renderer_desc(const char *gi)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = FIXTURE_WIDTH;
    desc.height = FIXTURE_HEIGHT;
    desc.gi = gi;
    desc.frame_options = "shadow_size=256,rsm_size=64";
    desc.indirect_layer = true;
    desc.motion_layer = true;
    return desc;
}

// The device of all tests of a program, one after the other: it keeps its pipelines.
static struct {
    struct ag_context *context;
    struct ag_device *device;
    bool used; // also by a test that failed
    int messages;
} shared_device;

static bool kept_end(void)
{
    ag_device_destroy(shared_device.device);
    ag_context_destroy(shared_device.context);
    return true;
}

static void open_device(struct renderer_fixture *s, const struct ag_device_adopt *adopt)
{
    // Hazards between submissions, which the layer leaves out unless told otherwise.
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
           0);
    struct ag_device_desc device;
    ag_device_desc_default(&device);
    device.validation = !adopt || ((const struct own_device *)adopt->user)->validation;
    device.adopt = adopt;
    s->context = fixture_context();
    assert_int_equal(ag_device_create(s->context, &device, &s->device), AG_OK);
}

static void open_kept_device(struct renderer_fixture *s)
{
    if (!shared_device.device) {
        open_device(s, NULL);
        shared_device.context = s->context;
        shared_device.device = s->device;
        test_register_end(kept_end);
    }
    shared_device.used = true;
    shared_device.messages = ag_device_validation_messages(shared_device.device);
    s->context = shared_device.context;
    s->device = shared_device.device;
}

static struct renderer_fixture open_fixture(const char *gi, const struct ag_device_adopt *adopt,
                                            bool keep)
{
    test_gpu_require();
    struct renderer_fixture s = { 0 };
    if (keep && !shared_device.used)
        open_kept_device(&s);
    else
        open_device(&s, adopt);
    assert_int_equal(ag_scene_load(s.context, "@cornell:light=point", &s.scene), AG_OK);
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    if (ag_renderer_create(s.device, s.scene, &desc, &s.renderer) != AG_OK)
        fail_msg("%s", ag_context_last_error(s.context));
    ag_frame_desc_default(&s.frame);
    assert_int_equal(ag_scene_camera(s.scene, "main", 0, 0, &s.frame.camera), AG_OK);
    return s;
}

struct renderer_fixture fixture_open(const char *gi, const struct ag_device_adopt *adopt)
{
    return open_fixture(gi, adopt, !adopt);
}

struct renderer_fixture fixture_open_alone(const char *gi)
{
    return open_fixture(gi, NULL, false);
}

void fixture_close(struct renderer_fixture *s)
{
    const bool keep = s->device == shared_device.device;
    ag_renderer_destroy(s->renderer);
    if (ag_device_validation_messages(s->device) > (keep ? shared_device.messages : 0))
        fail_msg("validation says: %s", fixture_last_warning);
    ag_scene_destroy(s->scene);
    if (keep) shared_device.used = false;
    if (keep) return;
    ag_device_destroy(s->device);
    ag_context_destroy(s->context);
}

struct ag_image *fixture_read(struct renderer_fixture *s, const char *layer)
{
    struct ag_image *image = NULL;
    if (ag_renderer_read(s->renderer, layer, &image) != AG_OK)
        fail_msg("%s: %s", layer, ag_context_last_error(s->context));
    return image;
}

struct renderer_fixture fixture_open_lit(const char *gi)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    const float sky[3] = { 300, 400, 500 };
    assert_int_equal(ag_scene_set_sky(s.scene, sky), AG_OK);
    struct ag_area_light_desc emitter;
    ag_area_light_desc_default(&emitter);
    assert_int_equal(ag_scene_add_area_light(s.scene, &emitter, NULL), AG_OK);
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    if (gi) assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    return s;
}

double fixture_difference(const struct ag_image *a, const struct ag_image *b)
{
    double sum = 0, mean = 0;
    for (int i = 0; i < b->width * b->height * b->channels; i++) {
        sum += fabs((double)a->pixels[i] - (double)b->pixels[i]);
        mean += fabs((double)b->pixels[i]);
    }
    return sum > 0 ? sum / mean : 0.0;
}

struct ag_layer_handle fixture_layer(struct renderer_fixture *s, struct ag_renderer *renderer,
                                     const char *name)
{
    struct ag_layer_handle handle;
    if (ag_renderer_layer_handle(renderer, name, &handle) != AG_OK)
        fail_msg("%s: %s", name, ag_context_last_error(s->context));
    return handle;
}

struct ag_image *fixture_read_from(struct renderer_fixture *s, struct ag_renderer *renderer,
                                   const char *layer)
{
    struct ag_image *image = NULL;
    if (ag_renderer_read(renderer, layer, &image) != AG_OK)
        fail_msg("%s: %s", layer, ag_context_last_error(s->context));
    return image;
}

void fixture_print_base(int technique, const struct ag_technique_info *info, char *out)
{
    struct ag_option_info o;
    const bool added =
        strcmp(info->role, "visibility") == 0 || strcmp(info->role, "reflection") == 0;
    size_t used = (size_t)snprintf(out, FIXTURE_SPEC, "%s%s", added ? "ambient+" : "", info->name);
    char separator = ':';
    for (int k = 0; ag_technique_option_get(technique, k, &o); k++) {
        if (strcmp(o.effect, "rebake") != 0 || strcmp(o.type, "int") != 0) continue;
        used += (size_t)snprintf(out + used, FIXTURE_SPEC - used, "%c%s=%d", separator, o.name,
                                 (int)o.min);
        separator = ',';
    }
}

bool fixture_print_variant(int technique, const struct ag_technique_info *info, int index,
                           char *out)
{
    struct ag_option_info o;
    fixture_print_base(technique, info, out);
    if (index == 0) return true;
    const size_t used = strlen(out);
    for (int k = 0; index == 1 && ag_technique_option_get(technique, k, &o); k++)
        if (strcmp(o.name, "temporal") == 0) {
            snprintf(out + used, FIXTURE_SPEC - used, "%ctemporal=true",
                     strchr(out, ':') ? ',' : ':');
            return true;
        }
    return false;
}

bool fixture_is_software(const struct renderer_fixture *s)
{
    struct ag_device_info info;
    ag_device_get_info(s->device, &info);
    return info.software;
}

struct ag_bake *fixture_bake(struct renderer_fixture *s, const char *gi,
                             const struct ag_technique_info *info)
{
    struct ag_bake *bake = NULL;
    if (!info->needs_bake) return NULL;
    assert_int_equal(ag_bake_create(s->scene, gi, NULL, &bake), AG_OK);
    struct ag_bake_info kept;
    assert_int_equal(ag_bake_get_info(bake, &kept), AG_OK);
    const char *path = test_bake_path(kept.key);
    if (access(path, R_OK) == 0) {
        assert_int_equal(ag_bake_load(bake, path), AG_OK);
        return bake;
    }
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(ag_bake_save(bake, path, false), AG_OK);
    return bake;
}
