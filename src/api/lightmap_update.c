// Updates of light maps: what a folder's record must share with the bake, and at which density.
#include "api/bake_state.h"

#include "core/parallel.h"
#include "lightmap/write.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

// ---- what the folder must be of

static bool read_record(struct host *host, const char *folder, struct lightmap_record *out)
{
    char *path = host_sprintf(host, "%s/" LIGHTMAP_RECORD_FILE, folder);
    const bool ok = path && lightmap_record_read(out, host, path);
    host_free(host, path);
    return ok;
}

static bool check_record(const struct ag_bake *b, const struct lightmap_record *record,
                         const char *folder, const char *options)
{
    struct host *host = &b->context->host;
    char differences[600];
    if (record->version != b->lightmap_version)
        return host_fail(host, FAIL_FORMAT, "cannot update %s: another version has baked it",
                         folder);
    option_differences(record->options, options, differences, sizeof differences);
    if (differences[0])
        return host_fail(host, FAIL_FORMAT, "cannot update %s: it has other options: %s", folder,
                         differences);
    if (record->seed != b->seed)
        return host_fail(host, FAIL_FORMAT,
                         "cannot update %s: its seed is %" PRIu64 ", not %" PRIu64, folder,
                         record->seed, b->seed);
    return true;
}

// ---- the charts

static bool make_charts(const struct ag_bake *b, const struct scene_pose *statics,
                        const struct charts_search *begin, struct charts *out)
{
    return b->spec.technique[b->term]->charts(statics, b->spec.options[b->term], &b->context->host,
                                              begin, out);
}

static bool is_density(float a, float b)
{
    static const float ROUNDING = 1e-5f; // of the sum of areas
    return fabsf(a - b) <= ROUNDING * b;
}

// The option `texels` leads to another density where the area has changed: the option `density`
// keeps it.
static bool keep_density(struct ag_bake *b, const char *folder, float texels_per_m)
{
    const struct technique *technique = b->spec.technique[b->term];
    const struct option_row *row = option_find(&technique->options, "density");
    if (!row || (double)texels_per_m > row->max)
        return host_fail(&b->context->host, FAIL_FORMAT,
                         "cannot update %s: the density of its texels has changed; set density",
                         folder);
    *(float *)((char *)b->spec.options[b->term] + row->offset) = texels_per_m;
    return true;
}

// The search for charts begins where that of the record has ended: the same charts, at a third of
// the time.
static bool make_equal_charts(struct ag_bake *b, const struct scene_pose *statics,
                              const char *folder, const struct lightmap_record *record,
                              struct charts *out)
{
    if (!make_charts(b, statics, &record->search, out)) return false;
    if (is_density(out->texels_per_m, record->texels_per_m)) return true;
    charts_finish(out);
    return keep_density(b, folder, record->texels_per_m) && make_charts(b, statics, NULL, out);
}

// ---- the bake

static bool add_stages(struct ag_bake *b, struct bake_plan *plan, const char *folder,
                       struct lightmap_record *record)
{
    struct host *host = &b->context->host;
    struct scene_statics statics;
    struct charts charts = { 0 };
    if (!scene_statics_init(&statics, host, &b->pose)) return false;
    const bool made = make_equal_charts(b, &statics.pose, folder, record, &charts);
    scene_statics_finish(&statics);
    if (!made) return false;
    const struct lightmap_bake how = { .pose = &b->pose, .samples = b->lightmap_samples };
    const struct lightmap_update update = {
        .how = &how, .folder = folder, .was = record, .charts = &charts
    };
    const bool ok = lightmap_add_update_stages(plan, &update, &b->change);
    b->charts = b->change.charts;
    return ok;
}

bool api_update_add_stages(struct ag_bake *b, struct bake_plan *plan, const char *folder,
                           const char *options)
{
    struct lightmap_record record = { 0 };
    const bool ok = read_record(&b->context->host, folder, &record) &&
                    check_record(b, &record, folder, options) &&
                    add_stages(b, plan, folder, &record);
    lightmap_record_finish(&record);
    b->updates = ok;
    return ok;
}

bool api_update_record(const struct ag_bake *b, const struct charts *charts,
                       struct lightmap_record *out)
{
    struct host *host = &b->context->host;
    struct scene_statics statics;
    const struct tensor *rest = tensors_find(bake_tensors(b->bake), LIGHTMAP_REST);
    if (!rest || !scene_statics_init(&statics, host, &b->pose)) return false;
    bool ok = lightmap_record_init(out, host, &statics.pose, charts, rest->data);
    scene_statics_finish(&statics);
    if (!ok) return false;
    out->options = host_strdup(host, bake_options_text(b->bake));
    out->version = b->lightmap_version;
    out->seed = b->seed;
    return out->options;
}

// ---- its cost

static double stage_seconds(const struct bake *bake, const char *name)
{
    for (int i = 0; i < bake_stage_count(bake); i++) {
        const struct bake_stage_info info = bake_stage_info(bake, i);
        if (strcmp(info.name, name) == 0) return info.seconds;
    }
    return (double)NAN;
}

// Enough texels for a mean time.
enum { LEAST_TEXELS = 64 };

// As if all texels took as long.
static double full_seconds(const struct ag_bake *b, const struct ag_bake_update_info *info)
{
    if (info->texels_again < LEAST_TEXELS) return (double)NAN;
    const int threads = b->options.threads > 0 ? b->options.threads : parallel_threads();
    return stage_seconds(b->bake, "paths") * (double)info->texels /
           ((double)info->texels_again * threads);
}

enum ag_result ag_bake_get_update(const struct ag_bake *b, struct ag_bake_update_info *out)
{
    struct ag_context *context = b ? b->context : NULL;
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_bake_update_info){ 0 };
    AG_REQUIRE(context, b->updates, "the bake is no update: set update_folder");
    AG_REQUIRE(context, bake_is_complete(b->bake), "the bake is incomplete: run it first");
    const struct tensor *again = tensors_find(bake_tensors(b->bake), LIGHTMAP_AGAIN);
    const uint8_t *marks = again ? again->data : NULL;
    out->texels = b->change.texels;
    for (uint32_t i = 0; marks && i < b->change.texels; i++) out->texels_again += marks[i] != 0;
    out->instances_changed = (int)b->change.instances;
    out->lights_changed = b->change.lights;
    out->seconds = bake_seconds(b->bake);
    out->full_seconds = full_seconds(b, out);
    return AG_OK;
}
