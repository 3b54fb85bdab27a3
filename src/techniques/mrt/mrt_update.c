#include "techniques/mrt/mrt_state.h"

#include "core/parallel.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

// Bytes that a frame copies at most.
static const size_t COPIED = 4u << 20;

static void keep_message(void *user, enum log_level level, const char *text)
{
    struct mrt_update *update = user;
    if (level == LOG_ERROR) snprintf(update->error, sizeof update->error, "%s", text);
}

static double now(void)
{
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

// ---- the thread

static bool make(struct mrt *mrt)
{
    struct mrt_update *u = &mrt->update;
    const struct mrt_build how = { .cache = &u->cache, .plan = &u->plan, .stop = &u->stop };
    const bool ok = mrt_parts_init(u->parts, &u->host, mrt, &u->snapshot.pose, &mrt->parts) &&
                    !mrt_is_stopped(&u->stop) &&
                    mrt_make_runtime(mrt, &u->host, u->parts, &how, &u->next);
    mrt_parts_end_inputs(u->parts);
    return ok;
}

static void *run(void *user)
{
    struct mrt *mrt = user;
    const double begin = now();
    // The other half is for frames.
    if (!mrt->update.waited_for) parallel_limit(parallel_threads() / 2);
    mrt->update.ok = make(mrt);
    mrt->update.seconds = now() - begin;
    atomic_store(&mrt->update.done, true);
    return NULL;
}

static void find_moves(struct mrt *mrt)
{
    struct mrt_update *u = &mrt->update;
    const bool moved = light_map_find_moves(&u->places, u->pose);
    mrt->runtime.clutter.map.surfaces.moves = moved ? u->places.moves : NULL;
}

// ---- its results

// Drops the unfinished update but keeps the snapshot, so that its pose is not tried again.
static void drop(struct mrt *mrt)
{
    struct mrt_update *u = &mrt->update;
    if (u->next.gpu) mrt_runtime_finish(&u->next);
    u->next = (struct mrt_runtime){ 0 };
    mrt_plan_finish(&u->plan);
    if (u->parts) mrt_parts_finish(u->parts);
    u->state = MRT_IDLE;
}

static void fail(struct mrt *mrt, const char *why)
{
    struct mrt_update *u = &mrt->update;
    if (!u->warned_failure)
        host_log(mrt->host, LOG_WARNING,
                 "%s: the scene changed, but indirect light stays as it was: %s",
                 mrt->delta ? "drt" : "mrt", why);
    u->warned_failure = true;
    drop(mrt);
}

static void log_walls(struct mrt *mrt)
{
    if (!mrt->update.warned_walls)
        host_log(mrt->host, LOG_WARNING,
                 "drt: walls changed, but the blocks keep those at the renderer's creation; only "
                 "objects inside blocks may move; lpv and vct follow all surfaces");
    mrt->update.warned_walls = true;
}

static bool had_walls(const struct mrt_parts *parts, int instance)
{
    return instance < parts->instance_count && parts->has_walls[instance];
}

static void check_walls(struct mrt *mrt)
{
    const struct mrt_update *u = &mrt->update;
    for (int i = 0; mrt->delta && i < u->changed_count; i++)
        if (u->changed[i] && (had_walls(&mrt->parts, i) || had_walls(u->parts, i))) {
            log_walls(mrt);
            return;
        }
}

static void join(struct mrt *mrt)
{
    struct mrt_update *u = &mrt->update;
    pthread_join(u->thread, NULL);
    if (!u->ok) {
        fail(mrt, u->error);
        return;
    }
    check_walls(mrt);
    u->next.gpu = mrt->gpu;
    u->next.host = mrt->host;
    if (!light_map_places_init(&u->next_places, &u->host, &u->snapshot.pose) ||
        !gpu_objects_create(mrt->gpu, &u->next.objects, 0, &u->next)) {
        fail(mrt, "out of memory");
        return;
    }
    u->warned_failure = false;
    u->state = MRT_COPYING;
    host_log(mrt->host, LOG_DEBUG, "drt: operators of %d blocks with objects made again in %.2f s",
             u->cache.traced, u->seconds);
}

// ---- starting it

static bool note_changes(struct mrt_update *u, const struct scene_pose *pose)
{
    const int then = u->snapshot.scene.instance_count, is = pose->scene->instance_count;
    host_free(&u->host, u->changed);
    u->changed_count = then > is ? then : is;
    u->changed = host_alloc(&u->host, (size_t)u->changed_count, sizeof *u->changed);
    for (int i = 0; u->changed && i < u->changed_count; i++)
        u->changed[i] = !scene_snapshot_has_instance(&u->snapshot, pose, i);
    if (!u->changed) u->changed_count = 0;
    return u->changed;
}

static void start(struct mrt *mrt, const struct scene_pose *pose)
{
    struct mrt_update *u = &mrt->update;
    u->error[0] = 0;
    u->cache.traced = 0;
    u->waited_for = u->waits;
    u->plan = (struct mrt_plan){ .host = &u->host, .columns = mrt->runtime.columns };
    atomic_store(&u->stop, false);
    atomic_store(&u->done, false);
    if (!note_changes(u, pose) || !scene_snapshot_take(&u->snapshot, pose))
        fail(mrt, u->error);
    else if (pthread_create(&u->thread, NULL, run, mrt) != 0)
        fail(mrt, "no thread could be started");
    else
        u->state = MRT_RUNNING;
}

// Tubes have no clutter.
static bool can_move_objects(const struct mrt *mrt)
{
    return mrt->delta && !mrt_block_is_tube(&mrt->map.blocks[0]);
}

static bool has_other_materials(const struct mrt *mrt, const struct scene_pose *pose)
{
    return mrt->update.snapshot.materials != pose->scene->revisions.materials;
}

static void follow(struct mrt *mrt, const struct scene_pose *pose)
{
    struct mrt_update *u = &mrt->update;
    const bool wait = u->waits;
    if (!u->host.log || mrt->map.count == 0) return;
    if (u->state == MRT_RUNNING && (wait || atomic_load(&u->done))) join(mrt);
    if (u->state == MRT_RUNNING || (u->state == MRT_COPYING && !wait)) return;
    if (!has_other_materials(mrt, pose) && !can_move_objects(mrt)) {
        if (mrt->delta && !scene_snapshot_is_current(&u->snapshot, pose)) log_walls(mrt);
        return;
    }
    if (scene_snapshot_is_current(&u->snapshot, pose)) return;
    drop(mrt);
    start(mrt, pose);
    if (wait && u->state == MRT_RUNNING) join(mrt);
}

void mrt_update_follow(struct mrt *mrt, const struct scene_pose *pose, bool wait)
{
    mrt->update.waits = wait || mrt->options.update == MRT_UPDATE_WAIT;
    follow(mrt, pose);
    mrt->update.pose = pose;
    find_moves(mrt);
}

bool mrt_update_record(struct mrt *mrt, struct gpu_cmd *cmd)
{
    struct mrt_update *u = &mrt->update;
    if (u->state != MRT_COPYING) return false;
    const size_t most = u->waits ? SIZE_MAX : COPIED;
    if (!mrt_plan_record(&u->plan, &u->next, cmd, most)) return false;
    mrt_runtime_finish(&mrt->runtime);
    mrt->runtime = u->next;
    u->next = (struct mrt_runtime){ 0 };
    light_map_places_finish(&u->places, &u->host);
    u->places = u->next_places;
    u->next_places = (struct light_map_places){ 0 };
    find_moves(mrt);
    mrt_parts_replace(&mrt->parts, u->parts);
    if (mrt->options.solver == MRT_SOLVER_CPU)
        mrt_host_solver_set_reflectance(&mrt->host_solver, mrt->parts.images.geometry);
    drop(mrt);
    return true;
}

// ---- creation

bool mrt_update_follow_materials(struct mrt *mrt, const struct scene_pose *pose, bool wait)
{
    struct mrt_update *u = &mrt->update;
    if (mrt->map.count == 0) return true;
    if (!u->host.log) {
        if (mrt->materials == pose->scene->revisions.materials) return true;
        if (!mrt_update_init(mrt, pose)) return false;
        u->snapshot.materials = mrt->materials; // the run time is of those before
    }
    mrt_update_follow(mrt, pose, wait);
    return true;
}

bool mrt_update_init(struct mrt *mrt, const struct scene_pose *pose)
{
    struct mrt_update *u = &mrt->update;
    u->host = host_default();
    u->host.log = keep_message;
    u->host.user = u;
    u->snapshot.host = &u->host;
    u->parts = host_alloc(&u->host, 1, sizeof *u->parts);
    return (u->parts && scene_snapshot_take(&u->snapshot, pose) &&
            light_map_places_init(&u->places, &u->host, &u->snapshot.pose) &&
            mrt_delta_cache_init(&u->cache, &u->host, mrt->map.count)) ||
           mrt_update_pass_on(mrt);
}

bool mrt_update_pass_on(struct mrt *mrt)
{
    const struct mrt_update *u = &mrt->update;
    if (u->error[0]) host_fail(mrt->host, u->host.failure, "%s", u->error);
    return false;
}

void mrt_update_finish(struct mrt *mrt)
{
    struct mrt_update *u = &mrt->update;
    if (!u->host.log) return;
    if (u->state == MRT_RUNNING) {
        atomic_store(&u->stop, true);
        pthread_join(u->thread, NULL);
    }
    drop(mrt);
    light_map_places_finish(&u->places, &u->host);
    light_map_places_finish(&u->next_places, &u->host);
    host_free(&u->host, u->parts);
    host_free(&u->host, u->changed);
    mrt_delta_cache_finish(&u->cache);
    scene_snapshot_finish(&u->snapshot);
}
