// References state their scene and view in attributes (tracing.c), bakes in the metadata of their
// safetensors header (docs/cli.md).
#include "cache_content.h"
#include "cli/options/option_text.h"

#include <afterglow/image.h>

#include <jansson.h>

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The scene as options would name it.
static void set_scene(const char *name, const char *scale, struct cache_content *out)
{
    snprintf(out->scene, CACHE_TEXT, "%.400s%s%.32s", name, scale[0] ? " --scene-scale " : "",
             scale);
}

// ---- references

static const char *attribute(struct ag_context *context, const char *path, const char *name,
                             char out[CACHE_TEXT])
{
    if (ag_image_read_attribute(context, path, name, out, CACHE_TEXT) != AG_OK) out[0] = 0;
    return out;
}

static void describe_reference(struct ag_context *context, const char *path,
                               struct cache_content *out)
{
    static const char SCALE[] = " scene-scale=";
    char camera[CACHE_TEXT], size[CACHE_TEXT], bounces[CACHE_TEXT], light[CACHE_TEXT];
    char scene[CACHE_TEXT], options[CACHE_TEXT];
    attribute(context, path, "afterglow.scene", scene);
    if (!scene[0]) return;
    const char *scale = strstr(attribute(context, path, "afterglow.options", options), SCALE);
    set_scene(scene, scale ? scale + sizeof SCALE - 1 : "", out);
    attribute(context, path, "afterglow.light", light);
    snprintf(out->technique, CACHE_TEXT, "%s", CACHE_PATH_TRACING);
    snprintf(out->options, CACHE_TEXT, "%.32s, %.128s, %.32s bounces%s%.192s",
             attribute(context, path, "afterglow.size", size),
             attribute(context, path, "afterglow.camera", camera),
             attribute(context, path, "afterglow.bounces", bounces),
             strcmp(light, "that of the scene") == 0 ? "" : ", ",
             strcmp(light, "that of the scene") == 0 ? "" : light);
}

// ---- bakes

// The "__metadata__" of a safetensors file; NULL where there is none. The caller releases it.
static json_t *read_metadata(const char *path)
{
    enum { MAX_HEADER = 16 << 20 };
    uint64_t length = 0;
    json_t *metadata = NULL;
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    const bool known = fread(&length, sizeof length, 1, file) == 1 && length <= MAX_HEADER;
    char *text = known ? malloc((size_t)length + 1) : NULL;
    if (text && fread(text, 1, (size_t)length, file) == length) {
        json_t *header = json_loadb(text, (size_t)length, 0, NULL);
        metadata = json_incref(json_object_get(header, "__metadata__"));
        json_decref(header);
    }
    free(text);
    fclose(file);
    return metadata;
}

static const char *text_of(const json_t *metadata, const char *key)
{
    const char *text = json_string_value(json_object_get(metadata, key));
    return text ? text : "";
}

static void describe_bake(const char *path, struct cache_content *out)
{
    json_t *metadata = read_metadata(path);
    const char *technique = text_of(metadata, "afterglow.technique");
    set_scene(text_of(metadata, "afterglow.scene_name"), text_of(metadata, "afterglow.scene_scale"),
              out);
    snprintf(out->technique, CACHE_TEXT, "%.*s", CACHE_TEXT - 1, technique);
    snprintf(out->options, CACHE_TEXT, "%.*s", CACHE_TEXT - 1,
             text_of(metadata, "afterglow.options"));
    json_decref(metadata);
}

// ---- defaults

// Whether "key=value" is the technique's default.
static bool is_default(int technique, const char *pair, int length)
{
    struct ag_option_info option;
    char expected[CACHE_TEXT], value[64];
    for (int k = 0; ag_technique_option_get(technique, k, &option); k++) {
        snprintf(expected, sizeof expected, "%s=%s", option.name, option_default(&option, value));
        if ((int)strlen(expected) == length && memcmp(expected, pair, (size_t)length) == 0)
            return true;
    }
    return false;
}

static int find_technique(const char *name)
{
    struct ag_technique_info info;
    int i = 0;
    while (ag_technique_get(i, &info) && strcmp(info.name, name) != 0) i++;
    return i;
}

void cache_set_options(const struct cache_content *content, char out[CACHE_TEXT])
{
    const int technique = find_technique(content->technique);
    size_t used = 0;
    out[0] = 0;
    for (const char *pair = content->options; pair[0];) {
        const size_t length = strcspn(pair, ",");
        if (!is_default(technique, pair, (int)length) && used < CACHE_TEXT)
            used += (size_t)snprintf(out + used, CACHE_TEXT - used, "%s%.*s", used ? "," : "",
                                     (int)length, pair);
        pair += length + (pair[length] == ',');
    }
}

void cache_describe(struct ag_context *context, const struct cache_entry *entry,
                    struct cache_content *out)
{
    *out = (struct cache_content){ 0 };
    if (entry->left_over) return;
    if (entry->kind == CACHE_REFERENCE)
        describe_reference(context, entry->path, out);
    else
        describe_bake(entry->path, out);
}
