// libpng reports errors by longjmp: all state is in a struct of setjmp's caller, and no local
// variable is read after it.
#include "image/png_decode.h"

#include "image/png_limits.h"

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

struct job {
    png_structp png;
    png_infop info;
    jmp_buf escape;
    struct png_input input;
    char *why; // [DECODE_WHY_SIZE]
};

static void on_error(png_structp png, png_const_charp message)
{
    struct job *job = png_get_error_ptr(png);
    snprintf(job->why, DECODE_WHY_SIZE, "%s", message);
    longjmp(job->escape, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

bool png_find_size(const uint8_t *data, size_t size, uint32_t *width, uint32_t *height)
{
    enum { TYPE_AT = 12, WIDTH_AT = 16, HEIGHT_AT = 20, END = 24 };
    if (size < END || png_sig_cmp(data, 0, 8) != 0 || memcmp(data + TYPE_AT, "IHDR", 4) != 0)
        return false;
    *width = png_get_uint_32(data + WIDTH_AT);
    *height = png_get_uint_32(data + HEIGHT_AT);
    return true;
}

// Any colour type to 8-bit RGBA.
static void request_rgba(struct job *job)
{
    png_set_expand(job->png);
    png_set_strip_16(job->png);
    png_set_gray_to_rgb(job->png);
    png_set_add_alpha(job->png, 0xff, PNG_FILLER_AFTER);
}

// All that may longjmp. Checksums are not compared: pixels that can be unpacked are used.
static bool read_rows(struct job *job, uint32_t width, uint32_t height, uint8_t *rgba)
{
    if (setjmp(job->escape)) return false;
    png_set_read_fn(job->png, &job->input, png_read_input);
    png_limit(job->png, width > height ? width : height);
    png_set_crc_action(job->png, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
#ifdef PNG_IGNORE_ADLER32 // not of each build of libpng; it is compared behind the last row
    png_set_option(job->png, PNG_IGNORE_ADLER32, PNG_OPTION_ON);
#endif
    png_read_info(job->png, job->info);
    request_rgba(job);
    const int passes = png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
    if (png_get_rowbytes(job->png, job->info) != (size_t)width * 4 ||
        png_get_image_height(job->png, job->info) != height)
        png_error(job->png, "its size is contradictory");
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t y = 0; y < height; y++)
            png_read_row(job->png, rgba + (size_t)y * width * 4, NULL);
    return true;
}

const char *png_decode(const uint8_t *data, size_t size, uint32_t width, uint32_t height,
                       uint8_t *rgba, char why[DECODE_WHY_SIZE])
{
    struct job job = { .input = { .at = data, .end = data + size }, .why = why };
    job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    job.input.info = job.info;
    snprintf(why, DECODE_WHY_SIZE, "there is no memory to decode it");
    const bool ok = job.info && read_rows(&job, width, height, rgba);
    png_destroy_read_struct(&job.png, &job.info, NULL);
    return ok ? NULL : why;
}
