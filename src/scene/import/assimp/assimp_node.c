// Nodes and instances through Assimp.
#include "scene/import/assimp/assimp.h"

#include "scene/scene_check.h"

#include <limits.h>
#include <string.h>

mat4s assimp_matrix(const struct aiMatrix4x4 *m)
{
    return (mat4s){ .raw = { { m->a1, m->b1, m->c1, m->d1 },
                             { m->a2, m->b2, m->c2, m->d2 },
                             { m->a3, m->b3, m->c3, m->d3 },
                             { m->a4, m->b4, m->c4, m->d4 } } };
}

int assimp_find_node(const struct assimp *assimp, const struct aiString *name)
{
    for (int i = 0; i < assimp->import->scene->node_count; i++) {
        if (strcmp(assimp->nodes[i]->mName.data, name->data) == 0) return i;
    }
    return -1;
}

// Nodes in breadth-first order: the list is its own queue.
bool assimp_load_nodes(struct assimp *assimp)
{
    struct import *import = assimp->import;
    struct scene *scene = import->scene;
    const struct aiNode *root = assimp->from->mRootNode;
    size_t count = 1, capacity = 64;
    struct node *nodes = host_alloc(import->host, capacity, sizeof *nodes);
    const struct aiNode **list = host_alloc(import->host, capacity, sizeof *list);
    bool ok = nodes && list;
    if (ok) list[0] = root;
    if (ok) nodes[0] = (struct node){ .parent = -1 };
    for (size_t i = 0; ok && i < count; i++) {
        size_t children = list[i]->mNumChildren;
        ok = import_charge(import, 1 + children, sizeof *nodes) && count + children < INT_MAX;
        while (ok && count + children > capacity) {
            struct node *more = host_realloc(import->host, nodes, 2 * capacity, sizeof *nodes);
            if (more) nodes = more;
            void *longer =
                more ? host_realloc(import->host, list, 2 * capacity, sizeof *list) : NULL;
            if (longer) list = longer;
            ok = longer != NULL;
            capacity *= 2;
        }
        for (size_t k = 0; ok && k < children; k++) {
            list[count] = list[i]->mChildren[k];
            nodes[count++] = (struct node){ .parent = (int)i };
        }
    }
    assimp->nodes = list;
    scene->nodes = ok ? import_alloc(import, count, sizeof *scene->nodes) : NULL;
    ok = scene->nodes != NULL;
    for (size_t i = 0; ok && i < count; i++) {
        struct node node = node_default();
        node.parent = nodes[i].parent;
        node.name = import_name(import, list[i]->mName.data, "node", i);
        node.has_matrix = true;
        node.matrix = assimp_matrix(&list[i]->mTransformation);
        ok = node.name && floats_are_finite(&node.matrix.raw[0][0], 16);
        if (node.name && !ok) {
            host_fail(import->host, FAIL_FORMAT, "%s: the matrix of node %s is not finite",
                      import->path, import_printable(node.name).s);
        }
        scene->nodes[i] = node;
    }
    if (ok) scene->node_count = (int)count;
    host_free(import->host, nodes);
    return ok;
}

bool assimp_load_instances(struct assimp *assimp)
{
    struct import *import = assimp->import;
    struct scene *scene = import->scene;
    size_t count = 0;
    for (int i = 0; i < scene->node_count; i++) count += assimp->nodes[i]->mNumMeshes;
    scene->instances =
        count < INT_MAX ? import_alloc(import, count, sizeof *scene->instances) : NULL;
    if (!scene->instances) return false;
    for (int i = 0; i < scene->node_count; i++) {
        for (unsigned k = 0; k < assimp->nodes[i]->mNumMeshes; k++) {
            unsigned mesh = assimp->nodes[i]->mMeshes[k];
            if (mesh >= assimp->from->mNumMeshes || assimp->mesh_of[mesh] < 0) continue;
            scene->instances[scene->instance_count++] = (struct instance){
                .node = i, .mesh = assimp->mesh_of[mesh], .skin = assimp->skin_of[mesh]
            };
        }
    }
    return true;
}
