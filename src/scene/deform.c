// Morphing and skinning; see deform.h.
#include "scene/deform.h"

#include "core/parallel.h"

#include <math.h>

bool deformer_init(struct deformer *deformer, struct arena *arena, const struct scene *scene)
{
    size_t instances = (size_t)scene->instance_count, total = 0;
    deformer->joint_offset = arena_alloc(arena, instances, sizeof *deformer->joint_offset);
    if (!deformer->joint_offset) return false;
    for (int i = 0; i < scene->instance_count; i++) {
        deformer->joint_offset[i] = total;
        int skin = scene->instances[i].skin;
        size_t joints = skin < 0 ? 0 : (size_t)scene->skins[skin].joint_count;
        if (!size_add(total, joints, &total)) {
            return host_fail(scene->host, FAIL_MEMORY, "pose of %s: too many joints", scene->name);
        }
    }
    deformer->world_from_mesh = arena_alloc(arena, total, sizeof *deformer->world_from_mesh);
    return deformer->world_from_mesh != NULL;
}

static vec3s unit_or(vec3s v, vec3s fallback)
{
    float length = glms_vec3_norm(v);
    return length > 0.0f && isfinite(length) ? glms_vec3_scale(v, 1.0f / length) : fallback;
}

static mat4s blend_joints(const mat4s *world_from_mesh, const uint16_t *joints, vec4s weights)
{
    mat4s blended = glms_mat4_zero();
    for (int k = 0; k < 4; k++) {
        if (weights.raw[k] == 0.0f) continue;
        for (int column = 0; column < 4; column++) {
            blended.col[column] = glms_vec4_muladds(world_from_mesh[joints[k]].col[column],
                                                    weights.raw[k], blended.col[column]);
        }
    }
    return blended;
}

// Position and normal of a vertex with the weighted morph targets added.
static void morph_vertex(const struct mesh *mesh, const float *weights, uint32_t v, vec3s *position,
                         vec3s *normal)
{
    *position = mesh->positions[v];
    *normal = mesh->normals[v];
    for (int m = 0; m < mesh->morph_count; m++) {
        if (weights[m] == 0.0f) continue;
        const struct morph_target *morph = &mesh->morphs[m];
        *position = glms_vec3_muladds(morph->positions[v], weights[m], *position);
        if (morph->normals) *normal = glms_vec3_muladds(morph->normals[v], weights[m], *normal);
    }
}

static vec4s transform_tangent(mat4s world_from_mesh, vec4s tangent, vec3s normal)
{
    vec3s transformed = mat4_direction(world_from_mesh, vec3_xyz(tangent));
    transformed =
        glms_vec3_sub(transformed, glms_vec3_scale(normal, glms_vec3_dot(transformed, normal)));
    vec3s any_tangent, any_bitangent;
    basis_of(normal, &any_tangent, &any_bitangent);
    return vec4_of(unit_or(transformed, any_tangent), tangent.w);
}

void deform_vertices(const struct mesh *mesh, const float *weights, const mat4s *joints,
                     mat4s world_from_node, const struct deformed_mesh *out)
{
    mat3s node_normals = mat4_normal_transform(world_from_node);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        vec3s position, normal;
        morph_vertex(mesh, weights, v, &position, &normal);
        mat4s world_from_mesh = world_from_node;
        mat3s normals = node_normals;
        if (joints) {
            world_from_mesh = blend_joints(joints, mesh->joints[v], mesh->weights[v]);
            normals = mat4_normal_transform(world_from_mesh);
        }
        out->positions[v] = mat4_point(world_from_mesh, position);
        out->normals[v] = unit_or(glms_mat3_mulv(normals, normal), mesh->normals[v]);
        if (out->tangents) {
            out->tangents[v] =
                transform_tangent(world_from_mesh, mesh->tangents[v], out->normals[v]);
        }
    }
}

struct deform_job {
    struct deformer *deformer;
    struct scene_pose *pose;
};

static void deform_instance(void *user, size_t i)
{
    const struct deform_job *job = user;
    struct scene_pose *pose = job->pose;
    if (!pose->deformed[i].positions) return;
    const struct scene *scene = pose->scene;
    const struct instance *instance = &scene->instances[i];
    mat4s *joints = NULL;
    if (instance->skin >= 0) {
        // glTF 2.0, section 3.7.3.3: the transform of a skinned node is ignored.
        const struct skin *skin = &scene->skins[instance->skin];
        joints = job->deformer->world_from_mesh + job->deformer->joint_offset[i];
        for (int j = 0; j < skin->joint_count; j++) {
            joints[j] =
                glms_mat4_mul(pose->world_from_node[skin->joints[j]], skin->joint_from_mesh[j]);
        }
    }
    deform_vertices(scene_mesh_of(scene, (int)i), pose->morph_weights + pose->morph_offset[i],
                    joints, pose->world_from_node[instance->node], &pose->deformed[i]);
}

void deform(struct deformer *deformer, struct scene_pose *pose)
{
    struct deform_job job = { deformer, pose };
    parallel_for((size_t)pose->scene->instance_count, 1, deform_instance, &job);
}
