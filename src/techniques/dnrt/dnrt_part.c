#include "techniques/dnrt/dnrt_part.h"

#include "bake/scene_key.h"

#include <math.h>
#include <stdio.h>

static bool make_arrays(struct dnrt_part *part, int instances)
{
    const struct scene *scene = &part->scene;
    const size_t count = (size_t)instances;
    part->scene.instances = host_alloc(part->host, count, sizeof *scene->instances);
    part->scene.meshes = host_alloc(part->host, count, sizeof *scene->meshes);
    part->scene.nodes = host_alloc(part->host, count, sizeof *scene->nodes);
    part->scene.materials = host_alloc(part->host, count, sizeof *scene->materials);
    part->pose.world_from_node = host_alloc(part->host, count, sizeof *part->pose.world_from_node);
    part->pose.deformed = host_alloc(part->host, count, sizeof *part->pose.deformed);
    return part->scene.instances && part->scene.meshes && part->scene.nodes &&
           part->scene.materials && part->pose.world_from_node && part->pose.deformed;
}

// Normal maps are finer than a volume, and emission is not reflected. Materials are those of the
// part alone: their numbers in the scene do not matter.
static void copy_material(struct dnrt_part *part, const struct scene *from, struct mesh *mesh,
                          int k)
{
    struct material *to = &part->scene.materials[k];
    *to = from->materials[mesh->material];
    mesh->material = k;
    material_clear_emission(to);
    to->normal_map = texture_use_none();
}

// The deformed vertices are the mesh.
static bool copy_deformed(struct dnrt_part *part, const struct scene_pose *pose, int instance,
                          const struct dnrt_root *root, struct mesh *mesh)
{
    const struct deformed_mesh to = {
        .positions = host_alloc(part->host, mesh->vertex_count, sizeof *to.positions),
        .normals = host_alloc(part->host, mesh->vertex_count, sizeof *to.normals),
    };
    mesh->positions = to.positions;
    mesh->normals = to.normals;
    mesh->tangents = NULL;
    mesh->morph_count = 0;
    mesh->own_arrays = true;
    return to.positions && to.normals && dnrt_deformed_mesh(part->host, pose, instance, root, &to);
}

static bool add_instance(struct dnrt_part *part, const struct scene_pose *pose, int instance,
                         const struct dnrt_root *root, mat3s stretch, int k)
{
    const struct scene *from = pose->scene;
    struct mesh *mesh = &part->scene.meshes[k];
    *mesh = *scene_mesh_of(from, instance);
    mesh->own_arrays = false;
    part->scene.nodes[k] = node_default();
    part->scene.instances[k] = (struct instance){ .node = k, .mesh = k, .skin = -1 };
    for (int i = 0; i < 3; i++) part->pose.world_from_node[k].col[i] = vec4_of(stretch.col[i], 0);
    part->pose.world_from_node[k].raw[3][3] = 1.0f;
    copy_material(part, from, mesh, k);
    return !pose->deformed[instance].positions || copy_deformed(part, pose, instance, root, mesh);
}

// ---- the bounding sphere

static vec3s vertex(const struct dnrt_part *part, int mesh, uint32_t index)
{
    return mat4_point(part->pose.world_from_node[mesh], part->scene.meshes[mesh].positions[index]);
}

static vec3s farthest(const struct dnrt_part *part, vec3s from, float *distance)
{
    vec3s at = from;
    *distance = 0.0f;
    for (int k = 0; k < part->scene.mesh_count; k++)
        for (uint32_t i = 0; i < part->scene.meshes[k].index_count; i++) {
            const vec3s p = vertex(part, k, part->scene.meshes[k].indices[i]);
            const float d = glms_vec3_distance(p, from);
            if (d > *distance) {
                *distance = d;
                at = p;
            }
        }
    return at;
}

// The centre moves towards the farthest vertex by 1/(i + 1): within 1/√i of the smallest sphere
// (Bădoiu & Clarkson 2003, "Smaller Core-Sets for Balls").
static void find_sphere(struct dnrt_part *part)
{
    enum { STEPS = 64 };
    struct box3 box = box3_empty();
    for (int k = 0; k < part->scene.mesh_count; k++)
        for (uint32_t i = 0; i < part->scene.meshes[k].index_count; i++)
            box = box3_add_point(box, vertex(part, k, part->scene.meshes[k].indices[i]));
    if (box3_is_empty(box)) return;
    part->box = box;
    vec3s at = box3_centre(box);
    part->centre = at;
    farthest(part, at, &part->radius);
    for (int i = 1; i <= STEPS; i++) {
        float distance;
        const vec3s far = farthest(part, at, &distance);
        if (distance < part->radius) {
            part->radius = distance;
            part->centre = at;
        }
        at = glms_vec3_lerp(at, far, 1.0f / (float)(i + 1));
    }
}

// ----

// Without the sphere.
static bool open_part(struct dnrt_part *out, struct host *host, const struct scene_pose *pose,
                      const struct dnrt_objects *objects, int object)
{
    const struct dnrt_object *of = &objects->at[object];
    struct dnrt_frame frame;
    mat3s stretch;
    *out = (struct dnrt_part){ .host = host, .scene = *pose->scene, .pose = { .scene = NULL } };
    struct scene *scene = &out->scene;
    scene->host = host;
    scene->light_count = scene->camera_count = scene->skin_count = scene->animation_count = 0;
    scene->environment = (struct environment){ 0 };
    scene->instances = NULL;
    scene->meshes = NULL;
    scene->nodes = NULL;
    scene->materials = NULL;
    out->pose.scene = scene;
    if (!make_arrays(out, of->count)) return false;
    scene->instance_count = scene->mesh_count = scene->node_count = scene->material_count =
        of->count;
    if (!dnrt_object_frame(objects, pose, object, &frame, &stretch)) return true; // radius 0
    for (int k = 0; k < of->count; k++)
        if (!add_instance(out, pose, objects->instances[of->first + k], &of->root, stretch, k))
            return false;
    return true;
}

bool dnrt_part_init(struct dnrt_part *out, struct host *host, const struct scene_pose *pose,
                    const struct dnrt_objects *objects, int object)
{
    if (!open_part(out, host, pose, objects, object)) return false;
    find_sphere(out);
    return true;
}

void dnrt_part_finish(struct dnrt_part *part)
{
    if (!part->host) return;
    for (int k = 0; part->scene.meshes && k < part->scene.mesh_count; k++)
        if (part->scene.meshes[k].own_arrays) {
            host_free(part->host, part->scene.meshes[k].positions);
            host_free(part->host, part->scene.meshes[k].normals);
        }
    host_free(part->host, part->scene.instances);
    host_free(part->host, part->scene.meshes);
    host_free(part->host, part->scene.nodes);
    host_free(part->host, part->scene.materials);
    host_free(part->host, part->pose.world_from_node);
    host_free(part->host, part->pose.deformed);
    *part = (struct dnrt_part){ 0 };
}

// ---- keys

const struct scene_pose *dnrt_pose_of_volume(const struct dnrt_objects *objects,
                                             const struct dnrt_key_poses *keys, int volume)
{
    const struct dnrt_shape *shape = &objects->shapes[dnrt_shape_of_volume(objects, volume)];
    return shape->keys > 1 ? dnrt_key_pose(keys, volume - shape->volume) : keys->pose;
}

static bool find_key(struct hash128 *out, struct host *host, const struct dnrt_objects *objects,
                     const struct dnrt_key_poses *keys, int volume)
{
    const struct dnrt_shape *shape = &objects->shapes[dnrt_shape_of_volume(objects, volume)];
    struct dnrt_part part;
    const bool ok =
        open_part(&part, host, dnrt_pose_of_volume(objects, keys, volume), objects, shape->object);
    if (ok) *out = scene_key(&part.pose, SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS);
    // Its points are those of the first key frame.
    if (ok && volume > shape->volume)
        *out = hash128_add(*out, &out[shape->volume - volume], sizeof *out);
    dnrt_part_finish(&part);
    return ok;
}

struct hash128 *dnrt_volume_keys(struct host *host, const struct dnrt_objects *objects,
                                 const struct scene_pose *pose, int keys)
{
    const int count = objects->volume_count;
    struct dnrt_key_poses poses;
    struct hash128 *out = host_alloc(host, (size_t)count, sizeof *out);
    bool ok = dnrt_key_poses_init(&poses, host, pose, keys) && out;
    for (int v = 0; ok && v < count; v++) ok = find_key(&out[v], host, objects, &poses, v);
    dnrt_key_poses_finish(&poses);
    if (ok) return out;
    host_free(host, out);
    return NULL;
}

void dnrt_tensor_name(const char *format, struct hash128 key, char out[DNRT_NAME_SIZE])
{
    char text[HASH128_TEXT];
    hash128_print(key, text);
    snprintf(out, DNRT_NAME_SIZE, format, text);
}
