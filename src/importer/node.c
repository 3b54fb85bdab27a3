// Nodes with their meshes, and skins.
#include "importer/importer.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Breadth-first: the list is its own queue.
void import_node_list(struct importer *importer)
{
    size_t capacity = 64, count = 1;
    const struct aiNode **nodes = allocate(capacity, sizeof *nodes);
    nodes[0] = importer->from->mRootNode;
    for (size_t i = 0; i < count; i++) {
        size_t children = nodes[i]->mNumChildren;
        if (count + children > INT_MAX / 2) output_fail("format", "too many nodes");
        while (count + children > capacity) {
            capacity *= 2;
            nodes = realloc(nodes, capacity * sizeof *nodes);
            if (!nodes) output_fail("memory", "out of memory");
        }
        for (size_t k = 0; k < children; k++) nodes[count++] = nodes[i]->mChildren[k];
    }
    importer->nodes = nodes;
    importer->node_count = count;
    importer->node_of = json_object();
    for (size_t i = 0; i < count; i++) {
        const char *name = nodes[i]->mName.data;
        if (!json_object_get(importer->node_of, name))
            json_object_set_new_nocheck(importer->node_of, name, json_integer((json_int_t)i));
    }
}

int importer_find_node(const struct importer *importer, const struct aiString *name)
{
    json_t *index = json_object_get(importer->node_of, name->data);
    return index ? (int)json_integer_value(index) : -1;
}

// Column-major, as glTF stores matrices.
static void matrix_of(const struct aiMatrix4x4 *m, float out[16])
{
    const float columns[16] = { m->a1, m->b1, m->c1, m->d1, m->a2, m->b2, m->c2, m->d2,
                                m->a3, m->b3, m->c3, m->d3, m->a4, m->b4, m->c4, m->d4 };
    memcpy(out, columns, sizeof columns);
}

static int add_skin(struct importer *importer, const struct aiMesh *from)
{
    json_t *joints = json_array();
    float(*matrices)[16] = allocate(from->mNumBones, sizeof *matrices);
    for (unsigned b = 0; b < from->mNumBones; b++) {
        const struct aiBone *bone = from->mBones[b];
        int node = importer_find_node(importer, &bone->mName);
        if (node < 0) output_fail("format", "bone %s is not a node", bone->mName.data);
        json_array_append_new(joints, json_integer(node));
        matrix_of(&bone->mOffsetMatrix, matrices[b]);
    }
    size_t accessor =
        glb_add_accessor(&importer->glb, matrices, GLB_FLOAT, "MAT4", from->mNumBones);
    free(matrices);
    return (int)glb_add(
        &importer->glb, "skins",
        json_pack("{s:o, s:I}", "joints", joints, "inverseBindMatrices", (json_int_t)accessor));
}

void import_skins(struct importer *importer)
{
    const struct aiScene *from = importer->from;
    importer->skin_of = allocate(from->mNumMeshes, sizeof *importer->skin_of);
    for (unsigned i = 0; i < from->mNumMeshes; i++) {
        unsigned bones = from->mMeshes[i]->mNumBones;
        bool skinned = importer->mesh_of[i] >= 0 && bones > 0 && bones <= UINT16_MAX;
        importer->skin_of[i] = skinned ? add_skin(importer, from->mMeshes[i]) : -1;
    }
}

// Animation keys replace the parts of a transform.
static void set_parts(json_t *node, const struct aiMatrix4x4 *matrix)
{
    struct aiVector3D scale, position;
    struct aiQuaternion rotation;
    aiDecomposeMatrix(matrix, &scale, &rotation, &position);
    const float q[4] = { rotation.x, rotation.y, rotation.z, rotation.w };
    float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    glb_set(node, "translation", glb_floats((float[3]){ position.x, position.y, position.z }, 3));
    glb_set(node, "scale", glb_floats((float[3]){ scale.x, scale.y, scale.z }, 3));
    if (length > 0.0f && isfinite(length)) glb_set(node, "rotation", glb_floats(q, 4));
}

static void set_transform(const struct importer *importer, json_t *node, size_t i)
{
    const struct aiNode *from = importer->nodes[i];
    float matrix[16];
    matrix_of(&from->mTransformation, matrix);
    for (int k = 0; k < 16; k++) {
        if (!isfinite(matrix[k]))
            output_fail("format", "the matrix of node %s is not finite", from->mName.data);
    }
    if (importer->animated[i])
        set_parts(node, &from->mTransformation);
    else
        glb_set(node, "matrix", glb_floats(matrix, 16));
}

static void set_mesh(const struct importer *importer, json_t *node, unsigned mesh)
{
    glb_set(node, "mesh", json_integer(importer->mesh_of[mesh]));
    if (importer->skin_of[mesh] >= 0) glb_set(node, "skin", json_integer(importer->skin_of[mesh]));
}

// A glTF node has one mesh; the others of a node get nodes of their own behind all others.
static json_t *node_of(const struct importer *importer, size_t i, size_t *first_child,
                       json_t *extra_nodes)
{
    const struct aiNode *from = importer->nodes[i];
    json_t *node = json_pack("{s:o}", "name", glb_text(from->mName.data)), *children = json_array();
    set_transform(importer, node, i);
    for (unsigned k = 0; k < from->mNumChildren; k++)
        json_array_append_new(children, json_integer((json_int_t)(*first_child)++));
    for (unsigned k = 0; k < from->mNumMeshes; k++) {
        unsigned mesh = from->mMeshes[k];
        if (mesh >= importer->from->mNumMeshes || importer->mesh_of[mesh] < 0) continue;
        if (!json_object_get(node, "mesh")) {
            set_mesh(importer, node, mesh);
            continue;
        }
        json_t *extra = json_pack("{s:o}", "name", glb_text(from->mName.data));
        set_mesh(importer, extra, mesh);
        size_t index = importer->node_count + json_array_size(extra_nodes);
        json_array_append_new(extra_nodes, extra);
        json_array_append_new(children, json_integer((json_int_t)index));
    }
    if (json_array_size(children) > 0)
        glb_set(node, "children", children);
    else
        json_decref(children);
    return node;
}

void import_nodes(struct importer *importer)
{
    json_t *extra_nodes = json_array(), *extra;
    size_t first_child = 1, k;
    for (size_t i = 0; i < importer->node_count; i++)
        glb_add(&importer->glb, "nodes", node_of(importer, i, &first_child, extra_nodes));
    json_array_foreach(extra_nodes, k, extra) glb_add(&importer->glb, "nodes", json_incref(extra));
}
