// Light maps as files: by the path tracer, through a bake, or by a renderer of a technique.
#include "light_map.h"
#include "light_map_report.h"
#include "light_renderer.h"
#include "cli/memory.h"
#include "cli/technique_names.h"
#include "cli/files/folder.h"
#include "cli/files/interrupt.h"
#include "cli/files/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// A folder with one of them is of an earlier run; the first is named in messages.
static const char *const MARKS[] = { "irradiance.exr",   "irradiance.ktx2",   "irradiance.png",
                                     "irradiance.0.exr", "irradiance.0.ktx2", "irradiance.0.png" };
static const char DEFAULT_GI[] = "radiosity";

struct job {
    const struct arguments *arguments;
    struct session session;
    struct folder folder;
    struct ag_bake_origin origin; // of the parts, with --merge
    struct baking baking;         // by paths
    struct light_renderer light;  // of the technique
    struct ag_lightmap *lightmap;
    double begun_s;
};

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ---- checks of the command line

// irradiance, irradiance_back, the number of several pages, and a format.
static bool is_map(const char *name)
{
    static const char *const endings[] = { ".exr", ".ktx2", ".png" };
    static const char start[] = "irradiance", back[] = "_back";
    if (strncmp(name, start, sizeof start - 1) != 0) return false;
    name += sizeof start - 1;
    if (strncmp(name, back, sizeof back - 1) == 0) name += sizeof back - 1;
    const size_t digits = name[0] == '.' ? strspn(name + 1, "0123456789") : 0;
    if (digits > 0) name += 1 + digits;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (strcmp(name, endings[i]) == 0) return true;
    return false;
}

static bool is_ours(const char *name)
{
    static const char *const others[] = { "bake.safetensors", "scene.glb", LIGHT_MAP_PAGE };
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcmp(name, others[i]) == 0) return true;
    return is_map(name);
}

// The map that the folder has, of the formats of the run that wrote it.
static const char *mark_in(const char *folder)
{
    char path[PATH_SIZE];
    for (size_t i = 0; i < sizeof MARKS / sizeof *MARKS; i++) {
        const int wrote = snprintf(path, sizeof path, "%s/%s", folder, MARKS[i]);
        if (wrote < PATH_SIZE && access(path, F_OK) == 0) return MARKS[i];
    }
    return MARKS[0];
}

static const char *gi_of(const struct job *job)
{
    const struct arguments *a = job->arguments;
    return a->merge ? job->origin.gi : a->has_gi ? a->gi : DEFAULT_GI;
}

static bool is_part(const struct arguments *a)
{
    return a->shard_count > 0;
}

static bool has_results(const struct arguments *a)
{
    return !is_part(a) && !baking_is_followed(a);
}

enum status light_map_check_others(const struct arguments *a)
{
    const char *option = a->lightmap_formats > 0 ? "--lightmap-format"
                         : a->page > 0           ? "--page"
                         : a->has_spp            ? "--spp"
                         : a->indirect_only      ? "--indirect-only"
                         : a->denoise            ? "--denoise"
                         : a->update             ? "--update"
                                                 : NULL;
    if (option) return wrong_usage("cannot use %s: it requires --lightmap DIR", option);
    option = a->light_count > 0   ? "--light"
             : a->has_sky         ? "--sky"
             : a->environment     ? "--environment"
             : a->no_scene_lights ? "--no-scene-lights"
             : a->device          ? "--device"
                                  : NULL;
    if (!option || a->probes) return DONE;
    return wrong_usage("cannot use %s: it requires --lightmap DIR or --probes DIR", option);
}

static enum status check_usage(const struct arguments *a)
{
    const char *option = a->report_full             ? "--report-full"
                         : a->all_objects           ? "--all-objects"
                         : a->exported              ? "--export"
                         : a->probes                ? "--probes"
                         : a->output && !is_part(a) ? "-o"
                                                    : NULL;
    if (option) return wrong_usage("cannot use %s with --lightmap: choose one", option);
    return baking_check_parts(a, false);
}

static enum status check_part(const struct arguments *a)
{
    const char *option = a->denoise                ? "--denoise"
                         : a->indirect_only        ? "--indirect-only"
                         : a->lightmap_formats > 0 ? "--lightmap-format"
                         : a->page > 0             ? "--page"
                                                   : NULL;
    if (is_part(a) && !a->has_spp)
        return wrong_usage("cannot use --shard with --lightmap: only a light map by paths has "
                           "parts; add --spp N");
    if (is_part(a) && option)
        return wrong_usage("cannot use %s with --shard: give it with --merge", option);
    option = a->has_gi ? "--gi" : a->has_spp ? "--spp" : NULL;
    if (a->merge && option)
        return wrong_usage("cannot use %s with --merge: it is that of the parts; leave it out",
                           option);
    return DONE;
}

static enum status check_update(const struct arguments *a)
{
    if (!a->update) return DONE;
    if (is_part(a) || a->merge)
        return wrong_usage("cannot use --update with --%s: an update has no parts; leave one out",
                           a->merge ? "merge" : "shard");
    if (a->team)
        return wrong_usage(
            "cannot use --update with afterglow-mpi: use afterglow, or leave it out");
    if (!a->has_spp)
        return wrong_usage(
            "cannot use --update: only a light map by paths is updated; add --spp N");
    if (a->spp_noise > 0.0)
        return wrong_usage(
            "cannot use --update with --spp auto: an update has one number of paths; "
            "use --spp N");
    return DONE;
}

static enum status find_origin(struct job *job)
{
    const struct arguments *a = job->arguments;
    if (!a->merge) return DONE;
    const enum status status = baking_origin(&job->session, &job->origin);
    if (status == DONE && job->origin.lightmap_samples == 0)
        return fail("cannot merge %s: it is no part of a light map; use -o FILE.safetensors "
                    "instead of --lightmap",
                    a->positional[0]);
    return status;
}

static bool has_lightmap(const struct ag_technique_info *info)
{
    return info->has_lightmap;
}

static enum status check_technique(const struct job *job)
{
    const char *found = NULL;
    char list[SPEC_SIZE];
    const enum ag_result result = ag_lightmap_technique(job->session.context, gi_of(job), &found);
    if (result != AG_OK) return fail_library(job->session.context, result);
    technique_names(has_lightmap, list, sizeof list);
    return found ? DONE
                 : wrong_usage("cannot bake a light map with --gi %s: no technique of it has one; "
                               "techniques that do: %s",
                               gi_of(job), list);
}

static enum status check_scene(const struct job *job)
{
    struct ag_scene_info info = { 0 };
    ag_scene_get_info(job->session.scene, -1, 0.0, &info);
    if (info.triangles > 0) return DONE;
    return fail("cannot bake a light map of %s: it has no triangles", job->session.name);
}

// Before the work that would be lost.
static enum status check_pages(const struct job *job)
{
    const int page = job->arguments->page;
    int count = 0;
    if (page == 0 || baking_is_followed(job->arguments)) return DONE;
    const enum ag_result result =
        ag_lightmap_count_pages(job->session.scene, gi_of(job), page, &count);
    if (result == AG_OK) return DONE;
    fail_library(job->session.context, result);
    return FAILED;
}

static enum status fail_call(const struct job *job, enum ag_result result)
{
    fail_library(job->session.context, result);
    return FAILED;
}

// ---- by paths

static enum status begin_paths(struct job *job)
{
    const struct arguments *a = job->arguments;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.seed = a->merge ? job->origin.seed : a->seed;
    desc.threads = a->threads;
    desc.shard = a->shard;
    desc.shard_count = a->shard_count;
    desc.max_memory_bytes = (uint64_t)a->max_memory_mib << 20;
    desc.lightmap_samples = a->merge ? job->origin.lightmap_samples : a->spp;
    desc.lightmap_noise = a->merge ? job->origin.lightmap_noise : (float)a->spp_noise;
    desc.update_folder = a->update ? a->lightmap : NULL;
    return baking_begin(&job->baking, &job->session, gi_of(job), &desc, a->output);
}

static enum status gather_paths(struct job *job)
{
    const struct arguments *a = job->arguments;
    enum status status = begin_paths(job);
    if (status != DONE) return status;
    session_say(&job->session);
    if (baking_is_followed(a)) return baking_follow(&job->baking);
    if (a->merge) status = baking_merge(&job->baking);
    if (status != DONE) return status;
    if (!a->merge && !is_part(a) && !a->force) baking_load(&job->baking);
    return job->baking.loaded ? baking_settle(&job->baking) : baking_run(&job->baking, is_part(a));
}

static enum status take_paths(struct job *job, const struct ag_lightmap_desc *desc)
{
    enum status status = gather_paths(job);
    if (status != DONE || !has_results(job->arguments)) return status;
    const enum ag_result result = ag_lightmap_from_bake(job->baking.bake, desc, &job->lightmap);
    return result == AG_OK ? DONE : fail_call(job, result);
}

// ---- by a technique

static enum status take_technique(struct job *job, const struct ag_lightmap_desc *desc)
{
    const enum status status = light_renderer_begin(&job->light, &job->session, gi_of(job));
    if (status != DONE || !has_results(job->arguments)) return status;
    const enum ag_result result =
        ag_lightmap_from_renderer(job->light.renderer, desc, &job->lightmap);
    return result == AG_OK ? DONE : fail_call(job, result);
}

// ---- results

static unsigned formats_of(const struct arguments *a)
{
    return a->lightmap_formats > 0 ? a->lightmap_formats
                                   : AG_LIGHTMAP_EXR | AG_LIGHTMAP_KTX2 | AG_LIGHTMAP_PNG;
}

static json_t *formats_json(unsigned formats)
{
    json_t *out = json_array();
    if (formats & AG_LIGHTMAP_EXR) json_array_append_new(out, json_string("exr"));
    if (formats & AG_LIGHTMAP_KTX2) json_array_append_new(out, json_string("ktx2"));
    if (formats & AG_LIGHTMAP_PNG) json_array_append_new(out, json_string("png"));
    return out;
}

static void say_noise(const struct ag_lightmap_info *info)
{
    if (!isfinite(info->noise)) return;
    char noisy[128] = "", quiet[128] = "";
    if (info->noisy_charts > 0)
        snprintf(noisy, sizeof noisy, "; %d of %d charts with the most paths above the bound",
                 info->noisy_charts, info->noise_charts);
    if (info->quiet_charts > 0)
        snprintf(quiet, sizeof quiet, "; %d below half of it by few paths, or without light",
                 info->quiet_charts);
    note("noise %.2g %% of a chart's light at most; %.0f paths per texel in the mean%s%s",
         100.0 * (double)info->noise, (double)info->paths, noisy, quiet);
}

static void say_update(const struct ag_bake_update_info *u)
{
    char full[64] = "";
    const double share = u->texels > 0 ? 100.0 * (double)u->texels_again / (double)u->texels : 0.0;
    if (u->instances_changed == 0 && !u->lights_changed && u->texels_again == 0) {
        note("nothing has changed; no texel is baked again");
        return;
    }
    if (isfinite(u->full_seconds))
        snprintf(full, sizeof full, "; all: about %.1f s", u->full_seconds);
    note("changed: %d instance%s%s; baked again: %llu of %llu texels, %.1f %%, in %.1f s%s",
         u->instances_changed, u->instances_changed == 1 ? "" : "s",
         u->lights_changed ? " and lights" : "", (unsigned long long)u->texels_again,
         (unsigned long long)u->texels, share, u->seconds, full);
}

static json_t *update_json(const struct ag_bake_update_info *u)
{
    return json_pack("{s:i, s:b, s:I, s:I, s:o, s:o}", "instances_changed", u->instances_changed,
                     "lights_changed", u->lights_changed, "texels", (json_int_t)u->texels,
                     "texels_again", (json_int_t)u->texels_again, "seconds",
                     json_double(u->seconds), "full_seconds", json_double(u->full_seconds));
}

static double texels_per_chart(const struct ag_lightmap_info *info)
{
    return (double)info->texels / fmax((double)info->charts, 1.0);
}

static json_t *pages_json(const struct job *job, int count)
{
    json_t *pages = json_array();
    for (int i = 0; i < count; i++) {
        struct ag_lightmap_page page;
        ag_lightmap_get_page(job->lightmap, i, &page);
        json_array_append_new(pages, json_pack("{s:[i, i], s:[i, i]}", "size", page.width,
                                               page.height, "at", page.x, page.y));
    }
    return pages;
}

static json_t *json_of(const struct job *job, const struct ag_lightmap_info *info,
                       double utilisation, const struct ag_bake_update_info *update)
{
    json_t *out =
        json_pack("{s:o, s:[i, i], s:i, s:i, s:o, s:o, s:o, s:b, s:o}", "output",
                  json_text(job->folder.shown), "size", info->width, info->height, "texels",
                  info->texels, "charts", info->charts, "texels_per_chart",
                  json_double(texels_per_chart(info)), "texels_per_m",
                  json_double((double)info->texels_per_m), "utilisation", json_double(utilisation),
                  "back", info->has_back, "formats", formats_json(formats_of(job->arguments)));
    if (out && job->arguments->page > 0)
        json_object_set_new(out, "pages", pages_json(job, info->pages));
    if (out && info->paths > 0.0f)
        json_object_set_new(out, "paths", json_double((double)info->paths));
    if (out && update) json_object_set_new(out, "update", update_json(update));
    if (!out || !isfinite(info->noise)) return out;
    json_object_set_new(out, "noise", json_double((double)info->noise));
    json_object_set_new(out, "noise_charts", json_integer(info->noise_charts));
    json_object_set_new(out, "noisy_charts", json_integer(info->noisy_charts));
    json_object_set_new(out, "quiet_charts", json_integer(info->quiet_charts));
    return out;
}

// The map in numbers.
struct outcome {
    struct ag_lightmap_info info;
    double utilisation;
    bool updated;
    struct ag_bake_update_info update;
};

static double page_places(const struct job *job, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        struct ag_lightmap_page page = { 0 };
        ag_lightmap_get_page(job->lightmap, i, &page);
        sum += (double)page.width * (double)page.height;
    }
    return sum;
}

static struct outcome outcome_of(const struct job *job)
{
    struct outcome out = { 0 };
    ag_lightmap_get_info(job->lightmap, &out.info);
    out.utilisation = (double)out.info.texels / page_places(job, out.info.pages);
    out.updated = job->baking.updates && ag_bake_get_update(job->baking.bake, &out.update) == AG_OK;
    return out;
}

static void say(const struct job *job, const struct outcome *o)
{
    const struct ag_lightmap_info *info = &o->info;
    if (o->updated) say_update(&o->update);
    char size[64];
    if (info->pages == 1)
        snprintf(size, sizeof size, "%dx%d", info->width, info->height);
    else
        snprintf(size, sizeof size, "%d pages of %dx%d", info->pages, job->arguments->page,
                 job->arguments->page);
    note("light map of %s, %d texels in %d charts, %.3g each, %.0f %% of it, %.3g texels per "
         "metre; written: %s",
         size, info->texels, info->charts, texels_per_chart(info), 100.0 * o->utilisation,
         (double)info->texels_per_m, job->folder.shown);
    say_noise(info);
    if (job->baking.estimate_bytes > 0)
        note("at most %.0f MB of memory with the scene", (double)memory_peak() * 1e-6);
}

static json_t *memory_json(const struct job *job)
{
    const uint64_t estimate = job->baking.estimate_bytes;
    return json_pack("{s:o, s:I}", "estimate_bytes",
                     estimate > 0 ? json_integer((json_int_t)estimate) : json_null(), "peak_bytes",
                     (json_int_t)memory_peak());
}

static struct light_map_run run_of(const struct job *job)
{
    struct light_map_run run = { .session = &job->session,
                                 .lightmap = job->lightmap,
                                 .gi = gi_of(job),
                                 .seconds = now_s() - job->begun_s };
    for (int i = 0; i < job->light.bakes.count; i++)
        run.bakes[run.bake_count++] = job->light.bakes.at[i].bake;
    if (job->baking.bake) run.bakes[run.bake_count++] = job->baking.bake;
    return run;
}

static enum status write_folder(struct job *job, const struct light_map_run *run,
                                const json_t *document)
{
    enum status status = folder_begin(&job->folder);
    if (status != DONE) return status;
    interrupt_hold();
    const enum ag_result result =
        ag_lightmap_write_as(job->lightmap, job->folder.beside.path, formats_of(job->arguments));
    interrupt_release();
    if (result != AG_OK) return fail_call(job, result);
    status = light_map_page_write(run, document, &job->folder);
    return status == DONE ? folder_commit(&job->folder, mark_in(job->folder.path)) : status;
}

static enum status publish(struct job *job)
{
    const struct arguments *a = job->arguments;
    const struct outcome outcome = outcome_of(job);
    const struct light_map_run run = run_of(job);
    json_t *document =
        json_of(job, &outcome.info, outcome.utilisation, outcome.updated ? &outcome.update : NULL);
    if (!document) return fail_call(job, AG_ERROR_MEMORY);
    enum status status = light_map_report_add(&run, document);
    if (status == DONE) status = write_folder(job, &run, document);
    if (status == DONE) say(job, &outcome);
    json_object_set_new(document, "memory", memory_json(job));
    if (status == DONE && a->report) status = json_write(document, a->report);
    if (status == DONE && a->json) return json_print(document);
    json_decref(document);
    return status;
}

// Everything that can fail before the work.
static enum status prepare(struct job *job)
{
    const struct arguments *a = job->arguments;
    enum status status = check_usage(a);
    if (status == DONE) status = check_part(a);
    if (status == DONE) status = check_update(a);
    if (status == DONE) status = session_begin(&job->session, a);
    if (status == DONE) status = find_origin(job);
    if (status == DONE) status = check_technique(job);
    if (status == DONE && !baking_is_followed(a))
        status = is_part(a) ? whole_file_check(a->output)
                            : folder_plan(&job->folder, a->lightmap, mark_in(a->lightmap), is_ours);
    if (status == DONE && a->report && !baking_is_followed(a)) status = whole_file_check(a->report);
    if (status == DONE)
        status = session_load(&job->session, a->merge ? job->origin.scene_name : a->positional[0],
                              a->merge ? job->origin.scene_scale : a->scene_scale);
    if (status == DONE) status = check_scene(job);
    if (status == DONE) status = check_pages(job);
    return status == DONE ? session_light(&job->session) : status;
}

static enum status run(struct job *job)
{
    const struct arguments *a = job->arguments;
    struct ag_lightmap_desc desc;
    ag_lightmap_desc_default(&desc);
    desc.indirect_only = a->indirect_only;
    desc.denoise = a->denoise;
    desc.report = true;
    desc.page = a->page;
    enum status status = prepare(job);
    if (status == DONE)
        status = a->has_spp || a->merge ? take_paths(job, &desc) : take_technique(job, &desc);
    if (status != DONE || !has_results(a)) return status;
    return publish(job);
}

enum status light_map_bake(const struct arguments *arguments)
{
    struct job *job = calloc(1, sizeof *job);
    if (!job) return fail("cannot bake %s: out of memory", arguments->positional[0]);
    job->arguments = arguments;
    job->begun_s = now_s();
    const enum status status = run(job);
    ag_lightmap_destroy(job->lightmap);
    light_renderer_end(&job->light);
    baking_end(&job->baking);
    folder_abort(&job->folder);
    session_end(&job->session);
    free(job);
    return status;
}
