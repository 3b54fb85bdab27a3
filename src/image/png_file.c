// PNG through libpng. libpng reports errors by longjmp, so all state is in a struct of setjmp's
// caller: no local variable is modified between setjmp and longjmp, and one place frees everything.
// gAMA and iCCP are ignored and colours are read as sRGB, as glTF requires.
#include "image/png_file.h"

#include "core/files/file.h"
#include "image/png_decode.h"
#include "image/png_limits.h"

#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

struct png_job {
    struct host *host;
    png_structp png;
    png_infop info;
    jmp_buf escape;
    char message[160];
    enum fail_kind kind;       // of the failure
    struct file_bytes bytes;   // reading
    struct png_input input;    // of `bytes`
    struct file_writer writer; // writing
    uint8_t *pixels;           // encoded, interleaved
    png_bytep *rows;
};

static void on_error(png_structp png, png_const_charp message)
{
    struct png_job *job = png_get_error_ptr(png);
    snprintf(job->message, sizeof job->message, "%s", message);
    longjmp(job->escape, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    struct png_job *job = png_get_error_ptr(png);
    host_log(job->host, LOG_DEBUG, "libpng: %s", message);
}

static png_voidp on_malloc(png_structp png, png_alloc_size_t bytes)
{
    struct png_job *job = png_get_mem_ptr(png);
    void *memory = host_alloc(job->host, 1, bytes);
    if (!memory) job->kind = FAIL_MEMORY;
    return memory;
}

static void on_free(png_structp png, png_voidp pointer)
{
    struct png_job *job = png_get_mem_ptr(png);
    host_free(job->host, pointer);
}

static void on_write(png_structp png, png_bytep data, size_t bytes)
{
    struct png_job *job = png_get_io_ptr(png);
    if (!file_write(&job->writer, data, bytes)) png_error(png, strerror(job->writer.why));
}

static void on_flush(png_structp png)
{
    (void)png; // file_commit flushes
}

static void job_finish_reading(struct png_job *job)
{
    png_destroy_read_struct(&job->png, &job->info, NULL);
    file_bytes_finish(job->host, &job->bytes);
    host_free(job->host, job->rows);
    host_free(job->host, job->pixels);
}

// Logs libpng's message. Without one the failure has already been logged.
static bool job_fail(const struct png_job *job, const char *verb, const char *path)
{
    if (!job->message[0]) return false;
    return host_fail(job->host, job->kind, "cannot %s %s: %s", verb, path, job->message);
}

// After png_create_…, which returns NULL when out of memory or on a version mismatch.
static bool job_started(struct png_job *job)
{
    job->info = job->png ? png_create_info_struct(job->png) : NULL;
    if (job->info) return true;
    return host_fail(job->host, FAIL_MEMORY,
                     "cannot start libpng %s: no memory, or built for another version",
                     png_get_libpng_ver(NULL));
}

// Allocates `height` rows of `row_bytes` each and libpng's row pointers.
static bool job_allocate_rows(struct png_job *job, size_t row_bytes, size_t height)
{
    job->pixels = host_alloc(job->host, height, row_bytes);
    job->rows = host_alloc(job->host, height, sizeof *job->rows);
    if (!job->pixels || !job->rows) return false;
    for (size_t y = 0; y < height; y++) job->rows[y] = job->pixels + y * row_bytes;
    return true;
}

// Converts any colour type to RGB or RGBA, with 8 bits or, where the file has them, 16.
static void request_rgb(png_structp png, png_infop info)
{
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
}

// Everything that may longjmp while reading.
static bool job_read(struct png_job *job)
{
    if (setjmp(job->escape)) return false;
    job->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job,
                                        on_malloc, on_free);
    if (!job_started(job)) return false;
    job->input =
        (struct png_input){ job->bytes.data, job->bytes.data + job->bytes.size, .info = job->info };
    png_set_read_fn(job->png, &job->input, png_read_input);
    png_limit(job->png, IMAGE_MAX_SIZE);
    png_read_info(job->png, job->info);
    request_rgb(job->png, job->info);
    if (!job_allocate_rows(job, png_get_rowbytes(job->png, job->info),
                           png_get_image_height(job->png, job->info)))
        return false;
    png_read_image(job->png, job->rows);
    job->input.info = NULL;       // texts may be large
    png_read_end(job->png, NULL); // a missing end chunk means a truncated file
    return true;
}

static float sample(const png_byte *row, size_t index, int depth)
{
    if (depth == 8) return (float)row[index] / 255.0f;
    return (float)(row[2 * index] << 8 | row[2 * index + 1]) / 65535.0f; // big-endian
}

static bool job_decode(const struct png_job *job, struct image *out)
{
    int channels = png_get_channels(job->png, job->info);
    int depth = png_get_bit_depth(job->png, job->info);
    if (!image_init(out, job->host, (int)png_get_image_width(job->png, job->info),
                    (int)png_get_image_height(job->png, job->info), channels))
        return false;
    for (int y = 0; y < out->height; y++) {
        float *to = image_at(out, 0, y);
        for (size_t i = 0; i < (size_t)out->width * (size_t)channels; i++) {
            float value = sample(job->rows[y], i, depth);
            bool is_alpha = channels == 4 && i % 4 == 3;
            to[i] = is_alpha ? value : srgb_decode(value);
        }
    }
    return true;
}

bool png_read_size(struct host *host, const char *path, int *width, int *height)
{
    struct file_bytes bytes;
    uint32_t w = 0, h = 0;
    if (!file_read(host, path, 0, &bytes)) return false;
    const bool whole = png_find_size(bytes.data, bytes.size, &w, &h);
    file_bytes_finish(host, &bytes);
    if (w < 1 || h < 1 || w > IMAGE_MAX_SIZE || h > IMAGE_MAX_SIZE)
        return host_fail(host, FAIL_FORMAT,
                         whole ? "cannot read %s: it is empty, or larger than 16384x16384"
                               : "cannot read %s: not a PNG file",
                         path);
    *width = (int)w;
    *height = (int)h;
    return true;
}

bool png_read(struct host *host, const char *path, struct image *out)
{
    *out = (struct image){ 0 };
    struct png_job job = { .host = host, .kind = FAIL_FORMAT };
    if (!file_read(host, path, 0, &job.bytes)) return false;
    uint32_t width, height;
    if (!png_find_size(job.bytes.data, job.bytes.size, &width, &height)) {
        host_fail(host, FAIL_FORMAT, "cannot read %s: not a PNG file", path);
        goto fail;
    }
    if (!job_read(&job)) {
        job_fail(&job, "read", path);
        goto fail;
    }
    if (!job_decode(&job, out)) goto fail;
    job_finish_reading(&job);
    return true;
fail:
    job_finish_reading(&job);
    return false;
}

// The nearest 8-bit code; NaN becomes 0.
static uint8_t code_of(float encoded)
{
    if (!(encoded > 0.0f)) return 0;
    return (uint8_t)(fminf(encoded, 1.0f) * 255.0f + 0.5f);
}

static void job_encode(struct png_job *job, const struct image *image)
{
    size_t channels = (size_t)image->channels;
    size_t count = (size_t)image->width * (size_t)image->height * channels;
    for (size_t i = 0; i < count; i++) {
        bool is_alpha = channels == 4 && i % 4 == 3;
        job->pixels[i] = code_of(is_alpha ? image->pixels[i] : srgb_encode(image->pixels[i]));
    }
}

// Everything that may longjmp while writing.
static bool job_write(struct png_job *job, const struct image *image, int colour_type)
{
    if (setjmp(job->escape)) return false;
    job->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job,
                                         on_malloc, on_free);
    if (!job_started(job)) return false;
    png_set_write_fn(job->png, job, on_write, on_flush);
    png_set_IHDR(job->png, job->info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(job->png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(job->png, job->info);
    png_write_image(job->png, job->rows);
    png_write_end(job->png, job->info);
    return true;
}

static bool colour_type_of(int channels, int *out)
{
    static const int types[] = { -1, PNG_COLOR_TYPE_GRAY, -1, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA };
    *out = channels >= 1 && channels <= 4 ? types[channels] : -1;
    return *out >= 0;
}

static void job_finish_writing(struct png_job *job)
{
    png_destroy_write_struct(&job->png, &job->info);
    host_free(job->host, job->rows);
    host_free(job->host, job->pixels);
}

bool png_write(struct host *host, const char *path, const struct image *image)
{
    struct png_job job = { .host = host, .kind = FAIL_FILE };
    int colour_type;
    if (!colour_type_of(image->channels, &colour_type))
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot write %s: a PNG has 1, 3 or 4 channels, not %d", path,
                         image->channels);
    size_t row_bytes = (size_t)image->width * (size_t)image->channels;
    if (!job_allocate_rows(&job, row_bytes, (size_t)image->height)) goto fail;
    job_encode(&job, image);
    if (!file_begin(&job.writer, host, path)) goto fail;
    if (!job_write(&job, image, colour_type)) {
        job_fail(&job, "write", path);
        goto fail;
    }
    job_finish_writing(&job);
    return file_commit(&job.writer);
fail:
    job_finish_writing(&job);
    file_abort(&job.writer);
    return false;
}
