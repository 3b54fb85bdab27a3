// What a JPEG's tables say, looked at before a decoder that believes them.
#pragma once

#include <stddef.h>
#include <stdint.h>

// NULL, or the reason of refusal (a constant): a Huffman table with more than 256 symbols, which
// overflows a buffer of stb_image before 2.29.
const char *jpeg_check(const uint8_t *data, size_t size);
