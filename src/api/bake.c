// Bakes: checks arguments and forwards to bake/ and the techniques.
#include "api/bake_state.h"

#include "core/c_locale.h"
#include "core/parallel.h"
#include "lightmap/lightmap.h"
#include "scene/rescale.h"
#include "techniques/gi_bake.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static const double CHECKPOINT_EVERY_S = 30.0;
enum { TECHNIQUE_NAME = 32, MOST_SAMPLES = 1000000 };
// Versions of the charts, in that of a light map.
enum { LIGHTMAP_VERSIONS = 10000 };
// At the end of its options.
#define NOISE   ",noise="
#define SAMPLES ",samples="
enum { NOISE_UNITS = 1000000 };

const char *api_program(void)
{
    return AG_VERSION_STRING;
}

static struct ag_context *context_of(const struct ag_bake *b)
{
    return b ? b->context : NULL;
}

void ag_bake_desc_default(struct ag_bake_desc *desc)
{
    if (desc) *desc = (struct ag_bake_desc){ .checkpoint_every_s = CHECKPOINT_EVERY_S };
}

// The index-th technique of the spec that bakes; *out is NULL past the last.
static enum ag_result find_technique(const char *function, struct ag_context *context,
                                     const char *gi, int index, const struct technique **out)
{
    *out = NULL;
    AG_REQUIRE_FOR(function, context, gi, "gi is NULL");
    AG_REQUIRE_FOR(function, context, index >= 0, "index %d is negative", index);
    struct gi_spec spec;
    int term = -1;
    const bool ok = gi_spec_parse(&spec, &context->host, gi);
    if (ok) gi_spec_bakes(&spec, index, &term);
    if (term >= 0) *out = spec.technique[term];
    gi_spec_finish(&spec);
    return api_done(context, ok);
}

enum ag_result ag_bake_technique(struct ag_context *context, const char *gi, int index,
                                 const char **name)
{
    AG_REQUIRE_OUT(context, name);
    AG_REQUIRE_POINTER(context, context);
    const struct technique *found;
    const enum ag_result result = find_technique(__func__, context, gi, index, &found);
    if (found) *name = found->name;
    return result;
}

enum ag_result ag_bake_technique_in_file(struct ag_context *context, const char *gi, int index,
                                         const char **name)
{
    AG_REQUIRE_OUT(context, name);
    AG_REQUIRE_POINTER(context, context);
    const struct technique *found;
    const enum ag_result result = find_technique(__func__, context, gi, index, &found);
    if (found) *name = gi_bake_name(found);
    return result;
}

enum ag_result ag_bake_file_technique(struct ag_context *context, const char *path, char name[32])
{
    AG_REQUIRE_POINTER(context, name);
    name[0] = 0;
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, path && path[0], "path is empty");
    return api_done(context, bake_file_technique(&context->host, path, name, TECHNIQUE_NAME));
}

// ---- creation

// The term of the spec that is to be baked.
static bool find_term(struct ag_bake *b, const char *gi, const char *technique)
{
    struct host *host = &b->context->host;
    const int count = gi_spec_bakes(&b->spec, 0, &b->term);
    if (count == 0) return host_fail(host, FAIL_ARGUMENT, "cannot bake %s: it needs no bake", gi);
    if (count > 1 && !technique)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot bake %s: several of its techniques bake; name one of them", gi);
    for (int i = 0; technique && i < count; i++) {
        gi_spec_bakes(&b->spec, i, &b->term);
        if (strcmp(b->spec.technique[b->term]->name, technique) == 0) return true;
    }
    return !technique ||
           host_fail(host, FAIL_ARGUMENT, "cannot bake %s: it has no technique %s that bakes", gi,
                     technique);
}

struct bake_run_options api_bake_run_options(const struct ag_bake_desc *desc)
{
    return (struct bake_run_options){ .threads = desc->threads,
                                      .shard = desc->shard,
                                      .shard_count = desc->shard_count,
                                      .checkpoint_every_s = desc->checkpoint_every_s,
                                      .max_memory_bytes = desc->max_memory_bytes };
}

static char *lightmap_options(const struct ag_bake *b, const char *options)
{
    struct host *host = &b->context->host;
    if (!(b->lightmap_noise > 0.0f))
        return host_sprintf(host, "%s" SAMPLES "%d", options, b->lightmap_samples);
    return host_sprintf(host, "%s" NOISE "%ld" SAMPLES "%d", options,
                        lround((double)b->lightmap_noise * NOISE_UNITS), b->lightmap_samples);
}

static bool add_lightmap_stages(struct ag_bake *b, struct bake_plan *plan, const char *update,
                                const char *options)
{
    if (update) return api_update_add_stages(b, plan, update, options);
    const struct lightmap_bake how = { .pose = &b->pose,
                                       .samples = b->lightmap_samples,
                                       .noise = b->lightmap_noise,
                                       .charts = b->spec.technique[b->term]->charts,
                                       .options = b->spec.options[b->term] };
    return lightmap_add_stages(plan, &how, &b->charts);
}

// The light map's texels are the technique's; a path needs none of its other data.
static struct bake *create_lightmap(struct ag_bake *b, struct bake_identity identity,
                                    const char *update)
{
    struct host *host = &b->context->host;
    const struct technique *technique = b->spec.technique[b->term];
    char *options = gi_bake_options(host, technique, b->spec.options[b->term]);
    char *text = options ? lightmap_options(b, options) : NULL;
    identity.technique = LIGHTMAP_NAME;
    identity.version = LIGHTMAP_VERSION * LIGHTMAP_VERSIONS + technique->bake_version;
    identity.options = text;
    identity.of_light = true;
    b->lightmap_version = identity.version;
    b->seed = identity.seed;
    struct bake *bake = text ? bake_create(host, &identity) : NULL;
    if (bake && !add_lightmap_stages(b, bake_plan_of(bake), update, text)) {
        bake_destroy(bake);
        bake = NULL;
    }
    host_free(host, options);
    host_free(host, text);
    return bake;
}

static bool build(struct ag_bake *b, const char *gi, const struct ag_bake_desc *desc)
{
    struct host *host = &b->context->host;
    if (!gi_spec_parse(&b->spec, host, gi) || !find_term(b, gi, desc->technique)) return false;
    b->lightmap_samples = desc->lightmap_samples;
    b->lightmap_noise =
        (float)(round((double)desc->lightmap_noise * NOISE_UNITS) / NOISE_UNITS); // as in its key
    if (b->lightmap_samples > 0 &&
        !technique_has_light_map(b->spec.technique[b->term], b->spec.options[b->term]))
        return host_fail(host, FAIL_ARGUMENT, "cannot bake %s: it has no light map", gi);
    if (desc->all_objects && b->spec.technique[b->term]->role != ROLE_DELTA)
        return host_fail(host, FAIL_ARGUMENT, "cannot bake objects of %s: it bakes none",
                         b->spec.technique[b->term]->name);
    b->options = api_bake_run_options(desc);
    if (!api_pose_at(b->scene, &b->pose, desc->animation, desc->time_s)) return false;
    if (!gi_bake_resolve(host, b->spec.technique[b->term], &b->pose, b->spec.options[b->term]))
        return false;
    b->how = (struct technique_bake){ .pose = &b->pose,
                                      .options = b->spec.options[b->term],
                                      .full_report = desc->full_report,
                                      .all_objects = desc->all_objects };
    char *text = gi_spec_print(&b->spec);
    const struct bake_identity identity = { .seed = desc->seed,
                                            .program = api_program(),
                                            .gi = text,
                                            .scene_name = b->scene->scene->name,
                                            .scene_scale = b->scene->scene->scale };
    if (text && b->lightmap_samples > 0)
        b->bake = create_lightmap(b, identity, desc->update_folder);
    else if (text)
        b->bake = gi_bake_create(host, b->spec.technique[b->term], &b->how, identity);
    host_free(host, text);
    return b->bake != NULL;
}

enum ag_result api_bake_check(const char *function, const struct ag_scene *scene,
                              const struct ag_bake_desc *desc)
{
    struct ag_context *context = scene->context;
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context, desc->threads >= 0, "threads %d is negative", desc->threads);
    AG_REQUIRE_FOR(function, context, desc->shard_count >= 0, "shard_count %d is negative",
                   desc->shard_count);
    AG_REQUIRE_FOR(function, context,
                   desc->shard_count == 0 || (desc->shard >= 0 && desc->shard < desc->shard_count),
                   "shard %d is not one of %d", desc->shard, desc->shard_count);
    AG_REQUIRE_FOR(function, context,
                   desc->lightmap_samples >= 0 && desc->lightmap_samples <= MOST_SAMPLES,
                   "lightmap_samples %d is not 0 to %d", desc->lightmap_samples, MOST_SAMPLES);
    AG_REQUIRE_FOR(function, context, desc->lightmap_noise >= 0.0f && desc->lightmap_noise < 1.0f,
                   "lightmap_noise %g is not 0 to 1", (double)desc->lightmap_noise);
    AG_REQUIRE_FOR(function, context,
                   desc->lightmap_noise == 0.0f || desc->lightmap_samples >= LIGHTMAP_LEAST_PATHS,
                   "lightmap_noise requires lightmap_samples of at least %d, the most paths of a "
                   "texel",
                   LIGHTMAP_LEAST_PATHS);
    AG_REQUIRE_FOR(function, context, !desc->update_folder || desc->lightmap_samples > 0,
                   "update_folder is of a light map: set lightmap_samples");
    AG_REQUIRE_FOR(function, context, !desc->update_folder || desc->shard_count == 0,
                   "an update has no shards");
    AG_REQUIRE_FOR(function, context, !desc->update_folder || desc->lightmap_noise == 0.0f,
                   "an update has one number of paths: lightmap_noise is not 0");
    AG_REQUIRE_FOR(function, context, desc->checkpoint_every_s >= 0.0,
                   "checkpoint_every_s is negative");
    AG_REQUIRE_FOR(function, context, api_animation_exists(scene, desc->animation),
                   "animation %d is not one of %d", desc->animation, scene->scene->animation_count);
    AG_REQUIRE_FOR(function, context, isfinite(desc->time_s), "time_s is not finite");
    return AG_OK;
}

enum ag_result ag_bake_create(struct ag_scene *scene, const char *gi,
                              const struct ag_bake_desc *desc, struct ag_bake **out)
{
    struct ag_context *context = scene ? scene->context : NULL;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, scene);
    AG_REQUIRE_POINTER(context, gi);
    struct ag_bake_desc fallback;
    ag_bake_desc_default(&fallback);
    if (!desc) desc = &fallback;
    enum ag_result checked = api_bake_check(__func__, scene, desc);
    if (checked != AG_OK) return checked;

    struct ag_bake *b = host_alloc(&context->host, 1, sizeof *b);
    if (!b) return api_done(context, false);
    b->context = context;
    b->scene = scene;
    api_scene_use(scene, &scene->bakes);
    const bool ok = build(b, gi, desc);
    enum ag_result result = api_done(context, ok);
    if (ok)
        *out = b;
    else
        ag_bake_destroy(b);
    return result;
}

void ag_bake_destroy(struct ag_bake *b)
{
    if (!b) return;
    struct host *host = &b->context->host;
    struct ag_scene *scene = b->scene;
    report_destroy(b->report);
    bake_destroy(b->bake);
    pose_finish(&b->pose);
    gi_spec_finish(&b->spec);
    host_free(host, b->checkpoint);
    host_free(host, b);
    api_scene_release(scene, &scene->bakes);
}

// ---- work

enum ag_result ag_bake_estimate_cost(struct ag_bake *b, bool probe, struct ag_bake_estimate *out)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE_POINTER(context, out);
    struct bake_estimate estimate;
    const bool ok = bake_estimate(b->bake, &b->options, probe, &estimate);
    *out = (struct ag_bake_estimate){ .texels = estimate.texels,
                                      .rays = estimate.rays,
                                      .seconds = estimate.seconds,
                                      .file_bytes = estimate.file_bytes,
                                      .peak_memory_bytes = estimate.peak_memory_bytes,
                                      .charts = estimate.light_map.charts,
                                      .texels_per_m = estimate.light_map.texels_per_m,
                                      .utilisation = estimate.light_map.utilisation };
    return api_done(context, ok);
}

enum ag_result ag_bake_estimate(struct ag_bake *b, bool probe, struct ag_bake_estimate *out)
{
    return ag_bake_estimate_cost(b, probe, out);
}

struct listener {
    bool (*progress)(void *user, const struct ag_bake_progress *progress);
    void *user;
};

static bool tell(void *user, const struct bake_progress *p)
{
    const struct listener *listener = user;
    const struct ag_bake_progress progress = {
        .stage = p->stage, .done = p->done, .seconds_left = p->seconds_left, .stopping = p->stopping
    };
    return listener->progress(listener->user, &progress);
}

static enum ag_result run(struct ag_bake *b, const struct bake_team *team,
                          bool (*progress)(void *user, const struct ag_bake_progress *progress),
                          void *user)
{
    struct listener listener = { progress, user };
    struct bake_run_options options = b->options;
    options.team = team;
    if (progress) {
        options.progress = tell;
        options.user = &listener;
    }
    return api_done(b->context, bake_run(b->bake, &options));
}

enum ag_result ag_bake_run(struct ag_bake *b,
                           bool (*progress)(void *user, const struct ag_bake_progress *progress),
                           void *user)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    return run(b, NULL, progress, user);
}

void ag_bake_team_default(struct ag_bake_team *team)
{
    if (team) *team = (struct ag_bake_team){ .count = 1 };
}

static bool send_to(void *user, int to, const void *data, size_t bytes)
{
    const struct ag_bake_team *team = user;
    return team->send(team->user, to, data, bytes);
}

static enum bake_news receive_from(void *user, int *from, const void **data, size_t *bytes)
{
    const struct ag_bake_team *team = user;
    return (enum bake_news)team->receive(team->user, from, data, bytes);
}

enum ag_result
ag_bake_run_team(struct ag_bake *b, const struct ag_bake_team *team,
                 bool (*progress)(void *user, const struct ag_bake_progress *progress), void *user)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE_POINTER(context, team);
    AG_REQUIRE_KNOWN(__func__, context, team);
    AG_REQUIRE(context, team->count >= 1 && team->rank >= 0 && team->rank < team->count,
               "rank %d is not one of %d", team->rank, team->count);
    AG_REQUIRE(context, team->send && team->receive, "send or receive is NULL");
    struct ag_bake_team copy = *team;
    const struct bake_team internal = { .rank = team->rank,
                                        .count = team->count,
                                        .send = send_to,
                                        .receive = receive_from,
                                        .user = &copy };
    return run(b, &internal, progress, user);
}

_Static_assert((int)AG_BAKE_NOTHING == (int)BAKE_NOTHING &&
                   (int)AG_BAKE_MESSAGE == (int)BAKE_MESSAGE && (int)AG_BAKE_LOST == (int)BAKE_LOST,
               "news are cast");

// ---- files

enum ag_result ag_bake_save(struct ag_bake *b, const char *path, bool record_seconds)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE(context, path && path[0], "path is empty");
    return api_done(context, bake_save(b->bake, path, record_seconds));
}

enum ag_result ag_bake_load(struct ag_bake *b, const char *path)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE(context, path && path[0], "path is empty");
    return api_done(context, bake_load(b->bake, path));
}

static bool is_part(const struct ag_bake *b, int index)
{
    return index >= 0 && index < bake_part_count(b->bake);
}

enum ag_result ag_bake_load_part(struct ag_bake *b, int index, const char *path)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE(context, path && path[0], "path is empty");
    AG_REQUIRE(context, is_part(b, index), "index %d is no part", index);
    return api_done(context, bake_load_part(b->bake, index, path));
}

enum ag_result ag_bake_save_part(struct ag_bake *b, int index, const char *path,
                                 bool record_seconds)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE(context, path && path[0], "path is empty");
    AG_REQUIRE(context, is_part(b, index), "index %d is no part", index);
    return api_done(context, bake_save_part(b->bake, index, path, record_seconds));
}

enum ag_result ag_bake_set_checkpoint(struct ag_bake *b, const char *path)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    host_free(&context->host, b->checkpoint);
    b->checkpoint = path ? host_strdup(&context->host, path) : NULL;
    b->options.checkpoint = b->checkpoint;
    return api_done(context, !path || b->checkpoint);
}

enum ag_result ag_bake_remove_checkpoint(struct ag_bake *b)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    bake_forget_checkpoint(b->bake);
    return AG_OK;
}

enum ag_result ag_bake_save_partial(struct ag_bake *b, const char *path)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE(context, path && path[0], "path is empty");
    return api_done(context, bake_save_partial(b->bake, path));
}

enum ag_result ag_bake_merge(struct ag_bake *b, const char *path)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE(context, path && path[0], "path is empty");
    return api_done(context, bake_merge(b->bake, path));
}

// The value behind the last `key` in the options of a light map; NULL: none.
static const char *value_of(const char *options, const char *key)
{
    const char *last = NULL;
    for (const char *at = options; (at = strstr(at, key)); at++) last = at;
    return last ? last + strlen(key) : NULL;
}

// 0: not stated.
static int samples_of(const char *options)
{
    const char *value = value_of(options, SAMPLES);
    const long samples = value ? strtol(value, NULL, 10) : 0;
    return samples >= 1 && samples <= MOST_SAMPLES ? (int)samples : 0;
}

// 0: not stated.
static float bound_of(const char *options)
{
    const char *value = value_of(options, NOISE);
    const long units = value ? strtol(value, NULL, 10) : 0;
    return units > 0 && units < NOISE_UNITS ? (float)((double)units / NOISE_UNITS) : 0.0f;
}

static bool take_origin(struct host *host, const char *path, const struct bake_origin *origin,
                        struct ag_bake_origin *out)
{
    const bool lightmap = strcmp(origin->technique, LIGHTMAP_NAME) == 0;
    if (lightmap) out->lightmap_samples = samples_of(origin->options);
    if (lightmap) out->lightmap_noise = bound_of(origin->options);
    if (lightmap && out->lightmap_samples == 0)
        return host_fail(host, FAIL_FORMAT, "cannot use %s: it does not state its samples", path);
    if (strlen(origin->gi) >= sizeof out->gi ||
        strlen(origin->scene_name) >= sizeof out->scene_name)
        return host_fail(host, FAIL_FORMAT, "cannot use %s: its GI spec or scene is too long",
                         path);
    if (!(origin->scene_scale >= SCENE_SCALE_MIN && origin->scene_scale <= SCENE_SCALE_MAX))
        return host_fail(host, FAIL_FORMAT, "cannot use %s: its scale of the scene is wrong", path);
    snprintf(out->gi, sizeof out->gi, "%s", origin->gi);
    snprintf(out->scene_name, sizeof out->scene_name, "%s", origin->scene_name);
    out->seed = origin->seed;
    out->scene_scale = origin->scene_scale;
    return true;
}

enum ag_result ag_bake_partial_origin(struct ag_context *context, const char *path,
                                      struct ag_bake_origin *out)
{
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_bake_origin){ 0 };
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, path && path[0], "path is empty");
    struct host *host = &context->host;
    struct bake_origin origin;
    const bool ok =
        bake_partial_origin(host, path, &origin) && take_origin(host, path, &origin, out);
    bake_origin_finish(host, &origin);
    return api_done(context, ok);
}

// ---- results

static const char *name_of(const struct ag_bake *b)
{
    if (api_bake_is_reference(b)) return REFERENCE_BAKE_NAME;
    return b->lightmap_samples > 0 ? LIGHTMAP_NAME : gi_bake_name(b->spec.technique[b->term]);
}

enum ag_result ag_bake_get_info(const struct ag_bake *b, struct ag_bake_info *out)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_bake_info){ .technique = name_of(b),
                                  .options = bake_options_text(b->bake),
                                  .complete = bake_is_complete(b->bake),
                                  .seconds = bake_seconds(b->bake),
                                  .bytes = bake_bytes(b->bake),
                                  .split_stage = bake_split_stage(b->bake),
                                  .part_count = bake_part_count(b->bake) };
    bake_key(b->bake, out->key);
    return AG_OK;
}

enum ag_result ag_bake_get_part(const struct ag_bake *b, int index, struct ag_bake_part *out)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE_POINTER(context, out);
    AG_REQUIRE(context, is_part(b, index), "index %d is no part", index);
    *out = (struct ag_bake_part){ .complete = bake_part_is_complete(b->bake, index),
                                  .loaded = bake_part_is_loaded(b->bake, index) };
    bake_part_key(b->bake, index, out->key);
    return AG_OK;
}

static double peak_memory_bytes(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? 1024.0 * (double)usage.ru_maxrss : (double)NAN;
}

static void report_options(struct report *report, const struct technique *technique,
                           const void *options)
{
    char value[OPTION_VALUE_SIZE];
    report_begin_object(report, "options");
    for (size_t i = 0; i < technique->options.count; i++) {
        const struct option_row *row = &technique->options.rows[i];
        option_print(row, options, value, sizeof value);
        char *end = NULL;
        const double number = c_locale_parse(value, &end);
        if (row->type == OPTION_TYPE_bool8)
            report_bool(report, row->name, strcmp(value, "true") == 0);
        else if (row->type != OPTION_TYPE_choice && row->type != OPTION_TYPE_text && *end == 0)
            report_number(report, row->name, number);
        else
            report_text_value(report, row->name, value);
    }
    report_end(report);
}

// null: of a task that was not run here.
static void report_task_seconds(struct report *report, const struct bake_stage_info *info)
{
    report_begin_list(report, "task_seconds");
    for (size_t i = 0; i < info->tasks; i++)
        report_number(report, NULL, (double)info->task_seconds[i]);
    report_end(report);
}

static void report_stages(struct report *report, const struct bake *bake)
{
    report_begin_list(report, "stages");
    for (int i = 0; i < bake_stage_count(bake); i++) {
        const struct bake_stage_info info = bake_stage_info(bake, i);
        report_begin_object(report, NULL);
        report_text_value(report, "name", info.name);
        report_number(report, "seconds", info.seconds);
        report_number(report, "tasks", (double)info.tasks);
        report_number(report, "wave", info.wave);
        report_number(report, "result_bytes", (double)info.result_bytes);
        report_number(report, "input_bytes", (double)info.input_bytes);
        report_task_seconds(report, &info);
        report_end(report);
    }
    report_end(report);
}

static void report_reference_options(struct report *report, const struct reference_bake *traced)
{
    report_begin_object(report, "options");
    report_number(report, "width", traced->width);
    report_number(report, "height", traced->height);
    report_number(report, "samples", traced->samples);
    report_end(report);
}

static bool write_report(struct ag_bake *b)
{
    const struct technique *technique =
        api_bake_is_reference(b) ? NULL : b->spec.technique[b->term];
    const char *name = technique && b->lightmap_samples == 0 ? technique->name : name_of(b);
    if (!bake_is_complete(b->bake))
        return host_fail(&b->context->host, FAIL_ARGUMENT,
                         "cannot report on the bake of %s: it is incomplete", name);
    report_destroy(b->report);
    b->report = report_create(&b->context->host);
    if (!b->report) return false;
    report_text_value(b->report, "technique", name);
    if (technique)
        report_options(b->report, technique, b->spec.options[b->term]);
    else
        report_reference_options(b->report, &b->traced);
    report_stages(b->report, b->bake);
    report_number(b->report, "seconds", bake_seconds(b->bake));
    report_number(b->report, "threads",
                  b->options.threads > 0 ? b->options.threads : parallel_threads());
    report_number(b->report, "prepare_seconds", bake_prepare_seconds(b->bake));
    report_number(b->report, "peak_memory_bytes", peak_memory_bytes());
    report_number(b->report, "bytes", (double)bake_bytes(b->bake));
    return !technique || b->lightmap_samples > 0 || !technique->bake_report ||
           technique->bake_report(b->report, b->bake, &b->how);
}

enum ag_result ag_bake_report(struct ag_bake *b, const char **json)
{
    struct ag_context *context = context_of(b);
    AG_REQUIRE_OUT(context, json);
    AG_REQUIRE(context, b, "bake is NULL");
    bool ok = write_report(b);
    if (ok) *json = report_text(b->report);
    if (ok && !*json)
        ok = host_fail(&context->host, FAIL_MEMORY, "cannot report on a bake: out of memory");
    return api_done(context, ok);
}
