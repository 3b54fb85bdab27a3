// JSON values of a glTF file, with type and range checks.
#include "scene/import/gltf/gltf.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

struct gltf_object gltf_element(struct gltf *gltf, json_t *array, const char *kind, size_t i)
{
    struct gltf_object object = { gltf, json_array_get(array, i), kind, i };
    if (!json_is_object(object.json)) {
        gltf_wrong(object, "is not an object");
        object.json = NULL;
    }
    return object;
}

struct gltf_object gltf_child(struct gltf_object object, const char *key)
{
    struct gltf_object child = object;
    child.json = json_object_get(object.json, key);
    if (child.json && !json_is_object(child.json)) {
        gltf_wrong(object, "%s is not an object", key);
        child.json = NULL;
    }
    return child;
}

struct gltf_object gltf_extension(struct gltf_object object, const char *name)
{
    return gltf_child(gltf_child(object, "extensions"), name);
}

bool gltf_has(struct gltf_object object, const char *key)
{
    return json_object_get(object.json, key) != NULL;
}

bool gltf_set_wrong(struct gltf_object object, const char *format, ...)
{
    struct gltf *gltf = object.gltf;
    if (gltf->failed) return false;
    gltf->failed = true;
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return host_fail(gltf->import->host, FAIL_FORMAT, "%s: %s %zu: %s", gltf->import->path,
                     object.kind, object.index, text);
}

json_t *gltf_array(struct gltf_object object, const char *key)
{
    json_t *array = json_object_get(object.json, key);
    if (array && !json_is_array(array)) {
        gltf_wrong(object, "%s is not an array", key);
        array = NULL;
    }
    return array ? array : object.gltf->empty;
}

int gltf_index_value(struct gltf_object object, const char *key, json_t *value, json_t *of)
{
    if (!json_is_integer(value)) {
        gltf_wrong(object, "%s is not an index", key);
        return -1;
    }
    json_int_t i = json_integer_value(value);
    if (i < 0 || i >= INT_MAX || (size_t)i >= json_array_size(of)) {
        gltf_wrong(object, "%s %lld does not exist; there are %zu", key, (long long)i,
                   json_array_size(of));
        return -1;
    }
    return (int)i;
}

int gltf_index(struct gltf_object object, const char *key, json_t *of)
{
    json_t *value = json_object_get(object.json, key);
    return value ? gltf_index_value(object, key, value, of) : -1;
}

size_t gltf_size(struct gltf_object object, const char *key, size_t fallback, size_t max)
{
    json_t *value = json_object_get(object.json, key);
    if (!value) return fallback;
    json_int_t n = json_integer_value(value);
    // Some exporters write integers as 3.0.
    if (json_is_real(value)) {
        double real = json_real_value(value);
        n = real >= 0.0 && real < 9e15 && floor(real) == real ? (json_int_t)real : -1;
    }
    if (!json_is_number(value) || n < 0 || (unsigned long long)n > max) {
        gltf_wrong(object, "%s is not an integer from 0 to %zu", key, max);
        return fallback;
    }
    return (size_t)n;
}

float gltf_float(struct gltf_object object, const char *key, float fallback, float min, float max)
{
    json_t *value = json_object_get(object.json, key);
    if (!value) return fallback;
    double number = json_number_value(value);
    if (!json_is_number(value) || !(number >= (double)min && number <= (double)max)) {
        gltf_wrong(object, "%s is not a number from %g to %g", key, (double)min, (double)max);
        return fallback;
    }
    return (float)number;
}

bool gltf_bool(struct gltf_object object, const char *key, bool fallback)
{
    json_t *value = json_object_get(object.json, key);
    if (!value) return fallback;
    if (!json_is_boolean(value)) {
        gltf_wrong(object, "%s is not a boolean", key);
        return fallback;
    }
    return json_is_true(value);
}

bool gltf_floats(struct gltf_object object, const char *key, int count, float *out)
{
    json_t *value = json_object_get(object.json, key);
    if (!value) return false;
    if (!json_is_array(value) || json_array_size(value) != (size_t)count) {
        return gltf_wrong(object, "%s is not an array of %d numbers", key, count);
    }
    for (int i = 0; i < count; i++) {
        json_t *element = json_array_get(value, (size_t)i);
        float number = (float)json_number_value(element);
        if (!json_is_number(element) || !isfinite(number)) {
            return gltf_wrong(object, "%s[%d] is not a number", key, i);
        }
        out[i] = number;
    }
    return true;
}

const char *gltf_string(struct gltf_object object, const char *key)
{
    json_t *value = json_object_get(object.json, key);
    if (!value) return NULL;
    if (!json_is_string(value)) {
        gltf_wrong(object, "%s is not a string", key);
        return NULL;
    }
    return json_string_value(value);
}
