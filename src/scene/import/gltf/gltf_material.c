// Materials, textures and samplers of a glTF file, and the images that they use (glTF 2.0,
// sections 3.8 and 3.9).
#include "scene/import/gltf/gltf.h"

#include "scene/import/import_files.h"
#include "scene/import/import_image.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    FILTER_NEAREST = 9728,
    WRAP_GL_CLAMP = 33071,
    WRAP_GL_MIRROR = 33648,
    WRAP_GL_REPEAT = 10497
};

static enum texture_wrap wrap_of(struct gltf_object sampler, const char *key)
{
    size_t wrap = gltf_size(sampler, key, WRAP_GL_REPEAT, 65535);
    if (wrap == WRAP_GL_CLAMP) return WRAP_CLAMP;
    if (wrap == WRAP_GL_MIRROR) return WRAP_MIRROR;
    if (wrap != WRAP_GL_REPEAT) gltf_wrong(sampler, "%s %zu is unknown", key, wrap);
    return WRAP_REPEAT;
}

// `info` is a textureInfo. The image index is glTF's until gltf_load_materials replaces it.
static struct texture_use texture_use_of(struct gltf *gltf, struct gltf_object info)
{
    struct texture_use use = texture_use_none();
    int texture_index = gltf_index(info, "index", gltf->textures);
    if (texture_index < 0) return use;
    struct gltf_object texture =
        gltf_element(gltf, gltf->textures, "texture", (size_t)texture_index);
    int image = gltf_index(texture, "source", gltf->images);
    if (image < 0) {
        import_note(gltf->import, "textures without a JPEG or PNG image");
        return use;
    }
    struct gltf_object transform = gltf_extension(info, "KHR_texture_transform");
    size_t uv_set = gltf_size(info, "texCoord", 0, 65535);
    uv_set = gltf_size(transform, "texCoord", uv_set, 65535);
    if (uv_set > 1) {
        import_note(gltf->import, "textures on texture coordinate sets above 1");
        return use;
    }
    use.image = image;
    use.uv_set = (int)uv_set;
    gltf_floats(transform, "offset", 2, use.uv_offset);
    gltf_floats(transform, "scale", 2, use.uv_scale);
    use.uv_rotation_rad = gltf_float(transform, "rotation", 0.0f, -FLT_MAX, FLT_MAX);
    int sampler_index = gltf_index(texture, "sampler", gltf->samplers);
    if (sampler_index < 0) return use;
    struct gltf_object sampler =
        gltf_element(gltf, gltf->samplers, "sampler", (size_t)sampler_index);
    use.wrap_u = wrap_of(sampler, "wrapS");
    use.wrap_v = wrap_of(sampler, "wrapT");
    use.nearest = gltf_size(sampler, "magFilter", 0, 65535) == FILTER_NEAREST;
    return use;
}

static void load_alpha_mode(struct gltf_object object, struct material *material)
{
    const char *mode = gltf_string(object, "alphaMode");
    if (!mode || strcmp(mode, "OPAQUE") == 0)
        material->alpha_mode = ALPHA_OPAQUE;
    else if (strcmp(mode, "MASK") == 0)
        material->alpha_mode = ALPHA_MASK;
    else if (strcmp(mode, "BLEND") == 0)
        material->alpha_mode = ALPHA_BLEND;
    else
        gltf_wrong(object, "alphaMode is not OPAQUE, MASK or BLEND");
    material->alpha_cutoff = gltf_float(object, "alphaCutoff", 0.5f, 0.0f, FLT_MAX);
}

// glTF's default material: white, metallic 1, roughness 1.
static struct material gltf_default(void)
{
    struct material material = material_default();
    material.base_color = vec4_of(vec3_of(1.0f, 1.0f, 1.0f), 1.0f);
    material.metallic = material.roughness = 1.0f;
    return material;
}

// KHR_materials_ior and KHR_materials_specular.
static void load_specular(struct gltf *gltf, struct gltf_object object, struct material *m)
{
    struct gltf_object ior = gltf_extension(object, "KHR_materials_ior");
    struct gltf_object specular = gltf_extension(object, "KHR_materials_specular");
    m->ior = gltf_float(ior, "ior", MATERIAL_DEFAULT_IOR, 0.0f, 1e6f);
    if (m->ior > 0.0f && m->ior < 1.0f) gltf_wrong(ior, "ior is neither 0 nor at least 1");
    m->specular = gltf_float(specular, "specularFactor", 1.0f, 0.0f, 1.0f);
    gltf_floats(specular, "specularColorFactor", 3, m->specular_color.raw);
    for (int k = 0; k < 3; k++)
        m->specular_color.raw[k] = fminf(fmaxf(m->specular_color.raw[k], 0.0f), 1e6f);
    m->specular_map = texture_use_of(gltf, gltf_child(specular, "specularTexture"));
    m->specular_color_map = texture_use_of(gltf, gltf_child(specular, "specularColorTexture"));
}

static bool load_material(struct gltf *gltf, size_t i, struct material *out)
{
    struct gltf_object object = gltf_element(gltf, gltf->materials, "material", i);
    struct gltf_object pbr = gltf_child(object, "pbrMetallicRoughness");
    struct gltf_object normal = gltf_child(object, "normalTexture");
    struct material m = gltf_default();
    m.name = import_name(gltf->import, gltf_string(object, "name"), "material", i);
    gltf_floats(pbr, "baseColorFactor", 4, m.base_color.raw);
    for (int k = 0; k < 4; k++) m.base_color.raw[k] = fminf(fmaxf(m.base_color.raw[k], 0.0f), 1.0f);
    m.metallic = gltf_float(pbr, "metallicFactor", 1.0f, 0.0f, 1.0f);
    m.roughness = gltf_float(pbr, "roughnessFactor", 1.0f, 0.0f, 1.0f);
    m.emissive = vec3_of(0.0f, 0.0f, 0.0f);
    gltf_floats(object, "emissiveFactor", 3, m.emissive.raw);
    // Emissive strength 1 is 1 cd/m² (KHR_materials_emissive_strength).
    float strength = gltf_float(gltf_extension(object, "KHR_materials_emissive_strength"),
                                "emissiveStrength", 1.0f, 0.0f, 1e18f);
    for (int k = 0; k < 3; k++)
        m.emissive.raw[k] = fminf(fmaxf(m.emissive.raw[k], 0.0f), 1e18f) * strength;
    m.normal_scale = gltf_float(normal, "scale", 1.0f, -FLT_MAX, FLT_MAX);
    load_alpha_mode(object, &m);
    m.double_sided = gltf_bool(object, "doubleSided", false);
    m.unlit = gltf_extension(object, "KHR_materials_unlit").json != NULL;
    m.base_color_map = texture_use_of(gltf, gltf_child(pbr, "baseColorTexture"));
    m.metallic_roughness_map = texture_use_of(gltf, gltf_child(pbr, "metallicRoughnessTexture"));
    m.normal_map = texture_use_of(gltf, normal);
    m.emissive_map = texture_use_of(gltf, gltf_child(object, "emissiveTexture"));
    load_specular(gltf, object, &m);
    if (m.unlit) material_clear_emission(&m);
    *out = m;
    return m.name && !gltf->failed;
}

enum { MAP_COUNT = 6 };

static struct texture_use *map_of(struct material *material, int k)
{
    struct texture_use *maps[MAP_COUNT] = {
        &material->base_color_map, &material->metallic_roughness_map, &material->normal_map,
        &material->emissive_map,   &material->specular_map,           &material->specular_color_map
    };
    return maps[k];
}

// The encoded images that materials use.
struct used_images {
    struct import_files files;
    struct image_source *sources;
    void **owned; // bytes of data URIs
    int *index;   // source → scene image
    int count;
};

static void finish_used_images(struct host *host, struct used_images *used)
{
    for (int i = 0; used->owned && i < used->count; i++) host_free(host, used->owned[i]);
    import_files_finish(&used->files);
    host_free(host, used->owned);
    host_free(host, used->sources);
    host_free(host, used->index);
}

// Reads and decodes the images that materials use; fills image_of.
static bool load_used_images(struct gltf *gltf)
{
    struct import *import = gltf->import;
    size_t count = json_array_size(gltf->images);
    struct used_images used = { 0 };
    used.sources = host_alloc(import->host, count, sizeof *used.sources);
    used.owned = host_alloc(import->host, count, sizeof *used.owned);
    used.index = host_alloc(import->host, count, sizeof *used.index);
    bool ok =
        used.sources && used.owned && used.index && import_files_init(&used.files, import, count);
    for (size_t i = 0; ok && i < count; i++) {
        if (gltf->image_of[i] < 0) continue;
        gltf->image_of[i] = used.count;
        ok = gltf_find_image(gltf, i, &used.files, &used.sources[used.count],
                             &used.owned[used.count]);
        used.count++;
    }
    ok = ok && import_images(import, used.sources, used.count, used.index);
    for (size_t i = 0; ok && i < count; i++) {
        if (gltf->image_of[i] >= 0) gltf->image_of[i] = used.index[gltf->image_of[i]];
    }
    finish_used_images(import->host, &used);
    return ok;
}

bool gltf_load_materials(struct gltf *gltf)
{
    struct scene *scene = gltf->import->scene;
    size_t count = json_array_size(gltf->materials), images = json_array_size(gltf->images);
    // One more: the default material.
    scene->materials = import_alloc(gltf->import, count + 1, sizeof *scene->materials);
    gltf->image_of = host_alloc(gltf->import->host, images, sizeof *gltf->image_of);
    if (!scene->materials || !gltf->image_of) return false;
    for (size_t i = 0; i < images; i++) gltf->image_of[i] = -1;
    for (size_t i = 0; i < count; i++) {
        if (!load_material(gltf, i, &scene->materials[i])) return false;
        scene->material_count++;
        for (int k = 0; k < MAP_COUNT; k++) {
            int image = map_of(&scene->materials[i], k)->image;
            if (image >= 0) gltf->image_of[image] = 0;
        }
    }
    if (!load_used_images(gltf)) return false;
    for (int i = 0; i < scene->material_count; i++) {
        for (int k = 0; k < MAP_COUNT; k++) {
            struct texture_use *use = map_of(&scene->materials[i], k);
            if (use->image >= 0) use->image = gltf->image_of[use->image];
        }
    }
    return count > 0 || gltf_material_default(gltf) >= 0;
}

int gltf_material_default(struct gltf *gltf)
{
    struct scene *scene = gltf->import->scene;
    if (gltf->default_material >= 0) return gltf->default_material;
    struct material material = gltf_default();
    material.name = import_name(gltf->import, "default", "", 0);
    if (!material.name) return -1;
    scene->materials[scene->material_count] = material;
    gltf->default_material = scene->material_count++;
    return gltf->default_material;
}
