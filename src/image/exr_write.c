// Writing OpenEXR through its C core: one part, scan lines, ZIP, floats, channels sorted by name.
// One thread packs the chunks in order, so the same layers give the same bytes.
#include "image/exr_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum {
    EXR_SHORT_NAME = 31, // longer names need the long-name flag of the header
    EXR_ZIP_LEVEL = 4,   // OpenEXR's default: nearly as small as 6, much faster
};

static int64_t write_bytes(exr_const_context_t context, void *user, const void *buffer,
                           uint64_t bytes, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    struct exr_file *file = user;
    if (fseeko(file->writer.stream, (off_t)offset, SEEK_SET) != 0) file->writer.why = errno;
    if (file_write(&file->writer, buffer, bytes)) return (int64_t)bytes;
    if (error) error(context, EXR_ERR_WRITE_IO, "%s", strerror(file->writer.why));
    return -1;
}

// To memory, which grows by doubling.
static int64_t append_bytes(exr_const_context_t context, void *user, const void *buffer,
                            uint64_t bytes, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    struct exr_file *file = user;
    const size_t end = (size_t)(offset + bytes);
    if (end > file->capacity) {
        const size_t capacity = 2 * end;
        uint8_t *larger = host_realloc(file->host, file->bytes.data, capacity, 1);
        if (!larger && error) error(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
        if (!larger) return -1;
        memset(larger + file->capacity, 0, capacity - file->capacity);
        file->bytes.data = larger;
        file->capacity = capacity;
    }
    memcpy(file->bytes.data + offset, buffer, bytes);
    if (end > file->bytes.size) file->bytes.size = end;
    return (int64_t)bytes;
}

// One channel of the file and the source of its values.
struct written_channel {
    char name[EXR_NAME_MAX + 3];
    const struct image *image;
    int component;
};

struct channel_list {
    struct written_channel *items;
    int count;
    exr_pixel_type_t type; // in the file
};

static bool refuse_layer(struct exr_file *file, const char *name, const char *why)
{
    return host_fail(file->host, FAIL_ARGUMENT, "cannot write %s: layer '%.*s' %s", file->path,
                     EXR_NAME_MAX, name ? name : "(no name)", why);
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

// Attribute names reserved by the format.
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
    return host_fail(file->host, FAIL_ARGUMENT,
                     "cannot write %s: attribute '%.*s' is unnamed, without value, the format's "
                     "own, or given twice",
                     file->path, EXR_NAME_MAX, name ? name : "");
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
    if (exr_is_plain(layer->name))
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

// Sorted by the bytes of the names, as the format requires.
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
        code = exr_add_channel(context, 0, channels->items[i].name, channels->type,
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

static bool write_file(struct exr_file *file, exr_context_initializer_t *init,
                       const struct channel_list *channels, const struct exr_attribute *attributes,
                       int attribute_count)
{
    init->zip_level = EXR_ZIP_LEVEL;
    exr_result_t code = exr_start_write(&file->context, file->path, EXR_WRITE_FILE_DIRECTLY, init);
    if (code == EXR_ERR_SUCCESS)
        code = write_header(file->context, channels, attributes, attribute_count);
    if (code == EXR_ERR_SUCCESS) code = write_chunks(file->context, channels);
    if (code == EXR_ERR_SUCCESS) code = exr_finish(&file->context); // writes the table of chunks
    return code == EXR_ERR_SUCCESS || exr_fail_writing(file, code);
}

static bool write_as(exr_pixel_type_t type, struct host *host, const char *path,
                     const struct exr_layer *layers, int layer_count,
                     const struct exr_attribute *attributes, int attribute_count)
{
    struct exr_file file = { .host = host, .path = path };
    struct channel_list channels = { .type = type };
    exr_context_initializer_t init = exr_initializer(&file);
    init.write_fn = write_bytes;
    const bool ok = check_layers(&file, layers, layer_count, attributes, attribute_count) &&
                    list_channels(&file, layers, layer_count, &channels) &&
                    file_begin(&file.writer, host, path) &&
                    write_file(&file, &init, &channels, attributes, attribute_count);
    exr_file_finish(&file);
    host_free(host, channels.items);
    if (ok) return file_commit(&file.writer);
    file_abort(&file.writer);
    return false;
}

bool exr_encode(struct host *host, const struct image *image, uint8_t **out, size_t *size)
{
    const struct exr_layer layer = { "color", image };
    struct exr_file file = { .host = host, .path = "an image" };
    struct channel_list channels = { .type = EXR_PIXEL_FLOAT };
    exr_context_initializer_t init = exr_initializer(&file);
    init.write_fn = append_bytes;
    const bool ok = check_layers(&file, &layer, 1, NULL, 0) &&
                    list_channels(&file, &layer, 1, &channels) &&
                    write_file(&file, &init, &channels, NULL, 0);
    host_free(host, channels.items);
    *out = ok ? file.bytes.data : NULL;
    *size = ok ? file.bytes.size : 0;
    if (ok) file.bytes = (struct file_bytes){ 0 };
    exr_file_finish(&file);
    return ok;
}

bool exr_write(struct host *host, const char *path, const struct exr_layer *layers, int layer_count,
               const struct exr_attribute *attributes, int attribute_count)
{
    return write_as(EXR_PIXEL_FLOAT, host, path, layers, layer_count, attributes, attribute_count);
}

bool exr_write_half(struct host *host, const char *path, const struct exr_layer *layers,
                    int layer_count, const struct exr_attribute *attributes, int attribute_count)
{
    return write_as(EXR_PIXEL_HALF, host, path, layers, layer_count, attributes, attribute_count);
}
