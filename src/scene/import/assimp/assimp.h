// The state of an import of OBJ, FBX or X through Assimp. Internal to src/scene/import/assimp.
#pragma once

#include "scene/import/import_context.h"

#include <assimp/cfileio.h>
#include <assimp/scene.h>

struct assimp {
    struct import *import;
    const struct aiScene *from;
    const struct aiNode **nodes; // in the order of the scene's nodes, parents first
    int *mesh_of;                // aiMesh → scene mesh, -1 without triangles
    int *skin_of;                // aiMesh → skin, -1
};

// Refuses files on which Assimp would overflow the stack or allocate gigabytes.
bool assimp_check_input(struct import *import, const struct file_bytes *bytes,
                        const char *extension);

// File access for Assimp: the imported file from memory, others from its folder only.
struct assimp_files {
    struct import *import;
    const struct file_bytes *main;
};
struct aiFileIO assimp_file_io(struct assimp_files *files);

// The parts of the scene, in this order.
bool assimp_load_materials(struct assimp *assimp);
bool assimp_load_meshes(struct assimp *assimp);
bool assimp_load_nodes(struct assimp *assimp);
bool assimp_load_skins(struct assimp *assimp);
bool assimp_load_instances(struct assimp *assimp);
bool assimp_load_animations(struct assimp *assimp);

int assimp_find_node(const struct assimp *assimp, const struct aiString *name); // -1: none
mat4s assimp_matrix(const struct aiMatrix4x4 *m);
