// Values of JSON: exact numbers, names of any bytes.
#pragma once

#include <jansson.h>

// The shortest decimal that reads back as the same float: 0.1, not 0.10000000149. Not finite: null.
json_t *json_float(float value);
json_t *json_floats(const float *values, int count);
// A double; null if not finite (PSNR of equal images).
json_t *json_double(double value);
// Names and paths may be any bytes: invalid UTF-8 becomes U+FFFD.
json_t *json_text(const char *text);
