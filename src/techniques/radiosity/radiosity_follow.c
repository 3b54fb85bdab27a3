#include "techniques/radiosity/radiosity_follow.h"

#include "core/hash.h"

#include <string.h>

struct radiosity_baked {
    bool is_static; // in the bake
    int mesh, material;
    uint64_t added, deformed; // of the instance; hash of its vertices where they are deformed
    mat4s world_from_mesh;
};

static uint64_t deformed_hash(const struct scene_pose *pose, int i)
{
    const vec3s *positions = pose->deformed[i].positions;
    const size_t count = scene_mesh_of(pose->scene, i)->vertex_count;
    return positions ? hash_bytes(positions, count * sizeof *positions, 0) : 0;
}

static struct radiosity_baked baked_of(const struct scene_pose *pose, int i)
{
    const struct instance *it = &pose->scene->instances[i];
    return (struct radiosity_baked){ .is_static = true,
                                     .mesh = it->mesh,
                                     .material = scene_mesh_of(pose->scene, i)->material,
                                     .added = it->added,
                                     .deformed = deformed_hash(pose, i),
                                     .world_from_mesh = pose_world_from_instance(pose, i) };
}

bool radiosity_followed_init(struct radiosity_followed *out, struct host *host,
                             const struct scene_pose *pose, const struct scene_statics *statics)
{
    const uint32_t count = (uint32_t)pose->scene->instance_count;
    *out = (struct radiosity_followed){ .host = host,
                                        .count = count,
                                        .started = pose->scene->revisions.newest,
                                        .revision = UINT64_MAX };
    out->baked = host_alloc(host, count, sizeof *out->baked);
    out->lit = host_alloc(host, count / 32 + 1, sizeof *out->lit);
    if (!out->baked || !out->lit) return false;
    for (uint32_t i = 0; i < count; i++)
        if (statics->scene.instances[i].mesh >= 0) out->baked[i] = baked_of(pose, (int)i);
    radiosity_followed_update(out, pose);
    return true;
}

void radiosity_followed_finish(struct radiosity_followed *f)
{
    if (!f->host) return;
    host_free(f->host, f->baked);
    host_free(f->host, f->lit);
    *f = (struct radiosity_followed){ 0 };
}

// ---- changes

static bool is_in_place(const struct radiosity_followed *f, const struct scene_pose *pose,
                        uint32_t i)
{
    const struct scene *scene = pose->scene;
    const struct radiosity_baked *was = &f->baked[i];
    const struct instance *is = &scene->instances[i];
    if (is->mesh < 0 || is->mesh != was->mesh || is->added != was->added) return false;
    if (scene->meshes[is->mesh].revision > f->started) return false;
    const mat4s now = pose_world_from_instance(pose, (int)i);
    return memcmp(&now, &was->world_from_mesh, sizeof now) == 0 &&
           deformed_hash(pose, (int)i) == was->deformed;
}

static void say(struct radiosity_followed *f, bool *said, const char *what)
{
    if (!*said) host_log(f->host, LOG_WARNING, "radiosity: %s", what);
    *said = true;
}

static void check_static(struct radiosity_followed *f, const struct scene_pose *pose, uint32_t i)
{
    const struct radiosity_baked *was = &f->baked[i];
    if (!is_in_place(f, pose, i)) {
        f->lit[i / 32] |= 1u << i % 32;
        say(f, &f->said_moved,
            "static geometry changed: probes light it, but the light that it blocks and reflects "
            "stays that of the bake; mark as movable what moves");
    } else if (pose->scene->materials[was->material].revision > f->started) {
        say(f, &f->said_material,
            "materials of static geometry changed: the light that it reflects and emits stays "
            "that of the bake");
    }
}

static void check_other(struct radiosity_followed *f, const struct scene *scene, uint32_t i)
{
    if (i < f->count) f->lit[i / 32] |= 1u << i % 32;
    const struct instance *it = &scene->instances[i];
    if (it->mesh >= 0 && it->added > f->started && !it->movable)
        say(f, &f->said_added,
            "static instances were added: probes light them, but they block and reflect no "
            "indirect light without another bake");
}

void radiosity_followed_update(struct radiosity_followed *f, const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    if (scene->revisions.newest == f->revision) return;
    f->revision = scene->revisions.newest;
    f->any_lit = false;
    memset(f->lit, 0, (f->count / 32 + 1) * sizeof *f->lit);
    for (uint32_t i = 0; i < (uint32_t)scene->instance_count; i++) {
        if (i < f->count && f->baked[i].is_static)
            check_static(f, pose, i);
        else
            check_other(f, scene, i);
        const bool lit = i >= f->count || (f->lit[i / 32] >> i % 32 & 1u);
        f->any_lit |= lit && scene->instances[i].mesh >= 0;
    }
}
