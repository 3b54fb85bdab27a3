// A glTF file's container (JSON text, or GLB chunks: glTF 2.0, section 4.4) and its buffers.
#include "scene/import/gltf/gltf.h"

#include <string.h>

static const uint32_t GLB_MAGIC = 0x46546c67, CHUNK_JSON = 0x4e4f534a, CHUNK_BIN = 0x004e4942;
enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };

static uint32_t read_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static bool is_glb(const struct file_bytes *bytes)
{
    return bytes->size >= 4 && read_u32(bytes->data) == GLB_MAGIC;
}

// Finds the JSON chunk and the BIN chunk.
static bool open_glb(struct gltf *gltf, const struct file_bytes *bytes, const uint8_t **json,
                     size_t *json_size)
{
    struct host *host = gltf->import->host;
    const char *path = gltf->import->path;
    if (bytes->size < GLB_HEADER + CHUNK_HEADER) {
        return host_fail(host, FAIL_FORMAT, "%s: truncated GLB header", path);
    }
    uint32_t version = read_u32(bytes->data + 4), length = read_u32(bytes->data + 8);
    if (version != 2) {
        return host_fail(host, FAIL_UNSUPPORTED,
                         "%s: GLB version %u is not supported; only version 2 is", path, version);
    }
    if (length > bytes->size) {
        return host_fail(host, FAIL_FORMAT, "%s: truncated: %zu bytes of the %u in its header",
                         path, bytes->size, length);
    }
    size_t at = GLB_HEADER;
    for (int chunk = 0; length >= CHUNK_HEADER && at <= length - CHUNK_HEADER; chunk++) {
        uint32_t size = read_u32(bytes->data + at), kind = read_u32(bytes->data + at + 4);
        at += CHUNK_HEADER;
        if (size > length - at) {
            return host_fail(host, FAIL_FORMAT, "%s: GLB chunk %d is longer than the file", path,
                             chunk);
        }
        if (chunk == 0 && kind != CHUNK_JSON) break;
        if (chunk == 0) {
            *json = bytes->data + at;
            *json_size = size;
        } else if (chunk == 1 && kind == CHUNK_BIN) {
            gltf->binary = bytes->data + at;
            gltf->binary_size = size;
        }
        at = (at + size + 3) & ~(size_t)3;
    }
    if (*json) return true;
    return host_fail(host, FAIL_FORMAT, "%s: the first GLB chunk is not JSON", path);
}

static bool parse_json(struct gltf *gltf, const uint8_t *text, size_t size)
{
    struct import *import = gltf->import;
    json_error_t error;
    gltf->root = json_loadb((const char *)text, size, 0, &error);
    if (!gltf->root) {
        return host_fail(import->host, FAIL_FORMAT, "%s: JSON, line %d: %s", import->path,
                         error.line, import_printable(error.text).s);
    }
    if (json_is_object(gltf->root)) return true;
    return host_fail(import->host, FAIL_FORMAT, "%s: the JSON is not an object", import->path);
}

bool gltf_open(struct gltf *gltf, struct import *import, const struct file_bytes *bytes)
{
    *gltf = (struct gltf){ .import = import, .default_material = -1, .empty = json_array() };
    if (!gltf->empty)
        return host_fail(import->host, FAIL_MEMORY, "%s: out of memory", import->path);
    const uint8_t *json = NULL;
    size_t json_size = 0;
    if (is_glb(bytes)) {
        if (!open_glb(gltf, bytes, &json, &json_size)) return false;
    } else {
        json = bytes->data;
        json_size = bytes->size;
        // Some exporters write a byte-order mark, which glTF forbids.
        if (json_size >= 3 && memcmp(json, "\xef\xbb\xbf", 3) == 0) {
            json += 3;
            json_size -= 3;
        }
    }
    if (!parse_json(gltf, json, json_size)) return false;
    struct gltf_object root = { gltf, gltf->root, "file", 0 };
    gltf->accessors = gltf_array(root, "accessors");
    gltf->views = gltf_array(root, "bufferViews");
    gltf->nodes = gltf_array(root, "nodes");
    gltf->meshes = gltf_array(root, "meshes");
    gltf->materials = gltf_array(root, "materials");
    gltf->textures = gltf_array(root, "textures");
    gltf->images = gltf_array(root, "images");
    gltf->samplers = gltf_array(root, "samplers");
    gltf->skins = gltf_array(root, "skins");
    gltf->cameras = gltf_array(root, "cameras");
    gltf->animations = gltf_array(root, "animations");
    gltf->lights = gltf_array(gltf_extension(root, "KHR_lights_punctual"), "lights");
    return !gltf->failed;
}

void gltf_close(struct gltf *gltf)
{
    struct host *host = gltf->import->host;
    for (size_t i = 0; i < gltf->buffer_count; i++) {
        host_free(host, gltf->buffers[i].path);
        host_free(host, gltf->buffers[i].owned);
    }
    host_free(host, gltf->buffers);
    host_free(host, gltf->cached);
    host_free(host, gltf->scene_node);
    host_free(host, gltf->in_scene);
    host_free(host, gltf->first_mesh);
    host_free(host, gltf->mesh_parts);
    host_free(host, gltf->image_of);
    json_decref(gltf->root);
    json_decref(gltf->empty);
}

static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

static uint8_t *not_base64(struct gltf_object object)
{
    gltf_wrong(object, "its data URI is not base64");
    return NULL;
}

uint8_t *gltf_data_uri(struct gltf_object object, const char *uri, size_t *size)
{
    struct host *host = object.gltf->import->host;
    const char *comma = strchr(uri, ',');
    static const char marker[] = ";base64";
    size_t marker_length = sizeof marker - 1;
    if (strncmp(uri, "data:", 5) != 0 || !comma || (size_t)(comma - uri) < 5 + marker_length ||
        memcmp(comma - marker_length, marker, marker_length) != 0) {
        return not_base64(object);
    }
    const char *text = comma + 1;
    size_t length = strlen(text);
    while (length > 0 && text[length - 1] == '=') length--;
    uint8_t *bytes = host_alloc(host, length / 4 * 3 + 3, 1);
    if (!bytes) return NULL;
    size_t n = 0;
    uint32_t bits = 0;
    int pending = 0; // bits not yet written
    for (size_t i = 0; i < length; i++) {
        int value = base64_value(text[i]);
        if (value < 0) {
            host_free(host, bytes);
            return not_base64(object);
        }
        bits = bits << 6 | (uint32_t)value;
        pending += 6;
        if (pending < 8) continue;
        pending -= 8;
        bytes[n++] = (uint8_t)(bits >> pending);
    }
    *size = n;
    return bytes;
}

// Reads an external file, or shares the bytes of an earlier buffer of the same path.
static bool read_external(struct gltf *gltf, size_t index, const char *uri)
{
    struct import *import = gltf->import;
    struct gltf_buffer *buffer = &gltf->buffers[index];
    buffer->path = import_resolve(import, uri);
    if (!buffer->path) return false;
    for (size_t i = 0; i < index; i++) {
        const struct gltf_buffer *other = &gltf->buffers[i];
        if (!other->path || strcmp(other->path, buffer->path) != 0) continue;
        buffer->data = other->data;
        buffer->size = other->size;
        return true;
    }
    struct file_bytes bytes = { 0 };
    if (!import_read(import, buffer->path, &bytes, NULL)) return false;
    buffer->owned = bytes.data;
    buffer->data = bytes.data;
    buffer->size = bytes.size;
    return true;
}

static bool load_buffer(struct gltf *gltf, json_t *array, size_t index)
{
    struct gltf_object object = gltf_element(gltf, array, "buffer", index);
    struct gltf_buffer *buffer = &gltf->buffers[index];
    const char *uri = gltf_string(object, "uri");
    size_t length = gltf_size(object, "byteLength", 0, SIZE_MAX / 2);
    if (gltf->failed) return false;
    if (uri && strncmp(uri, "data:", 5) == 0) {
        buffer->owned = gltf_data_uri(object, uri, &buffer->size);
        buffer->data = buffer->owned;
        if (!buffer->data) return false;
    } else if (uri) {
        if (!read_external(gltf, index, uri)) return false;
    } else if (gltf_has(gltf_extension(object, "EXT_meshopt_compression"), "fallback")) {
        return host_fail(
            gltf->import->host, FAIL_UNSUPPORTED,
            "%s: buffer %zu has only EXT_meshopt_compression data, which is not supported",
            gltf->import->path, index);
    } else if (index == 0 && gltf->binary) {
        buffer->data = gltf->binary;
        buffer->size = gltf->binary_size;
    } else {
        return gltf_wrong(object, "has no data");
    }
    if (length > buffer->size) {
        return gltf_wrong(object, "byteLength is %zu, but the data have %zu bytes", length,
                          buffer->size);
    }
    buffer->size = length;
    return true;
}

bool gltf_load_buffers(struct gltf *gltf)
{
    struct gltf_object root = { gltf, gltf->root, "file", 0 };
    json_t *array = gltf_array(root, "buffers");
    size_t count = json_array_size(array);
    gltf->buffers = host_alloc(gltf->import->host, count, sizeof *gltf->buffers);
    if (!gltf->buffers) return false;
    gltf->buffer_count = count;
    for (size_t i = 0; i < count; i++) {
        if (!load_buffer(gltf, array, i)) return false;
    }
    return true;
}
