// Deformed objects follow their root: the node that all of an object's moving parts hang from. glTF
// ignores the node of a skinned mesh (section 3.7.3.3), so its joints alone tell how it has turned.
#include "techniques/dnrt/dnrt_deformed.h"

// Parents come first, so the larger of two nodes is not above the other.
static int common_ancestor(const struct scene *scene, int a, int b)
{
    while (a != b && a >= 0 && b >= 0)
        if (a > b)
            a = scene->nodes[a].parent;
        else
            b = scene->nodes[b].parent;
    return a == b ? a : -1;
}

// [joint_count]: joints that a vertex is bound to. NULL without memory; the caller frees it.
static bool *find_used_joints(struct host *host, const struct mesh *mesh, const struct skin *skin)
{
    bool *used = host_alloc(host, (size_t)skin->joint_count, sizeof *used);
    for (uint32_t v = 0; used && v < mesh->vertex_count; v++)
        for (int k = 0; k < 4; k++)
            if (mesh->weights[v].raw[k] != 0.0f) used[mesh->joints[v][k]] = true;
    return used;
}

// Joints that no vertex is bound to do not count: a handle on the floor, or a root that stands
// still while the hips walk away.
static bool find_root_joint(struct host *host, const struct scene *scene, int instance,
                            struct dnrt_root *out)
{
    const struct skin *skin = &scene->skins[scene->instances[instance].skin];
    bool *used = find_used_joints(host, scene_mesh_of(scene, instance), skin);
    bool any = false;
    for (int j = 0; used && j < skin->joint_count; j++) {
        if (!used[j]) continue;
        out->node = any ? common_ancestor(scene, out->node, skin->joints[j]) : skin->joints[j];
        any = true;
    }
    for (int j = skin->joint_count - 1; j >= 0; j--)
        if (skin->joints[j] == out->node) out->from_mesh = skin->joint_from_mesh[j];
    host_free(host, used);
    return used != NULL;
}

bool dnrt_find_root(struct host *host, const struct scene *scene, int instance,
                    struct dnrt_root *out)
{
    const struct instance *of = &scene->instances[instance];
    *out = (struct dnrt_root){ of->skin < 0 ? of->node : -1, glms_mat4_identity() };
    return of->skin < 0 || find_root_joint(host, scene, instance, out);
}

static vec3s mean_of(const vec3s *points, uint32_t count)
{
    double sum[3] = { 0, 0, 0 };
    for (uint32_t v = 0; v < count; v++)
        for (int i = 0; i < 3; i++) sum[i] += (double)points[v].raw[i];
    const double scale = count > 0 ? 1.0 / (double)count : 0.0;
    return vec3_of((float)(sum[0] * scale), (float)(sum[1] * scale), (float)(sum[2] * scale));
}

mat4s dnrt_world_from_deformed(const struct scene_pose *pose, int instance,
                               const struct dnrt_root *root)
{
    mat4s m = root->from_mesh;
    if (root->node >= 0) m = glms_mat4_mul(pose->world_from_node[root->node], m);
    m.col[3] = vec4_of(mean_of(pose->deformed[instance].positions,
                               scene_mesh_of(pose->scene, instance)->vertex_count),
                       1);
    return m;
}

// The matrices of the joints in the root's space of the mesh. NULL without memory.
static mat4s *joints_of(struct host *host, const struct scene_pose *pose, const struct skin *skin,
                        const struct dnrt_root *root)
{
    const mat4s mesh_from_root = glms_mat4_inv(root->from_mesh);
    mat4s *joints = host_alloc(host, (size_t)skin->joint_count, sizeof *joints);
    for (int j = 0; joints && j < skin->joint_count; j++)
        joints[j] =
            glms_mat4_mul(mesh_from_root,
                          glms_mat4_mul(pose_ancestor_from_node(pose, root->node, skin->joints[j]),
                                        skin->joint_from_mesh[j]));
    return joints;
}

bool dnrt_deformed_mesh(struct host *host, const struct scene_pose *pose, int instance,
                        const struct dnrt_root *root, const struct deformed_mesh *out)
{
    const struct instance *of = &pose->scene->instances[instance];
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    mat4s *joints = NULL;
    if (of->skin >= 0) {
        joints = joints_of(host, pose, &pose->scene->skins[of->skin], root);
        if (!joints) return false;
    }
    deform_vertices(mesh, pose->morph_weights + pose->morph_offset[instance], joints,
                    glms_mat4_identity(), out);
    const vec3s mean = mean_of(out->positions, mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        out->positions[v] = glms_vec3_sub(out->positions[v], mean);
    host_free(host, joints);
    return true;
}
