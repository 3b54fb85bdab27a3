// Phong materials and textures of OBJ, FBX and X, converted to metallic-roughness.
#include "scene/import/assimp/assimp.h"

#include "scene/import/import_image.h"

#include <assimp/cimport.h>
#include <assimp/material.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct textures { // the distinct images of all materials
    char (*paths)[1024];
    struct image_source *sources;
    void **owned;
    int *scene_image;
    int count, capacity;
};

static enum texture_wrap wrap_of(const struct aiMaterial *material, const char *key,
                                 enum aiTextureType type)
{
    int mode = aiTextureMapMode_Wrap;
    aiGetMaterialIntegerArray(material, key, (unsigned)type, 0, &mode, NULL);
    if (mode == aiTextureMapMode_Mirror) return WRAP_MIRROR;
    return mode == aiTextureMapMode_Wrap ? WRAP_REPEAT : WRAP_CLAMP;
}

// The image index is that in `textures` until load_textures replaces it.
static struct texture_use use_of(struct import *import, struct textures *textures,
                                 const struct aiMaterial *material, enum aiTextureType type)
{
    struct texture_use use = texture_use_none();
    struct aiString path;
    unsigned uv_set = 0;
    if (aiGetMaterialTexture(material, type, 0, &path, NULL, &uv_set, NULL, NULL, NULL, NULL) !=
            aiReturn_SUCCESS ||
        path.length == 0) {
        return use;
    }
    if (uv_set > 1) {
        import_note(import, "textures on texture coordinate sets above 1");
        return use;
    }
    int i = 0;
    while (i < textures->count && strcmp(textures->paths[i], path.data) != 0) i++;
    if (i == textures->capacity) return use;
    if (i == textures->count) {
        snprintf(textures->paths[textures->count++], sizeof *textures->paths, "%s", path.data);
    }
    use.image = i;
    use.uv_set = (int)uv_set;
    use.wrap_u = wrap_of(material, _AI_MATKEY_MAPPINGMODE_U_BASE, type);
    use.wrap_v = wrap_of(material, _AI_MATKEY_MAPPINGMODE_V_BASE, type);
    return use;
}

static bool get_color(const struct aiMaterial *material, const char *key, vec4s *out)
{
    struct aiColor4D color;
    if (aiGetMaterialColor(material, key, 0, 0, &color) != aiReturn_SUCCESS) return false;
    float channels[4] = { color.r, color.g, color.b, color.a };
    for (int k = 0; k < 4; k++) {
        out->raw[k] = isfinite(channels[k]) && channels[k] > 0.0f ? channels[k] : 0.0f;
    }
    return true;
}

static float get_float(const struct aiMaterial *material, const char *key, float fallback)
{
    float value = fallback;
    unsigned count = 1;
    aiGetMaterialFloatArray(material, key, 0, 0, &value, &count);
    return isfinite(value) ? value : fallback;
}

static float clamp01(float value)
{
    return fminf(fmaxf(value, 0.0f), 1.0f);
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
static void load_phong_specular(const struct aiMaterial *from, struct material *m)
{
    vec4s color;
    int illum = 2;
    if (!get_color(from, "$clr.specular", &color)) return;
    aiGetMaterialIntegerArray(from, "$mat.illum", 0, 0, &illum, NULL);
    for (int k = 0; k < 3; k++) m->specular_color.raw[k] = 2.0f * clamp01(color.raw[k]);
    if (illum == 0 || illum == 1 || luminance(m->specular_color) == 0.0f) m->specular = 0.0f;
}

static bool load_material(struct import *import, struct textures *textures,
                          const struct aiMaterial *from, unsigned i, struct material *out)
{
    struct material m = material_default();
    struct aiString name = { 0 };
    aiGetMaterialString(from, AI_MATKEY_NAME, &name);
    m.name = import_name(import, name.data, "material", i);
    vec4s color = { { 1.0f, 1.0f, 1.0f, 1.0f } };
    if (!get_color(from, "$clr.base", &color)) get_color(from, "$clr.diffuse", &color);
    for (int k = 0; k < 3; k++) m.base_color.raw[k] = clamp01(color.raw[k]);
    m.base_color.w = clamp01(get_float(from, "$mat.opacity", 1.0f));
    if (m.base_color.w < 1.0f) m.alpha_mode = ALPHA_BLEND;
    m.metallic = clamp01(get_float(from, "$mat.metallicFactor", 0.0f));
    float shininess = get_float(from, "$mat.shininess", 0.0f);
    m.roughness =
        clamp01(get_float(from, "$mat.roughnessFactor", roughness_of_shininess(shininess)));
    if (get_float(from, "$mat.roughnessFactor", -1.0f) < 0.0f) load_phong_specular(from, &m);
    int two_sided = 0;
    aiGetMaterialIntegerArray(from, AI_MATKEY_TWOSIDED, &two_sided, NULL);
    m.double_sided = two_sided != 0;
    m.base_color_map = use_of(import, textures, from, aiTextureType_BASE_COLOR);
    if (m.base_color_map.image < 0) {
        m.base_color_map = use_of(import, textures, from, aiTextureType_DIFFUSE);
    }
    m.normal_map = use_of(import, textures, from, aiTextureType_NORMALS);
    m.emissive_map = use_of(import, textures, from, aiTextureType_EMISSIVE);
    vec4s emissive = { { 0.0f, 0.0f, 0.0f, 0.0f } };
    get_color(from, "$clr.emissive", &emissive);
    m.emissive = vec3_xyz(emissive);
    if (m.emissive_map.image >= 0 && luminance(m.emissive) == 0.0f) {
        m.emissive = vec3_of(1.0f, 1.0f, 1.0f);
    }
    if (aiGetMaterialTextureCount(from, aiTextureType_HEIGHT) > 0) import_note(import, "bump maps");
    if (aiGetMaterialTextureCount(from, aiTextureType_OPACITY) > 0) {
        import_note(import, "opacity textures");
    }
    *out = m;
    return m.name != NULL;
}

static const char *base_name(const char *path)
{
    const char *name = path;
    for (const char *c = path; *c; c++) {
        if (*c == '/' || *c == '\\') name = c + 1;
    }
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

// The bytes of a texture: embedded, or in a file.
static bool find_texture(struct assimp *assimp, struct textures *textures, int i)
{
    struct import *import = assimp->import;
    struct image_source *source = &textures->sources[i];
    const char *path = textures->paths[i];
    source->name = import_name(import, path, "texture", (size_t)i);
    if (!source->name) return false;
    const struct aiTexture *embedded = embedded_texture(assimp->from, path);
    if (embedded) {
        if (embedded->mHeight != 0)
            import_note(import, "uncompressed embedded textures");
        else
            source->data = (const uint8_t *)embedded->pcData;
        source->size = embedded->mWidth;
        return true;
    }
    char extension[16], *resolved = import_resolve_quietly(import, path, false);
    file_extension(path, extension);
    source->is_tga = strcmp(extension, "tga") == 0;
    struct file_bytes bytes = { 0 };
    bool there = resolved && access(resolved, R_OK) == 0;
    if (!there) {
        import_note(import, "image %s (%s)", import_printable(path).s,
                    resolved ? "no such file" : "not in the file's folder");
    }
    bool ok = !there || file_read(import->host, resolved, 0, &bytes);
    host_free(import->host, resolved);
    import->source_bytes += bytes.size;
    textures->owned[i] = bytes.data;
    source->data = bytes.data;
    source->size = bytes.size;
    return ok;
}

static void link_image(const struct textures *textures, struct texture_use *use)
{
    if (use->image >= 0) use->image = textures->scene_image[use->image];
}

static bool load_textures(struct assimp *assimp, struct textures *textures)
{
    struct scene *scene = assimp->import->scene;
    for (int i = 0; i < textures->count; i++) {
        if (!find_texture(assimp, textures, i)) return false;
    }
    if (!import_images(assimp->import, textures->sources, textures->count, textures->scene_image)) {
        return false;
    }
    for (int i = 0; i < scene->material_count; i++) {
        struct material *m = &scene->materials[i];
        link_image(textures, &m->base_color_map);
        link_image(textures, &m->normal_map);
        link_image(textures, &m->emissive_map);
        // These formats have no alpha mode: images with alpha are used as masks.
        int image = m->base_color_map.image;
        if (image >= 0 && scene->images[image].has_alpha && m->alpha_mode == ALPHA_OPAQUE) {
            m->alpha_mode = ALPHA_MASK;
        }
    }
    return true;
}

bool assimp_load_materials(struct assimp *assimp)
{
    struct import *import = assimp->import;
    struct scene *scene = import->scene;
    unsigned count = assimp->from->mNumMaterials;
    struct textures textures = { .capacity = 4 * (int)(count < 65536 ? count : 65536) };
    size_t capacity = (size_t)textures.capacity;
    scene->materials = import_alloc(import, (size_t)count + 1, sizeof *scene->materials);
    textures.paths = host_alloc(import->host, capacity, sizeof *textures.paths);
    textures.sources = host_alloc(import->host, capacity, sizeof *textures.sources);
    textures.owned = host_alloc(import->host, capacity, sizeof *textures.owned);
    textures.scene_image = host_alloc(import->host, capacity, sizeof *textures.scene_image);
    bool ok = scene->materials && textures.paths && textures.sources && textures.owned &&
              textures.scene_image;
    for (unsigned i = 0; ok && i < count; i++) {
        ok = load_material(import, &textures, assimp->from->mMaterials[i], i, &scene->materials[i]);
        scene->material_count += ok;
    }
    if (ok && count == 0) {
        scene->materials[0] = material_default();
        scene->materials[0].name = import_name(import, "default", "", 0);
        scene->material_count = 1;
        ok = scene->materials[0].name != NULL;
    }
    ok = ok && load_textures(assimp, &textures);
    for (int i = 0; textures.owned && i < textures.count; i++) {
        host_free(import->host, textures.owned[i]);
    }
    host_free(import->host, textures.paths);
    host_free(import->host, textures.sources);
    host_free(import->host, textures.owned);
    host_free(import->host, textures.scene_image);
    return ok;
}
