// Imports OBJ, FBX and X through Assimp's C API: files are read by our file functions, the result
// is copied into the scene. Lights and cameras are ignored, because these formats have no physical
// units.
#include "scene/import/assimp/assimp.h"

#include "scene/import/importers.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>

#include <string.h>

static const struct aiScene *read_scene(struct import *import, const struct file_bytes *bytes,
                                        const char *extension)
{
    struct assimp_files files = { import, bytes };
    struct aiFileIO io = assimp_file_io(&files);
    // v grows downwards in our texture coordinates. FBX files state their unit; GlobalScale
    // converts it to metres.
    unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType |
                     aiProcess_JoinIdenticalVertices | aiProcess_LimitBoneWeights |
                     aiProcess_ValidateDataStructure | aiProcess_FlipUVs;
    if (strcmp(extension, "fbx") == 0) steps |= aiProcess_GlobalScale;
    const struct aiScene *scene = aiImportFileEx(import->path, steps, &io);
    if (!scene || !scene->mRootNode) {
        host_fail(import->host, FAIL_FORMAT, "%s: %s", import->path,
                  import_printable(aiGetErrorString()).s);
        if (scene) aiReleaseImport(scene);
        return NULL;
    }
    return scene;
}

bool import_assimp(struct import *import, const struct file_bytes *bytes, const char *extension)
{
    if (!assimp_check_input(import, bytes, extension)) return false;
    struct assimp assimp = { .import = import };
    assimp.from = read_scene(import, bytes, extension);
    if (!assimp.from) return false;
    if (assimp.from->mNumLights > 0) import_note(import, "lights of this format (no units)");
    if (assimp.from->mNumCameras > 0) import_note(import, "cameras of this format");
    bool ok = assimp_load_materials(&assimp) && assimp_load_meshes(&assimp) &&
              assimp_load_nodes(&assimp) && assimp_load_skins(&assimp) &&
              assimp_load_instances(&assimp) && assimp_load_animations(&assimp);
    aiReleaseImport(assimp.from);
    host_free(import->host, assimp.nodes);
    host_free(import->host, assimp.mesh_of);
    host_free(import->host, assimp.skin_of);
    return ok;
}
