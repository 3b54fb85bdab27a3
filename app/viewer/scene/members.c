#include "members.h"

#include "viewer/operations.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool member_wrong(struct members *m, const char *format, ...)
{
    char text[700];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    viewer_warn(m->v, "cannot use %s: %s%s%s", m->path, m->where, m->where[0] ? ": " : "", text);
    return false;
}

bool member_known(struct members *m, json_t *object, const char *const *names, int count)
{
    const char *name;
    json_t *value;
    if (!json_is_object(object)) return member_wrong(m, "an object is expected");
    json_object_foreach(object, name, value)
    {
        bool found = false;
        for (int i = 0; i < count; i++) found |= strcmp(names[i], name) == 0;
        if (found) continue;
        const char *nearest = ag_nearest_name(name, names, count);
        return member_wrong(m, "unknown member %.100s%s%s%s", name,
                            nearest ? ": did you mean " : "", nearest ? nearest : "",
                            nearest ? "?" : "");
    }
    return true;
}

bool member_number(struct members *m, json_t *object, const char *name, double least, double most,
                   double *out)
{
    const json_t *value = json_object_get(object, name);
    if (!value) return true;
    if (!json_is_number(value) || !(json_number_value(value) >= least) ||
        !(json_number_value(value) <= most))
        return member_wrong(m, "%s is a number, %g to %g", name, least, most);
    *out = json_number_value(value);
    return true;
}

bool member_float(struct members *m, json_t *object, const char *name, float least, float most,
                  float *out)
{
    double value = (double)*out;
    if (!member_number(m, object, name, (double)least, (double)most, &value)) return false;
    *out = (float)value;
    return true;
}

bool member_integer(struct members *m, json_t *object, const char *name, int least, int most,
                    int *out)
{
    double value = *out;
    if (!member_number(m, object, name, least, most, &value)) return false;
    if (value != floor(value)) return member_wrong(m, "%s is an integer", name);
    *out = (int)value;
    return true;
}

bool member_floats(struct members *m, json_t *object, const char *name, float least, int count,
                   float *out)
{
    const json_t *array = json_object_get(object, name);
    if (!array) return true;
    bool right = json_is_array(array) && json_array_size(array) == (size_t)count;
    for (int i = 0; right && i < count; i++) {
        const json_t *value = json_array_get(array, (size_t)i);
        right = json_is_number(value) && json_number_value(value) >= (double)least &&
                json_number_value(value) <= 1e30;
        if (right) out[i] = (float)json_number_value(value);
    }
    return right ||
           member_wrong(m, "%s is an array of %d numbers, at least %g", name, count, (double)least);
}

bool member_boolean(struct members *m, json_t *object, const char *name, bool *out)
{
    const json_t *value = json_object_get(object, name);
    if (!value) return true;
    if (!json_is_boolean(value)) return member_wrong(m, "%s is true or false", name);
    *out = json_is_true(value);
    return true;
}

bool member_text(struct members *m, json_t *object, const char *name, const char **out)
{
    const json_t *value = json_object_get(object, name);
    if (!value) return true;
    if (!json_is_string(value) && !json_is_null(value))
        return member_wrong(m, "%s is a text", name);
    *out = json_is_null(value) ? NULL : json_string_value(value);
    return true;
}

bool member_list(struct members *m, json_t *object, const char *name, size_t most)
{
    const json_t *value = json_object_get(object, name);
    if (!value || (json_is_array(value) && json_array_size(value) <= most)) return true;
    return member_wrong(m, "%s is an array of at most %zu", name, most);
}
