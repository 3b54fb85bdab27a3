#include "techniques/common/light_map/follow.h"

#include "core/hash.h"

// In the bake.
static bool is_static(const struct light_map_followed *f, uint32_t i)
{
    return i < (uint32_t)f->places.count && f->places.at[i].mesh >= 0;
}

static uint64_t deformed_hash(const struct scene_pose *pose, int i)
{
    const vec3s *positions = pose->deformed[i].positions;
    const size_t count = scene_mesh_of(pose->scene, i)->vertex_count;
    return positions ? hash_bytes(positions, count * sizeof *positions, 0) : 0;
}

bool light_map_followed_init(struct light_map_followed *out, struct host *host,
                             const char *technique, const struct scene_pose *pose,
                             const struct scene_statics *statics)
{
    const uint32_t count = (uint32_t)pose->scene->instance_count;
    *out = (struct light_map_followed){ .host = host,
                                        .technique = technique,
                                        .started = pose->scene->revisions.newest,
                                        .revision = UINT64_MAX };
    out->deformed = host_alloc(host, count, sizeof *out->deformed);
    if (!out->deformed || !light_map_places_init(&out->places, host, &statics->pose)) return false;
    for (uint32_t i = 0; i < count; i++)
        if (is_static(out, i)) out->deformed[i] = deformed_hash(pose, (int)i);
    light_map_followed_update(out, pose);
    return true;
}

void light_map_followed_finish(struct light_map_followed *f)
{
    if (!f->host) return;
    host_free(f->host, f->deformed);
    light_map_places_finish(&f->places, f->host);
    *f = (struct light_map_followed){ 0 };
}

// ---- changes

// Whether its triangles are those of the light map, wherever they are.
static bool has_map(const struct light_map_followed *f, const struct scene_pose *pose, uint32_t i)
{
    if (light_map_is_gone(&f->places, (int)i)) return false;
    return scene_mesh_of(pose->scene, (int)i)->revision <= f->started &&
           deformed_hash(pose, (int)i) == f->deformed[i];
}

static void warn_once(struct light_map_followed *f, bool *warned, const char *what)
{
    if (!*warned) host_log(f->host, LOG_WARNING, "%s: %s", f->technique, what);
    *warned = true;
}

static void check_static(struct light_map_followed *f, const struct scene_pose *pose, uint32_t i)
{
    const bool in_map = has_map(f, pose, i);
    if (!in_map) {
        f->places.moves[i] = (struct light_map_move){ 0 }; // none of its pixels finds the map
        f->any_moved = true;
        f->any_lit |= pose->scene->instances[i].mesh >= 0;
    }
    if (!in_map || f->places.at[i].moved)
        warn_once(
            f, &f->warned_moved,
            "static geometry changed: what moved keeps the light of the bake, and the light that "
            "it blocks and reflects stays; mark as movable what moves");
}

static void check_other(struct light_map_followed *f, const struct scene *scene, uint32_t i)
{
    const struct instance *it = &scene->instances[i];
    f->any_lit |= it->mesh >= 0;
    if (it->mesh >= 0 && it->added > f->started && !it->movable)
        warn_once(f, &f->warned_added,
                  "static instances were added: they block and reflect no indirect light without "
                  "another bake");
}

void light_map_followed_update(struct light_map_followed *f, const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    if (scene->revisions.newest == f->revision) return;
    f->revision = scene->revisions.newest;
    f->any_lit = false;
    f->any_moved = light_map_find_moves(&f->places, pose);
    for (uint32_t i = 0; i < (uint32_t)scene->instance_count; i++) {
        if (is_static(f, i))
            check_static(f, pose, i);
        else
            check_other(f, scene, i);
    }
}
