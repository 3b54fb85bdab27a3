#include "scene/snapshot.h"

#include "scene/environment/environment_map.h"

#include <string.h>

// Vertices of a mesh, at a revision.
struct snapshot_mesh {
    uint64_t revision;
    vec3s *positions, *normals; // NULL: none taken
    vec4s *tangents;
};

struct snapshot_deformed {
    vec3s *positions, *normals;
    vec4s *tangents;
};

// ---- taking

static void *copy_of(struct host *host, const void *from, size_t count, size_t size)
{
    void *to = host_alloc(host, count, size);
    if (to && count > 0) memcpy(to, from, count * size);
    return to;
}

// Replaces an array of the copy; one of length 0 has a pointer, too.
#define TAKE(to, from, count)                                                                      \
    (host_free(s->host, to), (to) = copy_of(s->host, from, (size_t)(count), sizeof *(to)))

static bool copy_arrays(struct scene_snapshot *s, const struct scene_pose *pose)
{
    const struct scene old = s->scene;
    environment_map_retain(pose->scene->environment.map);
    environment_map_release(old.environment.map);
    s->scene = *pose->scene;
    s->scene.host = s->host;
    s->scene.images = old.images;
    s->scene.materials = old.materials;
    s->scene.meshes = old.meshes;
    s->scene.nodes = old.nodes;
    s->scene.instances = old.instances;
    s->scene.lights = old.lights;
    s->scene.camera_count = s->scene.animation_count = 0;
    const struct scene *from = pose->scene;
    mat4s *world = s->pose.world_from_node;
    s->pose = *pose;
    s->pose.scene = &s->scene;
    s->pose.workspace = NULL;
    s->pose.morph_weights = NULL;
    s->pose.morph_offset = NULL;
    s->pose.deformed = NULL;
    s->pose.world_from_node = world;
    return TAKE(s->scene.images, from->images, from->image_count) &&
           TAKE(s->scene.materials, from->materials, from->material_count) &&
           TAKE(s->scene.meshes, from->meshes, from->mesh_count) &&
           TAKE(s->scene.nodes, from->nodes, from->node_count) &&
           TAKE(s->scene.instances, from->instances, from->instance_count) &&
           TAKE(s->scene.lights, from->lights, from->light_count) &&
           TAKE(s->pose.world_from_node, pose->world_from_node, from->node_count);
}

static void free_mesh(struct scene_snapshot *s, struct snapshot_mesh *mesh)
{
    host_free(s->host, mesh->positions);
    host_free(s->host, mesh->normals);
    host_free(s->host, mesh->tangents);
    *mesh = (struct snapshot_mesh){ 0 };
}

static bool copy_mesh(struct scene_snapshot *s, const struct mesh *from, struct snapshot_mesh *to)
{
    const size_t count = from->vertex_count;
    if (to->positions && to->revision == from->revision) return true;
    free_mesh(s, to);
    to->revision = from->revision;
    to->positions = copy_of(s->host, from->positions, count, sizeof *to->positions);
    to->normals = copy_of(s->host, from->normals, count, sizeof *to->normals);
    if (from->tangents)
        to->tangents = copy_of(s->host, from->tangents, count, sizeof *to->tangents);
    return to->positions && to->normals && (!from->tangents || to->tangents);
}

static bool grow_vertices(struct scene_snapshot *s, int meshes)
{
    if (meshes <= s->vertices_count) return true;
    struct snapshot_mesh *grown =
        host_realloc(s->host, s->vertices, (size_t)meshes, sizeof *s->vertices);
    if (!grown) return false;
    memset(grown + s->vertices_count, 0, (size_t)(meshes - s->vertices_count) * sizeof *grown);
    s->vertices = grown;
    s->vertices_count = meshes;
    return true;
}

// Copies the vertices of meshes with instances. An array that meshes share is never overwritten.
static bool copy_vertices(struct scene_snapshot *s, const struct scene *scene)
{
    if (!grow_vertices(s, scene->mesh_count)) return false;
    for (int i = 0; i < scene->instance_count; i++) {
        const int m = scene->instances[i].mesh;
        if (m < 0 || !scene->meshes[m].own_arrays) continue;
        if (!copy_mesh(s, &scene->meshes[m], &s->vertices[m])) return false;
        s->scene.meshes[m].positions = s->vertices[m].positions;
        s->scene.meshes[m].normals = s->vertices[m].normals;
        s->scene.meshes[m].tangents = s->vertices[m].tangents;
    }
    return true;
}

static void free_deformed(struct scene_snapshot *s, int instances)
{
    for (int i = 0; s->deformed && i < instances; i++) {
        host_free(s->host, s->deformed[i].positions);
        host_free(s->host, s->deformed[i].normals);
        host_free(s->host, s->deformed[i].tangents);
    }
    host_free(s->host, s->deformed);
    s->deformed = NULL;
}

static bool copy_deformed_mesh(struct scene_snapshot *s, const struct deformed_mesh *from,
                               size_t vertices, struct snapshot_deformed *to)
{
    to->positions = copy_of(s->host, from->positions, vertices, sizeof *to->positions);
    to->normals = copy_of(s->host, from->normals, vertices, sizeof *to->normals);
    if (from->tangents)
        to->tangents = copy_of(s->host, from->tangents, vertices, sizeof *to->tangents);
    return to->positions && to->normals && (!from->tangents || to->tangents);
}

static bool copy_deformed(struct scene_snapshot *s, const struct scene_pose *pose)
{
    const int count = pose->scene->instance_count;
    s->deformed = host_alloc(s->host, (size_t)count, sizeof *s->deformed);
    s->pose.deformed = host_alloc(s->host, (size_t)count, sizeof *s->pose.deformed);
    if (!s->deformed || !s->pose.deformed) return false;
    for (int i = 0; i < count; i++) {
        struct snapshot_deformed *to = &s->deformed[i];
        if (!pose->deformed[i].positions) continue;
        if (!copy_deformed_mesh(s, &pose->deformed[i], scene_mesh_of(pose->scene, i)->vertex_count,
                                to))
            return false;
        s->pose.deformed[i] = (struct deformed_mesh){ to->positions, to->normals, to->tangents };
    }
    return true;
}

bool scene_snapshot_take(struct scene_snapshot *s, const struct scene_pose *pose)
{
    free_deformed(s, s->scene.instance_count);
    host_free(s->host, s->pose.deformed);
    s->materials = pose->scene->revisions.materials;
    if (copy_arrays(s, pose) && copy_vertices(s, pose->scene) && copy_deformed(s, pose))
        return true;
    struct host *host = s->host;
    scene_snapshot_finish(s);
    s->host = host;
    return false;
}

void scene_snapshot_finish(struct scene_snapshot *s)
{
    if (!s->host) return;
    environment_map_release(s->scene.environment.map);
    free_deformed(s, s->scene.instance_count);
    for (int m = 0; m < s->vertices_count; m++) free_mesh(s, &s->vertices[m]);
    void *const arrays[] = { s->scene.images,  s->scene.materials, s->scene.meshes,
                             s->scene.nodes,   s->scene.instances, s->scene.lights,
                             s->pose.deformed, s->vertices,        s->pose.world_from_node };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) host_free(s->host, arrays[i]);
    *s = (struct scene_snapshot){ 0 };
}

// ---- comparing

static bool same_deformed(const struct scene_snapshot *s, const struct scene_pose *pose, int i,
                          size_t vertices)
{
    const vec3s *then = s->pose.deformed[i].positions, *now = pose->deformed[i].positions;
    return then && memcmp(then, now, vertices * sizeof *now) == 0;
}

bool scene_snapshot_has_instance(const struct scene_snapshot *s, const struct scene_pose *pose,
                                 int i)
{
    const bool then = i < s->scene.instance_count && s->scene.instances[i].mesh >= 0;
    const bool now = i < pose->scene->instance_count && pose->scene->instances[i].mesh >= 0;
    if (!then || !now) return then == now;
    const struct instance *was = &s->scene.instances[i], *is = &pose->scene->instances[i];
    const struct mesh *mesh = &pose->scene->meshes[is->mesh];
    if (was->mesh != is->mesh || was->skin != is->skin ||
        s->scene.meshes[was->mesh].revision != mesh->revision)
        return false;
    if (pose->deformed[i].positions) return same_deformed(s, pose, i, mesh->vertex_count);
    return memcmp(&s->pose.world_from_node[was->node], &pose->world_from_node[is->node],
                  sizeof(mat4s)) == 0;
}

bool scene_snapshot_is_current(const struct scene_snapshot *s, const struct scene_pose *pose)
{
    const int now = pose->scene->instance_count, then = s->scene.instance_count;
    if (!s->scene.instances || s->materials != pose->scene->revisions.materials) return false;
    for (int i = 0; i < (now > then ? now : then); i++)
        if (!scene_snapshot_has_instance(s, pose, i)) return false;
    return true;
}
