// PLY files (Turk 1994, "The PLY Polygon File Format"): ASCII and both binary byte orders, vertices
// with normals, colours and texture coordinates, polygons. Not read through Assimp, which loops
// forever on a header without end_header and allocates lists before it checks their length.
#include "scene/import/importers.h"

#include "scene/import/import_mesh.h"

#include "image/png_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_ELEMENTS = 16, MAX_PROPERTIES = 64, NAME_SIZE = 32 };

enum ply_type { PLY_I8, PLY_U8, PLY_I16, PLY_U16, PLY_I32, PLY_U32, PLY_F32, PLY_F64, PLY_NONE };

struct ply_property {
    char name[NAME_SIZE];
    enum ply_type type, count_type; // count_type PLY_NONE: a single value
};

struct ply_element {
    char name[NAME_SIZE];
    size_t count;
    struct ply_property properties[MAX_PROPERTIES];
    int property_count;
};

enum ply_format { PLY_ASCII, PLY_LITTLE, PLY_BIG };

struct ply {
    struct import *import;
    const char *data;
    size_t size, at;
    enum ply_format format;
    struct ply_element elements[MAX_ELEMENTS];
    int element_count;
    struct mesh mesh;
    size_t index_capacity; // allocated length of mesh.indices
    bool broken;           // a value was missing or invalid
};

// The vertex attribute that a property belongs to.
enum ply_target { TO_NOTHING, TO_POSITION, TO_NORMAL, TO_UV, TO_COLOR };

static bool wrong(struct ply *ply, const char *why)
{
    return host_fail(ply->import->host, FAIL_FORMAT, "%s: PLY: %s", ply->import->path, why);
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

// --- Header

// The next line without its line end; false at the end of the file.
static bool next_line(struct ply *ply, char line[256])
{
    size_t start = ply->at, n = 0;
    while (ply->at < ply->size && ply->data[ply->at] != '\n') ply->at++;
    if (ply->at == ply->size) return false;
    n = ply->at++ - start;
    if (n > 0 && ply->data[start + n - 1] == '\r') n--;
    if (n > 255) n = 255;
    memcpy(line, ply->data + start, n);
    line[n] = 0;
    return true;
}

static enum ply_type type_of(const char *name)
{
    static const struct {
        const char *names[2];
        enum ply_type type;
    } types[] = {
        { { "char", "int8" }, PLY_I8 },      { { "uchar", "uint8" }, PLY_U8 },
        { { "short", "int16" }, PLY_I16 },   { { "ushort", "uint16" }, PLY_U16 },
        { { "int", "int32" }, PLY_I32 },     { { "uint", "uint32" }, PLY_U32 },
        { { "float", "float32" }, PLY_F32 }, { { "double", "float64" }, PLY_F64 },
    };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (strcmp(name, types[i].names[0]) == 0 || strcmp(name, types[i].names[1]) == 0) {
            return types[i].type;
        }
    }
    return PLY_NONE;
}

static bool add_element(struct ply *ply, const char *line)
{
    struct ply_element element = { 0 };
    unsigned long long count;
    if (sscanf(line, "element %31s %llu", element.name, &count) != 2 || count > UINT32_MAX) {
        return wrong(ply, "an element without a name or a count");
    }
    if (ply->element_count == MAX_ELEMENTS) return wrong(ply, "too many kinds of elements");
    element.count = (size_t)count;
    ply->elements[ply->element_count++] = element;
    return true;
}

static bool add_property(struct ply *ply, const char *line)
{
    struct ply_property property = { .count_type = PLY_NONE };
    char type[NAME_SIZE], count_type[NAME_SIZE];
    if (sscanf(line, "property list %31s %31s %31s", count_type, type, property.name) == 3) {
        property.count_type = type_of(count_type);
        if (property.count_type >= PLY_F32)
            return wrong(ply, "a list whose length is not an integer");
    } else if (sscanf(line, "property %31s %31s", type, property.name) != 2) {
        return wrong(ply, "a property without a type or a name");
    }
    property.type = type_of(type);
    if (property.type == PLY_NONE) return wrong(ply, "a property of unknown type");
    if (ply->element_count == 0) return wrong(ply, "a property before its element");
    struct ply_element *element = &ply->elements[ply->element_count - 1];
    if (element->property_count == MAX_PROPERTIES) return wrong(ply, "too many properties");
    element->properties[element->property_count++] = property;
    return true;
}

static bool starts_with(const char *line, const char *word)
{
    return strncmp(line, word, strlen(word)) == 0;
}

static bool read_header(struct ply *ply)
{
    char line[256];
    if (!next_line(ply, line) || strcmp(line, "ply") != 0) return wrong(ply, "not a PLY file");
    bool has_format = false;
    while (next_line(ply, line)) {
        if (starts_with(line, "format ")) {
            has_format = true;
            if (starts_with(line, "format ascii"))
                ply->format = PLY_ASCII;
            else if (starts_with(line, "format binary_little_endian"))
                ply->format = PLY_LITTLE;
            else if (starts_with(line, "format binary_big_endian"))
                ply->format = PLY_BIG;
            else
                return wrong(ply, "unknown format");
        } else if (starts_with(line, "element ")) {
            if (!add_element(ply, line)) return false;
        } else if (starts_with(line, "property ")) {
            if (!add_property(ply, line)) return false;
        } else if (strcmp(line, "end_header") == 0) {
            return has_format || wrong(ply, "the header has no format");
        }
    }
    return wrong(ply, "the header has no end_header");
}

// --- Values

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// A decimal number, independent of the locale. Stops at the zero byte after the file at the latest.
static double ascii_value(struct ply *ply)
{
    const char *c = ply->data + ply->at, *end = ply->data + ply->size;
    while (c < end && is_space(*c)) c++;
    bool negative = *c == '-';
    if (*c == '-' || *c == '+') c++;
    const char *first = c;
    double value = 0.0;
    int exponent = 0, stated = 0, digits = 0;
    for (; is_digit(*c); c++, digits++) value = value * 10.0 + (*c - '0');
    if (*c == '.') {
        for (c++; is_digit(*c); c++, digits++, exponent--) value = value * 10.0 + (*c - '0');
    }
    if (digits > 0 && (*c == 'e' || *c == 'E')) {
        bool down = c[1] == '-';
        c += down || c[1] == '+' ? 2 : 1;
        for (; is_digit(*c); c++) stated = stated < 9999 ? stated * 10 + (*c - '0') : stated;
        exponent += down ? -stated : stated;
    }
    ply->broken = ply->broken || digits == 0 || c == first || (*c && !is_space(*c));
    ply->at = (size_t)(c - ply->data);
    value *= pow(10.0, exponent);
    return negative ? -value : value;
}

static double binary_value(struct ply *ply, enum ply_type type)
{
    static const uint8_t sizes[] = { 1, 1, 2, 2, 4, 4, 4, 8 };
    size_t size = sizes[type];
    if (size > ply->size - ply->at) {
        ply->broken = true;
        return 0.0;
    }
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        size_t from = ply->format == PLY_BIG ? i : size - 1 - i;
        bits = bits << 8 | (uint8_t)ply->data[ply->at + from];
    }
    ply->at += size;
    uint32_t low = (uint32_t)bits;
    float f32;
    double f64;
    memcpy(&f32, &low, sizeof f32);
    memcpy(&f64, &bits, sizeof f64);
    switch (type) {
    case PLY_I8:
        return (int8_t)bits;
    case PLY_I16:
        return (int16_t)bits;
    case PLY_I32:
        return (int32_t)bits;
    case PLY_F32:
        return (double)f32;
    case PLY_F64:
        return f64;
    default:
        return (double)bits;
    }
}

static double next_value(struct ply *ply, enum ply_type type)
{
    return ply->format == PLY_ASCII ? ascii_value(ply) : binary_value(ply, type);
}

// The length of a list; each element takes at least a byte.
static size_t list_length(struct ply *ply, const struct ply_property *property)
{
    double length = next_value(ply, property->count_type);
    if (length >= 0.0 && length <= (double)(ply->size - ply->at)) return (size_t)length;
    ply->broken = true;
    return 0;
}

static void skip_property(struct ply *ply, const struct ply_property *property)
{
    size_t count = property->count_type == PLY_NONE ? 1 : list_length(ply, property);
    for (size_t i = 0; i < count && !ply->broken; i++) next_value(ply, property->type);
}

// --- Vertices and faces

static enum ply_target target_of(const struct ply_property *property, int *component)
{
    static const struct {
        const char *name;
        enum ply_target target;
        int component;
    } targets[] = {
        { "x", TO_POSITION, 0 },  { "y", TO_POSITION, 1 },  { "z", TO_POSITION, 2 },
        { "nx", TO_NORMAL, 0 },   { "ny", TO_NORMAL, 1 },   { "nz", TO_NORMAL, 2 },
        { "u", TO_UV, 0 },        { "s", TO_UV, 0 },        { "texture_u", TO_UV, 0 },
        { "v", TO_UV, 1 },        { "t", TO_UV, 1 },        { "texture_v", TO_UV, 1 },
        { "red", TO_COLOR, 0 },   { "green", TO_COLOR, 1 }, { "blue", TO_COLOR, 2 },
        { "alpha", TO_COLOR, 3 },
    };
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        if (property->count_type != PLY_NONE || strcmp(property->name, targets[i].name) != 0)
            continue;
        *component = targets[i].component;
        return targets[i].target;
    }
    return TO_NOTHING;
}

static bool allocate_vertices(struct ply *ply, const struct ply_element *element)
{
    struct mesh *mesh = &ply->mesh;
    bool has[TO_COLOR + 1] = { false };
    int component;
    for (int i = 0; i < element->property_count; i++) {
        has[target_of(&element->properties[i], &component)] = true;
    }
    if (mesh->positions || !has[TO_POSITION])
        return wrong(ply, "needs exactly one list of vertices with x, y, z");
    size_t count = element->count;
    if (count > ply->size - ply->at) return wrong(ply, "is shorter than its vertex data");
    mesh->vertex_count = (uint32_t)count;
    mesh->positions = import_alloc(ply->import, count, sizeof *mesh->positions);
    if (has[TO_NORMAL]) mesh->normals = import_alloc(ply->import, count, sizeof *mesh->normals);
    if (has[TO_UV]) mesh->uv[0] = import_alloc(ply->import, count, sizeof *mesh->uv[0]);
    if (has[TO_COLOR]) mesh->colors = import_alloc(ply->import, count, sizeof *mesh->colors);
    return mesh->positions && (mesh->normals || !has[TO_NORMAL]) && (mesh->uv[0] || !has[TO_UV]) &&
           (mesh->colors || !has[TO_COLOR]);
}

// Colours of a PLY file are sRGB-encoded; alpha is linear.
static float color_of(double value, enum ply_type type, int component)
{
    double scale = type == PLY_U8 ? 255.0 : type == PLY_U16 ? 65535.0 : 1.0;
    float encoded = (float)fmin(fmax(value / scale, 0.0), 1.0);
    return component == 3 ? encoded : srgb_decode(encoded);
}

static void read_vertex(struct ply *ply, const struct ply_element *element, size_t v)
{
    struct mesh *mesh = &ply->mesh;
    if (mesh->colors) mesh->colors[v].w = 1.0f;
    for (int i = 0; i < element->property_count; i++) {
        const struct ply_property *property = &element->properties[i];
        int k = 0;
        enum ply_target target = target_of(property, &k);
        if (target == TO_NOTHING) {
            skip_property(ply, property);
            continue;
        }
        double value = next_value(ply, property->type);
        if (target == TO_POSITION)
            mesh->positions[v].raw[k] = (float)value;
        else if (target == TO_NORMAL)
            mesh->normals[v].raw[k] = (float)value;
        // v grows upwards in PLY files, downwards here.
        else if (target == TO_UV)
            mesh->uv[0][v].raw[k] = (float)(k == 1 ? 1.0 - value : value);
        else
            mesh->colors[v].raw[k] = color_of(value, property->type, k);
    }
}

static bool read_vertices(struct ply *ply, const struct ply_element *element)
{
    if (!allocate_vertices(ply, element)) return false;
    for (size_t v = 0; v < element->count && !ply->broken; v++) read_vertex(ply, element, v);
    return !ply->broken || wrong(ply, "vertex data is truncated, or a value is not a number");
}

static bool reserve_triangle(struct ply *ply)
{
    struct mesh *mesh = &ply->mesh;
    if (mesh->index_count + (size_t)3 <= ply->index_capacity) return true;
    size_t grown = ply->index_capacity < 1024 ? 1024 : 2 * ply->index_capacity;
    if (grown > UINT32_MAX - 3) return wrong(ply, "too many triangles");
    uint32_t *more = import_alloc(ply->import, grown, sizeof *more);
    if (!more) return false;
    if (mesh->indices) memcpy(more, mesh->indices, mesh->index_count * sizeof *more);
    mesh->indices = more;
    ply->index_capacity = grown;
    return true;
}

// A polygon visits a vertex once, twice where it bridges to a hole. Longer lists would draw the
// same triangles again and again.
static size_t most_corners(const struct ply *ply)
{
    size_t vertices = 0;
    for (int e = 0; e < ply->element_count; e++)
        if (strcmp(ply->elements[e].name, "vertex") == 0) vertices += ply->elements[e].count;
    return 2 * vertices;
}

// Appends a polygon as a triangle fan to the indices.
static bool read_fan(struct ply *ply, const struct ply_property *property)
{
    struct mesh *mesh = &ply->mesh;
    size_t corners = list_length(ply, property);
    uint32_t first = 0, last = 0;
    if (corners > most_corners(ply))
        return wrong(ply, "a face has more than two corners per vertex");
    for (size_t k = 0; k < corners && !ply->broken; k++) {
        double value = next_value(ply, property->type);
        if (!(value >= 0.0 && value < (double)UINT32_MAX))
            return wrong(ply, "a face index is not a whole number");
        uint32_t corner = (uint32_t)value;
        if (k >= 2 && !reserve_triangle(ply)) return false;
        if (k >= 2) {
            uint32_t *triangle = mesh->indices + mesh->index_count;
            triangle[0] = first;
            triangle[1] = last;
            triangle[2] = corner;
            mesh->index_count += 3;
        }
        if (k == 0) first = corner;
        last = corner;
    }
    return true;
}

static bool read_faces(struct ply *ply, const struct ply_element *element)
{
    for (size_t f = 0; f < element->count && !ply->broken; f++) {
        for (int i = 0; i < element->property_count; i++) {
            const struct ply_property *property = &element->properties[i];
            bool corners = property->count_type != PLY_NONE &&
                           (strcmp(property->name, "vertex_indices") == 0 ||
                            strcmp(property->name, "vertex_index") == 0);
            if (!corners)
                skip_property(ply, property);
            else if (!read_fan(ply, property))
                return false;
        }
    }
    return !ply->broken || wrong(ply, "face data is truncated, or a value is not a number");
}

static bool read_elements(struct ply *ply)
{
    for (int e = 0; e < ply->element_count; e++) {
        const struct ply_element *element = &ply->elements[e];
        // Elements without properties have no data, whatever their count.
        if (element->property_count == 0) continue;
        if (strcmp(element->name, "vertex") == 0) {
            if (!read_vertices(ply, element)) return false;
        } else if (strcmp(element->name, "face") == 0) {
            if (!read_faces(ply, element)) return false;
        } else {
            if (element->count > 0) {
                import_note(ply->import, "elements \"%s\"", import_printable(element->name).s);
            }
            for (size_t i = 0; i < element->count && !ply->broken; i++) {
                for (int k = 0; k < element->property_count; k++) {
                    skip_property(ply, &element->properties[k]);
                }
            }
            if (ply->broken) return wrong(ply, "is truncated");
        }
    }
    return true;
}

static bool build_scene(struct ply *ply)
{
    struct import *import = ply->import;
    struct scene *scene = import->scene;
    struct material material = material_default();
    struct node node = node_default();
    material.name = "default";
    node.name = "mesh";
    ply->mesh.name = node.name;
    if (scene_add_material(scene, &material) != 0) return false;
    if (ply->mesh.index_count == 0) {
        import_note(import, "points without faces");
        return true;
    }
    if (!import_finish_mesh(import, &ply->mesh)) return false;
    scene->meshes = import_alloc(import, 1, sizeof *scene->meshes);
    if (!scene->meshes) return false;
    scene->meshes[scene->mesh_count++] = ply->mesh;
    struct instance instance = { .node = scene_add_node(scene, &node), .mesh = 0, .skin = -1 };
    return instance.node >= 0 && scene_add_instance(scene, &instance) >= 0;
}

bool import_ply(struct import *import, const struct file_bytes *bytes)
{
    struct ply *ply = host_alloc(import->host, 1, sizeof *ply);
    if (!ply) return false;
    ply->import = import;
    ply->data = (const char *)bytes->data;
    ply->size = bytes->size;
    bool ok = read_header(ply) && read_elements(ply) && build_scene(ply);
    host_free(import->host, ply);
    return ok;
}
