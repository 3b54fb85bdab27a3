// Scene files through Assimp's C API: the file and what it refers to come from our own file
// functions, the result is copied into the scene. Lights and cameras of these formats have no
// physical units; they are left out.
#include "scene/import_assimp.h"

#include "scene/scene_check.h"

#include <assimp/cimport.h>
#include <assimp/cfileio.h>
#include <assimp/postprocess.h>

#include <limits.h>
#include <string.h>
#include <unistd.h>

// --- Files for Assimp: the imported one from memory, others from its folder only.

struct assimp_files {
    struct import *import;
    const struct file_bytes *main;
};

struct open_file {
    struct import *import;
    struct file_bytes owned; // zero for the main file
    const uint8_t *data;
    size_t size, at;
};

static size_t file_read_proc(struct aiFile *file, char *out, size_t size, size_t count)
{
    struct open_file *open = (struct open_file *)file->UserData;
    size_t left = open->size - open->at;
    if (size == 0) return 0;
    if (count > left / size) count = left / size;
    memcpy(out, open->data + open->at, size * count);
    open->at += size * count;
    return count;
}

static size_t file_write_proc(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file;
    (void)data;
    (void)size;
    (void)count;
    return 0;
}

static size_t file_tell_proc(struct aiFile *file)
{
    return ((struct open_file *)file->UserData)->at;
}

static size_t file_size_proc(struct aiFile *file)
{
    return ((struct open_file *)file->UserData)->size;
}

static aiReturn file_seek_proc(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct open_file *open = (struct open_file *)file->UserData;
    size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? open->at : open->size;
    // Offsets from the end count backwards in some of Assimp's readers and forwards in others.
    if (origin == aiOrigin_END) {
        if (offset > open->size) return aiReturn_FAILURE;
        open->at = open->size - offset;
        return aiReturn_SUCCESS;
    }
    if (offset > open->size - base) return aiReturn_FAILURE;
    open->at = base + offset;
    return aiReturn_SUCCESS;
}

static void file_flush_proc(struct aiFile *file)
{
    (void)file;
}

// What stands after the folder of the imported file; NULL when the name is not in that folder.
static const char *name_in_folder(const struct import *import, const char *name)
{
    const char *slash = strrchr(import->path, '/');
    size_t folder = slash ? (size_t)(slash - import->path) + 1 : 0;
    if (strncmp(name, import->path, folder) != 0) return NULL;
    name += folder;
    while (name[0] == '/') name++;
    return name;
}

static bool open_other(struct import *import, const char *name, struct open_file *open)
{
    const char *inside = name_in_folder(import, name);
    char *path = inside ? import_resolve_quietly(import, inside, false) : NULL;
    bool ok = path && access(path, R_OK) == 0 && file_read(import->host, path, 0, &open->owned);
    host_free(import->host, path);
    import->source_bytes += open->owned.size;
    open->data = open->owned.data;
    open->size = open->owned.size;
    return ok;
}

static struct aiFile *files_open_proc(struct aiFileIO *io, const char *name, const char *mode)
{
    struct assimp_files *files = (struct assimp_files *)io->UserData;
    struct host *host = files->import->host;
    if (strpbrk(mode, "wa+")) return NULL;
    struct aiFile *file = host_alloc(host, 1, sizeof *file);
    struct open_file *open = host_alloc(host, 1, sizeof *open);
    if (!file || !open) goto fail;
    open->import = files->import;
    open->data = files->main->data;
    open->size = files->main->size;
    if (strcmp(name, files->import->path) != 0 && !open_other(files->import, name, open)) goto fail;
    *file = (struct aiFile){
        .ReadProc = file_read_proc,
        .WriteProc = file_write_proc,
        .TellProc = file_tell_proc,
        .FileSizeProc = file_size_proc,
        .SeekProc = file_seek_proc,
        .FlushProc = file_flush_proc,
        .UserData = (char *)open,
    };
    return file;
fail:
    host_free(host, file);
    host_free(host, open);
    return NULL;
}

static void files_close_proc(struct aiFileIO *io, struct aiFile *file)
{
    struct host *host = ((struct assimp_files *)io->UserData)->import->host;
    if (!file) return;
    struct open_file *open = (struct open_file *)file->UserData;
    file_bytes_finish(host, &open->owned);
    host_free(host, open);
    host_free(host, file);
}

// --- The result.

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

static bool copy_uv(struct import *import, const struct aiMesh *from, struct mesh *mesh)
{
    for (unsigned set = 0; set < 2; set++) {
        const struct aiVector3D *uv = from->mTextureCoords[set];
        if (!uv || from->mNumUVComponents[set] < 2) continue;
        mesh->uv[set] = import_alloc(import, mesh->vertex_count, sizeof(vec2s));
        if (!mesh->uv[set]) return false;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            mesh->uv[set][v] = (vec2s){ { uv[v].x, uv[v].y } };
        }
    }
    return true;
}

static bool copy_colors(struct import *import, const struct aiMesh *from, struct mesh *mesh)
{
    const struct aiColor4D *colors = from->mColors[0];
    if (!colors) return true;
    mesh->colors = import_alloc(import, mesh->vertex_count, sizeof *mesh->colors);
    if (!mesh->colors) return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        vec4s c = { { colors[v].r, colors[v].g, colors[v].b, colors[v].a } };
        mesh->colors[v] = c;
    }
    return true;
}

static bool copy_vertices(struct import *import, const struct aiMesh *from, struct mesh *mesh)
{
    uint32_t count = mesh->vertex_count = from->mNumVertices;
    mesh->positions = import_alloc(import, count, sizeof *mesh->positions);
    if (!mesh->positions) return false;
    for (uint32_t v = 0; v < count; v++) {
        const struct aiVector3D *p = &from->mVertices[v];
        mesh->positions[v] = vec3_of(p->x, p->y, p->z);
    }
    if (from->mNormals) {
        mesh->normals = import_alloc(import, count, sizeof *mesh->normals);
        if (!mesh->normals) return false;
    }
    for (uint32_t v = 0; mesh->normals && v < count; v++) {
        vec3s n = vec3_of(from->mNormals[v].x, from->mNormals[v].y, from->mNormals[v].z);
        // Assimp marks the normals of degenerate faces with NaN; zero asks for one of our own.
        mesh->normals[v] = vec3_is_finite(n) ? n : vec3_of(0.0f, 0.0f, 0.0f);
    }
    if (from->mNumAnimMeshes > 0) import_note(import, "morph targets of this format");
    return copy_uv(import, from, mesh) && copy_colors(import, from, mesh);
}

static bool copy_faces(struct import *import, const struct aiMesh *from, struct mesh *mesh)
{
    size_t room;
    if (!size_mul(from->mNumFaces, 3, &room) || room > UINT32_MAX) {
        return host_fail(import->host, FAIL_UNSUPPORTED, "%s: mesh %s has too many triangles",
                         import->path, import_printable(mesh->name).s);
    }
    mesh->indices = import_alloc(import, room, sizeof *mesh->indices);
    if (!mesh->indices) return false;
    for (unsigned f = 0; f < from->mNumFaces; f++) {
        const struct aiFace *face = &from->mFaces[f];
        if (face->mNumIndices != 3) continue;
        memcpy(mesh->indices + mesh->index_count, face->mIndices, 3 * sizeof *mesh->indices);
        mesh->index_count += 3;
    }
    return true;
}

// Weights of the mesh's bones, four at most for each vertex, that sum to 1. Joint k is bone k.
static bool copy_bones(struct import *import, const struct aiMesh *from, struct mesh *mesh)
{
    if (from->mNumBones == 0 || from->mNumBones > UINT16_MAX) return true;
    mesh->joints = import_alloc(import, mesh->vertex_count, sizeof *mesh->joints);
    mesh->weights = import_alloc(import, mesh->vertex_count, sizeof *mesh->weights);
    if (!mesh->joints || !mesh->weights) return false;
    for (unsigned b = 0; b < from->mNumBones; b++) {
        const struct aiBone *bone = from->mBones[b];
        for (unsigned w = 0; w < bone->mNumWeights; w++) {
            uint32_t v = bone->mWeights[w].mVertexId;
            float weight = bone->mWeights[w].mWeight;
            if (v >= mesh->vertex_count || !(weight > 0.0f)) continue;
            int k = 0;
            while (k < 4 && mesh->weights[v].raw[k] > 0.0f) k++;
            if (k == 4) continue;
            mesh->joints[v][k] = (uint16_t)b;
            mesh->weights[v].raw[k] = weight;
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        vec4s *w = &mesh->weights[v];
        float sum = w->x + w->y + w->z + w->w;
        if (sum > 0.0f)
            *w = glms_vec4_divs(*w, sum);
        else
            w->x = 1.0f;
    }
    return true;
}

static bool load_mesh(struct assimp *assimp, unsigned i)
{
    struct import *import = assimp->import;
    struct scene *scene = import->scene;
    const struct aiMesh *from = assimp->from->mMeshes[i];
    assimp->mesh_of[i] = -1;
    if (!(from->mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) {
        import_note(import, "points and lines");
        return true;
    }
    struct mesh mesh = { .material = (int)from->mMaterialIndex };
    mesh.name = import_name(import, from->mName.data, "mesh", i);
    if (!mesh.name || !copy_vertices(import, from, &mesh) || !copy_faces(import, from, &mesh) ||
        !copy_bones(import, from, &mesh)) {
        return false;
    }
    if (mesh.index_count == 0) return true;
    if (mesh.material >= scene->material_count) mesh.material = 0;
    if (!import_finish_mesh(import, &mesh)) return false;
    assimp->mesh_of[i] = scene->mesh_count;
    scene->meshes[scene->mesh_count++] = mesh;
    return true;
}

static bool load_meshes(struct assimp *assimp)
{
    struct import *import = assimp->import;
    unsigned count = assimp->from->mNumMeshes;
    import->scene->meshes = import_alloc(import, count, sizeof *import->scene->meshes);
    assimp->mesh_of = host_alloc(import->host, count, sizeof *assimp->mesh_of);
    assimp->skin_of = host_alloc(import->host, count, sizeof *assimp->skin_of);
    if (!import->scene->meshes || !assimp->mesh_of || !assimp->skin_of) return false;
    for (unsigned i = 0; i < count; i++) {
        assimp->skin_of[i] = -1;
        if (!load_mesh(assimp, i)) return false;
    }
    return true;
}

// Nodes in order of depth: a list that is its own queue.
static bool load_nodes(struct assimp *assimp)
{
    struct import *import = assimp->import;
    struct scene *scene = import->scene;
    const struct aiNode *root = assimp->from->mRootNode;
    size_t count = 1, room = 64;
    struct node *nodes = host_alloc(import->host, room, sizeof *nodes);
    const struct aiNode **list = host_alloc(import->host, room, sizeof *list);
    bool ok = nodes && list;
    if (ok) list[0] = root;
    if (ok) nodes[0] = (struct node){ .parent = -1 };
    for (size_t i = 0; ok && i < count; i++) {
        size_t children = list[i]->mNumChildren;
        ok = import_charge(import, 1 + children, sizeof *nodes) && count + children < INT_MAX;
        while (ok && count + children > room) {
            struct node *more = host_realloc(import->host, nodes, 2 * room, sizeof *nodes);
            if (more) nodes = more;
            void *longer = more ? host_realloc(import->host, list, 2 * room, sizeof *list) : NULL;
            if (longer) list = longer;
            ok = longer != NULL;
            room *= 2;
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
            host_fail(import->host, FAIL_FORMAT, "%s: node %s is not finite", import->path,
                      import_printable(node.name).s);
        }
        scene->nodes[i] = node;
    }
    if (ok) scene->node_count = (int)count;
    host_free(import->host, nodes);
    return ok;
}

static bool load_instances(struct assimp *assimp)
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

static const struct aiScene *read_scene(struct import *import, const struct file_bytes *bytes,
                                        const char *extension)
{
    struct assimp_files files = { import, bytes };
    struct aiFileIO io = { .OpenProc = files_open_proc,
                           .CloseProc = files_close_proc,
                           .UserData = (char *)&files };
    // v grows downwards in our texture coordinates. FBX has a unit of its own; scaled, it is
    // metres.
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
    bool ok = assimp_load_materials(&assimp) && load_meshes(&assimp) && load_nodes(&assimp) &&
              assimp_load_skins(&assimp) && load_instances(&assimp) &&
              assimp_load_animations(&assimp);
    aiReleaseImport(assimp.from);
    host_free(import->host, assimp.nodes);
    host_free(import->host, assimp.mesh_of);
    host_free(import->host, assimp.skin_of);
    return ok;
}
