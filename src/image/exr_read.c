// Reading OpenEXR through its C core. The whole file, or its start where the header alone counts,
// is read into memory first, which bounds every read of the library.
#include "image/exr_file.h"

#include <stdio.h>
#include <string.h>

enum { EXR_CHUNK_BYTES_MAX = 1 << 30 }; // unpacked

// The channels of one layer, in the image's order, and their offsets in an unpacked scan line. A
// line holds the channels one after the other, little-endian.
struct layer_channels {
    int count;
    int index[4]; // into the file's list
    exr_pixel_type_t type[4];
    size_t offset[4];
    size_t line_bytes;
};

// Channel suffixes that form a layer; the first complete set is used. exr_write makes the first
// five, other programs the rest: depths and vectors.
static const char *const suffix_sets[][4] = {
    { "R", "G", "B", "A" }, { "R", "G", "B" }, { "R", "G" }, { "Y" }, { "R" }, { "Z" }, { "V" },
};
static const char *const vector_set[4] = { "X", "Y", "Z" };

// `layer`.`suffix`, or just `suffix` for the plain channels.
static int find_channel(const exr_attr_chlist_t *list, const char *layer, bool prefixed,
                        const char *suffix)
{
    size_t length = prefixed ? strlen(layer) : 0;
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        if (prefixed) {
            if (strncmp(name, layer, length) != 0 || name[length] != '.') continue;
            name += length + 1;
        }
        if (strcmp(name, suffix) == 0) return i;
    }
    return -1;
}

static bool match_set(const exr_attr_chlist_t *list, const char *layer, bool prefixed,
                      const char *const set[4], struct layer_channels *out)
{
    out->count = 0;
    for (int i = 0; i < 4 && set[i]; i++) {
        int index = find_channel(list, layer, prefixed, set[i]);
        if (index < 0) return false;
        out->index[out->count++] = index;
    }
    return true;
}

static bool find_layer(const exr_attr_chlist_t *list, const char *layer, struct layer_channels *out)
{
    static const char *const plain_depth[4] = { "Z" };
    if (strcmp(layer, "depth") == 0 && match_set(list, layer, false, plain_depth, out)) return true;
    bool prefixed = !exr_is_plain(layer);
    if (prefixed && match_set(list, layer, true, vector_set, out)) return true;
    size_t sets = sizeof suffix_sets / sizeof suffix_sets[0];
    if (!prefixed) sets -= 2; // a plain Z is the layer "depth"
    for (size_t i = 0; i < sets; i++)
        if (match_set(list, layer, prefixed, suffix_sets[i], out)) return true;
    return false;
}

// The layer of a channel; false when the layer's name is too long.
static bool layer_of_channel(const char *channel, char out[EXR_NAME_MAX + 1])
{
    const char *dot = strrchr(channel, '.');
    size_t length = dot ? (size_t)(dot - channel) : 0;
    if (length > EXR_NAME_MAX) return false;
    if (dot)
        memcpy(out, channel, length), out[length] = 0;
    else
        snprintf(out, EXR_NAME_MAX + 1, "%s", strcmp(channel, "Z") == 0 ? "depth" : "color");
    return true;
}

static bool append_name(struct host *host, char **names, const char *name)
{
    char *longer = **names ? host_sprintf(host, "%s\n%s", *names, name) : host_strdup(host, name);
    if (!longer) return false;
    host_free(host, *names);
    *names = longer;
    return true;
}

// The channels of a layer need not be adjacent: channels are sorted by name, capitals first.
static bool is_first_of_layer(const exr_attr_chlist_t *list, int channel, const char *layer)
{
    char other[EXR_NAME_MAX + 1];
    for (int i = 0; i < channel; i++)
        if (layer_of_channel(list->entries[i].name.str, other) && strcmp(other, layer) == 0)
            return false;
    return true;
}

// In file order; NULL when out of memory.
static char *join_layer_names(struct host *host, const exr_attr_chlist_t *list)
{
    char *names = host_strdup(host, "");
    char layer[EXR_NAME_MAX + 1];
    struct layer_channels channels;
    for (int i = 0; names && i < list->num_channels; i++) {
        if (!layer_of_channel(list->entries[i].name.str, layer)) continue;
        if (!is_first_of_layer(list, i, layer) || !find_layer(list, layer, &channels)) continue;
        if (append_name(host, &names, layer)) continue;
        host_free(host, names);
        return NULL;
    }
    return names;
}

static int64_t read_bytes(exr_const_context_t context, void *user, void *buffer, uint64_t bytes,
                          uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context, (void)error;
    const struct exr_file *file = user;
    if (offset >= file->bytes.size) return 0;
    uint64_t left = file->bytes.size - offset;
    if (bytes > left) bytes = left;
    memcpy(buffer, file->bytes.data + offset, bytes);
    return (int64_t)bytes;
}

static int64_t count_bytes(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const struct exr_file *)user)->bytes.size;
}

static bool refuse(struct exr_file *file, const char *why)
{
    return host_fail(file->host, FAIL_UNSUPPORTED, "cannot read %s: %s", file->path, why);
}

static bool check_kind(struct exr_file *file)
{
    int parts = 0;
    exr_storage_t storage;
    exr_result_t code = exr_get_count(file->context, &parts);
    if (code != EXR_ERR_SUCCESS) return exr_fail_reading(file, code);
    if (parts != 1) return refuse(file, "it has several parts, only one is supported");
    code = exr_get_storage(file->context, 0, &storage);
    if (code != EXR_ERR_SUCCESS) return exr_fail_reading(file, code);
    if (storage == EXR_STORAGE_TILED)
        return refuse(file, "it is tiled, only scan lines are supported");
    if (storage != EXR_STORAGE_SCANLINE) return refuse(file, "it is a deep image");
    return true;
}

// The file has its bytes. On failure it has no context.
static exr_result_t create_context(struct exr_file *file)
{
    exr_context_initializer_t init = exr_initializer(file);
    init.read_fn = read_bytes;
    init.size_fn = count_bytes;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; // a truncated file is an error
    const exr_result_t code = exr_start_read(&file->context, file->path, &init);
    if (code != EXR_ERR_SUCCESS) file->context = NULL; // already released by the library
    return code;
}

static bool start_reading(struct exr_file *file)
{
    static const uint8_t magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
    if (file->bytes.size < sizeof magic || memcmp(file->bytes.data, magic, sizeof magic) != 0)
        return host_fail(file->host, FAIL_FORMAT, "cannot read %s: not an OpenEXR file",
                         file->path);
    const exr_result_t code = create_context(file);
    return code == EXR_ERR_SUCCESS ? check_kind(file) : exr_fail_reading(file, code);
}

// On failure the caller still calls exr_file_finish.
static bool exr_file_open(struct exr_file *file, struct host *host, const char *path)
{
    *file = (struct exr_file){ .host = host, .path = path };
    return file_read(host, path, 0, &file->bytes) && start_reading(file);
}

// Reads no more than a header usually needs. The pixels are absent then.
static bool exr_file_open_header(struct exr_file *file, struct host *host, const char *path)
{
    enum { HEADER_BYTES = 1 << 20 };
    *file = (struct exr_file){ .host = host, .path = path };
    if (!file_read_start(host, path, HEADER_BYTES, &file->bytes)) return false;
    if (file->bytes.size < HEADER_BYTES) return start_reading(file);
    if (create_context(file) == EXR_ERR_SUCCESS) return check_kind(file);
    exr_file_finish(file);
    return exr_file_open(file, host, path);
}

static bool get_channels(struct exr_file *file, const exr_attr_chlist_t **out)
{
    exr_result_t code = exr_get_channels(file->context, 0, out);
    if (code != EXR_ERR_SUCCESS) return exr_fail_reading(file, code);
    if ((*out)->num_channels < 1 || (*out)->num_channels > EXR_CHANNELS_MAX)
        return host_fail(file->host, FAIL_FORMAT,
                         "cannot read %s: %d channels, 1 to %d are possible", file->path,
                         (*out)->num_channels, EXR_CHANNELS_MAX);
    return true;
}

static bool fail_missing_layer(struct exr_file *file, const exr_attr_chlist_t *list,
                               const char *layer)
{
    char *names = join_layer_names(file->host, list);
    if (!names) return false;
    for (char *c = names; *c; c++)
        if (*c == '\n') *c = ' ';
    host_fail(file->host, FAIL_ARGUMENT, "cannot read %s: no layer '%.*s'; it has: %.800s",
              file->path, EXR_NAME_MAX, layer, names[0] ? names : "none that can be shown");
    host_free(file->host, names);
    return false;
}

// A scan line holds the channels of all layers.
static bool lay_out_line(struct exr_file *file, const exr_attr_chlist_t *list, int width,
                         struct layer_channels *layer)
{
    layer->line_bytes = 0;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return refuse(file, "a channel has fewer samples than pixels");
        for (int c = 0; c < layer->count; c++) {
            if (layer->index[c] != i) continue;
            layer->type[c] = entry->pixel_type;
            layer->offset[c] = layer->line_bytes;
        }
        layer->line_bytes += (size_t)width * (entry->pixel_type == EXR_PIXEL_HALF ? 2 : 4);
    }
    return true;
}

static bool choose_layer(struct exr_file *file, const char *name, int width,
                         struct layer_channels *out)
{
    const exr_attr_chlist_t *list;
    if (!get_channels(file, &list)) return false;
    if (!find_layer(list, name, out)) return fail_missing_layer(file, list, name);
    return lay_out_line(file, list, width, out);
}

static bool get_window(struct exr_file *file, exr_attr_box2i_t *out)
{
    exr_result_t code = exr_get_data_window(file->context, 0, out);
    if (code != EXR_ERR_SUCCESS) return exr_fail_reading(file, code);
    int64_t width = (int64_t)out->max.x - out->min.x + 1;
    int64_t height = (int64_t)out->max.y - out->min.y + 1;
    if (width < 1 || height < 1 || width > IMAGE_MAX_SIZE || height > IMAGE_MAX_SIZE)
        return host_fail(file->host, FAIL_FORMAT,
                         "cannot read %s: %lldx%lld pixels, each side must be 1 to %d", file->path,
                         (long long)width, (long long)height, IMAGE_MAX_SIZE);
    return true;
}

static float float_of_half(uint32_t half)
{
    uint32_t sign = (half & 0x8000u) << 16, exponent = half >> 10 & 31u, mantissa = half & 1023u;
    if (exponent == 0) return (sign ? -1.0f : 1.0f) * (float)mantissa * 0x1p-24f;
    uint32_t bits = sign | (exponent == 31 ? 255u : exponent + 112u) << 23 | mantissa << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float float_at(const uint8_t *bytes, exr_pixel_type_t type)
{
    uint32_t word = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
    if (type == EXR_PIXEL_HALF) return float_of_half(word);
    word |= (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    if (type == EXR_PIXEL_UINT) return (float)word;
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

static void copy_line(const struct image *out, int row, const uint8_t *line,
                      const struct layer_channels *layer)
{
    for (int c = 0; c < layer->count; c++) {
        const uint8_t *from = line + layer->offset[c];
        size_t step = layer->type[c] == EXR_PIXEL_HALF ? 2 : 4;
        for (int x = 0; x < out->width; x++, from += step)
            image_at(out, x, row)[c] = float_at(from, layer->type[c]);
    }
}

static bool check_chunk(struct exr_file *file, const exr_chunk_info_t *chunk, int row,
                        const struct layer_channels *layer, const struct image *out)
{
    bool fits = chunk->width == out->width && chunk->height >= 1 &&
                chunk->height <= out->height - row && chunk->packed_size <= file->bytes.size;
    uint64_t expected = fits ? (uint64_t)layer->line_bytes * (uint64_t)chunk->height : 0;
    if (fits && chunk->unpacked_size == expected && expected <= EXR_CHUNK_BYTES_MAX) return true;
    return host_fail(file->host, FAIL_FORMAT, "cannot read %s: a damaged chunk at row %d",
                     file->path, row);
}

// Reads the values from the library's unpacked buffer. Its own conversion writes through the null
// pointers of unwanted channels in some versions.
static bool read_chunk(struct exr_file *file, exr_decode_pipeline_t *decode, int first_y, int row,
                       const struct layer_channels *layer, const struct image *out)
{
    exr_chunk_info_t chunk;
    exr_const_context_t context = file->context;
    exr_result_t code = exr_read_scanline_chunk_info(context, 0, first_y + row, &chunk);
    if (code != EXR_ERR_SUCCESS) return exr_fail_reading(file, code);
    if (!check_chunk(file, &chunk, row, layer, out)) return false;
    code = row == 0 ? exr_decoding_initialize(context, 0, &chunk, decode)
                    : exr_decoding_update(context, 0, &chunk, decode);
    if (code == EXR_ERR_SUCCESS && row == 0)
        code = exr_decoding_choose_default_routines(context, 0, decode);
    decode->unpack_and_convert_fn = NULL;
    if (code == EXR_ERR_SUCCESS) code = exr_decoding_run(context, 0, decode);
    if (code != EXR_ERR_SUCCESS) return exr_fail_reading(file, code);
    bool is_raw = chunk.packed_size == chunk.unpacked_size; // stored uncompressed
    const uint8_t *lines = is_raw ? decode->packed_buffer : decode->unpacked_buffer;
    size_t held = is_raw ? decode->packed_alloc_size : decode->unpacked_alloc_size;
    if (!lines || held < layer->line_bytes * (size_t)chunk.height)
        return exr_fail_reading(file, EXR_ERR_CORRUPT_CHUNK);
    for (int i = 0; i < chunk.height; i++)
        copy_line(out, row + i, lines + (size_t)i * layer->line_bytes, layer);
    return true;
}

static bool read_chunks(struct exr_file *file, int first_y, const struct layer_channels *layer,
                        const struct image *out)
{
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t rows_per_chunk = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(file->context, 0, &rows_per_chunk);
    if (code != EXR_ERR_SUCCESS || rows_per_chunk < 1) return exr_fail_reading(file, code);
    bool good = true;
    for (int row = 0; good && row < out->height; row += rows_per_chunk)
        good = read_chunk(file, &decode, first_y, row, layer, out);
    exr_decoding_destroy(file->context, &decode);
    return good;
}

static bool read_layer(struct exr_file *file, const char *layer, struct image *out)
{
    struct layer_channels channels;
    exr_attr_box2i_t window;
    if (!get_window(file, &window)) return false;
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    if (choose_layer(file, layer ? layer : "color", width, &channels) &&
        image_init(out, file->host, width, height, channels.count) &&
        read_chunks(file, window.min.y, &channels, out))
        return true;
    image_finish(out, file->host);
    return false;
}

bool exr_read(struct host *host, const char *path, const char *layer, struct image *out)
{
    struct exr_file file;
    *out = (struct image){ 0 };
    const bool ok = exr_file_open(&file, host, path) && read_layer(&file, layer, out);
    exr_file_finish(&file);
    return ok;
}

static bool read_size(struct exr_file *file, int *width, int *height)
{
    exr_attr_box2i_t window;
    if (!get_window(file, &window)) return false;
    *width = window.max.x - window.min.x + 1;
    *height = window.max.y - window.min.y + 1;
    return true;
}

bool exr_read_size(struct host *host, const char *path, int *width, int *height)
{
    struct exr_file file;
    const bool ok = exr_file_open_header(&file, host, path) && read_size(&file, width, height);
    exr_file_finish(&file);
    return ok;
}

bool exr_decode(struct host *host, const char *name, const void *bytes, size_t size,
                size_t max_pixels, struct image *out)
{
    struct exr_file file = { .host = host, .path = name };
    int width, height;
    *out = (struct image){ 0 };
    bool ok = file_bytes_copy(host, bytes, size, &file.bytes) && start_reading(&file) &&
              read_size(&file, &width, &height);
    if (ok && (size_t)width * (size_t)height > max_pixels)
        ok = host_fail(host, FAIL_MEMORY, "cannot read %s: %dx%d pixels are more than %zu", name,
                       width, height, max_pixels);
    ok = ok && read_layer(&file, NULL, out);
    exr_file_finish(&file);
    return ok;
}

char *exr_layer_names(struct host *host, const char *path)
{
    struct exr_file file;
    const exr_attr_chlist_t *list;
    char *names = NULL;
    if (exr_file_open_header(&file, host, path) && get_channels(&file, &list))
        names = join_layer_names(host, list);
    exr_file_finish(&file);
    return names;
}

char *exr_attribute_value(struct host *host, const char *path, const char *name)
{
    struct exr_file file;
    int32_t length = 0;
    const char *text = NULL;
    char *value = NULL;
    if (exr_file_open_header(&file, host, path) &&
        exr_attr_get_string(file.context, 0, name, &length, &text) == EXR_ERR_SUCCESS)
        value = host_sprintf(host, "%.*s", length, text ? text : "");
    exr_file_finish(&file);
    return value;
}
