// libjpeg reports errors by longjmp: all state is in a struct of setjmp's caller, and no local
// variable is read after it.
#include "image/jpeg_decode.h"

#include <setjmp.h>
#include <stdio.h>

#include <jpeglib.h>

#include <jerror.h>

// A progressive JPEG has about ten scans. A scan can be ten bytes long and costs a pass over all
// pixels.
enum { MAX_SCANS = 100 };
// Coefficients of four components take 8 bytes of a pixel; the rest is rows.
enum { BYTES_PER_PIXEL = 18, ALLOWANCE_BYTES = 1 << 20 };

struct job {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf escape;
    char *why; // [DECODE_WHY_SIZE]
};
_Static_assert(DECODE_WHY_SIZE >= JMSG_LENGTH_MAX, "libjpeg writes a message of that length");

static _Noreturn void fail(struct job *job, const char *message)
{
    snprintf(job->why, DECODE_WHY_SIZE, "%s", message);
    longjmp(job->escape, 1);
}

static void on_error(j_common_ptr jpeg)
{
    struct job *job = jpeg->client_data;
    jpeg->err->format_message(jpeg, job->why);
    longjmp(job->escape, 1);
}

// Below 0 it is a warning of damaged data, whose pixels are used if all of them are there.
static void on_message(j_common_ptr jpeg, int level)
{
    if (level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF)
        fail(jpeg->client_data, "the file ends too early");
}

static void on_progress(j_common_ptr jpeg)
{
    struct job *job = jpeg->client_data;
    if (job->jpeg.input_scan_number > MAX_SCANS) fail(job, "it has more than 100 scans");
}

static void read_head(struct job *job, const uint8_t *data, size_t size)
{
    job->jpeg.err = jpeg_std_error(&job->errors);
    job->jpeg.client_data = job;
    job->errors.error_exit = on_error;
    job->errors.emit_message = on_message;
    job->progress.progress_monitor = on_progress;
    jpeg_create_decompress(&job->jpeg);
    job->jpeg.progress = &job->progress;
    jpeg_mem_src(&job->jpeg, data, (unsigned long)size);
    jpeg_read_header(&job->jpeg, TRUE);
}

// All that may longjmp.
static bool try_head(struct job *job, const uint8_t *data, size_t size)
{
    if (setjmp(job->escape)) return false;
    read_head(job, data, size);
    return true;
}

const char *jpeg_find_size(const uint8_t *data, size_t size, uint32_t *width, uint32_t *height,
                           char why[DECODE_WHY_SIZE])
{
    struct job job = { .why = why };
    const bool ok = try_head(&job, data, size);
    *width = job.jpeg.image_width;
    *height = job.jpeg.image_height;
    jpeg_destroy_decompress(&job.jpeg);
    return ok ? NULL : why;
}

// Inks are stored inverted (Adobe), so that 255 is none: a colour is their product.
static void rgb_from_cmyk(uint8_t *row, size_t width)
{
    for (size_t x = 0; x < width; x++, row += 4) {
        for (int c = 0; c < 3; c++) row[c] = (uint8_t)((row[c] * row[3] + 127) / 255);
        row[3] = 255;
    }
}

// All that may longjmp. No smoothing, and the exact transform: pixels are those of the file.
static bool read_rows(struct job *job, const uint8_t *data, size_t size, uint8_t *rgba)
{
    struct jpeg_decompress_struct *jpeg = &job->jpeg;
    if (setjmp(job->escape)) return false;
    read_head(job, data, size);
    const size_t pixels = (size_t)jpeg->image_width * jpeg->image_height;
    jpeg->mem->max_memory_to_use = (long)(pixels * BYTES_PER_PIXEL + ALLOWANCE_BYTES);
    const bool inks = jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK;
    jpeg->out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg->dct_method = JDCT_ISLOW;
    jpeg->do_block_smoothing = FALSE;
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW row = rgba + (size_t)jpeg->output_scanline * jpeg->output_width * 4;
        jpeg_read_scanlines(jpeg, &row, 1);
        if (inks) rgb_from_cmyk(row, jpeg->output_width);
    }
    return true;
}

const char *jpeg_decode(const uint8_t *data, size_t size, uint8_t *rgba, char why[DECODE_WHY_SIZE])
{
    struct job job = { .why = why };
    const bool ok = read_rows(&job, data, size, rgba);
    jpeg_destroy_decompress(&job.jpeg);
    return ok ? NULL : why;
}
