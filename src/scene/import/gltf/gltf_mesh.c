// Meshes of a glTF file (glTF 2.0, section 3.7.2): one scene mesh for each primitive of triangles.
#include "scene/import/gltf/gltf.h"

#include "scene/import/import_mesh.h"
#include "scene/scene_check.h"

#include <stdio.h>
#include <string.h>

enum primitive_mode { MODE_TRIANGLES = 4, MODE_TRIANGLE_STRIP, MODE_TRIANGLE_FAN };

struct primitive {
    struct gltf *gltf;
    struct gltf_object object, attributes;
    struct mesh *mesh;
};

// The accessor of an attribute, -1 if absent; its count must equal that of the mesh.
static int attribute(struct primitive *p, struct gltf_object attributes, const char *name)
{
    int accessor = gltf_index(attributes, name, p->gltf->accessors);
    if (accessor < 0) return -1;
    size_t count = gltf_accessor_count(p->gltf, accessor);
    if (count == p->mesh->vertex_count) return accessor;
    gltf_wrong(p->object, "%s has %zu elements, POSITION has %u", name, count,
               p->mesh->vertex_count);
    return -1;
}

static float *floats(struct primitive *p, struct gltf_object attributes, const char *name,
                     int width)
{
    int accessor = attribute(p, attributes, name);
    return accessor < 0 ? NULL : gltf_floats_of(p->gltf, accessor, width);
}

// Notes unsupported attributes.
static void note_attributes(struct primitive *p)
{
    const char *name;
    json_t *value;
    json_object_foreach(p->attributes.json, name, value)
    {
        (void)value;
        if (strcmp(name, "JOINTS_1") == 0) {
            import_note(p->gltf->import, "more than four joints per vertex");
        } else if (strcmp(name, "COLOR_1") == 0) {
            import_note(p->gltf->import, "a second set of vertex colours");
        } else if (strcmp(name, "TEXCOORD_2") == 0) {
            import_note(p->gltf->import, "texture coordinate sets above 1");
        } else if (name[0] == '_') {
            import_note(p->gltf->import, "attribute %s", import_printable(name).s);
        }
    }
}

static bool load_colors(struct primitive *p)
{
    int accessor = attribute(p, p->attributes, "COLOR_0");
    if (accessor < 0) return !p->gltf->failed;
    int width = gltf_accessor_width(p->gltf, accessor);
    if (width != 3 && width != 4) return gltf_wrong(p->object, "COLOR_0 is neither VEC3 nor VEC4");
    const float *values = gltf_floats_of(p->gltf, accessor, width);
    if (!values) return false;
    if (width == 4) {
        p->mesh->colors = (vec4s *)values;
        return true;
    }
    p->mesh->colors = import_alloc(p->gltf->import, p->mesh->vertex_count, sizeof(vec4s));
    for (uint32_t i = 0; p->mesh->colors && i < p->mesh->vertex_count; i++) {
        const float *v = values + 3 * (size_t)i;
        p->mesh->colors[i] = (vec4s){ { v[0], v[1], v[2], 1.0f } };
    }
    return p->mesh->colors != NULL;
}

// Normalises weights to sum 1; joints of weight 0 become joint 0.
static bool load_skinning(struct primitive *p)
{
    struct mesh *mesh = p->mesh;
    int joint_accessor = attribute(p, p->attributes, "JOINTS_0");
    const float *given = floats(p, p->attributes, "WEIGHTS_0", 4);
    if (p->gltf->failed || (joint_accessor >= 0) != (given != NULL)) {
        return gltf_wrong(p->object, "has only one of JOINTS_0 and WEIGHTS_0");
    }
    if (!given) return true;
    const uint32_t *joints = gltf_integers_of(p->gltf, joint_accessor, 4);
    if (!joints) return false;
    mesh->joints = import_alloc(p->gltf->import, mesh->vertex_count, sizeof *mesh->joints);
    mesh->weights = import_alloc(p->gltf->import, mesh->vertex_count, sizeof *mesh->weights);
    if (!mesh->joints || !mesh->weights) return false;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        float sum = 0.0f;
        for (size_t k = 0; k < 4; k++) {
            float weight = given[4 * i + k] > 0.0f ? given[4 * i + k] : 0.0f;
            uint32_t joint = weight > 0.0f ? joints[4 * i + k] : 0;
            if (joint > UINT16_MAX)
                return gltf_wrong(p->object, "joint index %u is above 65535", joint);
            mesh->joints[i][k] = (uint16_t)joint;
            mesh->weights[i].raw[k] = weight;
            sum += weight;
        }
        if (sum > 0.0f)
            mesh->weights[i] = glms_vec4_divs(mesh->weights[i], sum);
        else
            mesh->weights[i].x = 1.0f;
    }
    return true;
}

static bool load_morphs(struct primitive *p)
{
    struct import *import = p->gltf->import;
    struct mesh *mesh = p->mesh;
    json_t *targets = gltf_array(p->object, "targets");
    size_t count = json_array_size(targets);
    if (count == 0) return !p->gltf->failed;
    if (count > 4096) return gltf_wrong(p->object, "more than 4096 morph targets");
    mesh->morphs = import_alloc(import, count, sizeof *mesh->morphs);
    if (!mesh->morphs) return false;
    for (size_t i = 0; i < count; i++) {
        struct gltf_object target = gltf_element(p->gltf, targets, "morph target", i);
        struct morph_target *morph = &mesh->morphs[i];
        morph->positions = (vec3s *)floats(p, target, "POSITION", 3);
        morph->normals = (vec3s *)floats(p, target, "NORMAL", 3);
        // Offsets of absent normals are meaningless.
        if (!mesh->normals) morph->normals = NULL;
        if (p->gltf->failed) return false;
        if (!morph->positions) {
            morph->positions = import_alloc(import, mesh->vertex_count, sizeof(vec3s));
        }
        if (!morph->positions) return false;
        mesh->morph_count++;
    }
    return true;
}

// The file's indices, or 0, 1, 2, … for a primitive without.
static uint32_t *load_corners(struct primitive *p, size_t *count)
{
    int accessor = gltf_index(p->object, "indices", p->gltf->accessors);
    if (p->gltf->failed) return NULL;
    if (accessor >= 0) {
        *count = gltf_accessor_count(p->gltf, accessor);
        return gltf_integers_of(p->gltf, accessor, 1);
    }
    *count = p->mesh->vertex_count;
    uint32_t *corners = import_alloc(p->gltf->import, *count, sizeof *corners);
    for (size_t i = 0; corners && i < *count; i++) corners[i] = (uint32_t)i;
    return corners;
}

// Triangles of a strip or fan, in the order of glTF 2.0, section 3.7.2.1.
static uint32_t *triangles_of(struct primitive *p, const uint32_t *corners, size_t corner_count,
                              bool strip)
{
    size_t triangles = corner_count - 2;
    uint32_t *indices = import_alloc(p->gltf->import, triangles, 3 * sizeof *indices);
    for (size_t i = 0; indices && i < triangles; i++) {
        uint32_t *t = indices + 3 * i;
        size_t odd = i % 2;
        t[0] = corners[strip ? i : i + 1];
        t[1] = corners[strip ? i + 1 + odd : i + 2];
        t[2] = corners[strip ? i + 2 - odd : 0];
    }
    return indices;
}

static bool load_indices(struct primitive *p, size_t mode)
{
    struct mesh *mesh = p->mesh;
    size_t count;
    mesh->indices = load_corners(p, &count);
    if (!mesh->indices) return false;
    if (mode != MODE_TRIANGLES && count >= 3) {
        if (count > UINT32_MAX / 3) return gltf_wrong(p->object, "too many triangles");
        mesh->indices = triangles_of(p, mesh->indices, count, mode == MODE_TRIANGLE_STRIP);
        count = 3 * (count - 2);
    }
    if (count % 3 != 0) {
        return gltf_wrong(p->object, "%zu indices are not a multiple of 3", count);
    }
    mesh->index_count = (uint32_t)count;
    return mesh->indices != NULL;
}

// Refuses primitives that have only Draco data; beside ordinary accessors it is a copy.
static bool check_compression(struct primitive *p)
{
    if (!gltf_extension(p->object, "KHR_draco_mesh_compression").json) return !p->gltf->failed;
    int accessor = gltf_index(p->attributes, "POSITION", p->gltf->accessors);
    if (accessor < 0) return !p->gltf->failed;
    struct gltf_object object =
        gltf_element(p->gltf, p->gltf->accessors, "accessor", (size_t)accessor);
    if (gltf_has(object, "bufferView") || gltf_has(object, "sparse")) return true;
    struct import *import = p->gltf->import;
    return host_fail(import->host, FAIL_UNSUPPORTED,
                     "%s: mesh %s has only KHR_draco_mesh_compression data, which is not supported",
                     import->path, import_printable(p->mesh->name).s);
}

static bool uses_second_set(const struct material *m)
{
    const struct texture_use *const maps[] = { &m->base_color_map, &m->metallic_roughness_map,
                                               &m->normal_map,     &m->emissive_map,
                                               &m->specular_map,   &m->specular_color_map };
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (maps[i]->image >= 0 && maps[i]->uv_set == 1) return true;
    return false;
}

// A second set that no texture uses is for light maps, which need none.
static void drop_broken_unwrap(struct primitive *p)
{
    struct mesh *mesh = p->mesh;
    bool finite = true;
    for (uint32_t i = 0; mesh->uv[1] && i < mesh->index_count; i++)
        finite &= vec2_is_finite(mesh->uv[1][mesh->indices[i]]);
    if (finite || uses_second_set(&p->gltf->import->scene->materials[mesh->material])) return;
    import_note(p->gltf->import, "TEXCOORD_1 that is not finite");
    mesh->uv[1] = NULL;
}

static bool load_vertices(struct primitive *p, int position_accessor)
{
    struct mesh *mesh = p->mesh;
    mesh->positions = (vec3s *)gltf_floats_of(p->gltf, position_accessor, 3);
    if (!mesh->positions) return false;
    mesh->normals = (vec3s *)floats(p, p->attributes, "NORMAL", 3);
    mesh->tangents = (vec4s *)floats(p, p->attributes, "TANGENT", 4);
    if (!mesh->normals) mesh->tangents = NULL; // ignored then, as glTF 2.0 requires
    mesh->uv[0] = (vec2s *)floats(p, p->attributes, "TEXCOORD_0", 2);
    mesh->uv[1] = (vec2s *)floats(p, p->attributes, "TEXCOORD_1", 2);
    if (!p->gltf->failed) drop_broken_unwrap(p);
    return !p->gltf->failed && load_colors(p) && load_skinning(p) && load_morphs(p);
}

// Adds the primitive to the scene if it has triangles.
static bool load_primitive(struct gltf *gltf, const char *name, json_t *primitives, size_t i,
                           bool *added)
{
    struct scene *scene = gltf->import->scene;
    struct mesh mesh = { .name = name };
    struct primitive p = { .gltf = gltf, .mesh = &mesh };
    char kind[96];
    snprintf(kind, sizeof kind, "%s, primitive", import_printable(name).s);
    p.object = gltf_element(gltf, primitives, kind, i);
    p.attributes = gltf_child(p.object, "attributes");
    size_t mode = gltf_size(p.object, "mode", MODE_TRIANGLES, 6);
    mesh.material = gltf_index(p.object, "material", gltf->materials);
    int position = gltf_index(p.attributes, "POSITION", gltf->accessors);
    *added = false;
    if (gltf->failed) return false;
    if (mode < MODE_TRIANGLES) {
        import_note(gltf->import, mode == 0 ? "point primitives" : "line primitives");
        return true;
    }
    if (position < 0) {
        import_note(gltf->import, "primitives without positions");
        return true;
    }
    if (mesh.material < 0) mesh.material = gltf_material_default(gltf);
    if (mesh.material < 0 || !check_compression(&p)) return false;
    note_attributes(&p);
    uint32_t low, high;
    mesh.vertex_count = (uint32_t)gltf_accessor_count(gltf, position);
    if (gltf->failed || !load_indices(&p, mode)) return false;
    if (mesh.index_count < 3) return true;
    if (!import_check_indices(gltf->import, &mesh, &low, &high)) return false;
    if (!load_vertices(&p, position)) return false;
    if (!import_finish_mesh(gltf->import, &mesh)) return false;
    scene->meshes[scene->mesh_count++] = mesh;
    *added = true;
    return true;
}

static bool load_mesh(struct gltf *gltf, size_t i)
{
    struct import *import = gltf->import;
    struct gltf_object object = gltf_element(gltf, gltf->meshes, "mesh", i);
    const char *name = import_name(import, gltf_string(object, "name"), "mesh", i);
    json_t *primitives = gltf_array(object, "primitives");
    if (gltf->failed || !name) return false;
    gltf->first_mesh[i] = import->scene->mesh_count;
    for (size_t k = 0; k < json_array_size(primitives); k++) {
        bool added;
        if (!load_primitive(gltf, name, primitives, k, &added)) return false;
        gltf->mesh_parts[i] += added;
    }
    // All parts share one set of weights.
    const struct mesh *parts = import->scene->meshes + gltf->first_mesh[i];
    for (int k = 1; k < gltf->mesh_parts[i]; k++) {
        if (parts[k].morph_count == parts[0].morph_count) continue;
        return gltf_wrong(object, "its primitives differ in the number of morph targets");
    }
    return true;
}

bool gltf_load_meshes(struct gltf *gltf)
{
    struct import *import = gltf->import;
    size_t count = json_array_size(gltf->meshes), primitives = 0;
    for (size_t i = 0; i < count; i++) {
        struct gltf_object object = gltf_element(gltf, gltf->meshes, "mesh", i);
        primitives += json_array_size(gltf_array(object, "primitives"));
    }
    if (gltf->failed) return false;
    import->scene->meshes = import_alloc(import, primitives, sizeof *import->scene->meshes);
    gltf->first_mesh = host_alloc(import->host, count, sizeof *gltf->first_mesh);
    gltf->mesh_parts = host_alloc(import->host, count, sizeof *gltf->mesh_parts);
    if (!import->scene->meshes || !gltf->first_mesh || !gltf->mesh_parts) return false;
    for (size_t i = 0; i < count; i++) {
        if (!load_mesh(gltf, i)) return false;
    }
    return true;
}
