#include "json_values.h"

#include "core/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

json_t *json_double(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_float(float value)
{
    char text[64];
    if (!isfinite(value)) return json_null();
    text_float(value, text, sizeof text);
    return json_real(strtod(text, NULL));
}

json_t *json_floats(const float *values, int count)
{
    json_t *array = json_array();
    for (int i = 0; array && i < count; i++) json_array_append_new(array, json_float(values[i]));
    return array;
}

json_t *json_text(const char *text)
{
    static const char REPLACEMENT[] = "\xef\xbf\xbd";
    char *clean = malloc(3 * strlen(text) + 1);
    if (!clean) return NULL;
    size_t used = 0;
    while (*text) {
        size_t length = text_utf8_length(text);
        memcpy(clean + used, length ? text : REPLACEMENT, length ? length : 3);
        used += length ? length : 3;
        text += length ? length : 1;
    }
    json_t *string = json_stringn(clean, used);
    free(clean);
    return string;
}
