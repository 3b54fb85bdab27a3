// OpenEXR through its C core. A file is read into memory first, so that the library can ask for no
// more than there is; single-part scan-line files of any compression are read, tiled, deep and
// multi-part ones are refused.
#include "image/exr.h"

#include "core/file.h"

#include <openexr.h>

#include <stdlib.h>
#include <string.h>

enum {
    EXR_CHANNELS_MAX = 1024, // in a file
    EXR_NAME_MAX = 200,      // of a layer; the format allows 255 for a channel
    EXR_SHORT_NAME = 31,     // a file with longer names is marked as such
    EXR_ZIP_LEVEL = 4,       // what OpenEXR itself settled on: nearly as small as 6, much faster
    EXR_CHUNK_BYTES_MAX = 1 << 30 // unpacked
};

// One open file and what the library's callbacks need.
struct exr_file {
    struct host *host;
    const char *path;
    exr_context_t context;
    struct file_bytes bytes;   // reading
    struct file_writer writer; // writing
    char message[256];         // the first error that the library reported
};

// ---- errors, memory and streams for the library

// Text from a file, or from a library that quotes it, fit for one line of a log.
static void copy_printable(char *out, size_t size, const char *text)
{
    size_t n = 0;
    for (; text[n] && n + 1 < size; n++)
        out[n] = (unsigned char)text[n] < 32 || text[n] == 127 ? '?' : text[n];
    out[n] = 0;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    struct exr_file *file = user;
    if (!file->message[0]) copy_printable(file->message, sizeof file->message, message);
}

static enum fail_kind kind_of(exr_result_t code, enum fail_kind otherwise)
{
    if (code == EXR_ERR_OUT_OF_MEMORY) return FAIL_MEMORY;
    if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED) return FAIL_UNSUPPORTED;
    return otherwise;
}

static bool fail_reading(struct exr_file *file, exr_result_t code)
{
    return host_fail(file->host, kind_of(code, FAIL_FORMAT), "cannot read %s: %s", file->path,
                     file->message[0] ? file->message : exr_get_default_error_message(code));
}

static bool fail_writing(struct exr_file *file, exr_result_t code)
{
    return host_fail(file->host, kind_of(code, FAIL_FILE), "cannot write %s: %s", file->path,
                     file->message[0] ? file->message : exr_get_default_error_message(code));
}

// Zeroed, so that a chunk that unpacks to less than it should shows no stray memory. (The library
// hands its allocator no user data, so these few buffers cannot come from the host.)
static void *zeroed(size_t bytes)
{
    return calloc(bytes ? bytes : 1, 1);
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

static int64_t write_bytes(exr_const_context_t context, void *user, const void *buffer,
                           uint64_t bytes, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    struct exr_file *file = user;
    if (fseeko(file->writer.stream, (off_t)offset, SEEK_SET) == 0 &&
        fwrite(buffer, 1, bytes, file->writer.stream) == bytes)
        return (int64_t)bytes;
    if (error) error(context, EXR_ERR_WRITE_IO, "the disk does not take it");
    return -1;
}

static exr_context_initializer_t initializer_for(struct exr_file *file)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = on_error;
    init.alloc_fn = zeroed;
    init.free_fn = free;
    init.user_data = file;
    init.max_image_width = init.max_image_height = IMAGE_MAX_SIZE;
    init.zip_level = EXR_ZIP_LEVEL;
    return init;
}

static void exr_file_finish(struct exr_file *file)
{
    if (file->context) exr_finish(&file->context);
    file_bytes_finish(file->host, &file->bytes);
}

// ---- layers and channels

// The channels of one layer, in the image's order, and where their values lie in an unpacked line
// of the file: all channels one after the other, each with all its values of that line,
// little-endian.
struct layer_channels {
    int count;
    int index[4]; // into the file's list
    exr_pixel_type_t type[4];
    size_t offset[4];
    size_t line_bytes;
};

// Suffixes that make a layer, the first complete set counts. The first five are ours; the others
// are met in files of other programs: vectors and depths.
static const char *const suffix_sets[][4] = {
    { "R", "G", "B", "A" }, { "R", "G", "B" }, { "R", "G" }, { "Y" }, { "R" }, { "Z" }, { "V" },
};
static const char *const vector_set[4] = { "X", "Y", "Z" };

// Whether the layer stands in the plain channels, which have no prefix.
static bool is_plain(const char *layer)
{
    return strcmp(layer, "color") == 0;
}

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
    bool prefixed = !is_plain(layer);
    if (prefixed && match_set(list, layer, true, vector_set, out)) return true;
    size_t sets = sizeof suffix_sets / sizeof suffix_sets[0];
    if (!prefixed) sets -= 2; // a plain Z is the layer "depth"
    for (size_t i = 0; i < sets; i++)
        if (match_set(list, layer, prefixed, suffix_sets[i], out)) return true;
    return false;
}

// The layer that a channel belongs to; false when its name is too long to be asked for.
static bool layer_of_channel(const char *channel, char out[EXR_NAME_MAX + 1])
{
    const char *dot = strrchr(channel, '.');
    size_t length = dot ? (size_t)(dot - channel) : 0;
    if (length > EXR_NAME_MAX) return false;
    if (dot)
        memcpy(out, channel, length), out[length] = 0;
    else
        strcpy(out, strcmp(channel, "Z") == 0 ? "depth" : "color");
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

// The channels of a layer need not stand in one run: those of "color" do not, capitals sort before
// the rest.
static bool is_first_of_layer(const exr_attr_chlist_t *list, int channel, const char *layer)
{
    char other[EXR_NAME_MAX + 1];
    for (int i = 0; i < channel; i++)
        if (layer_of_channel(list->entries[i].name.str, other) && strcmp(other, layer) == 0)
            return false;
    return true;
}

// In the order of the file; NULL when out of memory.
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

// ---- reading

static bool refuse(struct exr_file *file, const char *why)
{
    return host_fail(file->host, FAIL_UNSUPPORTED, "cannot read %s: %s", file->path, why);
}

static bool check_kind(struct exr_file *file)
{
    int parts = 0;
    exr_storage_t storage;
    exr_result_t code = exr_get_count(file->context, &parts);
    if (code != EXR_ERR_SUCCESS) return fail_reading(file, code);
    if (parts != 1) return refuse(file, "it has several parts, only one is supported");
    code = exr_get_storage(file->context, 0, &storage);
    if (code != EXR_ERR_SUCCESS) return fail_reading(file, code);
    if (storage == EXR_STORAGE_TILED)
        return refuse(file, "it is tiled, only scan lines are supported");
    if (storage != EXR_STORAGE_SCANLINE) return refuse(file, "it is a deep image");
    return true;
}

// Leaves a half-open file to exr_file_finish.
static bool exr_file_open(struct exr_file *file, struct host *host, const char *path)
{
    *file = (struct exr_file){ .host = host, .path = path };
    static const uint8_t magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
    if (!file_read(host, path, 0, &file->bytes)) return false;
    if (file->bytes.size < sizeof magic || memcmp(file->bytes.data, magic, sizeof magic) != 0)
        return host_fail(host, FAIL_FORMAT, "cannot read %s: not an OpenEXR file", path);
    exr_context_initializer_t init = initializer_for(file);
    init.read_fn = read_bytes;
    init.size_fn = count_bytes;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; // a truncated file is an error
    exr_result_t code = exr_start_read(&file->context, path, &init);
    if (code != EXR_ERR_SUCCESS) {
        file->context = NULL; // released by the library
        return fail_reading(file, code);
    }
    return check_kind(file);
}

static bool get_channels(struct exr_file *file, const exr_attr_chlist_t **out)
{
    exr_result_t code = exr_get_channels(file->context, 0, out);
    if (code != EXR_ERR_SUCCESS) return fail_reading(file, code);
    if ((*out)->num_channels < 1 || (*out)->num_channels > EXR_CHANNELS_MAX)
        return host_fail(file->host, FAIL_FORMAT,
                         "cannot read %s: %d channels, 1 to %d are possible", file->path,
                         (*out)->num_channels, EXR_CHANNELS_MAX);
    return true;
}

static bool fail_missing_layer(struct exr_file *file, const exr_attr_chlist_t *list,
                               const char *layer)
{
    char wanted[EXR_NAME_MAX + 1], present[800];
    char *names = join_layer_names(file->host, list);
    if (!names) return false;
    for (char *c = names; *c; c++)
        if (*c == '\n') *c = ' ';
    copy_printable(wanted, sizeof wanted, layer);
    copy_printable(present, sizeof present, names);
    host_free(file->host, names);
    return host_fail(file->host, FAIL_ARGUMENT, "cannot read %s: no layer '%s'; it has: %s",
                     file->path, wanted, present[0] ? present : "none that can be shown");
}

// All channels stand in a line, also those of other layers.
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
    if (code != EXR_ERR_SUCCESS) return fail_reading(file, code);
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

// The library unpacks; the values are taken from its buffer here and not by its own conversion,
// which in some versions writes through the null pointers that stand for unwanted channels.
static bool read_chunk(struct exr_file *file, exr_decode_pipeline_t *decode, int first_y, int row,
                       const struct layer_channels *layer, const struct image *out)
{
    exr_chunk_info_t chunk;
    exr_const_context_t context = file->context;
    exr_result_t code = exr_read_scanline_chunk_info(context, 0, first_y + row, &chunk);
    if (code != EXR_ERR_SUCCESS) return fail_reading(file, code);
    if (!check_chunk(file, &chunk, row, layer, out)) return false;
    code = row == 0 ? exr_decoding_initialize(context, 0, &chunk, decode)
                    : exr_decoding_update(context, 0, &chunk, decode);
    if (code == EXR_ERR_SUCCESS && row == 0)
        code = exr_decoding_choose_default_routines(context, 0, decode);
    decode->unpack_and_convert_fn = NULL;
    if (code == EXR_ERR_SUCCESS) code = exr_decoding_run(context, 0, decode);
    if (code != EXR_ERR_SUCCESS) return fail_reading(file, code);
    bool is_raw = chunk.packed_size == chunk.unpacked_size; // so stored where packing does not help
    const uint8_t *lines = is_raw ? decode->packed_buffer : decode->unpacked_buffer;
    size_t held = is_raw ? decode->packed_alloc_size : decode->unpacked_alloc_size;
    if (!lines || held < layer->line_bytes * (size_t)chunk.height)
        return fail_reading(file, EXR_ERR_CORRUPT_CHUNK);
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
    if (code != EXR_ERR_SUCCESS || rows_per_chunk < 1) return fail_reading(file, code);
    bool good = true;
    for (int row = 0; good && row < out->height; row += rows_per_chunk)
        good = read_chunk(file, &decode, first_y, row, layer, out);
    exr_decoding_destroy(file->context, &decode);
    return good;
}

bool exr_read(struct host *host, const char *path, const char *layer, struct image *out)
{
    *out = (struct image){ 0 };
    struct exr_file file;
    struct layer_channels channels;
    exr_attr_box2i_t window;
    int width;
    if (!exr_file_open(&file, host, path)) goto fail;
    if (!get_window(&file, &window)) goto fail;
    width = window.max.x - window.min.x + 1;
    if (!choose_layer(&file, layer ? layer : "color", width, &channels)) goto fail;
    if (!image_init(out, host, width, window.max.y - window.min.y + 1, channels.count)) goto fail;
    if (!read_chunks(&file, window.min.y, &channels, out)) goto fail;
    exr_file_finish(&file);
    return true;
fail:
    image_finish(out, host);
    exr_file_finish(&file);
    return false;
}

char *exr_layer_names(struct host *host, const char *path)
{
    struct exr_file file;
    const exr_attr_chlist_t *list;
    char *names = NULL;
    if (exr_file_open(&file, host, path) && get_channels(&file, &list))
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
    if (exr_file_open(&file, host, path) &&
        exr_attr_get_string(file.context, 0, name, &length, &text) == EXR_ERR_SUCCESS)
        value = host_sprintf(host, "%.*s", length, text ? text : "");
    exr_file_finish(&file);
    return value;
}

// ---- writing

// One channel of the file and where its values lie.
struct written_channel {
    char name[EXR_NAME_MAX + 3];
    const struct image *image;
    int component;
};

struct channel_list {
    struct written_channel *items;
    int count;
};

static bool refuse_layer(struct exr_file *file, const char *name, const char *why)
{
    char shown[EXR_NAME_MAX + 1];
    copy_printable(shown, sizeof shown, name ? name : "(no name)");
    return host_fail(file->host, FAIL_ARGUMENT, "cannot write %s: layer '%s' %s", file->path, shown,
                     why);
}

static bool is_name(const char *name)
{
    if (!name || !name[0] || strlen(name) > EXR_NAME_MAX) return false;
    for (; *name; name++)
        if ((unsigned char)*name < 32 || *name == 127) return false;
    return true;
}

static bool check_layer(struct exr_file *file, const struct exr_layer *layers, int i)
{
    const struct image *image = layers[i].image, *first = layers[0].image;
    if (!is_name(layers[i].name))
        return refuse_layer(file, layers[i].name, "needs a name of 1 to 200 printable characters");
    if (!image || image->width < 1 || image->width > IMAGE_MAX_SIZE || image->height < 1 ||
        image->height > IMAGE_MAX_SIZE || image->channels < 1 || image->channels > 4)
        return refuse_layer(file, layers[i].name, "has no image of a possible size");
    if (image->width != first->width || image->height != first->height)
        return host_fail(file->host, FAIL_ARGUMENT,
                         "cannot write %s: layer '%s' is %dx%d, the first is %dx%d", file->path,
                         layers[i].name, image->width, image->height, first->width, first->height);
    for (int j = 0; j < i; j++)
        if (strcmp(layers[i].name, layers[j].name) == 0)
            return refuse_layer(file, layers[i].name, "is given twice");
    return true;
}

// Attributes that mean something to the format itself, whatever their type would be.
static bool is_reserved(const char *name)
{
    static const char *const reserved[] = {
        "channels",
        "chromaticities",
        "chunkCount",
        "compression",
        "dataWindow",
        "displayWindow",
        "lineOrder",
        "maxSamplesPerPixel",
        "name",
        "pixelAspectRatio",
        "preview",
        "screenWindowCenter",
        "screenWindowWidth",
        "tiles",
        "type",
        "version",
        "view",
    };
    for (size_t i = 0; i < sizeof reserved / sizeof reserved[0]; i++)
        if (strcmp(name, reserved[i]) == 0) return true;
    return false;
}

static bool check_attribute(struct exr_file *file, const struct exr_attribute *attributes, int i)
{
    const char *name = attributes[i].name;
    bool good = is_name(name) && attributes[i].value && !is_reserved(name);
    for (int j = 0; good && j < i; j++) good = strcmp(name, attributes[j].name) != 0;
    if (good) return true;
    char shown[EXR_NAME_MAX + 1];
    copy_printable(shown, sizeof shown, name ? name : "");
    return host_fail(file->host, FAIL_ARGUMENT,
                     "cannot write %s: attribute '%s' is unnamed, without value, the format's own, "
                     "or given twice",
                     file->path, shown);
}

static bool check_layers(struct exr_file *file, const struct exr_layer *layers, int layer_count,
                         const struct exr_attribute *attributes, int attribute_count)
{
    if (layer_count < 1 || layer_count > EXR_CHANNELS_MAX / 4)
        return host_fail(file->host, FAIL_ARGUMENT,
                         "cannot write %s: %d layers, 1 to %d are possible", file->path,
                         layer_count, EXR_CHANNELS_MAX / 4);
    for (int i = 0; i < layer_count; i++)
        if (!check_layer(file, layers, i)) return false;
    for (int i = 0; i < attribute_count; i++)
        if (!check_attribute(file, attributes, i)) return false;
    return true;
}

static void name_channel(struct written_channel *channel, const struct exr_layer *layer, int c)
{
    bool single = layer->image->channels == 1;
    const char *suffix = single ? "Y" : (const char *const[]){ "R", "G", "B", "A" }[c];
    if (is_plain(layer->name))
        snprintf(channel->name, sizeof channel->name, "%s", suffix);
    else if (single && strcmp(layer->name, "depth") == 0)
        snprintf(channel->name, sizeof channel->name, "Z");
    else
        snprintf(channel->name, sizeof channel->name, "%s.%s", layer->name, suffix);
    channel->image = layer->image;
    channel->component = c;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const struct written_channel *)a)->name,
                  ((const struct written_channel *)b)->name);
}

// In the order of the file, which the format demands to be that of the names' bytes.
static bool list_channels(struct exr_file *file, const struct exr_layer *layers, int layer_count,
                          struct channel_list *out)
{
    out->items = host_alloc(file->host, 4 * (size_t)layer_count, sizeof *out->items);
    if (!out->items) return false;
    for (int i = 0; i < layer_count; i++)
        for (int c = 0; c < layers[i].image->channels; c++)
            name_channel(&out->items[out->count++], &layers[i], c);
    qsort(out->items, (size_t)out->count, sizeof *out->items, by_name);
    return true;
}

static exr_result_t declare_names(exr_context_t context, const struct channel_list *channels,
                                  const struct exr_attribute *attributes, int attribute_count)
{
    bool long_names = false;
    for (int i = 0; i < channels->count; i++)
        long_names |= strlen(channels->items[i].name) > EXR_SHORT_NAME;
    for (int i = 0; i < attribute_count; i++)
        long_names |= strlen(attributes[i].name) > EXR_SHORT_NAME;
    return long_names ? exr_set_longname_support(context, 1) : EXR_ERR_SUCCESS;
}

static exr_result_t write_header(exr_context_t context, const struct channel_list *channels,
                                 const struct exr_attribute *attributes, int attribute_count)
{
    static const exr_attr_chromaticities_t rec709 = { 0.64f, 0.33f, 0.30f,   0.60f,
                                                      0.15f, 0.06f, 0.3127f, 0.3290f };
    const struct image *size = channels->items[0].image;
    int part;
    exr_result_t code = declare_names(context, channels, attributes, attribute_count);
    if (code == EXR_ERR_SUCCESS) code = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, 0, size->width, size->height,
                                                   EXR_COMPRESSION_ZIP);
    if (code == EXR_ERR_SUCCESS)
        code = exr_attr_set_chromaticities(context, 0, "chromaticities", &rec709);
    for (int i = 0; code == EXR_ERR_SUCCESS && i < channels->count; i++)
        code = exr_add_channel(context, 0, channels->items[i].name, EXR_PIXEL_FLOAT,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (int i = 0; code == EXR_ERR_SUCCESS && i < attribute_count; i++)
        code = exr_attr_set_string(context, 0, attributes[i].name, attributes[i].value);
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

static exr_result_t write_chunk(exr_context_t context, exr_encode_pipeline_t *encode, int row,
                                const struct channel_list *channels)
{
    exr_chunk_info_t chunk;
    exr_result_t code = exr_write_scanline_chunk_info(context, 0, row, &chunk);
    if (code != EXR_ERR_SUCCESS) return code;
    code = row == 0 ? exr_encoding_initialize(context, 0, &chunk, encode)
                    : exr_encoding_update(context, 0, &chunk, encode);
    if (code != EXR_ERR_SUCCESS) return code;
    if (encode->channel_count != channels->count) return EXR_ERR_INVALID_ARGUMENT;
    for (int i = 0; i < channels->count; i++) {
        const struct written_channel *from = &channels->items[i];
        exr_coding_channel_info_t *channel = &encode->channels[i];
        if (strcmp(channel->channel_name, from->name) != 0) return EXR_ERR_INVALID_ARGUMENT;
        channel->encode_from_ptr =
            (const uint8_t *)(image_at(from->image, 0, row) + from->component);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = from->image->channels * (int32_t)sizeof(float);
        channel->user_line_stride = from->image->width * channel->user_pixel_stride;
    }
    if (row == 0) code = exr_encoding_choose_default_routines(context, 0, encode);
    return code == EXR_ERR_SUCCESS ? exr_encoding_run(context, 0, encode) : code;
}

static exr_result_t write_chunks(exr_context_t context, const struct channel_list *channels)
{
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    int32_t rows_per_chunk = 0;
    int height = channels->items[0].image->height;
    exr_result_t code = exr_get_scanlines_per_chunk(context, 0, &rows_per_chunk);
    if (code == EXR_ERR_SUCCESS && rows_per_chunk < 1) code = EXR_ERR_INVALID_ARGUMENT;
    for (int row = 0; code == EXR_ERR_SUCCESS && row < height; row += rows_per_chunk)
        code = write_chunk(context, &encode, row, channels);
    exr_encoding_destroy(context, &encode);
    return code;
}

bool exr_write(struct host *host, const char *path, const struct exr_layer *layers, int layer_count,
               const struct exr_attribute *attributes, int attribute_count)
{
    struct exr_file file = { .host = host, .path = path };
    struct channel_list channels = { 0 };
    exr_context_initializer_t init = initializer_for(&file);
    init.write_fn = write_bytes;
    exr_result_t code;
    if (!check_layers(&file, layers, layer_count, attributes, attribute_count)) goto fail;
    if (!list_channels(&file, layers, layer_count, &channels)) goto fail;
    if (!file_begin(&file.writer, host, path)) goto fail;
    code = exr_start_write(&file.context, path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (code == EXR_ERR_SUCCESS)
        code = write_header(file.context, &channels, attributes, attribute_count);
    if (code == EXR_ERR_SUCCESS) code = write_chunks(file.context, &channels);
    if (code == EXR_ERR_SUCCESS) code = exr_finish(&file.context); // writes the table of chunks
    if (code != EXR_ERR_SUCCESS) {
        fail_writing(&file, code);
        goto fail;
    }
    host_free(host, channels.items);
    return file_commit(&file.writer);
fail:
    exr_file_finish(&file);
    host_free(host, channels.items);
    file_abort(&file.writer);
    return false;
}
