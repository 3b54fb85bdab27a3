#include "paper_dnrt/view.h"

#include "bakes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float RADII = 2.0f; // pixels this near to an object count

// ---- objects and masks

static void place(const struct ag_instance_info *instance, const struct ag_mesh_info *mesh,
                  struct dnrt_object *out)
{
    const float *m = instance->world_from_mesh;
    float centre[3], longest = 0.0f;
    for (int i = 0; i < 3; i++) {
        centre[i] = 0.5f * (mesh->bounds_min[i] + mesh->bounds_max[i]);
        longest = fmaxf(longest, mesh->bounds_max[i] - mesh->bounds_min[i]);
    }
    for (int i = 0; i < 3; i++)
        out->centre[i] = m[i] * centre[0] + m[4 + i] * centre[1] + m[8 + i] * centre[2] + m[12 + i];
    out->radius = 0.5f * longest * sqrtf(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
}

static enum ag_result find_objects(struct dnrt_view *view)
{
    struct ag_scene_info scene;
    enum ag_result result = ag_scene_get_info(view->scene, 0, 0.0, &scene);
    for (int i = 0; i < scene.instances && result == AG_OK; i++) {
        struct ag_instance_info instance;
        struct ag_mesh_info mesh;
        result = ag_scene_get_instance(view->scene, i, 0, 0.0, &instance);
        if (result != AG_OK || instance.mesh < 0 || instance.mobility != AG_MOBILITY_MOVABLE ||
            view->object_count == DNRT_MAX_OBJECTS)
            continue;
        result = ag_scene_get_mesh(view->scene, instance.mesh, &mesh);
        struct dnrt_object *object = &view->objects[view->object_count++];
        object->instance = i;
        place(&instance, &mesh, object);
    }
    return result;
}

static bool is_near(const struct dnrt_view *view, const float *position)
{
    for (int o = 0; o < view->object_count; o++) {
        const struct dnrt_object *object = &view->objects[o];
        float square = 0.0f;
        for (int i = 0; i < 3; i++)
            square += (position[i] - object->centre[i]) * (position[i] - object->centre[i]);
        if (square <= RADII * RADII * object->radius * object->radius) return true;
    }
    return false;
}

// Renders with ids, which the reference does not have.
static enum ag_result read_ids(const struct dnrt_view *view, struct ag_image **out)
{
    struct ag_renderer_desc desc;
    struct ag_renderer *renderer = NULL;
    ag_renderer_desc_default(&desc);
    desc.width = view->width;
    desc.height = view->height;
    desc.gi = "none";
    desc.id_layer = true;
    enum ag_result result = ag_renderer_create(view->bench->device, view->scene, &desc, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &view->frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "id", out);
    ag_renderer_destroy(renderer);
    return result;
}

static bool is_object(const struct dnrt_view *view, float instance)
{
    for (int o = 0; o < view->object_count; o++)
        if (view->objects[o].instance == (int)instance) return true;
    return false;
}

static enum ag_result make_masks(struct dnrt_view *view)
{
    struct ag_context *context = view->bench->context;
    struct ag_image *ids = NULL;
    enum ag_result result = read_ids(view, &ids);
    if (result == AG_OK)
        result = ag_image_create(context, view->width, view->height, 1, &view->near);
    if (result == AG_OK)
        result = ag_image_create(context, view->width, view->height, 1, &view->around);
    for (int i = 0; i < view->width * view->height && result == AG_OK; i++) {
        const float instance = ids->pixels[2 * i];
        if (instance < 0.0f || !is_near(view, view->position->pixels + 3 * i)) continue;
        view->near->pixels[i] = 1.0f;
        view->around->pixels[i] = is_object(view, instance) ? 0.0f : 1.0f;
    }
    ag_image_destroy(context, ids);
    return result;
}

// ---- the view

enum ag_result dnrt_view_trace(struct dnrt_view *view, struct ag_image **out,
                               struct ag_image **out_position)
{
    struct ag_reference_desc desc;
    struct ag_reference *reference = NULL;
    struct ag_reference_info info;
    ag_reference_desc_default(&desc);
    desc.width = view->width;
    desc.height = view->height;
    desc.camera = view->frame.camera;
    enum ag_result result = ag_reference_create(view->scene, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, view->spp, NULL, NULL);
    if (result == AG_OK) result = ag_reference_read(reference, "indirect_emitters_sky", out);
    if (result == AG_OK && out_position)
        result = ag_reference_read(reference, "position", out_position);
    if (result == AG_OK) result = ag_reference_get_info(reference, &info);
    if (result == AG_OK) view->noise = info.error / info.mean;
    ag_reference_destroy(reference);
    return result;
}

enum ag_result dnrt_view_open_scene(struct dnrt_view *view, struct ag_scene *scene)
{
    view->scene = scene;
    enum ag_result result = find_objects(view);
    if (view->spp == 0) return result;
    if (result == AG_OK) result = dnrt_view_trace(view, &view->reference, &view->position);
    if (result == AG_OK) result = make_masks(view);
    return result;
}

enum ag_result dnrt_view_open(struct dnrt_view *view, const char *name, const char *camera)
{
    struct ag_scene *scene = NULL;
    enum ag_result result = bench_open_scene(view->bench, name, &scene, &view->frame);
    view->scene = scene;
    if (result == AG_OK && camera)
        result = ag_scene_camera(scene, camera, 0, 0.0, &view->frame.camera);
    return result == AG_OK ? dnrt_view_open_scene(view, scene) : result;
}

void dnrt_view_close(struct dnrt_view *view)
{
    struct ag_image *images[] = { view->reference, view->position, view->near, view->around };
    for (int i = 0; i < 4; i++) ag_image_destroy(view->bench->context, images[i]);
    ag_scene_destroy(view->scene);
}

// ---- errors

enum ag_result dnrt_view_render(const struct dnrt_view *view, const char *gi,
                                struct ag_image **indirect)
{
    struct ag_renderer_desc desc;
    struct ag_renderer *renderer = NULL;
    struct bench_bakes bakes;
    ag_renderer_desc_default(&desc);
    desc.width = view->width;
    desc.height = view->height;
    desc.gi = gi;
    desc.indirect_layer = true;
    enum ag_result result = bench_bakes_prepare(&bakes, view->bench->context, view->scene, gi);
    desc.bakes = bakes.bakes;
    desc.bake_count = bakes.count;
    if (result == AG_OK)
        result = ag_renderer_create(view->bench->device, view->scene, &desc, &renderer);
    bench_bakes_finish(&bakes);
    for (int f = 0; f < 2 && result == AG_OK; f++)
        result = ag_renderer_render(renderer, &view->frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "indirect", indirect);
    ag_renderer_destroy(renderer);
    return result;
}

static enum ag_result measure(const struct dnrt_view *view, const struct ag_image *image,
                              const struct ag_image *mask, struct ag_metrics *out)
{
    struct ag_compare_desc desc;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = ag_image_auto_exposure(view->reference);
    desc.mask = mask;
    return ag_image_metrics(view->bench->context, image, view->reference, &desc, out);
}

enum ag_result dnrt_view_errors(const struct dnrt_view *view, struct dnrt_method *method)
{
    struct ag_image *image = NULL;
    if (view->spp == 0) return AG_OK;
    enum ag_result result = dnrt_view_render(view, method->gi, &image);
    if (result == AG_OK) result = measure(view, image, view->near, &method->near);
    if (result == AG_OK) result = measure(view, image, view->around, &method->around);
    ag_image_destroy(view->bench->context, image);
    return result;
}

// ---- times

struct samples {
    const struct dnrt_view *view;
    struct dnrt_method *methods;
    int count, frame;
    bool new_light; // in each frame
    enum ag_result result;
};

// By a hundredth, to and fro.
static enum ag_result change_lights(const struct dnrt_view *view, bool up)
{
    struct ag_scene_info scene;
    enum ag_result result = ag_scene_get_info(view->scene, 0, 0.0, &scene);
    for (int i = 0; i < scene.lights && result == AG_OK; i++) {
        struct ag_light_info info;
        result = ag_scene_get_light(view->scene, i, 0, 0.0, &info);
        for (int c = 0; c < 3; c++) info.light.intensity[c] *= up ? 1.01f : 1.0f / 1.01f;
        if (result == AG_OK) result = ag_scene_set_light(view->scene, i, &info.light);
    }
    return result;
}

static void end_frame(struct samples *samples)
{
    samples->frame++;
    if (!samples->new_light) return;
    const enum ag_result result = change_lights(samples->view, samples->frame % 2 == 1);
    if (samples->result == AG_OK) samples->result = result;
}

static void add_sample(void *user, int index, const struct ag_timing *timings, int count)
{
    static const char *const names[DNRT_STAGES] = { "light", "volumes", "apply" };
    struct samples *samples = user;
    struct dnrt_method *method = &samples->methods[index];
    const bool is_first = samples->frame == 0;
    if (index == samples->count - 1) end_frame(samples);
    if (samples->new_light && is_first) return; // its light is that of the frame before
    double sum = 0.0, stages[DNRT_STAGES] = { 0 };
    for (int i = 0; i < count && method->term[0]; i++) {
        const char *stage = passes_stage(timings[i].name, method->term);
        if (!stage) continue;
        sum += timings[i].ms;
        for (int s = 0; s < DNRT_STAGES; s++)
            if (strcmp(stage, names[s]) == 0) stages[s] = timings[i].ms;
    }
    passes_keep_least(&method->ms, sum);
    for (int s = 0; s < DNRT_STAGES; s++) passes_keep_least(&method->stage_ms[s], stages[s]);
}

enum ag_result dnrt_view_times(const struct dnrt_view *view, bool new_light,
                               struct dnrt_method *methods, int count)
{
    struct ag_renderer *renderers[DNRT_MAX_METHODS] = { NULL };
    struct samples samples = { view, methods, count, 0, new_light, AG_OK };
    enum ag_result result = AG_OK;
    for (int m = 0; m < count && result == AG_OK; m++)
        result =
            bench_create_renderer(view->bench, view->scene, methods[m].gi, NULL, &renderers[m]);
    if (result == AG_OK)
        result = passes_alternate(renderers, count, &view->frame, view->bench->frames, add_sample,
                                  &samples);
    for (int m = 0; m < count; m++) ag_renderer_destroy(renderers[m]);
    return result == AG_OK ? samples.result : result;
}
