// Which instances are dynamic objects, and which objects share a volume.
#include "techniques/dnrt/dnrt_object.h"

#include "scene/statics.h"
#include "techniques/dnrt/dnrt_keys.h"

#include <math.h>
#include <string.h>

// ---- objects

// Primitives of a node's mesh are instances that follow each other.
static bool joins(const struct dnrt_objects *out, const struct scene_pose *pose, int instance)
{
    if (out->count == 0 || pose->deformed[instance].positions) return false;
    const struct dnrt_object *last = &out->at[out->count - 1];
    return !last->deformed && out->instances[last->first] + last->count == instance &&
           last->node == pose->scene->instances[instance].node;
}

static bool add_instance(struct dnrt_objects *out, const struct scene_pose *pose, int instance,
                         int *instances)
{
    if (!joins(out, pose, instance)) {
        struct dnrt_object *object = &out->at[out->count++];
        *object = (struct dnrt_object){ .node = pose->scene->instances[instance].node,
                                        .deformed = pose->deformed[instance].positions != NULL,
                                        .first = *instances };
        if (object->deformed && !dnrt_find_root(out->host, pose->scene, instance, &object->root))
            return false;
    }
    out->at[out->count - 1].count++;
    out->instances[(*instances)++] = instance;
    return true;
}

static bool find_objects(struct dnrt_objects *out, const struct scene_pose *pose, bool all)
{
    const struct scene *scene = pose->scene;
    bool *dynamic = scene_dynamic_instances(out->host, scene);
    int instances = 0;
    bool ok = dynamic != NULL;
    for (int i = 0; ok && i < scene->instance_count; i++)
        if ((all || dynamic[i]) && scene_mesh_of(scene, i)->index_count > 0)
            ok = add_instance(out, pose, i, &instances);
    host_free(out->host, dynamic);
    return ok;
}

// ---- frames

bool dnrt_object_frame(const struct dnrt_objects *objects, const struct scene_pose *pose,
                       int object, struct dnrt_frame *frame, mat3s *stretch)
{
    const struct dnrt_object *of = &objects->at[object];
    const int first = objects->instances[of->first];
    const mat4s world_from_mesh = of->deformed ? dnrt_world_from_deformed(pose, first, &of->root)
                                               : pose_world_from_instance(pose, first);
    return dnrt_frame_of(world_from_mesh, frame, stretch);
}

// ---- shapes

// Within two steps of its rounding. That of a deformed object is part of its deformation.
static bool same_stretch(mat3s a, mat3s b)
{
    for (int i = 0; i < 9; i++)
        if (fabsf(a.raw[i / 3][i % 3] - b.raw[i / 3][i % 3]) > 0x1p-11f) return false;
    return true;
}

static bool has_meshes(const struct dnrt_objects *of, const struct dnrt_shape *shape,
                       const struct dnrt_objects *objects, const struct scene_pose *pose,
                       const struct dnrt_object *object)
{
    if (shape->deformed != object->deformed || shape->count != object->count) return false;
    for (int i = 0; i < shape->count; i++) {
        const int instance = objects->instances[object->first + i];
        if (of->meshes[shape->first + i] != pose->scene->instances[instance].mesh) return false;
    }
    return true;
}

int dnrt_find_shape(const struct dnrt_objects *of, const struct dnrt_objects *objects,
                    const struct scene_pose *pose, int object)
{
    struct dnrt_frame frame;
    mat3s stretch;
    if (!dnrt_object_frame(objects, pose, object, &frame, &stretch)) return -1;
    for (int s = 0; s < of->shape_count; s++)
        if (has_meshes(of, &of->shapes[s], objects, pose, &objects->at[object]) &&
            (of->shapes[s].deformed || same_stretch(of->shapes[s].stretch, stretch)))
            return s;
    return -1;
}

static void add_shape(struct dnrt_objects *out, const struct scene_pose *pose, int keys, int object,
                      int *meshes)
{
    const struct dnrt_object *of = &out->at[object];
    struct dnrt_shape *shape = &out->shapes[out->shape_count++];
    struct dnrt_frame frame;
    *shape = (struct dnrt_shape){ .object = object,
                                  .first = *meshes,
                                  .count = of->count,
                                  .volume = out->volume_count,
                                  .keys = of->deformed ? dnrt_keys_of(pose, keys) : 1,
                                  .deformed = of->deformed,
                                  .stretch = glms_mat3_identity() };
    out->volume_count += shape->keys;
    dnrt_object_frame(out, pose, object, &frame, &shape->stretch);
    for (int i = 0; i < of->count; i++)
        out->meshes[(*meshes)++] = pose->scene->instances[out->instances[of->first + i]].mesh;
}

static void find_shapes(struct dnrt_objects *out, const struct scene_pose *pose, int keys)
{
    int meshes = 0;
    for (int i = 0; i < out->count; i++) {
        out->at[i].shape = out->at[i].deformed ? -1 : dnrt_find_shape(out, out, pose, i);
        if (out->at[i].shape >= 0) continue;
        out->at[i].shape = out->shape_count;
        add_shape(out, pose, keys, i, &meshes);
    }
}

int dnrt_shape_of_volume(const struct dnrt_objects *objects, int volume)
{
    int shape = 0;
    while (volume >= objects->shapes[shape].volume + objects->shapes[shape].keys) shape++;
    return shape;
}

bool dnrt_objects_init(struct dnrt_objects *out, struct host *host, const struct scene_pose *pose,
                       int keys, bool all)
{
    const size_t most = (size_t)pose->scene->instance_count;
    *out = (struct dnrt_objects){ .host = host };
    out->instances = host_alloc(host, most, sizeof *out->instances);
    out->meshes = host_alloc(host, most, sizeof *out->meshes);
    out->at = host_alloc(host, most, sizeof *out->at);
    out->shapes = host_alloc(host, most, sizeof *out->shapes);
    if (!out->instances || !out->meshes || !out->at || !out->shapes ||
        !find_objects(out, pose, all))
        return false;
    find_shapes(out, pose, keys);
    return true;
}

void dnrt_objects_finish(struct dnrt_objects *objects)
{
    if (!objects->host) return;
    host_free(objects->host, objects->instances);
    host_free(objects->host, objects->meshes);
    host_free(objects->host, objects->at);
    host_free(objects->host, objects->shapes);
    *objects = (struct dnrt_objects){ 0 };
}
