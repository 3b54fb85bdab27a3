// A document of a glTF file: its JSON, and the bytes of all its buffers and images in one buffer.
#include "scene/export/gltf_scene.h"

#include "core/hash.h"
#include "scene/import/gltf/gltf.h"

#include <string.h>
#include <unistd.h>

// ---- buffers

static void move_view(struct gltf_doc *doc, json_t *view, const size_t *base, size_t count)
{
    const json_int_t buffer = json_integer_value(json_object_get(view, "buffer"));
    const json_int_t offset = json_integer_value(json_object_get(view, "byteOffset"));
    if (buffer < 0 || (size_t)buffer >= count || base[buffer] == SIZE_MAX) return;
    gltf_doc_set(doc, view, "buffer", json_integer(0));
    gltf_doc_set(doc, view, "byteOffset", json_integer((json_int_t)base[buffer] + offset));
}

static void move_views(struct gltf_doc *doc, const size_t *base, size_t count)
{
    size_t i;
    json_t *view;
    json_array_foreach(gltf_doc_array(doc, "bufferViews"), i, view)
    {
        json_t *extensions = json_object_get(view, "extensions");
        json_t *compressed = json_object_get(extensions, "EXT_meshopt_compression");
        move_view(doc, view, base, count);
        if (compressed) move_view(doc, compressed, base, count);
    }
}

// Views added by gltf_doc_add_view would be listed: the bytes alone are taken.
static size_t add_bytes(struct gltf_doc *doc, const uint8_t *data, size_t size)
{
    const size_t offset = doc->size;
    gltf_doc_add_view(doc, data, size);
    json_t *views = gltf_doc_array(doc, "bufferViews");
    json_array_remove(views, json_array_size(views) - 1);
    return offset;
}

// The buffers become one, in their order.
static bool join_buffers(struct gltf_doc *doc, const struct gltf *gltf)
{
    size_t *base = host_alloc(doc->host, gltf->buffer_count, sizeof *base);
    if (!base) return false;
    for (size_t i = 0; i < gltf->buffer_count; i++)
        base[i] = add_bytes(doc, gltf->buffers[i].data, gltf->buffers[i].size);
    move_views(doc, base, gltf->buffer_count);
    if (gltf->buffer_count > 0) {
        json_t *first = json_array_get(gltf_doc_array(doc, "buffers"), 0);
        json_object_del(first, "uri");
        while (json_array_size(gltf_doc_array(doc, "buffers")) > 1)
            json_array_remove(gltf_doc_array(doc, "buffers"), 1);
    }
    host_free(doc->host, base);
    return true;
}

// ---- images

static const char *mime_of(const struct file_bytes *bytes, const char *path)
{
    static const uint8_t png[] = { 0x89, 'P', 'N', 'G' }, jpeg[] = { 0xff, 0xd8 };
    char extension[16];
    if (bytes->size > 4 && memcmp(bytes->data, png, sizeof png) == 0) return "image/png";
    if (bytes->size > 2 && memcmp(bytes->data, jpeg, sizeof jpeg) == 0) return "image/jpeg";
    file_extension(path, extension);
    if (strcmp(extension, "webp") == 0) return "image/webp";
    return strcmp(extension, "ktx2") == 0 ? "image/ktx2" : "application/octet-stream";
}

static bool embed_image(struct gltf_doc *doc, struct gltf *gltf, json_t *image)
{
    const char *uri = json_string_value(json_object_get(image, "uri"));
    struct file_bytes bytes = { 0 };
    if (!uri || strncmp(uri, "data:", 5) == 0) return true;
    char *path = import_resolve(gltf->import, uri);
    bool ok = path && import_read(gltf->import, path, &bytes, NULL);
    if (ok) {
        if (!json_object_get(image, "name")) gltf_doc_set(doc, image, "name", gltf_doc_text(uri));
        gltf_doc_set(doc, image, "mimeType", json_string(mime_of(&bytes, path)));
        gltf_doc_set(doc, image, "bufferView",
                     json_integer((json_int_t)gltf_doc_add_view(doc, bytes.data, bytes.size)));
        json_object_del(image, "uri");
    }
    file_bytes_finish(doc->host, &bytes);
    host_free(doc->host, path);
    return ok;
}

static bool embed_images(struct gltf_doc *doc, struct gltf *gltf)
{
    size_t i;
    json_t *image;
    json_array_foreach(gltf->images, i, image) if (!embed_image(doc, gltf, image)) return false;
    return true;
}

// ---- instances

// Whether the reader made a mesh of it: see gltf_mesh.c.
static bool is_loaded(struct gltf *gltf, json_t *primitive)
{
    const struct gltf_object of = { gltf, primitive, "primitive", 0 };
    const int position = gltf_index(gltf_child(of, "attributes"), "POSITION", gltf->accessors);
    const int indices = gltf_index(of, "indices", gltf->accessors);
    if (gltf_size(of, "mode", 4, 6) < 4 || position < 0) return false;
    return gltf_accessor_count(gltf, indices >= 0 ? indices : position) >= 3;
}

static void place_node(struct gltf_doc *doc, struct gltf *gltf, size_t node)
{
    const int mesh =
        gltf_index(gltf_element(gltf, gltf->nodes, "node", node), "mesh", gltf->meshes);
    if (mesh < 0) return;
    json_t *primitives = json_object_get(json_array_get(gltf->meshes, (size_t)mesh), "primitives"),
           *primitive;
    size_t i;
    json_array_foreach(primitives, i, primitive)
    {
        if (!is_loaded(gltf, primitive)) continue;
        if (doc->places)
            doc->places[doc->place_count] = (struct gltf_place){ node, (size_t)mesh, i };
        doc->place_count++;
    }
}

// In the order of the reader: see gltf_node.c.
static void place_instances(struct gltf_doc *doc, struct gltf *gltf)
{
    doc->place_count = 0;
    for (size_t i = 0; i < json_array_size(gltf->nodes); i++)
        if (gltf->in_scene[i]) place_node(doc, gltf, i);
}

static bool find_places(struct gltf_doc *doc, struct gltf *gltf, const struct scene *scene)
{
    place_instances(doc, gltf);
    if (!gltf->failed && doc->place_count > scene->instance_count)
        return host_fail(doc->host, FAIL_FORMAT, "%s: its instances are not those of the scene",
                         scene->name);
    doc->places = host_alloc(doc->host, (size_t)scene->instance_count, sizeof *doc->places);
    if (gltf->failed || !doc->places) return false;
    place_instances(doc, gltf);
    doc->file_place_count = doc->place_count;
    return true;
}

// ---- the file

// *can: the document can have all that the scene has.
static bool fill(struct gltf_doc *doc, struct gltf *gltf, const struct scene *scene, bool *can)
{
    json_decref(doc->root);
    doc->root = json_incref(gltf->root);
    if (!gltf_check_asset(gltf) || !gltf_order_nodes(gltf) || !gltf_load_buffers(gltf) ||
        !find_places(doc, gltf, scene))
        return false;
    *can = gltf_doc_can_add(doc, scene, json_array_size(gltf->nodes));
    return !*can || (join_buffers(doc, gltf) && embed_images(doc, gltf) &&
                     gltf_doc_add_rest(doc, gltf, scene));
}

static bool is_gltf(const struct scene *scene)
{
    char extension[16];
    file_extension(scene->name, extension);
    return scene->name[0] != '@' &&
           (strcmp(extension, "gltf") == 0 || strcmp(extension, "glb") == 0);
}

static bool is_changed(const struct scene *scene)
{
    const struct scene_revisions *r = &scene->revisions;
    return r->transforms > 0 || r->vertices > 0 || r->materials > 0;
}

bool gltf_doc_of_file(struct gltf_doc *doc, struct host *host, const struct scene *scene,
                      bool *same)
{
    struct file_bytes bytes = { 0 };
    struct import import = { .host = host, .path = scene->name };
    *doc = (struct gltf_doc){ 0 };
    *same = false;
    if (!is_gltf(scene) || is_changed(scene) || access(scene->name, R_OK) != 0) return true;
    if (!file_read(host, scene->name, 0, &bytes)) return false;
    *same = hash_bytes(bytes.data, bytes.size, 0) == scene->content_hash;
    bool ok = true;
    if (*same) {
        struct gltf gltf = { .import = &import };
        ok = gltf_doc_init(doc, host) && gltf_open(&gltf, &import, &bytes) &&
             fill(doc, &gltf, scene, same);
        gltf_close(&gltf);
        if (ok && !*same) gltf_doc_finish(doc);
    }
    file_bytes_finish(host, &bytes);
    return ok;
}
