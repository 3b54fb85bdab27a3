// Text of files for people: names come from scene files and paths and may be any bytes. Numbers as
// text.
#pragma once

#include <stddef.h>

// The byte length of the UTF-8 character at `text` (Unicode 15, table 3-7); 0: it is invalid, or
// the end.
size_t text_utf8_length(const char *text);

// Copies `text` to `out` of `size` bytes, truncated between characters, with a terminating zero.
// Escapes characters that could control a terminal or reorder the line: C0 and C1 controls, line
// and paragraph separators and bidirectional controls as \uXXXX, bytes that are not UTF-8 as \xXX.
// Returns the length written. out NULL: the length that the whole text needs; size is unused.
size_t text_escape(const char *text, char *out, size_t size);

// The shortest decimal that parses to the same float; 16 bytes always suffice.
// The decimal point is that of the thread's locale.
void text_float(float value, char *out, size_t size);
