// Materials of a scene, with textures as PNG.
#include "scene/export/gltf_scene.h"

#include "image/png_file.h"

#include <math.h>
#include <string.h>

// Colours of linear images become sRGB, which is all that glTF has.
static uint8_t *encoded_pixels(struct host *host, const struct scene_image *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    uint8_t *out = host_alloc(host, count, 4);
    if (!out) return NULL;
    memcpy(out, image->rgba, 4 * count);
    for (size_t i = 0; image->linear && i < 4 * count; i++)
        if (i % 4 != 3) out[i] = (uint8_t)(255.0f * srgb_encode((float)out[i] / 255.0f) + 0.5f);
    return out;
}

static void add_image(struct gltf_doc *doc, const struct scene_image *image)
{
    uint8_t *pixels = encoded_pixels(doc->host, image), *png = NULL;
    size_t size = 0;
    if (pixels && png_encode(doc->host, pixels, image->width, image->height, &png, &size)) {
        const size_t view = gltf_doc_add_view(doc, png, size);
        gltf_doc_add(doc, "images",
                     json_pack("{s:o, s:I, s:s}", "name",
                               gltf_doc_text(image->name ? image->name : "image"), "bufferView",
                               (json_int_t)view, "mimeType", "image/png"));
    } else {
        doc->failed = true;
    }
    host_free(doc->host, png);
    host_free(doc->host, pixels);
}

static json_t *texture_info(struct gltf_doc *doc, const struct texture_use *use)
{
    static const int wraps[] = {
        [WRAP_REPEAT] = 10497, [WRAP_MIRROR] = 33648, [WRAP_CLAMP] = 33071
    };
    json_t *sampler =
        json_pack("{s:i, s:i}", "wrapS", wraps[use->wrap_u], "wrapT", wraps[use->wrap_v]);
    if (use->nearest) gltf_doc_set(doc, sampler, "magFilter", json_integer(9728));
    const size_t added = gltf_doc_add(doc, "samplers", sampler);
    const size_t texture =
        gltf_doc_add(doc, "textures",
                     json_pack("{s:i, s:I}", "source", use->image, "sampler", (json_int_t)added));
    json_t *info = json_pack("{s:I}", "index", (json_int_t)texture);
    if (use->uv_set > 0) gltf_doc_set(doc, info, "texCoord", json_integer(use->uv_set));
    const bool moved = use->uv_offset[0] != 0.0f || use->uv_offset[1] != 0.0f ||
                       use->uv_scale[0] != 1.0f || use->uv_scale[1] != 1.0f ||
                       use->uv_rotation_rad != 0.0f;
    if (!moved) return info;
    gltf_doc_use_extension(doc, "KHR_texture_transform");
    json_t *transform =
        gltf_doc_child(doc, gltf_doc_child(doc, info, "extensions"), "KHR_texture_transform");
    gltf_doc_set(doc, transform, "offset", gltf_doc_floats(use->uv_offset, 2));
    gltf_doc_set(doc, transform, "scale", gltf_doc_floats(use->uv_scale, 2));
    gltf_doc_set(doc, transform, "rotation", json_real((double)use->uv_rotation_rad));
    return info;
}

static void add_texture(struct gltf_doc *doc, json_t *object, const char *key,
                        const struct texture_use *use)
{
    if (use->image >= 0) gltf_doc_set(doc, object, key, texture_info(doc, use));
}

static json_t *extension(struct gltf_doc *doc, json_t *material, const char *name)
{
    gltf_doc_use_extension(doc, name);
    return gltf_doc_child(doc, gltf_doc_child(doc, material, "extensions"), name);
}

// The strength is a power of two, by which products are exact.
static void add_emission(struct gltf_doc *doc, json_t *out, const struct material *m)
{
    int exponent = 0;
    const float most = glms_vec3_max(m->emissive);
    if (!(most > 0.0f)) return;
    if (most > 1.0f) frexpf(most, &exponent);
    const float strength = ldexpf(1.0f, exponent);
    const vec3s factor = glms_vec3_divs(m->emissive, strength);
    gltf_doc_set(doc, out, "emissiveFactor", gltf_doc_floats(factor.raw, 3));
    add_texture(doc, out, "emissiveTexture", &m->emissive_map);
    if (exponent > 0)
        gltf_doc_set(doc, extension(doc, out, "KHR_materials_emissive_strength"),
                     "emissiveStrength", json_real((double)strength));
}

static void add_specular(struct gltf_doc *doc, json_t *out, const struct material *m)
{
    if (m->ior != MATERIAL_DEFAULT_IOR)
        gltf_doc_set(doc, extension(doc, out, "KHR_materials_ior"), "ior",
                     json_real((double)m->ior));
    const vec3s c = m->specular_color;
    if (m->specular == 1.0f && c.x == 1.0f && c.y == 1.0f && c.z == 1.0f &&
        m->specular_map.image < 0 && m->specular_color_map.image < 0)
        return;
    json_t *specular = extension(doc, out, "KHR_materials_specular");
    gltf_doc_set(doc, specular, "specularFactor", json_real((double)m->specular));
    gltf_doc_set(doc, specular, "specularColorFactor", gltf_doc_floats(c.raw, 3));
    add_texture(doc, specular, "specularTexture", &m->specular_map);
    add_texture(doc, specular, "specularColorTexture", &m->specular_color_map);
}

static void add_alpha(struct gltf_doc *doc, json_t *out, const struct material *m)
{
    static const char *const modes[] = { "OPAQUE", "MASK", "BLEND" };
    if (m->alpha_mode == ALPHA_OPAQUE) return;
    gltf_doc_set(doc, out, "alphaMode", json_string(modes[m->alpha_mode]));
    if (m->alpha_mode == ALPHA_MASK)
        gltf_doc_set(doc, out, "alphaCutoff", json_real((double)m->alpha_cutoff));
}

json_t *gltf_doc_material(struct gltf_doc *doc, const struct material *m)
{
    json_t *out = json_pack("{s:o}", "name", gltf_doc_text(m->name ? m->name : "material"));
    json_t *pbr = gltf_doc_child(doc, out, "pbrMetallicRoughness");
    gltf_doc_set(doc, pbr, "baseColorFactor", gltf_doc_floats(m->base_color.raw, 4));
    gltf_doc_set(doc, pbr, "metallicFactor", json_real((double)m->metallic));
    gltf_doc_set(doc, pbr, "roughnessFactor", json_real((double)m->roughness));
    add_texture(doc, pbr, "baseColorTexture", &m->base_color_map);
    add_texture(doc, pbr, "metallicRoughnessTexture", &m->metallic_roughness_map);
    add_texture(doc, out, "normalTexture", &m->normal_map);
    if (m->normal_map.image >= 0)
        gltf_doc_set(doc, json_object_get(out, "normalTexture"), "scale",
                     json_real((double)m->normal_scale));
    add_emission(doc, out, m);
    add_specular(doc, out, m);
    add_alpha(doc, out, m);
    if (m->double_sided) gltf_doc_set(doc, out, "doubleSided", json_true());
    if (m->unlit) extension(doc, out, "KHR_materials_unlit");
    return out;
}

void gltf_doc_materials(struct scene_export *x)
{
    for (int i = 0; i < x->scene->image_count; i++) add_image(x->doc, &x->scene->images[i]);
    for (int i = 0; i < x->scene->material_count; i++)
        gltf_doc_add(x->doc, "materials", gltf_doc_material(x->doc, &x->scene->materials[i]));
}
