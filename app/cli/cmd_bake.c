// afterglow bake: what a technique precomputes, to a file or to the cache.
#include "cli/bake/bake_export.h"
#include "cli/bake/baking.h"
#include "commands.h"
#include "cli/bake/light_map.h"
#include "cli/bake/probes.h"
#include "cli/files/json.h"

#include <stdio.h>
#include <stdlib.h>

struct job {
    const struct arguments *arguments;
    struct session session;
    struct baking baking;
    struct bake_export exported;
    struct ag_bake_origin origin; // of the parts, with --merge
};

// ---- checks of the command line

static enum status check_usage(const struct arguments *a)
{
    enum status status = baking_check_parts(a, true);
    if (status != DONE) return status;
    if (!a->merge && !a->has_gi)
        return wrong_usage("cannot bake %s: --gi SPEC is missing (see afterglow list)",
                           a->positional[0]);
    if (a->exported && a->shard_count > 0)
        return wrong_usage("cannot use --export with --shard: the bake is complete after --merge; "
                           "give it there");
    return light_map_check_others(a);
}

static enum status check_cache(const struct arguments *a)
{
    char folder[PATH_SIZE], why[CACHE_WHY_SIZE];
    if (cache_folder(CACHE_BAKE, folder, why)) return DONE;
    return fail("cannot bake %s: no cache for the result: %s; use -o FILE.safetensors, "
                "or " CACHE_REMEDY,
                a->positional[0], why);
}

// Only the process that keeps the results writes files.
static enum status check_outputs(const struct arguments *a)
{
    if (baking_is_followed(a)) return DONE;
    enum status status = a->output ? whole_file_check(a->output) : check_cache(a);
    return status == DONE && a->report ? whole_file_check(a->report) : status;
}

// ---- the bake

// The scene and the GI spec: of the command line, or of the first part.
static enum status find_origin(struct job *job)
{
    const struct arguments *a = job->arguments;
    if (!a->merge) return DONE;
    const enum status status = baking_origin(&job->session, &job->origin);
    if (status == DONE && job->origin.lightmap_samples > 0)
        return fail("cannot merge %s: it is part of a light map; add --lightmap DIR",
                    a->positional[0]);
    return status;
}

static enum status begin_export(struct job *job)
{
    const struct arguments *a = job->arguments;
    if (baking_is_followed(a)) return DONE;
    return bake_export_begin(&job->exported, &job->session, a->exported,
                             a->merge ? job->origin.gi : a->gi);
}

static enum status begin(struct job *job)
{
    const struct arguments *a = job->arguments;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.seed = a->merge ? job->origin.seed : a->seed;
    desc.threads = a->threads;
    desc.shard = a->shard;
    desc.shard_count = a->shard_count;
    desc.max_memory_bytes = (uint64_t)a->max_memory_mib << 20;
    desc.full_report = a->report_full;
    desc.all_objects = a->all_objects;
    enum status status = baking_begin(&job->baking, &job->session,
                                      a->merge ? job->origin.gi : a->gi, &desc, a->output);
    job->baking.must_keep = true;
    return status;
}

// A full report is not loaded: the file lacks data that only the report has.
static bool may_load(const struct arguments *a)
{
    return !a->force && !a->report_full && !a->merge && a->shard_count == 0;
}

// A bake of the cache is copied to -o, without a run.
static enum status use_baked(struct job *job)
{
    struct baking *b = &job->baking;
    const char *output = job->arguments->output;
    const bool copied = b->from_cache && output;
    const enum status status = output ? baking_run(b, false) : baking_settle(b);
    if (status != DONE) return status;
    note(copied ? "%s is already baked, in the cache; written: %s (--force bakes again)"
                : "%s is already baked: %s (--force bakes again)",
         b->technique, b->kept);
    return DONE;
}

static enum status bake_it(struct job *job)
{
    const struct arguments *a = job->arguments;
    if (baking_is_followed(a)) return baking_follow(&job->baking);
    if (may_load(a) && baking_load(&job->baking)) return use_baked(job);
    const enum status status = a->merge ? baking_merge(&job->baking) : DONE;
    return status == DONE ? baking_run(&job->baking, a->shard_count > 0) : status;
}

// ---- results

// The library's report with what this command knows: {"…": …, "estimate_seconds": …, "output": …}.
static json_t *report_json(struct job *job)
{
    const char *text = NULL;
    if (ag_bake_report(job->baking.bake, &text) != AG_OK) return NULL;
    json_t *report = json_loads(text, 0, NULL);
    if (!report) return NULL;
    json_object_set_new(report, "estimate_seconds", json_double(job->baking.estimate_seconds));
    json_object_set_new(report, "cached", json_boolean(job->baking.loaded));
    json_object_set_new(report, "output", json_text(job->baking.kept));
    if (job->exported.facts) json_object_set(report, "export", job->exported.facts);
    return report;
}

// Stages of at least a hundredth of the time; --verbose shows all.
static void describe_stages(const json_t *stages)
{
    double sum = 0.0;
    size_t i;
    const json_t *stage;
    json_array_foreach(stages, i, stage) sum +=
        json_number_value(json_object_get(stage, "seconds"));
    json_array_foreach(stages, i, stage)
    {
        const double seconds = json_number_value(json_object_get(stage, "seconds"));
        void (*say)(const char *format, ...) = seconds >= 0.01 * sum ? note : detail;
        say("%-32s %9.2f s on all threads", json_string_value(json_object_get(stage, "name")),
            seconds);
    }
}

static void describe(const json_t *report)
{
    describe_stages(json_object_get(report, "stages"));
    note("baked in %.1f s, at most %.0f MB of memory with the scene, %.1f MB of arrays",
         json_number_value(json_object_get(report, "seconds")),
         json_number_value(json_object_get(report, "peak_memory_bytes")) * 1e-6,
         json_number_value(json_object_get(report, "bytes")) * 1e-6);
}

static enum status publish(struct job *job, json_t *report)
{
    const struct arguments *a = job->arguments;
    if (!job->baking.loaded) describe(report);
    if (!a->output && !job->baking.loaded && job->baking.path[0])
        note("written: %s", job->baking.kept);
    enum status status = a->report ? json_write(report, a->report) : DONE;
    return status == DONE && a->json ? json_print(json_incref(report)) : status;
}

static enum status describe_shard(const struct job *job)
{
    const struct arguments *a = job->arguments;
    note("written: %s, part %d of %d; afterglow bake --merge with all parts finishes the bake, or "
         "continues it in parts with --shard",
         a->output, a->shard, a->shard_count);
    return DONE;
}

static enum status report(struct job *job)
{
    if (job->arguments->shard_count > 0) return describe_shard(job);
    json_t *document = report_json(job);
    if (!document) return fail_library(job->session.context, AG_ERROR_MEMORY);
    enum status status = publish(job, document);
    json_decref(document);
    return status;
}

static enum status bake(const struct arguments *arguments)
{
    if (arguments->lightmap) return light_map_bake(arguments);
    if (arguments->probes) return probes_bake(arguments);
    struct job *job = calloc(1, sizeof *job);
    if (!job) return fail("cannot bake %s: out of memory", arguments->positional[0]);
    job->arguments = arguments;
    enum status status = check_usage(arguments);
    if (status == DONE) status = check_outputs(arguments);
    if (status == DONE) status = session_begin(&job->session, arguments);
    if (status == DONE) status = find_origin(job);
    if (status == DONE) status = begin_export(job);
    if (status == DONE)
        status = session_load(&job->session,
                              arguments->merge ? job->origin.scene_name : arguments->positional[0],
                              arguments->merge ? job->origin.scene_scale : arguments->scene_scale);
    if (status == DONE) status = begin(job);
    if (status == DONE) status = bake_it(job);
    const bool has_results = status == DONE && !baking_is_followed(arguments);
    if (has_results) status = bake_export_write(&job->exported, &job->baking);
    if (has_results && status == DONE) status = report(job);
    bake_export_end(&job->exported);
    baking_end(&job->baking);
    session_end(&job->session);
    free(job);
    return status;
}

const struct command command_bake = {
    .name = "bake",
    .bit = BAKE,
    .positional_count = 1,
    .usage = "SCENE --gi SPEC [options]",
    .summary = "precompute the data of a technique on the CPU",
    .text =
        "Precomputes the data of a technique for SCENE, once. render and compare do it by\n"
        "themselves when nothing fits; this command does it ahead, elsewhere or in parts.\n"
        "\n"
        "Says first what it needs: rays, time, memory, bytes on disk. Runs on all cores.\n"
        "Ctrl-C keeps what is finished; the same command continues with it.\n"
        "Neither threads, parts nor interruptions change the file.\n"
        "With --report, writes the seconds, memory and bytes that each stage took, as JSON.\n"
        "\n"
        "With --lightmap, writes a light map for other engines instead: see docs/lightmaps.md.\n"
        "With --probes, writes irradiance probes: see docs/probes.md.\n"
        "With --export, writes the transfer maps of ort as images too: see\n"
        "docs/techniques/ort.md.\n"
        "mpirun -n N afterglow-mpi bake … takes the same options and runs on N processes, also\n"
        "of several machines, with the same result: see docs/clusters.md.\n"
        "\n"
        "The file is in the safetensors format: in Python,\n"
        "safetensors.numpy.load_file('maze.safetensors') returns its arrays by name.\n",
    .examples =
        "  afterglow bake @maze --gi mrt\n"
        "      into the cache, where render and compare find it\n"
        "  afterglow bake @maze --gi mrt -o maze.safetensors\n"
        "  afterglow render @maze --gi mrt --bake maze.safetensors\n"
        "      into a file, and use it\n"
        "  afterglow bake @maze --gi mrt --report report.json --force\n"
        "      bake again and write seconds, bytes and figures of each stage\n"
        "  afterglow bake @maze --gi mrt --shard 0/2 -o part0.safetensors\n"
        "  afterglow bake @maze --gi mrt --shard 1/2 -o part1.safetensors\n"
        "  afterglow bake --merge part0.safetensors part1.safetensors -o all.safetensors\n"
        "      two parts, on two machines, joined, and the rest of the bake\n"
        "  afterglow bake --merge part0.safetensors part1.safetensors --shard 0/2 -o "
        "next0.safetensors\n"
        "      joined, and half of the next work that is worth splitting\n"
        "  afterglow bake chair.glb --gi dnrt --all-objects\n"
        "      into the cache, for all scenes that have the chair as an object\n"
        "  afterglow bake head.glb --gi ort:offsets=100 --export bins\n"
        "      into the cache, and its maps for other programs: bins/index.json\n"
        "  afterglow bake house.glb --lightmap maps\n"
        "      light map of radiosity: maps/irradiance.exr and maps/scene.glb\n"
        "  afterglow bake house.glb --lightmap maps --lightmap-format ktx2,png\n"
        "      for the web: irradiance.ktx2, and scene.glb, which opens lit\n"
        "  afterglow bake house.glb --lightmap maps --spp 256\n"
        "      the same by path tracing, which Ctrl-C interrupts and the next run continues\n"
        "  afterglow bake house.glb --lightmap maps --spp 256 --update\n"
        "      after a change of house.glb: only the texels that it reaches\n"
        "  afterglow bake house.glb --lightmap maps --spp auto:noise=5 --denoise\n"
        "      as many paths as each chart needs for a noise of 5 %, then filtered\n"
        "  afterglow bake house.glb --probes probes\n"
        "      irradiance probes for objects that move: probes/probes.json\n"
        "  afterglow bake house.glb --lightmap maps --spp 256 --shard 0/2 -o p0.safetensors\n"
        "  afterglow bake house.glb --lightmap maps --spp 256 --shard 1/2 -o p1.safetensors\n"
        "  afterglow bake --merge p0.safetensors p1.safetensors --lightmap maps\n"
        "      the same in two parts\n",
    .run = bake,
};
