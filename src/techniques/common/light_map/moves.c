#include "techniques/common/light_map/moves.h"

#include <string.h>

void light_map_places_finish(struct light_map_places *places, struct host *host)
{
    host_free(host, places->at);
    host_free(host, places->moves);
    *places = (struct light_map_places){ 0 };
}

bool light_map_places_init(struct light_map_places *out, struct host *host,
                           const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    light_map_places_finish(out, host);
    *out = (struct light_map_places){
        .at = host_alloc(host, (size_t)scene->instance_count, sizeof *out->at),
        .moves = host_alloc(host, (size_t)scene->instance_count, sizeof *out->moves)
    };
    if (!out->at || !out->moves) return false;
    out->count = scene->instance_count;
    for (int i = 0; i < out->count; i++) {
        struct light_map_place *at = &out->at[i];
        at->mesh = scene->instances[i].mesh;
        if (at->mesh < 0) continue;
        at->added = scene->instances[i].added;
        at->deformed = pose->deformed[i].positions;
        at->world_from_mesh = pose_world_from_instance(pose, i);
    }
    return true;
}

static struct light_map_move move_of(mat4s m)
{
    return (struct light_map_move){ vec3_xyz(m.col[0]), vec3_xyz(m.col[1]), vec3_xyz(m.col[2]),
                                    vec3_xyz(m.col[3]) };
}

// Whether an instance is elsewhere.
static bool find_move(struct light_map_places *places, const struct scene_pose *pose, int i)
{
    const struct light_map_place *was = &places->at[i];
    const struct scene *scene = pose->scene;
    places->moves[i] = (struct light_map_move){ 0 };
    if (i >= scene->instance_count || scene->instances[i].mesh != was->mesh ||
        scene->instances[i].added != was->added || was->mesh < 0)
        return was->mesh >= 0;
    places->moves[i] = move_of(glms_mat4_identity());
    if (was->deformed) return false; // the map has its triangles as they were
    const mat4s now = pose_world_from_instance(pose, i);
    if (memcmp(&now, &was->world_from_mesh, sizeof now) == 0) return false;
    places->moves[i] = move_of(glms_mat4_mul(was->world_from_mesh, glms_mat4_inv(now)));
    return true;
}

bool light_map_find_moves(struct light_map_places *places, const struct scene_pose *pose)
{
    bool moved = false;
    for (int i = 0; i < places->count; i++) {
        places->at[i].moved = find_move(places, pose, i);
        moved |= places->at[i].moved;
    }
    return moved;
}
