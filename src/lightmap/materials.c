// Each use of a material, by a primitive or one of its variants, has a set of coordinates on a page
// of the map. The first use that is met keeps the material; each other one gets a copy of it.
#include "lightmap/materials.h"

#include "lightmap/attach.h"

#include <string.h>

static const char EXTENSION[] = "MOZ_lightmap", VARIANTS[] = "KHR_materials_variants";

// A use is a set, which is at least 1, plus MAX_SETS times the page.
enum { UNSEEN = -1, NO_MAP = 0, MAX_SETS = 32 };

struct materials {
    struct gltf_doc *doc;
    const struct lightmap_image *pages;
    uint32_t page_count;
    size_t given;     // materials of the document; one more for primitives without one
    int *first_use;   // [given + 1]
    size_t *copies;   // [given + 1][MAX_SETS · page_count] material + 1; 0: none
    size_t *textures; // [page_count] + 1; 0: not added
    size_t sampler;   // + 1; 0: not added
};

// ---- earlier maps

static void forget_use(json_t *used)
{
    size_t i;
    json_t *name;
    json_array_foreach(used, i, name)
    {
        if (strcmp(json_string_value(name) ? json_string_value(name) : "", EXTENSION) != 0)
            continue;
        json_array_remove(used, i);
        return;
    }
}

static void forget_member(json_t *object, const char *child, const char *key)
{
    json_t *at = json_object_get(object, child);
    if (json_object_del(at, key) == 0 && json_object_size(at) == 0) json_object_del(object, child);
}

void lightmap_forget(struct gltf_doc *doc)
{
    json_t *used = json_object_get(doc->root, "extensionsUsed"), *mesh, *element;
    size_t i, k;
    forget_use(used);
    if (used && json_array_size(used) == 0) json_object_del(doc->root, "extensionsUsed");
    json_array_foreach(json_object_get(doc->root, "materials"), i, element)
        forget_member(element, "extensions", EXTENSION);
    json_array_foreach(json_object_get(doc->root, "meshes"), i, mesh)
        json_array_foreach(json_object_get(mesh, "primitives"), k, element)
            forget_member(element, "extras", LIGHTMAP_EXTRAS);
}

// ---- the texture

static size_t add_sampler(struct gltf_doc *doc)
{
    enum { LINEAR = 9729, CLAMP = 33071 };
    return gltf_doc_add(doc, "samplers",
                        json_pack("{s:i, s:i, s:i, s:i}", "magFilter", LINEAR, "minFilter", LINEAR,
                                  "wrapS", CLAMP, "wrapT", CLAMP));
}

static size_t add_texture(struct materials *m, const struct lightmap_image *image)
{
    struct gltf_doc *doc = m->doc;
    const size_t view = gltf_doc_add_view(doc, image->png, image->size);
    const size_t at = gltf_doc_add(doc, "images",
                                   json_pack("{s:s, s:I, s:s}", "name", image->name, "bufferView",
                                             (json_int_t)view, "mimeType", "image/png"));
    if (m->sampler == 0) m->sampler = 1 + add_sampler(doc);
    return gltf_doc_add(doc, "textures",
                        json_pack("{s:s, s:I, s:I}", "name", image->name, "source", (json_int_t)at,
                                  "sampler", (json_int_t)(m->sampler - 1)));
}

static void give_map(struct materials *m, json_t *material, int use)
{
    const int page = use / MAX_SETS;
    if (!m->pages[page].png) return;
    if (m->textures[page] == 0) m->textures[page] = 1 + add_texture(m, &m->pages[page]);
    json_t *extensions = gltf_doc_child(m->doc, material, "extensions");
    gltf_doc_use_extension(m->doc, EXTENSION);
    gltf_doc_set(m->doc, extensions, EXTENSION,
                 json_pack("{s:I, s:i, s:f}", "index", (json_int_t)(m->textures[page] - 1),
                           "texCoord", use % MAX_SETS, "intensity", (double)m->pages[page].range));
}

// ---- uses

static json_t *material_at(const struct materials *m, size_t index)
{
    return json_array_get(json_object_get(m->doc->root, "materials"), index);
}

static bool is_unlit(const json_t *material)
{
    return json_object_get(json_object_get(material, "extensions"), "KHR_materials_unlit") != NULL;
}

// A copy of the material as it was, or the default material of the format.
static size_t add_copy(struct materials *m, size_t index)
{
    json_t *copy = index < m->given ? json_deep_copy(material_at(m, index)) : json_object();
    forget_member(copy, "extensions", EXTENSION);
    return gltf_doc_add(m->doc, "materials", copy);
}

// The material for a use of `index`.
static size_t material_for(struct materials *m, size_t index, int use)
{
    if (is_unlit(material_at(m, index))) return index;
    if (index < m->given && m->first_use[index] == UNSEEN) {
        m->first_use[index] = use;
        if (use != NO_MAP) give_map(m, material_at(m, index), use);
    }
    if (m->first_use[index] == use) return index;
    size_t *copy = &m->copies[index * MAX_SETS * m->page_count + (size_t)use];
    if (*copy == 0) {
        *copy = 1 + add_copy(m, index);
        if (use != NO_MAP) give_map(m, material_at(m, *copy - 1), use);
    }
    return *copy - 1;
}

static void use_material(struct materials *m, json_t *holder, int use)
{
    const json_t *given = json_object_get(holder, "material");
    const size_t index = given ? (size_t)json_integer_value(given) : m->given;
    if (index > m->given || (!given && use == NO_MAP)) return;
    const size_t material = material_for(m, index, use);
    if (material != index)
        gltf_doc_set(m->doc, holder, "material", json_integer((json_int_t)material));
}

static int use_of(const struct materials *m, const json_t *primitive)
{
    const json_t *extras = json_object_get(json_object_get(primitive, "extras"), LIGHTMAP_EXTRAS);
    const json_int_t set = json_integer_value(json_object_get(extras, "texCoord"));
    const json_int_t page = json_integer_value(json_object_get(extras, "page"));
    if (set <= 0 || set >= MAX_SETS || page < 0 || page >= (json_int_t)m->page_count) return NO_MAP;
    return (int)(page * MAX_SETS + set);
}

static void use_primitive(struct materials *m, json_t *primitive)
{
    const json_t *variants = json_object_get(json_object_get(primitive, "extensions"), VARIANTS);
    const int use = use_of(m, primitive);
    size_t i;
    json_t *mapping;
    use_material(m, primitive, use);
    json_array_foreach(json_object_get(variants, "mappings"), i, mapping)
        use_material(m, mapping, use);
}

bool lightmap_materials(struct gltf_doc *doc, const struct lightmap_image *pages,
                        uint32_t page_count)
{
    struct materials m = { .doc = doc, .pages = pages, .page_count = page_count };
    m.given = json_array_size(json_object_get(doc->root, "materials"));
    m.first_use = host_alloc(doc->host, m.given + 1, sizeof *m.first_use);
    m.copies = host_alloc(doc->host, (m.given + 1) * MAX_SETS, page_count * sizeof *m.copies);
    m.textures = host_alloc(doc->host, page_count, sizeof *m.textures);
    const bool ok = m.first_use && m.copies && m.textures;
    size_t i, k;
    json_t *mesh, *primitive;
    for (i = 0; ok && i <= m.given; i++) m.first_use[i] = UNSEEN;
    if (ok)
        json_array_foreach(json_object_get(doc->root, "meshes"), i, mesh)
            json_array_foreach(json_object_get(mesh, "primitives"), k, primitive)
                use_primitive(&m, primitive);
    host_free(doc->host, m.first_use);
    host_free(doc->host, m.copies);
    host_free(doc->host, m.textures);
    return ok;
}
