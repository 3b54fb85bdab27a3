// Limits that libpng has for untrusted files.
#pragma once

#include <png.h>

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
