// What a JPEG's tables say, looked at before a decoder that believes them.
#pragma once

#include <stddef.h>
#include <stdint.h>

// NULL, or why the file is refused (a constant): a Huffman table with more symbols than there are
// byte values, which stb_image before 2.29 writes past the end of its own.
const char *jpeg_check(const uint8_t *data, size_t size);
