// A reference whose samples a bake traces: checks arguments and forwards to reference/.
#include "api/bake_state.h"
#include "api/reference_state.h"

static bool build(struct ag_bake *b, const struct ag_reference_desc *of, int samples)
{
    struct host *host = &b->context->host;
    if (!api_pose_at(b->scene, &b->pose, of->animation, of->time_s)) return false;
    b->traced = (struct reference_bake){ .pose = &b->pose,
                                         .camera = api_camera(&of->camera),
                                         .width = of->width,
                                         .height = of->height,
                                         .samples = samples,
                                         .options = api_reference_options(of) };
    char *options = reference_bake_options(host, &b->traced);
    const struct bake_identity identity = { .technique = REFERENCE_BAKE_NAME,
                                            .version = REFERENCE_BAKE_VERSION,
                                            .options = options,
                                            .seed = of->seed,
                                            .program = api_program(),
                                            .scene_name = b->scene->scene->name,
                                            .scene_scale = b->scene->scene->scale,
                                            .of_light = true };
    b->bake = options ? bake_create(host, &identity) : NULL;
    host_free(host, options);
    return b->bake && reference_add_stages(bake_plan_of(b->bake), &b->traced);
}

static bool is_of_technique(const struct ag_bake_desc *desc)
{
    return desc->technique || desc->lightmap_samples > 0 || desc->update_folder ||
           desc->all_objects || desc->full_report;
}

enum ag_result ag_bake_create_reference(struct ag_scene *scene, const struct ag_reference_desc *of,
                                        int samples, const struct ag_bake_desc *desc,
                                        struct ag_bake **out)
{
    struct ag_context *context = scene ? scene->context : NULL;
    struct ag_bake_desc fallback;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, scene);
    AG_REQUIRE_POINTER(context, of);
    ag_bake_desc_default(&fallback);
    if (!desc) desc = &fallback;
    AG_REQUIRE(context, samples >= 1, "samples %d is less than 1", samples);
    enum ag_result result = api_reference_check(__func__, scene, of);
    if (result == AG_OK) result = api_bake_check(__func__, scene, desc);
    if (result != AG_OK) return result;
    AG_REQUIRE(context, !is_of_technique(desc),
               "technique, lightmap_samples, update_folder, all_objects and full_report are of "
               "other bakes");
    struct ag_bake *b = host_alloc(&context->host, 1, sizeof *b);
    if (!b) return api_done(context, false);
    b->context = context;
    b->scene = scene;
    b->options = api_bake_run_options(desc);
    api_scene_use(scene, &scene->bakes);
    const bool ok = build(b, of, samples);
    result = api_done(context, ok);
    if (ok)
        *out = b;
    else
        ag_bake_destroy(b);
    return result;
}

enum ag_result ag_reference_from_bake(const struct ag_bake *bake, struct ag_reference **out)
{
    struct ag_context *context = bake ? bake->context : NULL;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, bake, "bake is NULL");
    AG_REQUIRE(context, api_bake_is_reference(bake),
               "the bake is of no reference: see ag_bake_create_reference");
    AG_REQUIRE(context, bake_is_complete(bake->bake), "the bake is incomplete: run it first");
    return api_reference_give(
        bake->scene, reference_of_bake(&context->host, &bake->traced, bake_tensors(bake->bake)),
        out);
}
