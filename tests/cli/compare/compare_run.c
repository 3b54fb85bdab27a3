#include "cli/compare/compare_run.h"

#include "image/exr.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *path_in(const char *folder, const char *name)
{
    static char paths[8][600];
    static int next;
    char path[600];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        fail_msg("too long: %s", path);
    return memcpy(paths[next++ % 8], path, sizeof path);
}

const char *own_cache(const char *name)
{
    static char folder[600];
    setenv("AFTERGLOW_CACHE", path_of(name), 1);
    snprintf(folder, sizeof folder, "%s/references", getenv("AFTERGLOW_CACHE"));
    return folder;
}

json_t *report_of(const char *folder)
{
    json_error_t error;
    json_t *report = json_load_file(path_in(folder, "report.json"), 0, &error);
    if (!report) fail_msg("%s/report.json, line %d: %s", folder, error.line, error.text);
    return report;
}

json_t *method_of(const json_t *report, size_t index)
{
    return json_array_get(json_object_get(report, "methods"), index);
}

double number_of(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value)) fail_msg("no number %s", key);
    return json_number_value(value);
}

double of_reference(const json_t *report, const char *key)
{
    return number_of(json_object_get(report, "reference"), key);
}

struct image read_layer(const char *path, const char *layer)
{
    struct image image = { 0 };
    if (!exr_read(test_host(), path, layer, &image)) fail_msg("%s", test_last_message());
    return image;
}

void check_equal_numbers(const json_t *a, const json_t *b)
{
    static const char *const keys[] = { "relmse", "flip", "mae", "ssim", "energy", "flip_hdr" };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        CHECK(number_of(a, keys[i]) == number_of(b, keys[i]));
    CHECK(json_equal(json_object_get(a, "indirect"), json_object_get(b, "indirect")));
    CHECK(json_equal(json_object_get(a, "options"), json_object_get(b, "options")));
}
