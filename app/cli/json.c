// JSON out.
#include "json.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const size_t JSON_FLAGS = JSON_INDENT(2) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(12);

json_t *json_double(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_float(float value)
{
    char text[64];
    if (!isfinite(value)) return json_null();
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) break;
    }
    return json_real(strtod(text, NULL));
}

json_t *json_floats(const float *values, int count)
{
    json_t *array = json_array();
    for (int i = 0; array && i < count; i++) json_array_append_new(array, json_float(values[i]));
    return array;
}

enum status json_print(json_t *document)
{
    if (!document) return fail("cannot write JSON on standard output: out of memory");
    bool ok = json_dumpf(document, stdout, JSON_FLAGS) == 0 && putchar('\n') != EOF;
    json_decref(document);
    return ok ? DONE : fail("cannot write standard output: %s", strerror(errno));
}

enum status json_write(const json_t *document, const char *path)
{
    if (!document) return fail("cannot write %s: out of memory", path);
    size_t size = strlen(path) + 32;
    char *beside = malloc(size);
    if (!beside) return fail("cannot write %s: out of memory", path);
    snprintf(beside, size, "%s.tmp-%ld", path, (long)getpid());
    FILE *file = fopen(beside, "wxe");
    bool ok = file != NULL;
    if (ok) ok = json_dumpf(document, file, JSON_FLAGS) == 0 && fputc('\n', file) != EOF;
    if (file && fclose(file) != 0) ok = false;
    if (ok) ok = rename(beside, path) == 0;
    int why = errno;
    if (!ok && file) unlink(beside);
    free(beside);
    return ok ? DONE : fail("cannot write %s: %s", path, strerror(why));
}
