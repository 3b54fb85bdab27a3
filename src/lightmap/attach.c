// A vertex at the border of charts has coordinates in each of them: the first stay at the vertex,
// others get copies of it after all vertices. Attributes of primitives without divided vertices are
// kept.
#include "lightmap/attach.h"

#include <stdio.h>
#include <string.h>

struct variant {
    vec2s uv;
    uint32_t chart;
    uint32_t vertex; // of which it is a copy
    uint32_t next;   // variant of that vertex; CHART_NONE: none
};

struct unwrapped {
    struct host *host;
    const uint32_t *source;   // of a mesh's vertex; NULL: itself
    uint32_t total;           // vertices before
    bool changed;             // vertices are others than before
    struct variant *variants; // [total + 3 triangles] first one of each vertex, then copies
    uint32_t count;
    bool *used;        // [total] it has coordinates
    bool *kept;        // [total] a corner is there
    uint32_t *indices; // [3 triangles]
};

struct attaching {
    struct gltf_doc *doc;
    const struct charts *charts;
    const struct scene *scene;
};

// ---- triangles

static bool has_charts(const struct attaching *a, int instance)
{
    for (size_t t = a->charts->triangle_0[instance]; t < a->charts->triangle_0[instance + 1]; t++)
        if (a->charts->chart_triangle[t] != CHART_NONE) return true;
    return false;
}

// ---- vertices

static uint32_t variant_of(struct unwrapped *u, uint32_t vertex, uint32_t chart, vec2s uv)
{
    uint32_t at = vertex;
    if (!u->used[vertex]) {
        u->used[vertex] = true;
        u->variants[vertex] = (struct variant){ uv, chart, vertex, CHART_NONE };
        return vertex;
    }
    for (;; at = u->variants[at].next) {
        const vec2s other = u->variants[at].uv;
        if (other.x == uv.x && other.y == uv.y) return at;
        if (u->variants[at].next == CHART_NONE) break;
    }
    u->variants[at].next = u->count;
    u->variants[u->count] = (struct variant){ uv, chart, vertex, CHART_NONE };
    return u->count++;
}

// All corners of a single-texel chart are at its texel's centre. Triangles without area are no
// valid unwrap: in the file each has a cell of the texel, and all cells have the texel's light.
static vec2s place_in_texel(const struct chart *chart, uint32_t triangle, uint32_t k)
{
    static const float CORNER[3][2] = { { 0.1f, 0.1f }, { 0.9f, 0.1f }, { 0.1f, 0.9f } };
    const uint32_t at = triangle - chart->first_triangle;
    uint32_t across = 1;
    while (across * across < chart->triangle_count) across++;
    const float x = ((float)(at % across) + CORNER[k][0]) / (float)across;
    const float y = ((float)(at / across) + CORNER[k][1]) / (float)across;
    return (
        vec2s){ { (float)(chart->x + CHART_GUTTER) + x, (float)(chart->y + CHART_GUTTER) + y } };
}

static vec2s place_of(const struct charts *charts, uint32_t triangle, uint32_t k)
{
    const struct chart_triangle *t = &charts->triangles[triangle];
    const struct chart *chart = &charts->charts[t->chart];
    return chart->single_texel ? place_in_texel(chart, triangle, k) : t->place[k];
}

// On the chart's page.
static vec2s coordinates_of(const struct charts *charts, uint32_t triangle, uint32_t k)
{
    const vec2s place = place_of(charts, triangle, k);
    const struct chart *chart = &charts->charts[charts->triangles[triangle].chart];
    const struct chart_page page = charts_page(charts, chart->page);
    return (vec2s){ { (place.x - (float)page.x) / (float)page.width,
                      (place.y - (float)page.y) / (float)page.height } };
}

static void unwrap_corner(const struct attaching *a, struct unwrapped *u, const struct mesh *mesh,
                          uint32_t chart_triangle, uint32_t corner)
{
    const uint32_t v = mesh->indices[corner], vertex = u->source ? u->source[v] : v;
    u->indices[corner] = vertex;
    u->kept[vertex] = true;
    if (chart_triangle == CHART_NONE) return;
    u->indices[corner] = variant_of(u, vertex, a->charts->triangles[chart_triangle].chart,
                                    coordinates_of(a->charts, chart_triangle, corner % 3));
}

// ---- triangles without an area, which are in no chart

// The vertex's variant in the chart; CHART_NONE: none.
static uint32_t variant_in(const struct unwrapped *u, uint32_t vertex, uint32_t chart)
{
    uint32_t at = u->used[vertex] ? vertex : CHART_NONE;
    while (at != CHART_NONE && u->variants[at].chart != chart) at = u->variants[at].next;
    return at;
}

// The chart in which most of the vertices have a variant; CHART_NONE where none has one.
static uint32_t common_chart(const struct unwrapped *u, const uint32_t vertex[3])
{
    uint32_t best = CHART_NONE;
    int most = 0;
    for (int k = 0; k < 3; k++) {
        uint32_t at = u->used[vertex[k]] ? vertex[k] : CHART_NONE;
        for (; at != CHART_NONE; at = u->variants[at].next) {
            const uint32_t chart = u->variants[at].chart;
            int count = 0;
            for (int j = 0; j < 3; j++) count += variant_in(u, vertex[j], chart) != CHART_NONE;
            if (count <= most) continue;
            most = count;
            best = chart;
        }
    }
    return best;
}

// Corners get their coordinates in a chart that they have in common with others, or where they have
// none those of another corner there. fallback: a chart triangle, for corners without any.
static void unwrap_degenerate(const struct attaching *a, struct unwrapped *u, uint32_t first,
                              uint32_t fallback)
{
    const uint32_t vertex[3] = { u->indices[first], u->indices[first + 1], u->indices[first + 2] };
    uint32_t chart = common_chart(u, vertex), variant[3];
    vec2s uv = coordinates_of(a->charts, fallback, 0);
    for (int k = 0; k < 3; k++) {
        variant[k] = chart == CHART_NONE ? CHART_NONE : variant_in(u, vertex[k], chart);
        if (variant[k] != CHART_NONE) uv = u->variants[variant[k]].uv;
    }
    if (chart == CHART_NONE) chart = a->charts->triangles[fallback].chart;
    for (uint32_t k = 0; k < 3; k++)
        u->indices[first + k] =
            variant[k] != CHART_NONE ? variant[k] : variant_of(u, vertex[k], chart, uv);
}

static void unwrap_degenerates(const struct attaching *a, struct unwrapped *u, int instance)
{
    const size_t first = a->charts->triangle_0[instance], end = a->charts->triangle_0[instance + 1];
    uint32_t fallback = CHART_NONE;
    for (size_t t = first; t < end && fallback == CHART_NONE; t++)
        fallback = a->charts->chart_triangle[t];
    for (size_t t = first; t < end; t++)
        if (a->charts->chart_triangle[t] == CHART_NONE)
            unwrap_degenerate(a, u, 3 * (uint32_t)(t - first), fallback);
}

// ---- the vertices of an instance

// Primitives may share one large vertex buffer, which is not copied for each of them: where at most
// half of it is used, only those vertices stay.
static bool drop_unused(struct unwrapped *u, uint32_t index_count)
{
    uint32_t kept = 0, next = 0;
    for (uint32_t v = 0; v < u->total; v++) kept += u->kept[v];
    if (2 * (uint64_t)kept > u->total) return true;
    uint32_t *place = host_alloc(u->host, u->count, sizeof *place);
    if (!place) return false;
    for (uint32_t v = 0; v < u->count; v++) {
        place[v] = next;
        if (v < u->total && !u->kept[v]) continue;
        u->variants[next++] = u->variants[v];
    }
    for (uint32_t i = 0; i < index_count; i++) u->indices[i] = place[u->indices[i]];
    u->changed = true;
    u->count = next;
    host_free(u->host, place);
    return true;
}

static bool unwrap(const struct attaching *a, int instance, struct unwrapped *u)
{
    const struct mesh *mesh = scene_mesh_of(a->scene, instance);
    const bool of_file = instance < a->doc->file_place_count && mesh->source;
    *u = (struct unwrapped){ .host = a->charts->host,
                             .source = of_file ? mesh->source : NULL,
                             .total = of_file ? mesh->source_count : mesh->vertex_count };
    const size_t most = (size_t)u->total + mesh->index_count;
    u->variants = host_alloc(u->host, most, sizeof *u->variants);
    u->used = host_alloc(u->host, u->total, sizeof *u->used);
    u->kept = host_alloc(u->host, u->total, sizeof *u->kept);
    u->indices = host_alloc(u->host, mesh->index_count, sizeof *u->indices);
    if (!u->variants || !u->used || !u->kept || !u->indices) return false;
    for (uint32_t v = 0; v < u->total; v++) u->variants[v].vertex = v;
    u->count = u->total;
    for (uint32_t i = 0; i < mesh->index_count; i++)
        unwrap_corner(a, u, mesh,
                      a->charts->chart_triangle[a->charts->triangle_0[instance] + i / 3], i);
    unwrap_degenerates(a, u, instance);
    u->changed = u->count > u->total;
    return drop_unused(u, mesh->index_count);
}

static void unwrapped_finish(struct unwrapped *u)
{
    host_free(u->host, u->variants);
    host_free(u->host, u->used);
    host_free(u->host, u->kept);
    host_free(u->host, u->indices);
}

// ---- the primitive

// Bits of the sets that textures of a material use: members "texCoord", at any depth.
static uint32_t sets_of(const json_t *json)
{
    uint32_t sets = 0;
    const char *key;
    json_t *value;
    size_t i;
    if (json_is_array(json)) json_array_foreach(json, i, value) sets |= sets_of(value);
    if (!json_is_object(json)) return sets;
    json_object_foreach((json_t *)json, key, value)
    {
        const json_int_t set = json_integer_value(value);
        if (strcmp(key, "texCoord") == 0 && set >= 0 && set < 32) sets |= 1u << set;
        if (strcmp(key, "index") == 0) sets |= 1u << 31; // of a texture
        sets |= sets_of(value);
    }
    return sets;
}

static uint32_t sets_of_primitive(struct gltf_doc *doc, const json_t *primitive)
{
    json_t *materials = gltf_doc_array(doc, "materials");
    const json_t *material = json_object_get(primitive, "material");
    uint32_t sets = 0;
    if (material) sets = sets_of(json_array_get(materials, (size_t)json_integer_value(material)));
    const json_t *variants =
        json_object_get(json_object_get(primitive, "extensions"), "KHR_materials_variants");
    size_t i;
    json_t *mapping;
    json_array_foreach(json_object_get(variants, "mappings"), i, mapping)
    {
        const json_int_t of = json_integer_value(json_object_get(mapping, "material"));
        sets |= sets_of(json_array_get(materials, (size_t)of));
    }
    return sets;
}

static size_t add_coordinates(struct gltf_doc *doc, const struct unwrapped *u, bool zeros)
{
    vec2s *uv = host_alloc(doc->host, u->count, sizeof *uv);
    if (!uv) {
        doc->failed = true;
        return 0;
    }
    for (uint32_t i = 0; !zeros && i < u->count; i++) uv[i] = u->variants[i].uv;
    const size_t added = gltf_doc_add_accessor(doc, uv, GLTF_FLOAT, "VEC2", u->count);
    host_free(doc->host, uv);
    return added;
}

// Sets are numbered from 0 without gaps (section 3.7.2.1): absent ones become these, or zeros
// where a texture could use them.
static void set_coordinates(struct gltf_doc *doc, json_t *primitive, const struct unwrapped *u)
{
    json_t *attributes = json_object_get(primitive, "attributes");
    const uint32_t taken = sets_of_primitive(doc, primitive);
    char name[32];
    int set = 1;
    while (set < 31 && taken >> set & 1u) set++;
    const size_t added = add_coordinates(doc, u, false);
    for (int k = 0; k < set; k++) {
        snprintf(name, sizeof name, "TEXCOORD_%d", k);
        if (json_object_get(attributes, name)) continue;
        const size_t filled = taken ? add_coordinates(doc, u, true) : added;
        gltf_doc_set(doc, attributes, name, json_integer((json_int_t)filled));
    }
    snprintf(name, sizeof name, "TEXCOORD_%d", set);
    gltf_doc_set(doc, attributes, name, json_integer((json_int_t)added));
    gltf_doc_set(doc, gltf_doc_child(doc, primitive, "extras"), LIGHTMAP_EXTRAS,
                 json_pack("{s:i}", "texCoord", set));
}

// All charts of an instance are on one page.
static uint32_t page_of(const struct charts *charts, int instance)
{
    size_t t = charts->triangle_0[instance];
    while (charts->chart_triangle[t] == CHART_NONE) t++;
    return charts->charts[charts->triangles[charts->chart_triangle[t]].chart].page;
}

static void set_page(const struct attaching *a, json_t *primitive, int instance)
{
    json_t *extras = json_object_get(json_object_get(primitive, "extras"), LIGHTMAP_EXTRAS);
    if (charts_page_count(a->charts) > 1)
        gltf_doc_set(a->doc, extras, "page", json_integer(page_of(a->charts, instance)));
}

static bool gather(struct gltf_doc *doc, json_t *attributes, const struct unwrapped *u,
                   const uint32_t *source)
{
    const char *name;
    json_t *value;
    void *next;
    json_object_foreach_safe(attributes, next, name, value)
    {
        size_t added;
        if (!gltf_doc_gather_accessor(doc, (size_t)json_integer_value(value), u->total, source,
                                      u->count, &added))
            return false;
        gltf_doc_set(doc, attributes, name, json_integer((json_int_t)added));
    }
    return true;
}

// All attributes, also of morph targets, get the vertices, and triangles their indices.
static bool replace_vertices(struct gltf_doc *doc, json_t *primitive, const struct unwrapped *u,
                             uint32_t index_count)
{
    uint32_t *source = host_alloc(doc->host, u->count, sizeof *source);
    if (!source) return false;
    for (uint32_t i = 0; i < u->count; i++) source[i] = u->variants[i].vertex;
    bool ok = gather(doc, json_object_get(primitive, "attributes"), u, source);
    size_t i;
    json_t *target;
    json_array_foreach(json_object_get(primitive, "targets"), i, target) ok =
        ok && gather(doc, target, u, source);
    host_free(doc->host, source);
    json_object_del(primitive, "mode"); // strips and fans become triangles
    gltf_doc_set(doc, primitive, "indices",
                 json_integer((json_int_t)gltf_doc_add_accessor(doc, u->indices, GLTF_UINT,
                                                                "SCALAR", index_count)));
    return ok;
}

// A compressed copy would not have the coordinates.
static void drop_compression(json_t *primitive)
{
    json_t *extensions = json_object_get(primitive, "extensions");
    json_object_del(extensions, "KHR_draco_mesh_compression");
    if (extensions && json_object_size(extensions) == 0) json_object_del(primitive, "extensions");
}

static bool attach_instance(const struct attaching *a, int instance)
{
    struct gltf_doc *doc = a->doc;
    const struct gltf_place *place = &doc->places[instance];
    json_t *mesh = json_array_get(gltf_doc_array(doc, "meshes"), place->mesh);
    json_t *primitive = json_array_get(json_object_get(mesh, "primitives"), place->primitive);
    struct unwrapped u;
    bool ok = unwrap(a, instance, &u);
    if (ok) {
        drop_compression(primitive);
        if (u.changed)
            ok = replace_vertices(doc, primitive, &u,
                                  scene_mesh_of(a->scene, instance)->index_count);
        if (ok) {
            set_coordinates(doc, primitive, &u);
            set_page(a, primitive, instance);
        }
    }
    unwrapped_finish(&u);
    return ok;
}

// ---- meshes

// Meshes at several nodes are copied, but for the first node.
static bool separate_meshes(struct gltf_doc *doc)
{
    const size_t count = json_array_size(gltf_doc_array(doc, "meshes"));
    size_t *owner = host_alloc(doc->host, count, sizeof *owner); // node + 1
    size_t *copy = host_alloc(doc->host, count, sizeof *copy);   // the newest one
    for (int i = 0; owner && copy && i < doc->place_count; i++) {
        struct gltf_place *place = &doc->places[i];
        const size_t mesh = place->mesh, node = place->node + 1;
        if (place->node == SIZE_MAX) continue;
        if (owner[mesh] == 0) {
            owner[mesh] = node;
            copy[mesh] = mesh;
        } else if (owner[mesh] != node) {
            // Places of a node follow each other.
            owner[mesh] = node;
            copy[mesh] = gltf_doc_add(
                doc, "meshes", json_deep_copy(json_array_get(gltf_doc_array(doc, "meshes"), mesh)));
            gltf_doc_set(doc, json_array_get(gltf_doc_array(doc, "nodes"), place->node), "mesh",
                         json_integer((json_int_t)copy[mesh]));
        }
        place->mesh = copy[mesh];
    }
    const bool ok = owner && copy;
    host_free(doc->host, owner);
    host_free(doc->host, copy);
    return ok;
}

bool lightmap_attach(struct gltf_doc *doc, const struct charts *charts, const struct scene *scene)
{
    struct attaching a = { .doc = doc, .charts = charts, .scene = scene };
    bool ok = separate_meshes(doc);
    for (int i = 0; ok && i < doc->place_count && i < scene->instance_count; i++)
        if (doc->places[i].node != SIZE_MAX && has_charts(&a, i)) ok = attach_instance(&a, i);
    return ok;
}
