// Limits and settings of libpng for untrusted files.
#pragma once

#include <png.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

// Largest width and height. Of the ancillary chunks tRNS alone is read: texts and profiles take
// memory, and time to unpack.
static inline void png_limit(png_structp png, png_uint_32 size)
{
    enum { CHUNK_BYTES_MAX = 64 << 20, CHUNKS_MAX = 1000 };
    png_set_user_limits(png, size, size);
    png_set_chunk_malloc_max(png, CHUNK_BYTES_MAX);
    png_set_chunk_cache_max(png, CHUNKS_MAX);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
}

// A file in memory. libpng unpacks the data behind the last row to find their end and discards
// them; a byte can stand for a thousand, so that only some of them may be read.
struct png_input {
    const uint8_t *at, *end;
    png_infop info;     // NULL: the chunks behind the rows are read too, whatever their size
    size_t behind_rows; // bytes read behind the last row
};

// The passes of an interlaced file are 0 to 6.
static inline bool png_has_all_rows(png_structp png, png_infop info)
{
    const png_uint_32 height = png_get_image_height(png, info);
    return png_get_current_pass_number(png) >= 7 ||
           (height > 0 && png_get_current_row_number(png) >= height);
}

// For png_set_read_fn with a struct png_input.
static inline void png_read_input(png_structp png, png_bytep out, size_t bytes)
{
    enum { BEHIND_ROWS_MAX = 64 << 10 };
    struct png_input *input = png_get_io_ptr(png);
    if (bytes > (size_t)(input->end - input->at)) png_error(png, "the file ends too early");
    if (input->info && png_has_all_rows(png, input->info)) input->behind_rows += bytes;
    if (input->behind_rows > BEHIND_ROWS_MAX) png_error(png, "it has data behind its last row");
    memcpy(out, input->at, bytes);
    input->at += bytes;
}
