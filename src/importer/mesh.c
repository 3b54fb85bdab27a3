// One glTF mesh for each aiMesh that has triangles. Values are checked by the library.
#include "importer/importer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void add_attribute(struct glb *glb, json_t *attributes, const char *name, const void *data,
                          int component, const char *type, size_t count)
{
    size_t accessor = glb_add_accessor(glb, data, component, type, count);
    glb_set(attributes, name, json_integer((json_int_t)accessor));
}

// Assimp gives degenerate faces NaN normals; the library replaces zero normals.
static void add_normals(struct glb *glb, json_t *attributes, const struct aiMesh *from)
{
    if (!from->mNormals) return;
    float(*normals)[3] = allocate(from->mNumVertices, sizeof *normals);
    for (unsigned v = 0; v < from->mNumVertices; v++) {
        const struct aiVector3D *n = &from->mNormals[v];
        if (!isfinite(n->x) || !isfinite(n->y) || !isfinite(n->z)) continue;
        memcpy(normals[v], (float[3]){ n->x, n->y, n->z }, sizeof *normals);
    }
    add_attribute(glb, attributes, "NORMAL", normals, GLB_FLOAT, "VEC3", from->mNumVertices);
    free(normals);
}

static void add_uv(struct glb *glb, json_t *attributes, const struct aiMesh *from, unsigned set)
{
    const struct aiVector3D *uv = from->mTextureCoords[set];
    if (!uv || from->mNumUVComponents[set] < 2) return;
    float(*pairs)[2] = allocate(from->mNumVertices, sizeof *pairs);
    for (unsigned v = 0; v < from->mNumVertices; v++) {
        pairs[v][0] = uv[v].x;
        pairs[v][1] = uv[v].y;
    }
    add_attribute(glb, attributes, set ? "TEXCOORD_1" : "TEXCOORD_0", pairs, GLB_FLOAT, "VEC2",
                  from->mNumVertices);
    free(pairs);
}

// At most four bone weights per vertex. Joint k is bone k.
static void add_bones(struct glb *glb, json_t *attributes, const struct aiMesh *from)
{
    if (from->mNumBones == 0 || from->mNumBones > UINT16_MAX) return;
    uint16_t(*joints)[4] = allocate(from->mNumVertices, sizeof *joints);
    float(*weights)[4] = allocate(from->mNumVertices, sizeof *weights);
    for (unsigned b = 0; b < from->mNumBones; b++) {
        for (unsigned w = 0; w < from->mBones[b]->mNumWeights; w++) {
            const struct aiVertexWeight *weight = &from->mBones[b]->mWeights[w];
            if (weight->mVertexId >= from->mNumVertices || !(weight->mWeight > 0.0f)) continue;
            int k = 0;
            while (k < 4 && weights[weight->mVertexId][k] > 0.0f) k++;
            if (k == 4) continue;
            joints[weight->mVertexId][k] = (uint16_t)b;
            weights[weight->mVertexId][k] = weight->mWeight;
        }
    }
    add_attribute(glb, attributes, "JOINTS_0", joints, GLB_USHORT, "VEC4", from->mNumVertices);
    add_attribute(glb, attributes, "WEIGHTS_0", weights, GLB_FLOAT, "VEC4", from->mNumVertices);
    free(joints);
    free(weights);
}

// The accessor of the triangles' indices; false without any.
static bool add_triangles(struct glb *glb, const struct aiMesh *from, size_t *accessor)
{
    uint32_t(*triangles)[3] = allocate(from->mNumFaces, sizeof *triangles);
    size_t count = 0;
    for (unsigned f = 0; f < from->mNumFaces; f++) {
        const struct aiFace *face = &from->mFaces[f];
        if (face->mNumIndices == 3) memcpy(triangles[count++], face->mIndices, sizeof *triangles);
    }
    if (count > 0) *accessor = glb_add_accessor(glb, triangles, GLB_UINT, "SCALAR", 3 * count);
    free(triangles);
    return count > 0;
}

static int add_mesh(struct importer *importer, const struct aiMesh *from)
{
    struct glb *glb = &importer->glb;
    size_t indices, materials = glb_count(glb, "materials");
    if (!(from->mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) {
        output_note("points and lines");
        return -1;
    }
    if (!add_triangles(glb, from, &indices)) return -1;
    if (from->mNumAnimMeshes > 0) output_note("morph targets of this format");
    json_t *attributes = json_object();
    add_attribute(glb, attributes, "POSITION", from->mVertices, GLB_FLOAT, "VEC3",
                  from->mNumVertices);
    add_normals(glb, attributes, from);
    for (unsigned set = 0; set < 2; set++) add_uv(glb, attributes, from, set);
    if (from->mColors[0])
        add_attribute(glb, attributes, "COLOR_0", from->mColors[0], GLB_FLOAT, "VEC4",
                      from->mNumVertices);
    add_bones(glb, attributes, from);
    size_t material = from->mMaterialIndex < materials ? from->mMaterialIndex : 0;
    json_t *primitive = json_pack("{s:o, s:I, s:I}", "attributes", attributes, "indices",
                                  (json_int_t)indices, "material", (json_int_t)material);
    return (int)glb_add(
        glb, "meshes",
        json_pack("{s:o, s:[o]}", "name", glb_text(from->mName.data), "primitives", primitive));
}

void import_meshes(struct importer *importer)
{
    const struct aiScene *from = importer->from;
    importer->mesh_of = allocate(from->mNumMeshes, sizeof *importer->mesh_of);
    for (unsigned i = 0; i < from->mNumMeshes; i++)
        importer->mesh_of[i] = add_mesh(importer, from->mMeshes[i]);
}
