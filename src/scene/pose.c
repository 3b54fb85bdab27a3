// A scene at a time: node transforms from the rest pose and an animation (animation_sample.c),
// deformed vertices (deform.c), bounds, and lights and cameras in world space.
#include "scene/pose.h"

#include "scene/animation_sample.h"
#include "scene/deform.h"

#include "core/hash.h"

#include <math.h>
#include <string.h>

// Cached bounds of one rigid instance, valid while its mesh and its transform stay the same.
struct rigid_bounds {
    bool valid;
    int mesh;
    uint64_t revision; // of the mesh
    mat4s world_from_mesh;
    struct box3 box;
};

struct pose_workspace {
    struct arena arena;
    struct node_local *local; // [node_count]
    struct deformer deformer;
    struct rigid_bounds *bounds; // [instance_count]
    int bounds_count;            // never falls: indices of removed instances stay
};

static bool instance_deforms(const struct scene *scene, int instance)
{
    const struct instance *it = &scene->instances[instance];
    return it->skin >= 0 || scene_mesh_of(scene, instance)->morph_count > 0;
}

// Concatenated morph weights of all instances.
static bool create_morph_weights(struct scene_pose *pose, struct arena *arena)
{
    const struct scene *scene = pose->scene;
    size_t total = 0;
    for (int i = 0; i < scene->instance_count; i++) {
        pose->morph_offset[i] = total;
        size_t morph_count = (size_t)scene_mesh_of(scene, i)->morph_count;
        if (!size_add(total, morph_count, &total)) {
            return host_fail(scene->host, FAIL_MEMORY, "pose of %s: too many morph weights",
                             scene->name);
        }
    }
    pose->morph_weights = arena_alloc(arena, total, sizeof *pose->morph_weights);
    return pose->morph_weights != NULL;
}

static bool create_deformed(struct scene_pose *pose, struct arena *arena)
{
    const struct scene *scene = pose->scene;
    for (int i = 0; i < scene->instance_count; i++) {
        if (!instance_deforms(scene, i)) continue;
        const struct mesh *mesh = scene_mesh_of(scene, i);
        struct deformed_mesh *deformed = &pose->deformed[i];
        deformed->positions = arena_alloc(arena, mesh->vertex_count, sizeof(vec3s));
        deformed->normals = arena_alloc(arena, mesh->vertex_count, sizeof(vec3s));
        if (!deformed->positions || !deformed->normals) return false;
        if (!mesh->tangents) continue;
        deformed->tangents = arena_alloc(arena, mesh->vertex_count, sizeof(vec4s));
        if (!deformed->tangents) return false;
    }
    return true;
}

static bool create_arrays(struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    struct pose_workspace *work = pose->workspace;
    struct arena *arena = &work->arena;
    size_t nodes = (size_t)scene->node_count, instances = (size_t)scene->instance_count;
    pose->world_from_node = arena_alloc(arena, nodes, sizeof *pose->world_from_node);
    pose->morph_offset = arena_alloc(arena, instances, sizeof *pose->morph_offset);
    pose->deformed = arena_alloc(arena, instances, sizeof *pose->deformed);
    work->local = arena_alloc(arena, nodes, sizeof *work->local);
    work->bounds = arena_alloc(arena, instances, sizeof *work->bounds);
    if (!pose->world_from_node || !pose->morph_offset || !pose->deformed || !work->local ||
        !work->bounds) {
        return false;
    }
    return create_morph_weights(pose, arena) && create_deformed(pose, arena) &&
           deformer_init(&work->deformer, arena, scene);
}

static bool create_workspace(struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    pose->layout = scene->revisions.layout;
    pose->workspace = host_alloc(scene->host, 1, sizeof *pose->workspace);
    if (!pose->workspace) return false;
    arena_init(&pose->workspace->arena, scene->host);
    pose->workspace->bounds_count = scene->instance_count;
    if (create_arrays(pose)) return true;
    pose_finish(pose);
    return false;
}

bool pose_init(struct scene_pose *pose, const struct scene *scene, int animation, float time_s)
{
    *pose = (struct scene_pose){ .scene = scene, .bounds = box3_empty() };
    if (animation < -1 || animation >= scene->animation_count || !isfinite(time_s)) {
        return host_fail(scene->host, FAIL_ARGUMENT,
                         "pose of %s: animation %d at %g s, but it has %d animations", scene->name,
                         animation, (double)time_s, scene->animation_count);
    }
    if (!create_workspace(pose)) return false;
    pose_update(pose, animation, time_s);
    return true;
}

bool pose_follow(struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    struct scene_pose made = { .scene = scene, .bounds = box3_empty() };
    if (pose->layout == scene->revisions.layout) return true;
    if (!create_workspace(&made)) return false;
    const struct pose_workspace *old = pose->workspace;
    memcpy(made.workspace->bounds, old->bounds, (size_t)old->bounds_count * sizeof *old->bounds);
    pose_finish(pose);
    *pose = made;
    return true;
}

void pose_finish(struct scene_pose *pose)
{
    if (pose->workspace) {
        arena_finish(&pose->workspace->arena);
        host_free(pose->scene->host, pose->workspace);
    }
    *pose = (struct scene_pose){ .bounds = box3_empty() };
}

static mat4s matrix_of_local(const struct node_local *local)
{
    mat4s matrix = glms_quat_mat4(local->rotation);
    for (int axis = 0; axis < 3; axis++) {
        matrix.col[axis] = glms_vec4_scale(matrix.col[axis], local->scale.raw[axis]);
    }
    matrix.col[3] = vec4_of(local->translation, 1);
    return matrix;
}

// Animation replaces a node's matrix by translation, rotation and scale (glTF 2.0, 3.6.2: nodes
// with a matrix are not animated).
static mat4s parent_from_node(const struct scene_pose *pose, int node)
{
    const struct node_local *local = &pose->workspace->local[node];
    return pose->scene->nodes[node].has_matrix && !local->animated ? pose->scene->nodes[node].matrix
                                                                   : matrix_of_local(local);
}

// Parents come before their children, so one pass is enough.
static void update_nodes(struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    for (int i = 0; i < scene->node_count; i++) {
        const int parent = scene->nodes[i].parent;
        const mat4s local = parent_from_node(pose, i);
        pose->world_from_node[i] =
            parent < 0 ? local : glms_mat4_mul(pose->world_from_node[parent], local);
    }
}

// Whether the transform maps axes to axes: a transformed box is then exact.
static bool maps_axes_to_axes(mat4s m)
{
    for (int column = 0; column < 3; column++) {
        int used = 0;
        for (int row = 0; row < 3; row++) used += m.raw[column][row] != 0.0f;
        if (used > 1) return false;
    }
    return true;
}

static struct box3 bounds_of_points(const vec3s *points, uint32_t count)
{
    struct box3 box = box3_empty();
    for (uint32_t v = 0; v < count; v++) box = box3_add_point(box, points[v]);
    return box;
}

static struct box3 bounds_of_transformed_points(mat4s to_from, const vec3s *points, uint32_t count)
{
    struct box3 box = box3_empty();
    for (uint32_t v = 0; v < count; v++) box = box3_add_point(box, mat4_point(to_from, points[v]));
    return box;
}

static struct box3 instance_bounds(struct scene_pose *pose, int instance)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    if (pose->deformed[instance].positions) {
        return bounds_of_points(pose->deformed[instance].positions, mesh->vertex_count);
    }
    if (box3_is_empty(mesh->bounds)) return box3_empty();
    mat4s world_from_mesh = pose_world_from_instance(pose, instance);
    // Exact bounds of a moving mesh would take time in proportion to its vertices in each frame.
    if (maps_axes_to_axes(world_from_mesh) || pose->scene->instances[instance].movable)
        return box3_transform(world_from_mesh, mesh->bounds);
    struct rigid_bounds *cached = &pose->workspace->bounds[instance];
    if (!cached->valid || cached->revision != mesh->revision ||
        cached->mesh != pose->scene->instances[instance].mesh ||
        memcmp(&cached->world_from_mesh, &world_from_mesh, sizeof world_from_mesh) != 0) {
        *cached = (struct rigid_bounds){ .valid = true,
                                         .mesh = pose->scene->instances[instance].mesh,
                                         .revision = mesh->revision,
                                         .world_from_mesh = world_from_mesh };
        cached->box =
            bounds_of_transformed_points(world_from_mesh, mesh->positions, mesh->vertex_count);
    }
    return cached->box;
}

void pose_update(struct scene_pose *pose, int animation, float time_s)
{
    const struct scene *scene = pose->scene;
    struct pose_workspace *work = pose->workspace;
    pose->animation = animation < scene->animation_count ? animation : -1;
    pose->time_s = time_s;
    rest_pose(scene, work->local, pose->morph_weights, pose->morph_offset);
    if (pose->animation >= 0) {
        animate(scene, &scene->animations[animation], time_s, work->local, pose->morph_weights,
                pose->morph_offset);
    }
    update_nodes(pose);
    deform(&work->deformer, pose);
    pose->bounds = box3_empty();
    for (int i = 0; i < scene->instance_count; i++) {
        struct box3 box = instance_bounds(pose, i);
        if (!box3_is_empty(box)) pose->bounds = box3_union(pose->bounds, box);
    }
}

mat4s pose_world_from_instance(const struct scene_pose *pose, int instance)
{
    if (pose->deformed[instance].positions) return glms_mat4_identity();
    return pose->world_from_node[pose->scene->instances[instance].node];
}

uint64_t pose_surfaces_hash(const struct scene_pose *pose)
{
    uint64_t hash = 0;
    for (int i = 0; i < pose->scene->instance_count; i++) {
        const vec3s *deformed = pose->deformed[i].positions;
        const mat4s world_from_mesh = pose_world_from_instance(pose, i);
        const size_t vertices = scene_mesh_of(pose->scene, i)->vertex_count;
        hash = deformed ? hash_bytes(deformed, vertices * sizeof *deformed, hash)
                        : hash_bytes(&world_from_mesh, sizeof world_from_mesh, hash);
    }
    return hash;
}

mat4s pose_ancestor_from_node(const struct scene_pose *pose, int ancestor, int node)
{
    mat4s m = glms_mat4_identity();
    for (int n = node; n >= 0 && n != ancestor; n = pose->scene->nodes[n].parent)
        m = glms_mat4_mul(parent_from_node(pose, n), m);
    return m;
}

static bool is_mirroring(mat4s m)
{
    return glms_mat4_det(m) < 0.0f;
}

bool pose_is_mirrored(const struct scene_pose *pose, int instance)
{
    const struct instance *i = &pose->scene->instances[instance];
    if (i->skin < 0) return is_mirroring(pose->world_from_node[i->node]);
    const struct skin *skin = &pose->scene->skins[i->skin];
    if (skin->joint_count == 0) return false;
    return is_mirroring(
        glms_mat4_mul(pose->world_from_node[skin->joints[0]], skin->joint_from_mesh[0]));
}

// A direction in world space, normalised; `fallback` where the node's transform maps it to zero.
static vec3s node_direction(const struct scene_pose *pose, int node, vec3s direction,
                            vec3s fallback)
{
    vec3s transformed = mat4_direction(pose->world_from_node[node], direction);
    float length = glms_vec3_norm(transformed);
    return length > 0.0f && isfinite(length) ? glms_vec3_scale(transformed, 1.0f / length)
                                             : fallback;
}

int pose_light_count(const struct scene_pose *pose)
{
    struct world_light sun;
    return pose->scene->light_count + environment_sun_light(&pose->scene->environment, &sun);
}

struct world_light pose_light(const struct scene_pose *pose, int light)
{
    struct world_light sun;
    if (light == pose->scene->light_count && environment_sun_light(&pose->scene->environment, &sun))
        return sun;
    const struct light *source = &pose->scene->lights[light];
    vec3s back = vec3_of(0, 0, -1);
    return (struct world_light){
        .type = source->type,
        .position = vec3_xyz(pose->world_from_node[source->node].col[3]),
        .direction = node_direction(pose, source->node, back, back),
        .intensity = source->off ? vec3_of(0, 0, 0) : source->intensity,
        .cos_inner = cosf(source->inner_rad),
        .cos_outer = cosf(source->outer_rad),
        .range_m = source->range_m,
    };
}

// The unit vector nearest to `up` that is orthogonal to `forward`. For parallel vectors, the limit
// of a horizontal camera that tilts up or down.
static vec3s orthogonal_up(vec3s forward, vec3s up)
{
    vec3s rest = glms_vec3_sub(up, glms_vec3_scale(forward, glms_vec3_dot(up, forward)));
    if (glms_vec3_norm(rest) < 1e-4f) {
        up = vec3_of(0, 0, forward.y < 0.0f ? -1.0f : 1.0f);
        if (fabsf(forward.z) > 0.9f) up = vec3_of(0, 1, 0);
        rest = glms_vec3_sub(up, glms_vec3_scale(forward, glms_vec3_dot(up, forward)));
    }
    return glms_vec3_normalize(rest);
}

struct world_camera pose_camera(const struct scene_pose *pose, int camera)
{
    const struct camera *source = &pose->scene->cameras[camera];
    vec3s forward = node_direction(pose, source->node, vec3_of(0, 0, -1), vec3_of(0, 0, -1));
    vec3s up = node_direction(pose, source->node, vec3_of(0, 1, 0), vec3_of(0, 1, 0));
    return (struct world_camera){
        .eye = vec3_xyz(pose->world_from_node[source->node].col[3]),
        .forward = forward,
        .up = orthogonal_up(forward, up),
        .vertical_fov_rad = source->vertical_fov_rad,
        .near_m = source->near_m,
    };
}

struct world_camera camera_look_at(vec3s eye, vec3s target, float vertical_fov_rad, float near_m)
{
    vec3s forward = vec3_towards(eye, target);
    if (glms_vec3_norm(forward) == 0.0f) forward = vec3_of(0, 0, -1);
    return (struct world_camera){
        .eye = eye,
        .forward = forward,
        .up = orthogonal_up(forward, vec3_of(0, 1, 0)),
        .vertical_fov_rad = vertical_fov_rad,
        .near_m = near_m,
    };
}
