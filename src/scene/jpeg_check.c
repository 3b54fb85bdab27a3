// Traversal of a JPEG's segments (ITU-T T.81, annex B). It reaches every table that a decoder
// reaches: both skip segments by their length, and in entropy-coded data a marker is 0xff before a
// byte that is neither 0, a fill byte nor a restart marker.
#include "scene/jpeg_check.h"

#include <stdbool.h>

enum { MARKER_DHT = 0xc4, MARKER_RST0 = 0xd0, MARKER_SOI = 0xd8, MARKER_EOI = 0xd9 };
enum { CODE_LENGTHS = 16, MAX_SYMBOLS = 256 };

// The position after the next marker, which is stored in *marker; `size` when there is none.
static size_t next_marker(const uint8_t *data, size_t size, size_t at, uint8_t *marker)
{
    for (; at + 1 < size; at++) {
        uint8_t code = data[at + 1];
        bool restart = code >= MARKER_RST0 && code < MARKER_SOI;
        if (data[at] != 0xff || code == 0 || code == 0xff || restart) continue;
        *marker = code;
        return at + 2;
    }
    return size;
}

// One or more tables: class and number, the number of codes of each length, the symbols (T.81,
// B.2.4.2). A decoder reads the last table to its end, even beyond the end of the segment.
static bool tables_are_sound(const uint8_t *data, size_t size, size_t length)
{
    for (size_t at = 0; at < length;) {
        size_t symbols = 0;
        for (size_t i = at + 1; i <= at + CODE_LENGTHS && i < size; i++) symbols += data[i];
        if (symbols > MAX_SYMBOLS) return false;
        at += 1 + CODE_LENGTHS + symbols;
    }
    return true;
}

const char *jpeg_check(const uint8_t *data, size_t size)
{
    uint8_t marker = 0;
    size_t at = 0;
    while ((at = next_marker(data, size, at, &marker)) < size) {
        if (marker == MARKER_SOI) continue;
        if (marker == MARKER_EOI || size - at < 2) break;
        size_t length = (size_t)data[at] << 8 | data[at + 1];
        size_t rest = size - at;
        if (length < 2) break; // decoders give up here
        if (marker == MARKER_DHT && !tables_are_sound(data + at + 2, rest - 2, length - 2))
            return "a Huffman table has more than 256 symbols";
        at += length < rest ? length : rest;
    }
    return NULL;
}
