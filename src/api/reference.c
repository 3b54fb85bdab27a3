// The path-traced reference: checks arguments and forwards to trace/.
#include "api/reference_state.h"

#include "core/option.h"
#include "image/exr.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

// The number changes with the sampling, so that older checkpoints are refused.
static const char CHECKPOINT_SAMPLING[] = "reference 3 ";

static struct ag_context *context_of(const struct ag_reference *r)
{
    return r ? r->context : NULL;
}

void ag_reference_desc_default(struct ag_reference_desc *desc)
{
    if (desc)
        *desc = (struct ag_reference_desc){ .width = 1280,
                                            .height = 720,
                                            .bounces = -1,
                                            .guiding = true,
                                            .obscurance_radius_m = 0.5f };
}

struct reference_options api_reference_options(const struct ag_reference_desc *desc)
{
    return (struct reference_options){ .bounces = desc->bounces,
                                       .direct_only = desc->direct_only,
                                       .indirect_only = desc->indirect_only,
                                       .guiding = desc->guiding,
                                       .antialias = desc->antialias,
                                       .obscurance_radius_m = desc->obscurance_radius_m,
                                       .occlusion_decay_per_m = desc->occlusion_decay_per_m,
                                       .obscurance_sphere = desc->obscurance_sphere,
                                       .seed = desc->seed };
}

static struct reference *build(const struct ag_scene *scene, const struct ag_reference_desc *desc)
{
    struct scene_pose pose = { 0 };
    if (!api_pose_at(scene, &pose, desc->animation, desc->time_s)) return NULL;
    const struct world_camera camera = api_camera(&desc->camera);
    const struct reference_options options = api_reference_options(desc);
    struct reference *reference = reference_create(&scene->context->host, &pose, &camera,
                                                   desc->width, desc->height, &options);
    pose_finish(&pose);
    return reference;
}

enum ag_result api_reference_check(const char *function, const struct ag_scene *scene,
                                   const struct ag_reference_desc *desc)
{
    struct ag_context *context = scene->context;
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context,
                   desc->width >= 1 && desc->width <= IMAGE_MAX_SIZE && desc->height >= 1 &&
                       desc->height <= IMAGE_MAX_SIZE,
                   "width and height must be 1 to %d, not %d and %d", IMAGE_MAX_SIZE, desc->width,
                   desc->height);
    AG_REQUIRE_FOR(function, context, desc->bounces >= -1, "bounces %d is less than -1",
                   desc->bounces);
    AG_REQUIRE_FOR(function, context, !(desc->direct_only && desc->indirect_only),
                   "direct_only and indirect_only exclude each other");
    AG_REQUIRE_FOR(function, context,
                   desc->obscurance_radius_m > 0.0f && isfinite(desc->obscurance_radius_m),
                   "obscurance_radius_m %g is not more than 0", (double)desc->obscurance_radius_m);
    AG_REQUIRE_FOR(function, context,
                   desc->occlusion_decay_per_m >= 0.0f && isfinite(desc->occlusion_decay_per_m),
                   "occlusion_decay_per_m %g is less than 0", (double)desc->occlusion_decay_per_m);
    AG_REQUIRE_FOR(function, context, api_animation_exists(scene, desc->animation),
                   "animation %d is not one of %d", desc->animation, scene->scene->animation_count);
    AG_REQUIRE_FOR(function, context, isfinite(desc->time_s), "time_s is not finite");
    return api_camera_check(context, function, &desc->camera);
}

enum ag_result api_reference_give(struct ag_scene *scene, struct reference *reference,
                                  struct ag_reference **out)
{
    struct host *host = &scene->context->host;
    struct ag_reference *r = reference ? host_alloc(host, 1, sizeof *r) : NULL;
    if (!r) {
        reference_destroy(reference);
        return api_done(scene->context, false);
    }
    *r = (struct ag_reference){ .context = scene->context, .scene = scene, .reference = reference };
    snprintf(r->checkpoint, sizeof r->checkpoint, "%s%016" PRIx64, CHECKPOINT_SAMPLING,
             reference_key(reference));
    api_scene_use(scene, &scene->references);
    *out = r;
    return api_done(scene->context, true);
}

enum ag_result ag_reference_create(struct ag_scene *scene, const struct ag_reference_desc *desc,
                                   struct ag_reference **out)
{
    struct ag_context *context = scene ? scene->context : NULL;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, scene);
    AG_REQUIRE_POINTER(context, desc);
    const enum ag_result checked = api_reference_check(__func__, scene, desc);
    if (checked != AG_OK) return checked;
    return api_reference_give(scene, build(scene, desc), out);
}

void ag_reference_destroy(struct ag_reference *r)
{
    if (!r) return;
    struct ag_scene *scene = r->scene;
    reference_destroy(r->reference);
    host_free(&r->context->host, r);
    api_scene_release(scene, &scene->references);
}

enum ag_result ag_reference_render(struct ag_reference *r, int samples,
                                   bool (*progress)(void *user, double done), void *user)
{
    struct ag_context *context = context_of(r);
    AG_REQUIRE(context, r, "reference is NULL");
    AG_REQUIRE(context, samples >= 1, "samples %d is less than 1", samples);
    return api_done(context, reference_render(r->reference, samples, progress, user));
}

const char *ag_reference_layer_name(int index)
{
    return reference_layer_name(index);
}

static bool fail_unknown(struct host *host, const char *name)
{
    const char *names[REFERENCE_LAYER_COUNT];
    for (int i = 0; i < REFERENCE_LAYER_COUNT; i++) names[i] = reference_layer_name(i);
    const char *nearest = nearest_name(name, names, REFERENCE_LAYER_COUNT);
    return host_fail(host, FAIL_ARGUMENT, "unknown layer %s of a reference: %s%s", name,
                     nearest ? "did you mean " : "see ag_reference_layer_name",
                     nearest ? nearest : "");
}

enum ag_result ag_reference_read(struct ag_reference *r, const char *layer, struct ag_image **out)
{
    struct ag_context *context = context_of(r);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, r, "reference is NULL");
    AG_REQUIRE_POINTER(context, layer);
    layer = api_layer_name(context, layer);
    int index = 0;
    while (index < REFERENCE_LAYER_COUNT && strcmp(reference_layer_name(index), layer) != 0)
        index++;
    if (index == REFERENCE_LAYER_COUNT)
        return api_done(context, fail_unknown(&context->host, layer));
    struct image image = { 0 };
    bool ok = reference_read(r->reference, (enum reference_layer)index, &image);
    return api_give_image(context, ok, &image, out);
}

enum ag_result ag_reference_get_info(const struct ag_reference *r, struct ag_reference_info *out)
{
    struct ag_context *context = context_of(r);
    AG_REQUIRE(context, r, "reference is NULL");
    AG_REQUIRE_POINTER(context, out);
    struct reference_info info = reference_info(r->reference);
    *out = (struct ag_reference_info){
        .samples = info.samples, .rays = info.rays, .mean = info.mean, .error = info.error
    };
    return AG_OK;
}

// ---- checkpoints

const char *ag_reference_checkpoint(const struct ag_reference *r)
{
    return r ? r->checkpoint : "";
}

// Why a file with this value is not continued. value NULL: none.
static const char *checkpoint_difference(const char *value)
{
    bool known = value && strncmp(value, CHECKPOINT_SAMPLING, strlen(CHECKPOINT_SAMPLING)) == 0;
    return !value || known ? "its scene, lights, camera, size or options differ"
                           : "another version of the path tracer took its samples; render it again";
}

static bool checkpoint_matches(struct ag_reference *r, const char *path)
{
    struct host *host = &r->context->host;
    char *value = exr_attribute_value(host, path, AG_REFERENCE_CHECKPOINT);
    bool same = value && strcmp(value, r->checkpoint) == 0;
    const char *why = checkpoint_difference(value);
    host_free(host, value);
    if (same || host->failure != FAIL_NONE) return same;
    return host_fail(host, FAIL_ARGUMENT, "cannot resume %s: %s", path, why);
}

static bool resume(struct ag_reference *r, const char *path)
{
    struct host *host = &r->context->host;
    struct image layers[REFERENCE_KEPT_COUNT] = { 0 };
    host->failure = FAIL_NONE;
    bool ok = checkpoint_matches(r, path);
    for (int i = 0; i < REFERENCE_KEPT_COUNT && ok; i++)
        ok = api_read_layer(r->context, path, reference_layer_name(reference_kept_layers[i]),
                            &layers[i]);
    ok = ok && reference_restore(r->reference, layers);
    for (int i = 0; i < REFERENCE_KEPT_COUNT; i++) image_finish(&layers[i], host);
    return ok;
}

enum ag_result ag_reference_resume(struct ag_reference *r, const char *path)
{
    struct ag_context *context = context_of(r);
    AG_REQUIRE(context, r, "reference is NULL");
    AG_REQUIRE(context, path && path[0], "path is empty");
    return api_done(context, resume(r, path));
}
