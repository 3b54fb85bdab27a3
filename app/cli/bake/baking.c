// Finding, running and caching bakes.
#include "baking.h"
#include "cli/memory.h"
#include "cli/files/disk.h"
#include "cli/files/interrupt.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const char CHECKPOINT[] = ".checkpoint";
static const double STOP_WITHIN_S = 0.8; // after Ctrl-C, whatever the running tasks do

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static enum status fail_bake(const struct baking *b, enum ag_result result)
{
    return fail_library(b->session->context, result);
}

// ---- one bake

// Without a cache the result stays in memory.
static enum status find_path(struct baking *b, const char *path)
{
    struct ag_bake_info info;
    ag_bake_get_info(b->bake, &info);
    b->technique = info.technique;
    b->in_cache = !path;
    if (path && strlen(path) >= sizeof b->path - sizeof CHECKPOINT)
        return wrong_usage("wrong value -o: the path is longer than %zu",
                           sizeof b->path - sizeof CHECKPOINT);
    if (path)
        snprintf(b->path, sizeof b->path, "%s", path);
    else if (!cache_file(CACHE_BAKE, info.key, b->path, b->no_cache))
        b->path[0] = 0;
    if (!b->in_cache || info.part_count < 2 || !cache_folder(CACHE_BAKE, b->kept, NULL))
        snprintf(b->kept, sizeof b->kept, "%s", b->path);
    return DONE;
}

// Bakes all where the folder cannot be updated.
static enum ag_result create(struct baking *b, const char *gi, const struct ag_bake_desc *desc)
{
    struct ag_scene *scene = b->session->scene;
    enum ag_result result = ag_bake_create(scene, gi, desc, &b->bake);
    b->updates = desc->update_folder && result == AG_OK;
    if (!desc->update_folder || (result != AG_ERROR_FORMAT && result != AG_ERROR_FILE))
        return result;
    note("warning: all is baked: %s", ag_context_last_error(b->session->context));
    struct ag_bake_desc all = *desc;
    all.update_folder = NULL;
    return ag_bake_create(scene, gi, &all, &b->bake);
}

static enum status begin_at(struct baking *b, const char *path)
{
    const enum status status = find_path(b, path);
    if (status != DONE || !b->path[0]) return status;
    char checkpoint[PATH_SIZE + sizeof CHECKPOINT];
    snprintf(checkpoint, sizeof checkpoint, "%s%s", b->path, CHECKPOINT);
    const enum ag_result result = ag_bake_set_checkpoint(b->bake, checkpoint);
    return result == AG_OK ? DONE : fail_bake(b, result);
}

enum status baking_begin(struct baking *b, struct session *session, const char *gi,
                         const struct ag_bake_desc *desc, const char *path)
{
    *b = (struct baking){ .session = session,
                          .estimate_seconds = (double)NAN,
                          .scene_bytes = memory_resident() };
    const enum ag_result result = create(b, gi, desc);
    return result == AG_OK ? begin_at(b, path) : fail_bake(b, result);
}

enum status baking_begin_reference(struct baking *b, struct session *session,
                                   const struct ag_reference_desc *of, int samples,
                                   const char *path)
{
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.threads = session->arguments->threads;
    *b = (struct baking){ .session = session,
                          .of_reference = true,
                          .estimate_seconds = (double)NAN,
                          .scene_bytes = memory_resident() };
    const enum ag_result result =
        ag_bake_create_reference(session->scene, of, samples, &desc, &b->bake);
    return result == AG_OK ? begin_at(b, path) : fail_bake(b, result);
}

void baking_end(struct baking *b)
{
    ag_bake_destroy(b->bake);
    *b = (struct baking){ 0 };
}

// ---- the other ranks of a team

bool baking_is_followed(const struct arguments *arguments)
{
    return arguments->team && arguments->team->ranks.rank > 0;
}

static bool is_asked_to_go_on(void *user, const struct ag_bake_progress *progress)
{
    (void)user;
    (void)progress;
    return !interrupt_caught();
}

enum status baking_follow(struct baking *b)
{
    interrupt_catch();
    const enum ag_result result =
        ag_bake_run_team(b->bake, &b->session->arguments->team->ranks, is_asked_to_go_on, NULL);
    interrupt_let_go();
    return result == AG_OK ? DONE : fail_bake(b, result);
}

enum status baking_settle(struct baking *b)
{
    const struct team *team = b->session->arguments->team;
    if (!team || b->settled) return DONE;
    b->settled = true;
    const enum ag_result result = ag_bake_run_team(b->bake, &team->ranks, NULL, NULL);
    return result == AG_OK ? DONE : fail_bake(b, result);
}

// ---- files

static bool load_from(struct baking *b, const char *path)
{
    if (!path[0] || access(path, F_OK) != 0) return false;
    b->loaded = ag_bake_load(b->bake, path) == AG_OK;
    if (!b->loaded)
        note("warning: %s is baked again: %s", b->technique,
             ag_context_last_error(b->session->context));
    return b->loaded;
}

// Returns whether the part is loaded; warns of a file that does not fit.
static bool load_part(struct baking *b, int index)
{
    struct ag_bake_part part;
    char path[PATH_SIZE];
    if (ag_bake_get_part(b->bake, index, &part) != AG_OK ||
        !cache_file(CACHE_BAKE, part.key, path, NULL) || access(path, F_OK) != 0)
        return false;
    if (!part.complete && ag_bake_load_part(b->bake, index, path) != AG_OK) {
        note("warning: %s is baked again: %s", b->technique,
             ag_context_last_error(b->session->context));
        return false;
    }
    cache_touch(path);
    return true;
}

static bool load_from_cache(struct baking *b)
{
    struct ag_bake_info info;
    ag_bake_get_info(b->bake, &info);
    bool all = true;
    for (int i = 0; i < info.part_count; i++) all = load_part(b, i) && all;
    b->loaded = b->from_cache = all;
    return all;
}

bool baking_load(struct baking *b)
{
    return (!b->in_cache && load_from(b, b->path)) || load_from_cache(b);
}

// ---- parts

enum status baking_check_parts(const struct arguments *a, bool file)
{
    const bool shard = a->shard_count > 0;
    if (shard && a->team)
        return wrong_usage("cannot use --shard with afterglow-mpi: its ranks share the bake "
                           "already; choose one");
    if (shard && a->merge && !file)
        return wrong_usage("cannot use --shard with --merge for a light map: choose one");
    if (!a->output && (shard || (a->merge && file)))
        return wrong_usage("cannot use --%s: it requires -o FILE.safetensors",
                           a->merge ? "merge" : "shard");
    if (a->merge && a->has_scene_scale)
        return wrong_usage("cannot use --scene-scale with --merge: it is that of the parts; leave "
                           "it out");
    if (shard && a->report)
        return wrong_usage("cannot use --report with --shard: the bake is complete after --merge");
    return DONE;
}

enum status baking_origin(const struct session *session, struct ag_bake_origin *out)
{
    const char *part = session->arguments->positional[0];
    if (ag_bake_partial_origin(session->context, part, out) == AG_OK) return DONE;
    fail_library(session->context, AG_ERROR_FORMAT);
    return FAILED; // a file's content is not wrong usage
}

enum status baking_merge(struct baking *b)
{
    const struct arguments *a = b->session->arguments;
    for (int i = 0; i < a->positional_count; i++) {
        const enum ag_result result = ag_bake_merge(b->bake, a->positional[i]);
        if (result == AG_OK) continue;
        fail_bake(b, result);
        return FAILED;
    }
    return DONE;
}

// ---- the run

// "baking mrt"
static void print_work(const struct baking *b, char out[64])
{
    snprintf(out, 64, "%s %.32s", b->of_reference ? "tracing the" : "baking", b->technique);
}

// 1234567 as "1.23 million".
static void print_count(double count, char out[32])
{
    if (count >= 1e9)
        snprintf(out, 32, "%.3g billion", count * 1e-9);
    else if (count >= 1e6)
        snprintf(out, 32, "%.3g million", count * 1e-6);
    else
        snprintf(out, 32, "%.0f", count);
}

// Before hours of work: without room a render goes on and keeps nothing.
static enum status check_disk(const struct baking *b, uint64_t needed)
{
    uint64_t room = 0;
    if (!b->path[0] || !disk_free(b->path, &room) || room >= needed) return DONE;
    char what[128];
    snprintf(what, sizeof what, "%.1f MB are free there, it needs %.1f MB", (double)room * 1e-6,
             (double)needed * 1e-6);
    if (!b->in_cache)
        return fail("cannot write %s: %s; make room or choose another folder", b->path, what);
    if (b->must_keep)
        return fail("cannot write %s: %s; make room (afterglow cache --clear), use -o "
                    "FILE.safetensors, or " CACHE_REMEDY,
                    b->path, what);
    note("warning: the bake of %s is not kept for the next run: %s in %s; make room (afterglow "
         "cache --clear), or " CACHE_REMEDY,
         b->technique, what, b->path);
    return DONE;
}

// shard: the file has intermediate results, whose bytes are not known.
static enum status estimate(struct baking *b, bool shard)
{
    const struct arguments *a = b->session->arguments;
    const long long mib = a->max_memory_mib;
    struct ag_bake_estimate needs;
    char texels[32], rays[32], work[64];
    enum ag_result result = ag_bake_estimate_cost(b->bake, false, &needs);
    // Refused before the probe, which takes memory too.
    if (result == AG_OK && mib > 0 && needs.peak_memory_bytes > (uint64_t)mib << 20)
        return fail_bake(b, ag_bake_run(b->bake, NULL, NULL));
    if (result == AG_OK && !shard && check_disk(b, needs.file_bytes) != DONE) return FAILED;
    if (result == AG_OK && b->updates) return DONE; // its cost is not known before
    if (result == AG_OK) result = ag_bake_estimate_cost(b->bake, true, &needs);
    if (result != AG_OK) return fail_bake(b, result);
    b->estimate_seconds = needs.seconds / (a->team ? a->team->ranks.count : 1);
    print_count(needs.texels, texels);
    print_count(needs.rays, rays);
    print_work(b, work);
    b->estimate_bytes = b->scene_bytes + needs.peak_memory_bytes;
    note("%s: %s %s, %s rays, about %.*f s, %.0f MB of memory with the scene, %.1f MB on disk",
         work, texels, b->of_reference ? "pixels" : "texels", rays,
         b->estimate_seconds < 10.0 ? 1 : 0, b->estimate_seconds, (double)b->estimate_bytes * 1e-6,
         (double)needs.file_bytes * 1e-6);
    return DONE;
}

struct watch {
    const struct baking *baking;
    double stopped_s; // when Ctrl-C was seen; 0: not yet
};

static enum status interrupted(const struct baking *b)
{
    char work[64];
    print_work(b, work);
    return fail("%s: interrupted; %s", work,
                b->path[0] ? "the same command continues with what was finished"
                           : "without a cache its results are lost");
}

// A running task may be in the middle of a decomposition, which cannot be interrupted. The
// checkpoint is written by then, so nothing is lost by not waiting for it.
static void leave_if_late(const struct watch *watch)
{
    if (now_s() - watch->stopped_s < STOP_WITHIN_S) return;
    progress_end();
    _exit(interrupted(watch->baking));
}

static bool show(void *user, const struct ag_bake_progress *p)
{
    struct watch *watch = user;
    char what[160], work[64];
    print_work(watch->baking, work);
    snprintf(what, sizeof what, "%s, %.64s", work, p->stage);
    progress_share(what, p->done, p->seconds_left);
    if (interrupt_caught() && watch->stopped_s <= 0.0) watch->stopped_s = now_s();
    if (p->stopping) leave_if_late(watch);
    return !interrupt_caught();
}

static enum status run(struct baking *b)
{
    struct watch watch = { .baking = b };
    interrupt_catch();
    const struct team *team = b->session->arguments->team;
    const enum ag_result result = team ? ag_bake_run_team(b->bake, &team->ranks, show, &watch)
                                       : ag_bake_run(b->bake, show, &watch);
    progress_end();
    interrupt_let_go();
    if (result == AG_ERROR_CANCELLED) return interrupted(b);
    return result == AG_OK ? DONE : fail_bake(b, result);
}

// Those that are not there yet.
static enum ag_result write_parts(struct baking *b)
{
    struct ag_bake_info info;
    struct ag_bake_part part;
    char path[PATH_SIZE];
    enum ag_result result = ag_bake_get_info(b->bake, &info);
    for (int i = 0; result == AG_OK && i < info.part_count; i++) {
        result = ag_bake_get_part(b->bake, i, &part);
        if (result != AG_OK || part.loaded || !cache_file(CACHE_BAKE, part.key, path, NULL))
            continue;
        result = ag_bake_save_part(b->bake, i, path, true);
        if (result == AG_OK) cache_trim(path);
    }
    return result;
}

static enum status write_file(struct baking *b, bool shard)
{
    if (!b->path[0]) return DONE;
    interrupt_hold();
    enum ag_result result = shard         ? ag_bake_save_partial(b->bake, b->path)
                            : b->in_cache ? write_parts(b)
                                          : ag_bake_save(b->bake, b->path, false);
    interrupt_release();
    if (result == AG_OK) return DONE;
    if (!b->in_cache) return fail_bake(b, result);
    note("warning: the bake of %s is not cached: %s", b->technique,
         ag_context_last_error(b->session->context));
    return DONE;
}

enum status baking_complete(struct baking *b, bool shard)
{
    struct ag_bake_info info;
    ag_bake_get_info(b->bake, &info);
    const bool run_it = !info.complete || shard; // which a complete bake refuses
    if (!b->path[0] && !info.complete)
        note("warning: the bake of %s is not kept for the next run: no cache: %s; " CACHE_REMEDY,
             b->technique, b->no_cache);
    enum status status = info.complete ? DONE : estimate(b, shard);
    if (status == DONE && run_it) status = run(b);
    return status == DONE && !run_it ? baking_settle(b) : status;
}

enum status baking_run(struct baking *b, bool shard)
{
    const enum status status = baking_complete(b, shard);
    return status == DONE ? write_file(b, shard) : status;
}

// ---- the files of --bake

enum { TECHNIQUE_SIZE = 32 };

static enum status technique_of(const struct session *session, const char *path,
                                char name[TECHNIQUE_SIZE])
{
    const enum ag_result result = ag_bake_file_technique(session->context, path, name);
    if (result == AG_OK) return DONE;
    fail_library(session->context, result);
    return FAILED; // a file's content is not wrong usage
}

static enum status find_use(const struct session *session, const char *technique, const char *gi,
                            bool *used)
{
    for (int i = 0; !*used; i++) {
        const char *name = NULL;
        const enum ag_result result = ag_bake_technique_in_file(session->context, gi, i, &name);
        if (result != AG_OK) return fail_library(session->context, result);
        if (!name) break;
        *used = strcmp(name, technique) == 0;
    }
    return DONE;
}

static enum status check_use(const struct session *session, const char *path, const char *technique,
                             const char *const *gis, int gi_count)
{
    bool used = false;
    for (int i = 0; i < gi_count; i++) {
        const enum status status = find_use(session, technique, gis[i], &used);
        if (status != DONE) return status;
    }
    if (used) return DONE;
    if (gi_count > 1)
        return fail("cannot use --bake %s: it is of %s, which no --gi uses; leave it out", path,
                    technique);
    return fail("cannot use --bake %s: it is of %s, which --gi %s does not use; leave it out", path,
                technique, gis[0]);
}

enum status bakes_check_files(const struct session *session, const char *const *gis, int gi_count)
{
    const struct arguments *a = session->arguments;
    char names[MAX_BAKE_FILES][TECHNIQUE_SIZE];
    for (int i = 0; i < a->bake_file_count; i++) {
        enum status status = technique_of(session, a->bake_files[i], names[i]);
        if (status == DONE) status = check_use(session, a->bake_files[i], names[i], gis, gi_count);
        if (status != DONE) return status;
        for (int k = 0; k < i; k++)
            if (strcmp(names[k], names[i]) == 0)
                return fail("cannot use --bake %s: --bake %s is of %s too; leave one of them out",
                            a->bake_files[i], a->bake_files[k], names[i]);
    }
    return DONE;
}

// ---- the bakes of a renderer

// The --bake file that names this technique.
static enum status find_given(const struct session *session, const char *technique,
                              const char **path)
{
    const struct arguments *a = session->arguments;
    char name[TECHNIQUE_SIZE];
    *path = NULL;
    for (int i = 0; i < a->bake_file_count; i++) {
        const enum status status = technique_of(session, a->bake_files[i], name);
        if (status != DONE) return status;
        if (strcmp(name, technique) == 0) *path = a->bake_files[i];
    }
    return DONE;
}

static enum status prepare_one(struct baking *b, struct session *session, const char *gi,
                               const char *technique)
{
    const struct arguments *a = session->arguments;
    struct ag_bake_desc desc;
    const char *given = NULL;
    ag_bake_desc_default(&desc);
    desc.technique = technique;
    desc.seed = a->seed;
    enum status status = baking_begin(b, session, gi, &desc, NULL);
    if (status == DONE) status = find_given(session, b->technique, &given);
    if (status != DONE) return status;
    if (baking_is_followed(a)) return baking_follow(b);
    if (given) {
        enum ag_result result = ag_bake_load(b->bake, given);
        b->loaded = result == AG_OK;
        if (result != AG_OK) fail_bake(b, result);
        return result == AG_OK ? baking_settle(b) : FAILED;
    }
    if (baking_load(b)) return baking_settle(b);
    if (a->no_bake)
        return fail("cannot use %s: there is no bake for these options and this scene, and "
                    "--no-bake; see afterglow bake --help",
                    technique);
    return baking_run(b, false);
}

static void add_up(struct bakes *bakes)
{
    bakes->loaded = bakes->count > 0;
    for (int i = 0; i < bakes->count; i++) {
        struct ag_bake_info info;
        ag_bake_get_info(bakes->at[i].bake, &info);
        bakes->bakes[i] = bakes->at[i].bake;
        bakes->loaded = bakes->loaded && bakes->at[i].loaded;
        bakes->seconds += info.seconds;
        bakes->bytes += info.bytes;
    }
}

enum status bakes_prepare(struct bakes *bakes, struct session *session, const char *gi)
{
    *bakes = (struct bakes){ 0 };
    for (int i = 0; i < MAX_BAKES; i++) {
        const char *technique = NULL;
        enum ag_result result = ag_bake_technique(session->context, gi, i, &technique);
        if (result != AG_OK) return fail_library(session->context, result);
        if (!technique) break;
        enum status status = prepare_one(&bakes->at[bakes->count++], session, gi, technique);
        if (status != DONE) return status;
    }
    add_up(bakes);
    return DONE;
}

void bakes_finish(struct bakes *bakes)
{
    for (int i = 0; i < bakes->count; i++) baking_end(&bakes->at[i]);
    *bakes = (struct bakes){ 0 };
}
