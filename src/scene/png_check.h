// What a PNG's chunks say, looked at before a decoder that believes them.
#pragma once

#include <stddef.h>
#include <stdint.h>

// NULL, or the reason of refusal (a constant): an empty first IDAT chunk, for which stb_image
// copies to a null pointer. Data that is no PNG passes.
const char *png_check(const uint8_t *data, size_t size);
