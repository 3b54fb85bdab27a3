// UTF-8 and control characters in names; numbers.
#include "core/text.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ESCAPE_SIZE = 8 }; // "\u202e" and a zero

size_t text_utf8_length(const char *text)
{
    const unsigned char *s = (const unsigned char *)text;
    if (s[0] < 0x80) return s[0] != 0;
    size_t length = s[0] < 0xc2 ? 0 : s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : s[0] < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < length; i++)
        if ((s[i] & 0xc0) != 0x80) return 0;
    bool wrong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xed && s[1] > 0x9f) ||
                 (s[0] == 0xf0 && s[1] < 0x90) || (s[0] == 0xf4 && s[1] > 0x8f);
    return wrong ? 0 : length;
}

// The code point of a valid character of one to three bytes; 0 for four, as no control has four.
static uint32_t code_point(const char *text, size_t length)
{
    const unsigned char *s = (const unsigned char *)text;
    if (length == 1) return s[0];
    if (length == 2) return (s[0] & 0x1fu) << 6 | (s[1] & 0x3fu);
    if (length == 3) return (s[0] & 0x0fu) << 12 | (s[1] & 0x3fu) << 6 | (s[2] & 0x3fu);
    return 0;
}

// Controls, separators, and the property Bidi_Control of Unicode 15.
static bool is_control(uint32_t c)
{
    return (c > 0 && c < 0x20) || (c >= 0x7f && c < 0xa0) || c == 0x061c || c == 0x200e ||
           c == 0x200f || (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
}

size_t text_escape(const char *text, char *out, size_t size)
{
    char escape[ESCAPE_SIZE];
    size_t used = 0;
    if (!out) size = SIZE_MAX;
    while (*text && size > 0) {
        const size_t length = text_utf8_length(text);
        const uint32_t c = code_point(text, length);
        const char *output = text;
        size_t bytes = length;
        if (length == 0 || is_control(c)) {
            const unsigned value = length ? c : (unsigned char)*text;
            bytes = (size_t)snprintf(escape, sizeof escape, length ? "\\u%04x" : "\\x%02x", value);
            output = escape;
        }
        if (used + bytes >= size) break;
        if (out) memcpy(out + used, output, bytes);
        used += bytes;
        text += length ? length : 1;
    }
    if (out && size > 0) out[used] = 0;
    return used;
}

void text_float(float value, char *out, size_t size)
{
    enum { ENOUGH_DIGITS = 9 };
    for (int digits = 1; digits <= ENOUGH_DIGITS; digits++) {
        snprintf(out, size, "%.*g", digits, (double)value);
        if (strtof(out, NULL) == value) return;
    }
}
