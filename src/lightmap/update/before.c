// The scene of an earlier bake: the scene of now, with the instances that have changed as the
// folder's copy has them.
#include "lightmap/update/update.h"

#include "lightmap/write.h"

#include <math.h>
#include <string.h>

// ---- the folder's copy

static bool open_file(struct update_before *b, struct host *host, const char *path)
{
    b->quiet = *host;
    if (b->quiet.log_up_to > LOG_ERROR) b->quiet.log_up_to = LOG_ERROR;
    b->file = scene_load(&b->quiet, path);
    const bool ok = b->file && pose_init(&b->file_pose, b->file, -1, 0.0f) &&
                    scene_statics_init(&b->file_statics, &b->quiet, &b->file_pose);
    if (!ok) host->failure = b->quiet.failure;
    return ok;
}

// Numbers of the copy may be rounded: those of a built-in scene are written as text.
static bool is_near(vec3s a, vec3s b, float tolerance)
{
    const vec3s distance = glms_vec3_abs(glms_vec3_sub(a, b));
    return glms_vec3_max(distance) <= tolerance;
}

static bool is_instance(const struct record_instance *found, const struct record_instance *wanted)
{
    static const float TOLERANCE = 1e-4f; // of the size and of the place
    const float size =
        glms_vec3_max(box3_size(wanted->bounds)) + glms_vec3_max(glms_vec3_abs(wanted->bounds.max));
    return found->triangles == wanted->triangles &&
           is_near(found->bounds.min, wanted->bounds.min, TOLERANCE * size) &&
           is_near(found->bounds.max, wanted->bounds.max, TOLERANCE * size);
}

// An instance of the copy: at the same index in most files.
static uint32_t find_in_file(const struct lightmap_record *file, const struct lightmap_record *was,
                             uint32_t index)
{
    const struct record_instance *wanted = &was->instances[index];
    if (index < file->instance_count && is_instance(&file->instances[index], wanted)) return index;
    for (uint32_t i = 0; i < file->instance_count; i++)
        if (is_instance(&file->instances[i], wanted)) return i;
    return UPDATE_NONE;
}

// ---- the scene

static void shift_map(struct texture_use *use, int images)
{
    if (use->image >= 0) use->image += images;
}

static struct material material_of(const struct scene *file, int material, int images)
{
    struct material m = file->materials[material];
    shift_map(&m.base_color_map, images);
    shift_map(&m.metallic_roughness_map, images);
    shift_map(&m.normal_map, images);
    shift_map(&m.emissive_map, images);
    shift_map(&m.specular_map, images);
    shift_map(&m.specular_color_map, images);
    return m;
}

// Copies `count` elements, with zeroed room for `more`.
static void *extend(struct host *host, const void *from, size_t count, size_t more, size_t size)
{
    char *out = host_alloc(host, count + more, size);
    if (out && count > 0) memcpy(out, from, count * size);
    return out;
}

static bool copy_arrays(struct update_before *b, const struct scene_pose *now, size_t more)
{
    const struct scene *scene = now->scene;
    const size_t images = b->file ? (size_t)b->file->image_count : 0;
    b->scene = *scene;
    b->pose = *now;
    b->pose.scene = &b->scene;
    b->scene.images =
        extend(b->host, scene->images, (size_t)scene->image_count, images, sizeof *scene->images);
    b->scene.materials = extend(b->host, scene->materials, (size_t)scene->material_count, more,
                                sizeof *scene->materials);
    b->scene.meshes =
        extend(b->host, scene->meshes, (size_t)scene->mesh_count, more, sizeof *scene->meshes);
    b->scene.instances = extend(b->host, scene->instances, (size_t)scene->instance_count, more,
                                sizeof *scene->instances);
    b->pose.world_from_node = extend(b->host, now->world_from_node, (size_t)scene->node_count, more,
                                     sizeof *now->world_from_node);
    b->pose.deformed =
        extend(b->host, now->deformed, (size_t)scene->instance_count, more, sizeof *now->deformed);
    if (!b->scene.images || !b->scene.materials || !b->scene.meshes || !b->scene.instances ||
        !b->pose.world_from_node || !b->pose.deformed)
        return false;
    if (images > 0)
        memcpy(b->scene.images + scene->image_count, b->file->images,
               images * sizeof *b->scene.images);
    b->scene.image_count += (int)images;
    return true;
}

// Deformed vertices are in world space; the node tells whether they are mirrored.
static mat4s place_of(const struct scene_pose *file, int instance)
{
    mat4s place = pose_world_from_instance(file, instance);
    if (file->deformed[instance].positions && pose_is_mirrored(file, instance))
        place.m00 = -place.m00;
    return place;
}

// Gives instance `index` the surface of one of the copy.
static void set_instance(struct update_before *b, int index, int of_file)
{
    const struct scene_pose *file = &b->file_statics.pose;
    struct mesh mesh = *scene_mesh_of(file->scene, of_file);
    b->scene.materials[b->scene.material_count] = material_of(
        file->scene, mesh.material, b->scene.image_count - (int)file->scene->image_count);
    mesh.material = b->scene.material_count++;
    b->scene.meshes[b->scene.mesh_count] = mesh;
    b->pose.world_from_node[b->scene.node_count] = place_of(file, of_file);
    b->pose.deformed[index] = file->deformed[of_file];
    b->scene.instances[index] = (struct instance){ .node = b->scene.node_count++,
                                                   .mesh = b->scene.mesh_count++,
                                                   .skin = -1 };
}

static bool fail_missing(struct host *host, const char *path)
{
    return host_fail(host, FAIL_FORMAT,
                     "cannot use %s: it is not of the bake beside it: an instance is missing",
                     path);
}

static bool take_from_file(struct update_before *b, const char *path, int index,
                           const struct lightmap_record *file, const struct lightmap_record *was,
                           uint32_t wanted)
{
    const uint32_t found = find_in_file(file, was, wanted);
    if (found == UPDATE_NONE) return fail_missing(b->host, path);
    set_instance(b, index, (int)found);
    return true;
}

static bool set_instances(struct update_before *b, const char *path,
                          const struct lightmap_record *file, const struct lightmap_record *was,
                          const struct update_match *match)
{
    const int count = b->scene.instance_count;
    bool ok = true;
    for (int i = 0; ok && i < count; i++) {
        if (scene_mesh_of(&b->scene, i)->index_count == 0) continue;
        if (match->was[i] == UPDATE_NONE)
            b->scene.instances[i].mesh = -1; // added since
        else if (!match->same[i])
            ok = take_from_file(b, path, i, file, was, match->was[i]);
    }
    for (uint32_t i = 0; ok && i < was->instance_count; i++)
        if (match->gone[i]) ok = take_from_file(b, path, b->scene.instance_count++, file, was, i);
    return ok;
}

// Instances that are read from the copy.
static size_t count_needed(const struct scene_pose *now, const struct lightmap_record *was,
                           const struct update_match *match)
{
    size_t count = 0;
    for (int i = 0; i < now->scene->instance_count; i++)
        count += match->was[i] != UPDATE_NONE && !match->same[i];
    for (uint32_t i = 0; i < was->instance_count; i++) count += match->gone[i];
    return count;
}

bool update_before_init(struct update_before *out, struct host *host, const char *folder,
                        const struct scene_pose *now, const struct lightmap_record *was,
                        const struct update_match *match)
{
    *out = (struct update_before){ .host = host };
    const size_t needed = count_needed(now, was, match);
    struct lightmap_record file = { 0 };
    char *path = host_sprintf(host, "%s/" LIGHTMAP_SCENE_FILE, folder);
    bool ok = path && (needed == 0 || open_file(out, host, path));
    if (ok && needed > 0)
        ok = lightmap_record_init(&file, host, &out->file_statics.pose, NULL, NULL);
    ok = ok && copy_arrays(out, now, needed) && set_instances(out, path, &file, was, match);
    lightmap_record_finish(&file);
    host_free(host, path);
    if (!ok) update_before_finish(out);
    return ok;
}

void update_before_finish(struct update_before *b)
{
    if (!b->host) return;
    host_free(b->host, b->scene.images);
    host_free(b->host, b->scene.materials);
    host_free(b->host, b->scene.meshes);
    host_free(b->host, b->scene.instances);
    host_free(b->host, b->pose.world_from_node);
    host_free(b->host, b->pose.deformed);
    scene_statics_finish(&b->file_statics);
    pose_finish(&b->file_pose);
    scene_destroy(b->file);
    *b = (struct update_before){ 0 };
}
