// Writing safetensors files.
#include "bake/safetensors.h"

#include "core/files/file.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static const char METADATA[] = "__metadata__";
enum { DATA_ALIGNMENT = 8 };

// Element sizes in the order of the file: each tensor begins at a multiple of its own.
static const size_t SIZES[] = { 4, 2, 1 };
enum { SIZE_COUNT = sizeof SIZES / sizeof SIZES[0] };

static bool fail_name(struct host *host, const char *path, const char *name)
{
    return host_fail(host, FAIL_ARGUMENT,
                     "cannot write %s: the name %s occurs twice, is empty or is not UTF-8", path,
                     name);
}

static bool add_metadata(struct host *host, const char *path, const struct tensors *set,
                         json_t *header)
{
    json_t *all = json_object();
    if (json_object_set_new(header, METADATA, all) != 0)
        return host_fail(host, FAIL_MEMORY, "cannot write %s: out of memory", path);
    for (size_t i = 0; i < set->metadata_count; i++) {
        const struct tensor_metadata *m = &set->metadata[i];
        if (json_object_get(all, m->key) ||
            json_object_set_new(all, m->key, json_string(m->value)) != 0)
            return fail_name(host, path, m->key);
    }
    return true;
}

static json_t *describe(const struct tensor *tensor, size_t begin)
{
    json_t *shape = json_array();
    for (int i = 0; i < tensor->rank; i++)
        json_array_append_new(shape, json_integer((json_int_t)tensor->shape[i]));
    return json_pack("{s:s, s:o, s:[I, I]}", "dtype", tensor_type_name(tensor->type), "shape",
                     shape, "data_offsets", (json_int_t)begin, (json_int_t)(begin + tensor->bytes));
}

static bool add_tensors(struct host *host, const char *path, const struct tensors *set,
                        json_t *header)
{
    size_t begin = 0;
    for (int k = 0; k < SIZE_COUNT; k++)
        for (size_t i = 0; i < set->count; i++) {
            const struct tensor *tensor = &set->at[i];
            if (tensor_type_bytes(tensor->type) != SIZES[k]) continue;
            if (!tensor->name[0] || json_object_get(header, tensor->name) ||
                json_object_set_new(header, tensor->name, describe(tensor, begin)) != 0)
                return fail_name(host, path, tensor->name);
            if (!size_add(begin, tensor->bytes, &begin) || begin > INT64_MAX)
                return host_fail(host, FAIL_MEMORY, "cannot write %s: too large", path);
        }
    return true;
}

// Failed writes are seen by file_commit.
static void write_all(struct file_writer *writer, const char *text, const struct tensors *set)
{
    static const char SPACES[DATA_ALIGNMENT] = "        ";
    const size_t length = strlen(text);
    const size_t padding = (DATA_ALIGNMENT - length % DATA_ALIGNMENT) % DATA_ALIGNMENT;
    const uint64_t header = length + padding;
    file_write(writer, &header, sizeof header);
    file_write(writer, text, length);
    file_write(writer, SPACES, padding);
    for (int k = 0; k < SIZE_COUNT; k++)
        for (size_t i = 0; i < set->count; i++)
            if (tensor_type_bytes(set->at[i].type) == SIZES[k] && set->at[i].bytes > 0)
                file_write(writer, set->at[i].data, set->at[i].bytes);
}

static bool write_file(struct host *host, const char *path, const char *text,
                       const struct tensors *set)
{
    struct file_writer writer;
    if (strlen(text) > SAFETENSORS_MAX_HEADER - DATA_ALIGNMENT)
        return host_fail(host, FAIL_ARGUMENT, "cannot write %s: its header is larger than 16 MiB",
                         path);
    if (!file_begin(&writer, host, path)) return false;
    write_all(&writer, text, set);
    return file_commit(&writer);
}

bool safetensors_write(struct host *host, const char *path, const struct tensors *set)
{
    json_t *header = json_object();
    bool ok =
        header && add_metadata(host, path, set, header) && add_tensors(host, path, set, header);
    char *text = ok ? json_dumps(header, JSON_COMPACT) : NULL;
    json_decref(header);
    if (ok && !text) ok = host_fail(host, FAIL_MEMORY, "cannot write %s: out of memory", path);
    ok = ok && write_file(host, path, text, set);
    free(text);
    return ok;
}
