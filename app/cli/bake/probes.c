#include "probes.h"
#include "light_map.h"
#include "light_renderer.h"
#include "probe_files.h"
#include "cli/files/json.h"

#include <string.h>

static const char DEFAULT_GI[] = "radiosity:probes=true";

struct job {
    const struct arguments *arguments;
    const char *gi;
    struct session session;
    struct folder folder;
    struct light_renderer light;
    struct ag_probes *probes;
};

static bool is_ours(const char *name)
{
    return strcmp(name, PROBES_JSON) == 0 || strcmp(name, PROBES_ATLAS) == 0 ||
           strcmp(name, PROBES_VISIBILITY) == 0;
}

static enum status check_usage(const struct arguments *a)
{
    const char *option = a->report            ? "--report"
                         : a->report_full     ? "--report-full"
                         : a->all_objects     ? "--all-objects"
                         : a->exported        ? "--export"
                         : a->output          ? "-o"
                         : a->merge           ? "--merge"
                         : a->shard_count > 0 ? "--shard"
                                              : NULL;
    if (option) return wrong_usage("cannot use %s with --probes: choose one", option);
    return light_map_check_others(a);
}

// Everything that can fail before the work.
static enum status prepare(struct job *job)
{
    const struct arguments *a = job->arguments;
    enum status status = check_usage(a);
    if (status == DONE) status = session_begin(&job->session, a);
    if (status == DONE && !baking_is_followed(a))
        status = folder_plan(&job->folder, a->probes, PROBES_JSON, is_ours);
    if (status == DONE) status = session_load(&job->session, a->positional[0], a->scene_scale);
    return status == DONE ? session_light(&job->session) : status;
}

static enum status take_probes(struct job *job)
{
    const enum status status = light_renderer_begin(&job->light, &job->session, job->gi);
    if (status != DONE || baking_is_followed(job->arguments)) return status;
    const enum ag_result result = ag_renderer_read_probes(job->light.renderer, &job->probes);
    if (result == AG_OK) return DONE;
    fail_library(job->session.context, result);
    return FAILED;
}

static enum status write_folder(struct job *job)
{
    enum status status = folder_begin(&job->folder);
    if (status != DONE) return status;
    status = probe_files_write(job->session.context, job->probes, job->gi, &job->folder);
    return status == DONE ? folder_commit(&job->folder, PROBES_JSON) : status;
}

static enum status report(const struct job *job)
{
    const struct ag_probes *p = job->probes;
    note("%dx%dx%d probes, %.3g m apart; written: %s", p->counts[0], p->counts[1], p->counts[2],
         (double)p->spacing, job->folder.shown);
    if (!job->arguments->json) return DONE;
    return json_print(json_pack("{s:o, s:[i, i, i], s:o}", "output", json_text(job->folder.shown),
                                "counts", p->counts[0], p->counts[1], p->counts[2], "spacing",
                                json_double((double)p->spacing)));
}

enum status probes_bake(const struct arguments *arguments)
{
    struct job job = { .arguments = arguments, .gi = DEFAULT_GI };
    if (arguments->has_gi) job.gi = arguments->gi;
    enum status status = prepare(&job);
    if (status == DONE) status = take_probes(&job);
    const bool has_probes = status == DONE && job.probes;
    if (has_probes) status = write_folder(&job);
    if (has_probes && status == DONE) status = report(&job);
    ag_probes_destroy(job.session.context, job.probes);
    light_renderer_end(&job.light);
    folder_abort(&job.folder);
    session_end(&job.session);
    return status;
}
