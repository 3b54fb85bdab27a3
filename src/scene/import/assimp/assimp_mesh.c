// Meshes through Assimp: one scene mesh for each aiMesh that has triangles.
#include "scene/import/assimp/assimp.h"

#include "scene/import/import_mesh.h"
#include "scene/scene_check.h"

#include <string.h>

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
        // Assimp gives degenerate faces NaN normals; import_finish_mesh replaces zero normals.
        mesh->normals[v] = vec3_is_finite(n) ? n : vec3_of(0.0f, 0.0f, 0.0f);
    }
    if (from->mNumAnimMeshes > 0) import_note(import, "morph targets of this format");
    return copy_uv(import, from, mesh) && copy_colors(import, from, mesh);
}

static bool copy_faces(struct import *import, const struct aiMesh *from, struct mesh *mesh)
{
    size_t capacity;
    if (!size_mul(from->mNumFaces, 3, &capacity) || capacity > UINT32_MAX) {
        return host_fail(import->host, FAIL_UNSUPPORTED, "%s: mesh %s has too many triangles",
                         import->path, import_printable(mesh->name).s);
    }
    mesh->indices = import_alloc(import, capacity, sizeof *mesh->indices);
    if (!mesh->indices) return false;
    for (unsigned f = 0; f < from->mNumFaces; f++) {
        const struct aiFace *face = &from->mFaces[f];
        if (face->mNumIndices != 3) continue;
        memcpy(mesh->indices + mesh->index_count, face->mIndices, 3 * sizeof *mesh->indices);
        mesh->index_count += 3;
    }
    return true;
}

// At most four bone weights per vertex, with sum 1. Joint k is bone k.
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

bool assimp_load_meshes(struct assimp *assimp)
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
