// Phong materials and textures of OBJ, FBX and X, converted to metallic-roughness.
#include "importer/importer.h"

#include <assimp/material.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WRAP_CLAMP = 33071, WRAP_MIRROR = 33648, WRAP_REPEAT = 10497 };

struct textures {
    struct glb *glb;
    const struct aiScene *from;
    json_t *image_of; // path → glTF image
};

static int wrap_of(const struct aiMaterial *material, const char *key, enum aiTextureType type)
{
    int mode = aiTextureMapMode_Wrap;
    aiGetMaterialIntegerArray(material, key, (unsigned)type, 0, &mode, NULL);
    if (mode == aiTextureMapMode_Mirror) return WRAP_MIRROR;
    return mode == aiTextureMapMode_Wrap ? WRAP_REPEAT : WRAP_CLAMP;
}

static const char *base_name(const char *path)
{
    const char *name = path;
    for (const char *c = path; *c; c++)
        if (*c == '/' || *c == '\\') name = c + 1;
    return name;
}

// "*3" is embedded texture 3; FBX refers to embedded textures by file name.
static const struct aiTexture *embedded_texture(const struct aiScene *scene, const char *path)
{
    if (path[0] == '*') {
        unsigned long i = strtoul(path + 1, NULL, 10);
        return i < scene->mNumTextures ? scene->mTextures[i] : NULL;
    }
    for (unsigned i = 0; i < scene->mNumTextures; i++) {
        const char *name = scene->mTextures[i]->mFilename.data;
        if (name[0] && strcmp(base_name(name), base_name(path)) == 0) return scene->mTextures[i];
    }
    return NULL;
}

// Every byte as a percent escape that is not plainly part of a relative path.
static json_t *uri_of(const char *path)
{
    static const char plain[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._/\\";
    char *uri = allocate(3 * strlen(path) + 1, 1), *end = uri;
    for (; *path; path++) {
        if (strchr(plain, *path))
            *end++ = *path;
        else
            end += sprintf(end, "%%%02x", (unsigned char)*path);
    }
    json_t *text = glb_text(uri);
    free(uri);
    return text;
}

static json_t *make_image(struct textures *textures, const char *path)
{
    json_t *image = json_pack("{s:o}", "name", glb_text(path));
    const struct aiTexture *embedded = embedded_texture(textures->from, path);
    if (!embedded) {
        glb_set(image, "uri", uri_of(path));
    } else if (embedded->mHeight == 0 && embedded->pcData) {
        size_t view = glb_add_view(textures->glb, embedded->pcData, embedded->mWidth);
        glb_set(image, "bufferView", json_integer((json_int_t)view));
    } else {
        output_note("uncompressed embedded textures");
        json_decref(image);
        image = NULL;
    }
    return image;
}

// The glTF image of a path, -1: none.
static json_int_t image_of(struct textures *textures, const char *path)
{
    json_t *known = json_object_get(textures->image_of, path);
    if (known) return json_integer_value(known);
    json_t *image = make_image(textures, path);
    json_int_t index = image ? (json_int_t)glb_add(textures->glb, "images", image) : -1;
    json_object_set_new_nocheck(textures->image_of, path, json_integer(index));
    return index;
}

// A textureInfo in `parent`; false where the material has no such texture.
static bool set_texture(struct textures *textures, json_t *parent, const char *key,
                        const struct aiMaterial *material, enum aiTextureType type)
{
    struct aiString path;
    unsigned uv_set = 0;
    if (aiGetMaterialTexture(material, type, 0, &path, NULL, &uv_set, NULL, NULL, NULL, NULL) !=
            aiReturn_SUCCESS ||
        path.length == 0)
        return false;
    json_int_t image = uv_set > 1 ? -1 : image_of(textures, path.data);
    if (uv_set > 1) output_note("textures on texture coordinate sets above 1");
    if (image < 0) return false;
    size_t sampler = glb_add(
        textures->glb, "samplers",
        json_pack("{s:i, s:i}", "wrapS", wrap_of(material, _AI_MATKEY_MAPPINGMODE_U_BASE, type),
                  "wrapT", wrap_of(material, _AI_MATKEY_MAPPINGMODE_V_BASE, type)));
    size_t texture =
        glb_add(textures->glb, "textures",
                json_pack("{s:I, s:I}", "source", image, "sampler", (json_int_t)sampler));
    glb_set(parent, key,
            json_pack("{s:I, s:i}", "index", (json_int_t)texture, "texCoord", (int)uv_set));
    return true;
}

static float clamp01(float value)
{
    return fminf(fmaxf(value, 0.0f), 1.0f);
}

static bool get_color(const struct aiMaterial *material, const char *key, float out[3])
{
    struct aiColor4D color;
    if (aiGetMaterialColor(material, key, 0, 0, &color) != aiReturn_SUCCESS) return false;
    float channels[3] = { color.r, color.g, color.b };
    for (int k = 0; k < 3; k++)
        out[k] = isfinite(channels[k]) && channels[k] > 0.0f ? channels[k] : 0.0f;
    return true;
}

static float get_float(const struct aiMaterial *material, const char *key, float fallback)
{
    float value = fallback;
    unsigned count = 1;
    aiGetMaterialFloatArray(material, key, 0, 0, &value, &count);
    return isfinite(value) ? value : fallback;
}

// A Blinn-Phong exponent s corresponds to a microfacet distribution with alpha² = 2 / (s + 2)
// (Walter et al. 2007, section 5.2); roughness is the square root of alpha.
static float roughness_of_shininess(float shininess)
{
    return shininess > 0.0f ? sqrtf(sqrtf(2.0f / (shininess + 2.0f))) : 1.0f;
}

// The specular lobe of Phong materials (OBJ, FBX, …), none where Ks is 0 or OBJ's illum 0 or 1:
// then the material is purely diffuse. Else F0 = 0.08 · Ks, as Blender exports it: 0.5 is ior 1.5.
// Assimp reports illum 1 where an OBJ file has none.
static void set_phong_specular(json_t *material, const struct aiMaterial *from)
{
    float color[3];
    int illum = 2;
    if (!get_color(from, "$clr.specular", color)) return;
    aiGetMaterialIntegerArray(from, "$mat.illum", 0, 0, &illum, NULL);
    for (int k = 0; k < 3; k++) color[k] = 2.0f * clamp01(color[k]);
    bool diffuse = illum == 0 || illum == 1 || color[0] + color[1] + color[2] == 0.0f;
    glb_set(material, "extensions",
            json_pack("{s:{s:f, s:o}}", "KHR_materials_specular", "specularFactor",
                      diffuse ? 0.0 : 1.0, "specularColorFactor", glb_floats(color, 3)));
}

static json_t *pbr_of(struct textures *textures, const struct aiMaterial *from)
{
    float color[4] = { 1, 1, 1, 1 };
    if (!get_color(from, "$clr.base", color)) get_color(from, "$clr.diffuse", color);
    for (int k = 0; k < 3; k++) color[k] = clamp01(color[k]);
    color[3] = clamp01(get_float(from, "$mat.opacity", 1.0f));
    float shininess = get_float(from, "$mat.shininess", 0.0f);
    float roughness = get_float(from, "$mat.roughnessFactor", roughness_of_shininess(shininess));
    json_t *pbr =
        json_pack("{s:o, s:f, s:f}", "baseColorFactor", glb_floats(color, 4), "metallicFactor",
                  (double)clamp01(get_float(from, "$mat.metallicFactor", 0.0f)), "roughnessFactor",
                  (double)clamp01(roughness));
    if (!set_texture(textures, pbr, "baseColorTexture", from, aiTextureType_BASE_COLOR))
        set_texture(textures, pbr, "baseColorTexture", from, aiTextureType_DIFFUSE);
    return pbr;
}

static void set_emission(struct textures *textures, json_t *material, const struct aiMaterial *from)
{
    float emissive[3] = { 0, 0, 0 };
    get_color(from, "$clr.emissive", emissive);
    bool map = set_texture(textures, material, "emissiveTexture", from, aiTextureType_EMISSIVE);
    bool dark = emissive[0] + emissive[1] + emissive[2] == 0.0f;
    for (int k = 0; map && dark && k < 3; k++) emissive[k] = 1.0f;
    glb_set(material, "emissiveFactor", glb_floats(emissive, 3));
}

static json_t *material_of(struct textures *textures, const struct aiMaterial *from)
{
    struct aiString name = { 0 };
    int two_sided = 0;
    aiGetMaterialString(from, AI_MATKEY_NAME, &name);
    aiGetMaterialIntegerArray(from, AI_MATKEY_TWOSIDED, &two_sided, NULL);
    json_t *material =
        json_pack("{s:o, s:o, s:b}", "name", glb_text(name.data), "pbrMetallicRoughness",
                  pbr_of(textures, from), "doubleSided", two_sided != 0);
    if (get_float(from, "$mat.opacity", 1.0f) < 1.0f)
        glb_set(material, "alphaMode", json_string("BLEND"));
    if (get_float(from, "$mat.roughnessFactor", -1.0f) < 0.0f) set_phong_specular(material, from);
    set_texture(textures, material, "normalTexture", from, aiTextureType_NORMALS);
    set_emission(textures, material, from);
    if (aiGetMaterialTextureCount(from, aiTextureType_HEIGHT) > 0) output_note("bump maps");
    if (aiGetMaterialTextureCount(from, aiTextureType_OPACITY) > 0) output_note("opacity textures");
    return material;
}

void import_materials(struct importer *importer)
{
    const struct aiScene *from = importer->from;
    struct textures textures = { &importer->glb, from, json_object() };
    for (unsigned i = 0; i < from->mNumMaterials; i++)
        glb_add(&importer->glb, "materials", material_of(&textures, from->mMaterials[i]));
    if (from->mNumMaterials == 0)
        glb_add(&importer->glb, "materials",
                json_pack("{s:s, s:{s:f}}", "name", "default", "pbrMetallicRoughness",
                          "metallicFactor", 0.0));
}
