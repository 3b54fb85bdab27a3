// Meshes and animations of a scene.
#include "scene/export/gltf_scene.h"

#include <string.h>

// Positions state their range (glTF 2.0, section 3.6.2.5).
static size_t add_positions(struct gltf_doc *doc, const vec3s *positions, uint32_t count)
{
    struct box3 box = box3_empty();
    for (uint32_t v = 0; v < count; v++) box = box3_add_point(box, positions[v]);
    const size_t added = gltf_doc_add_accessor(doc, positions, GLTF_FLOAT, "VEC3", count);
    json_t *accessor = json_array_get(gltf_doc_array(doc, "accessors"), added);
    gltf_doc_set(doc, accessor, "min", gltf_doc_floats(box.min.raw, 3));
    gltf_doc_set(doc, accessor, "max", gltf_doc_floats(box.max.raw, 3));
    return added;
}

static void set_index(struct gltf_doc *doc, json_t *object, const char *key, size_t index)
{
    gltf_doc_set(doc, object, key, json_integer((json_int_t)index));
}

static void add_attribute(struct gltf_doc *doc, json_t *attributes, const char *name,
                          const void *data, enum gltf_component component, const char *type,
                          uint32_t count)
{
    if (data)
        set_index(doc, attributes, name, gltf_doc_add_accessor(doc, data, component, type, count));
}

static json_t *attributes_of(struct gltf_doc *doc, const struct mesh *m)
{
    json_t *out = json_object();
    const uint32_t count = m->vertex_count;
    set_index(doc, out, "POSITION", add_positions(doc, m->positions, count));
    add_attribute(doc, out, "NORMAL", m->normals, GLTF_FLOAT, "VEC3", count);
    add_attribute(doc, out, "TANGENT", m->tangents, GLTF_FLOAT, "VEC4", count);
    add_attribute(doc, out, "TEXCOORD_0", m->uv[0], GLTF_FLOAT, "VEC2", count);
    add_attribute(doc, out, "TEXCOORD_1", m->uv[1], GLTF_FLOAT, "VEC2", count);
    add_attribute(doc, out, "COLOR_0", m->colors, GLTF_FLOAT, "VEC4", count);
    add_attribute(doc, out, "JOINTS_0", m->joints, GLTF_USHORT, "VEC4", count);
    add_attribute(doc, out, "WEIGHTS_0", m->weights, GLTF_FLOAT, "VEC4", count);
    return out;
}

static json_t *targets_of(struct gltf_doc *doc, const struct mesh *m)
{
    json_t *out = json_array();
    for (int i = 0; i < m->morph_count; i++) {
        json_t *target = json_object();
        set_index(doc, target, "POSITION",
                  add_positions(doc, m->morphs[i].positions, m->vertex_count));
        add_attribute(doc, target, "NORMAL", m->morphs[i].normals, GLTF_FLOAT, "VEC3",
                      m->vertex_count);
        if (json_array_append_new(out, target) != 0) doc->failed = true;
    }
    return out;
}

json_t *gltf_doc_primitive(struct scene_export *x, int mesh)
{
    struct gltf_doc *doc = x->doc;
    const struct mesh *m = &x->scene->meshes[mesh];
    if (x->primitives[mesh]) return x->primitives[mesh];
    json_t *out = json_object();
    gltf_doc_set(doc, out, "attributes", attributes_of(doc, m));
    set_index(doc, out, "indices",
              gltf_doc_add_accessor(doc, m->indices, GLTF_UINT, "SCALAR", m->index_count));
    set_index(doc, out, "material", (size_t)m->material);
    if (m->morph_count > 0) gltf_doc_set(doc, out, "targets", targets_of(doc, m));
    x->primitives[mesh] = out;
    return out;
}

void gltf_doc_finish_primitives(struct scene_export *x)
{
    for (int i = 0; x->primitives && i < x->scene->mesh_count; i++) json_decref(x->primitives[i]);
    host_free(x->doc->host, x->primitives);
    x->primitives = NULL;
}

// ---- animations

static json_t *sampler_json(struct gltf_doc *doc, const struct animation_channel *c)
{
    static const char *const names[] = { "STEP", "LINEAR", "CUBICSPLINE" };
    static const char *const types[] = { [PATH_TRANSLATION] = "VEC3",
                                         [PATH_ROTATION] = "VEC4",
                                         [PATH_SCALE] = "VEC3",
                                         [PATH_WEIGHTS] = "SCALAR" };
    const size_t keys = (size_t)c->key_count;
    const size_t values = keys * (c->interpolation == INTERPOLATE_CUBIC ? 3 : 1) *
                          (c->path == PATH_WEIGHTS ? (size_t)c->width : 1);
    const size_t times = gltf_doc_add_accessor(doc, c->times_s, GLTF_FLOAT, "SCALAR", keys);
    json_t *accessor = json_array_get(gltf_doc_array(doc, "accessors"), times);
    gltf_doc_set(doc, accessor, "min", gltf_doc_floats(&c->times_s[0], 1));
    gltf_doc_set(doc, accessor, "max", gltf_doc_floats(&c->times_s[keys - 1], 1));
    return json_pack(
        "{s:I, s:I, s:s}", "input", (json_int_t)times, "output",
        (json_int_t)gltf_doc_add_accessor(doc, c->values, GLTF_FLOAT, types[c->path], values),
        "interpolation", names[c->interpolation]);
}

static json_t *animation_json(struct gltf_doc *doc, const struct animation *a)
{
    static const char *const paths[] = { "translation", "rotation", "scale", "weights" };
    json_t *samplers = json_array(), *channels = json_array();
    for (int i = 0; i < a->channel_count; i++) {
        const struct animation_channel *c = &a->channels[i];
        if (c->key_count < 1) continue;
        json_t *channel =
            json_pack("{s:I, s:{s:i, s:s}}", "sampler", (json_int_t)json_array_size(samplers),
                      "target", "node", c->node, "path", paths[c->path]);
        if (json_array_append_new(samplers, sampler_json(doc, c)) != 0 ||
            json_array_append_new(channels, channel) != 0)
            doc->failed = true;
    }
    return json_pack("{s:o, s:o, s:o}", "name", gltf_doc_text(a->name ? a->name : "animation"),
                     "samplers", samplers, "channels", channels);
}

void gltf_doc_animations(struct scene_export *x)
{
    for (int i = 0; i < x->scene->animation_count; i++)
        if (x->scene->animations[i].channel_count > 0)
            gltf_doc_add(x->doc, "animations", animation_json(x->doc, &x->scene->animations[i]));
}
