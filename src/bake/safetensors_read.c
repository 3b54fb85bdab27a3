// Reading safetensors files, which are untrusted.
#include "bake/safetensors.h"

#include "core/arena.h"
#include "core/files/file.h"

#include <jansson.h>
#include <string.h>

static const char METADATA[] = "__metadata__";
enum { LENGTH_BYTES = 8, DATA_ALIGNMENT = 8 };

struct memory {
    struct host *host;
    struct file_bytes file;
    struct arena arena;
};

struct reader {
    struct host *host;
    const char *path;
    struct arena *arena;
    const uint8_t *data;
    size_t data_size;
    size_t reached; // end of the last tensor
};

static bool fail_file(const struct reader *r, const char *why)
{
    return host_fail(r->host, FAIL_FORMAT, "cannot read %s: %s", r->path, why);
}

static bool fail_tensor(const struct reader *r, const char *name, const char *why)
{
    return host_fail(r->host, FAIL_FORMAT, "cannot read %s: tensor %.200s %s", r->path, name, why);
}

static bool read_type(const json_t *value, enum tensor_type *out)
{
    const char *name = json_string_value(value);
    for (int i = 0; name && i < TENSOR_TYPE_COUNT; i++) {
        *out = (enum tensor_type)i;
        if (strcmp(name, tensor_type_name(*out)) == 0) return true;
    }
    return false;
}

static bool read_whole(const json_t *value, uint64_t *out)
{
    if (!json_is_integer(value) || json_integer_value(value) < 0) return false;
    *out = (uint64_t)json_integer_value(value);
    return true;
}

static bool read_shape(const json_t *list, struct tensor *out)
{
    if (!json_is_array(list) || json_array_size(list) > TENSOR_MAX_RANK) return false;
    out->rank = (int)json_array_size(list);
    for (int i = 0; i < out->rank; i++)
        if (!read_whole(json_array_get(list, (size_t)i), &out->shape[i])) return false;
    return true;
}

// Offsets follow the last tensor without a gap, so that no two share data and none is left over.
static bool read_offsets(struct reader *r, const json_t *list, struct tensor *out)
{
    uint64_t begin = 0, end = 0;
    if (!json_is_array(list) || json_array_size(list) != 2 ||
        !read_whole(json_array_get(list, 0), &begin) || !read_whole(json_array_get(list, 1), &end))
        return fail_tensor(r, out->name, "has no data_offsets of two whole numbers");
    if (begin != r->reached) return fail_tensor(r, out->name, "does not follow the one before it");
    if (end < begin || end > r->data_size)
        return fail_tensor(r, out->name, "lies outside the file: it is truncated or damaged");
    out->bytes = (size_t)(end - begin);
    out->data = r->data + begin;
    r->reached = (size_t)end;
    return true;
}

static bool read_tensor(struct reader *r, const char *name, const json_t *value, struct tensor *out)
{
    size_t extent = 0;
    out->name = arena_strdup(r->arena, name);
    if (!out->name) return false;
    if (!name[0]) return fail_file(r, "a tensor has no name");
    if (!json_is_object(value) || json_object_size(value) != 3)
        return fail_tensor(r, name, "is not described by dtype, shape and data_offsets");
    if (!read_type(json_object_get(value, "dtype"), &out->type))
        return fail_tensor(r, name, "has an unknown dtype");
    if (!read_shape(json_object_get(value, "shape"), out))
        return fail_tensor(r, name, "has no shape of at most 8 whole numbers");
    if (!read_offsets(r, json_object_get(value, "data_offsets"), out)) return false;
    if (!tensor_extent(out->type, out->rank, out->shape, &extent) || extent != out->bytes)
        return fail_tensor(r, name, "has another extent than its shape");
    if ((size_t)((const uint8_t *)out->data - r->data) % tensor_type_bytes(out->type) != 0)
        return fail_tensor(r, name, "is not aligned to its elements");
    return true;
}

static bool read_metadata(struct reader *r, json_t *object, struct tensors *out)
{
    const char *key;
    json_t *value;
    if (!json_is_object(object)) return fail_file(r, "__metadata__ is not an object");
    struct tensor_metadata *all = arena_alloc(r->arena, json_object_size(object), sizeof *all);
    if (!all) return false;
    out->metadata = all;
    json_object_foreach(object, key, value)
    {
        if (!json_is_string(value))
            return fail_file(r, "__metadata__ has a value that is not text");
        struct tensor_metadata *m = &all[out->metadata_count++];
        m->key = arena_strdup(r->arena, key);
        m->value = arena_strdup(r->arena, json_string_value(value));
        if (!m->key || !m->value) return false;
    }
    return true;
}

static bool read_header(struct reader *r, json_t *header, struct tensors *out)
{
    const char *name;
    json_t *value;
    struct tensor *all = arena_alloc(r->arena, json_object_size(header), sizeof *all);
    if (!all) return false;
    out->at = all;
    json_object_foreach(header, name, value)
    {
        const bool is_metadata = strcmp(name, METADATA) == 0;
        if (is_metadata ? !read_metadata(r, value, out)
                        : !read_tensor(r, name, value, &all[out->count]))
            return false;
        out->count += !is_metadata;
    }
    if (r->reached != r->data_size) return fail_file(r, "bytes follow the last tensor");
    return true;
}

// Text begins with bytes that would be a length of a header of petabytes.
static bool fail_not_safetensors(const struct reader *r, const struct file_bytes *file)
{
    const char *text = (const char *)file->data;
    const size_t blanks = strspn(text, " \t\r\n");
    if (text[blanks] == '{' || text[blanks] == '[')
        return fail_file(r, "it is JSON text, not a safetensors file");
    return fail_file(r, "it is not a safetensors file: its header would be larger than 16 MiB");
}

// Splits the file into header and data. *header is NULL on failure.
static bool parse_file(struct reader *r, const struct file_bytes *file, json_t **header)
{
    uint64_t length = 0;
    json_error_t error;
    *header = NULL;
    if (file->size < LENGTH_BYTES) return fail_file(r, "it is shorter than its header");
    memcpy(&length, file->data, sizeof length);
    if (length > SAFETENSORS_MAX_HEADER) return fail_not_safetensors(r, file);
    if (length > file->size - LENGTH_BYTES) return fail_file(r, "it is shorter than its header");
    if (length % DATA_ALIGNMENT != 0)
        return fail_file(r, "the length of its header is not a multiple of 8");
    r->data = file->data + LENGTH_BYTES + length;
    r->data_size = file->size - LENGTH_BYTES - (size_t)length;
    *header = json_loadb((const char *)file->data + LENGTH_BYTES, (size_t)length,
                         JSON_REJECT_DUPLICATES, &error);
    if (!*header)
        return host_fail(r->host, FAIL_FORMAT, "cannot read %s: its header is not valid JSON: %s",
                         r->path, error.text);
    return json_is_object(*header) || fail_file(r, "its header is not a JSON object");
}

bool safetensors_read(struct host *host, const char *path, struct safetensors *out)
{
    *out = (struct safetensors){ 0 };
    struct memory *memory = host_alloc(host, 1, sizeof *memory);
    if (!memory) return false;
    memory->host = host;
    arena_init(&memory->arena, host);
    out->memory = memory;
    struct reader reader = { .host = host, .path = path, .arena = &memory->arena };
    json_t *header = NULL;
    const bool ok = file_read(host, path, 0, &memory->file) &&
                    parse_file(&reader, &memory->file, &header) &&
                    read_header(&reader, header, &out->set);
    json_decref(header);
    if (!ok) safetensors_finish(host, out);
    return ok;
}

void safetensors_finish(struct host *host, struct safetensors *file)
{
    struct memory *memory = file->memory;
    if (memory) {
        arena_finish(&memory->arena);
        file_bytes_finish(host, &memory->file);
        host_free(host, memory);
    }
    *file = (struct safetensors){ 0 };
}
