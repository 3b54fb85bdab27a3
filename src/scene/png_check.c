// Traversal of a PNG's chunks (PNG specification, section 5.3): length, type, data, CRC.
#include "scene/png_check.h"

#include <stdbool.h>
#include <string.h>

enum { SIGNATURE = 8, LENGTH = 4, TYPE = 4, CRC = 4 };

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

const char *png_check(const uint8_t *data, size_t size)
{
    if (size < SIGNATURE || memcmp(data, "\x89PNG\r\n\x1a\n", SIGNATURE) != 0) return NULL;
    size_t at = SIGNATURE;
    while (size - at >= LENGTH + TYPE) {
        const size_t length = big_endian(data + at), rest = size - at - LENGTH - TYPE;
        const bool is_data = memcmp(data + at + LENGTH, "IDAT", TYPE) == 0;
        if (is_data) return length == 0 ? "its first IDAT chunk is empty" : NULL;
        if (rest < CRC || length > rest - CRC) return NULL; // decoders give up here
        at += LENGTH + TYPE + length + CRC;
    }
    return NULL;
}
