// OBJ, FBX and X through Assimp. Internal to src/scene.
#pragma once

#include "scene/import/import_context.h"

#include <assimp/cfileio.h>
#include <assimp/scene.h>

struct assimp {
    struct import *import;
    const struct aiScene *from;
    const struct aiNode **nodes; // in the scene's order, parents first
    int *mesh_of;                // aiMesh → scene mesh, -1: no triangles
    int *skin_of;                // aiMesh → skin, -1
};

// Refuses what Assimp would follow into a stack overflow or gigabytes.
bool assimp_check_input(struct import *import, const struct file_bytes *bytes,
                        const char *extension);

// The imported file in memory, for assimp_file_io.
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
