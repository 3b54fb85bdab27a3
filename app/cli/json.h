// Small helpers over jansson: numbers as they were meant, a whole document out.
#pragma once

#include "messages.h"

#include <jansson.h>

// The shortest decimal that reads back as the same float: 0.1, not 0.10000000149. Not finite: null.
json_t *json_float(float value);
json_t *json_floats(const float *values, int count);
// A double; not finite (the PSNR of equal images): null.
json_t *json_double(double value);
// Names and paths, which are any bytes: what is no UTF-8 becomes U+FFFD.
json_t *json_text(const char *text);
// Indented, to standard output. Takes the document, which may be NULL (out of memory).
enum status json_print(json_t *document);
// To a file that appears whole or not at all. Keeps the document.
enum status json_write(const json_t *document, const char *path);
