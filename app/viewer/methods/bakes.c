#include "bakes.h"

#include "viewer/operations.h"
#include "yielding.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct bake_job {
    const struct viewer_desc *desc;
    char gi[METHOD_SPEC];
    bool other; // for the right part of a split screen
    bool again; // the method runs with older files
    struct edits edits;
    pthread_t thread;
    pthread_mutex_t mutex;
    // under the mutex
    double done, seconds_left;
    char stage[64], error[512];
    // ended is set last
    atomic_bool cancelled, ended;
    bool failed;
};

// ---- the thread

static bool progress(void *user, const struct ag_bake_progress *p)
{
    struct bake_job *job = user;
    pthread_mutex_lock(&job->mutex);
    job->done = p->done;
    job->seconds_left = p->seconds_left;
    snprintf(job->stage, sizeof job->stage, "%.60s", p->stage ? p->stage : "");
    pthread_mutex_unlock(&job->mutex);
    return !job->cancelled;
}

static bool fail(struct bake_job *job, const struct ag_context *context)
{
    pthread_mutex_lock(&job->mutex);
    snprintf(job->error, sizeof job->error, "%s", ag_context_last_error(context));
    pthread_mutex_unlock(&job->mutex);
    return false;
}

// The file of a part. False: there is no cache, as `error` says.
static bool part_path(const struct viewer_desc *desc, const struct ag_bake *bake, int index,
                      struct ag_bake_part *part, char path[4096], char error[512])
{
    return ag_bake_get_part(bake, index, part) == AG_OK &&
           desc->bake_path(desc->user, part->key, path, error);
}

// As far as there are files; true: all.
static bool load_parts(const struct viewer_desc *desc, struct ag_bake *bake, int count)
{
    bool all = true;
    for (int i = 0; i < count; i++) {
        struct ag_bake_part part;
        char path[4096], why[512];
        all = part_path(desc, bake, i, &part, path, why) &&
              (part.complete || ag_bake_load_part(bake, i, path) == AG_OK) && all;
    }
    return all;
}

static bool save_parts(struct bake_job *job, struct ag_bake *bake, int count)
{
    bool all = true;
    for (int i = 0; all && i < count; i++) {
        struct ag_bake_part part;
        char path[4096];
        all = part_path(job->desc, bake, i, &part, path, job->error) &&
              (part.loaded || ag_bake_save_part(bake, i, path, true) == AG_OK);
    }
    return all;
}

// Runs it, or goes on with the checkpoint that render and bake leave, too.
static bool make(struct bake_job *job, struct ag_context *context, struct ag_bake *bake,
                 const char *path, int parts)
{
    char checkpoint[4096 + 16];
    snprintf(checkpoint, sizeof checkpoint, "%s.checkpoint", path);
    const bool done = load_parts(job->desc, bake, parts) ||
                      (ag_bake_set_checkpoint(bake, checkpoint) == AG_OK &&
                       ag_bake_run(bake, progress, job) == AG_OK && save_parts(job, bake, parts));
    return done || fail(job, context);
}

static bool run_one(struct bake_job *job, struct ag_context *context, struct ag_scene *scene,
                    const char *technique)
{
    struct ag_bake_desc desc;
    struct ag_bake_info info;
    struct ag_bake *bake = NULL;
    char path[4096];
    ag_bake_desc_default(&desc);
    desc.technique = technique;
    if (ag_bake_create(scene, job->gi, &desc, &bake) != AG_OK ||
        ag_bake_get_info(bake, &info) != AG_OK)
        return fail(job, context);
    const bool done = job->desc->bake_path(job->desc->user, info.key, path, job->error) &&
                      make(job, context, bake, path, info.part_count);
    ag_bake_destroy(bake);
    return done;
}

static void *run(void *user)
{
    struct bake_job *job = user;
    struct ag_context *context = NULL;
    struct ag_scene *scene = NULL;
    thread_yields();
    bool done = job->desc->open_copy(job->desc->user, &context, &scene, job->error) &&
                (edits_apply(&job->edits, scene) == AG_OK || fail(job, context));
    for (int i = 0; done; i++) {
        const char *technique = NULL;
        if (ag_bake_technique(context, job->gi, i, &technique) != AG_OK) done = fail(job, context);
        if (!done || !technique) break;
        done = run_one(job, context, scene, technique);
    }
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    job->failed = !done;
    job->ended = true;
    window_wake();
    return NULL;
}

// ---- the viewer's thread

// How a method is to run.
struct wanted {
    struct rendering *rendering;
    const char *gi;
    bool again;    // it runs already, with older files
    bool may_bake; // what is not there
};

static bool start(struct viewer *v, const struct wanted *wanted)
{
    struct bake_job *job = calloc(1, sizeof *job);
    if (!job) return false;
    job->desc = v->desc;
    job->other = wanted->rendering == &v->other;
    job->again = wanted->again;
    job->edits = v->edits;
    snprintf(job->gi, sizeof job->gi, "%s", wanted->gi);
    pthread_mutex_init(&job->mutex, NULL);
    if (pthread_create(&job->thread, NULL, run, job) != 0) {
        pthread_mutex_destroy(&job->mutex);
        free(job);
        return false;
    }
    v->bake_job = job;
    viewer_say(v, "baking %s; the old method is shown meanwhile", wanted->gi);
    return true;
}

static void end(struct viewer *v)
{
    pthread_join(v->bake_job->thread, NULL);
    pthread_mutex_destroy(&v->bake_job->mutex);
    free(v->bake_job);
    v->bake_job = NULL;
}

// The bakes that the method needs, as far as there are files; true: all.
static bool load(struct viewer *v, const char *gi, struct ag_bake *bakes[VIEWER_BAKES], int *count)
{
    bool all = true;
    for (int i = 0; i < VIEWER_BAKES; i++) {
        const char *technique = NULL;
        struct ag_bake_desc desc;
        struct ag_bake_info info;
        if (ag_bake_technique(v->desc->context, gi, i, &technique) != AG_OK || !technique) break;
        ag_bake_desc_default(&desc);
        desc.technique = technique;
        const int at = (*count)++;
        all = ag_bake_create(v->desc->scene, gi, &desc, &bakes[at]) == AG_OK &&
              ag_bake_get_info(bakes[at], &info) == AG_OK &&
              load_parts(v->desc, bakes[at], info.part_count) && all;
    }
    return all;
}

// The same spec goes on as it runs: it ends before it begins again, between two frames.
static enum ag_result run_gi(struct viewer *v, const struct wanted *wanted,
                             const struct ag_bake *const *bakes, int count)
{
    struct ag_renderer *renderer = wanted->rendering->renderer;
    if (wanted->again) ag_renderer_set_gi(renderer, "none", NULL, 0);
    const enum ag_result result = ag_renderer_set_gi(renderer, wanted->gi, bakes, count);
    if (wanted->again && result != AG_OK) viewer_runs(v, wanted->rendering == &v->other, "none");
    return result;
}

static bool set_gi(struct viewer *v, const struct wanted *wanted)
{
    struct ag_bake *bakes[VIEWER_BAKES] = { NULL };
    const char *gi = wanted->gi;
    int count = 0;
    const bool all = load(v, gi, bakes, &count), other = wanted->rendering == &v->other;
    enum ag_result result = AG_OK;
    if (all) result = run_gi(v, wanted, (const struct ag_bake *const *)bakes, count);
    for (int i = 0; i < count; i++) ag_bake_destroy(bakes[i]);
    if (!all && wanted->may_bake) {
        if (v->bake_job && v->bake_job->other != other) {
            viewer_warn(v, "%.400s waits: choose it again after the bake of %.400s", gi,
                        v->bake_job->gi);
            return false;
        }
        bakes_cancel(v);
        if (start(v, wanted)) return false;
    }
    if (!all) viewer_warn(v, "%s needs a bake, and that in the cache is of another scene", gi);
    return all && viewer_check(v, result);
}

// The newest choice holds: no bake of an older one takes its place later.
static bool choose(struct viewer *v, const struct wanted *wanted)
{
    const bool done = set_gi(v, wanted);
    if (done) bakes_cancel_part(v, wanted->rendering == &v->other);
    return done;
}

bool bakes_set_gi(struct viewer *v, struct rendering *rendering, const char *gi)
{
    return choose(v, &(struct wanted){ rendering, gi, .may_bake = true });
}

bool bakes_begin_gi_again(struct viewer *v, struct rendering *rendering, const char *gi)
{
    return choose(v, &(struct wanted){ rendering, gi, .again = true, .may_bake = true });
}

bool bakes_running(const struct viewer *v)
{
    return v->bake_job != NULL;
}

double bakes_progress(struct viewer *v, char stage[64], double *seconds_left)
{
    struct bake_job *job = v->bake_job;
    pthread_mutex_lock(&job->mutex);
    const double done = job->done;
    *seconds_left = job->seconds_left;
    snprintf(stage, 64, "%s", job->stage);
    pthread_mutex_unlock(&job->mutex);
    return done;
}

void bakes_cancel(struct viewer *v)
{
    if (!v->bake_job) return;
    v->bake_job->cancelled = true;
    end(v);
}

void bakes_cancel_part(struct viewer *v, bool other)
{
    if (v->bake_job && v->bake_job->other == other) bakes_cancel(v);
}

void bakes_step(struct viewer *v)
{
    struct bake_job *job = v->bake_job;
    char gi[METHOD_SPEC];
    if (!job || !job->ended) return;
    const bool failed = job->failed, other = job->other, again = job->again;
    if (failed) viewer_warn(v, "%s", job->error);
    snprintf(gi, sizeof gi, "%s", job->gi);
    end(v);
    if (failed || (other && !v->split)) return;
    if (!set_gi(v, &(struct wanted){ other ? &v->other : &v->main, gi, again, false })) return;
    viewer_runs(v, other, gi);
    viewer_say(v, "%s is shown", gi);
}
