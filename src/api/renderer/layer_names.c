// Former names of reference layers.
#include "api/objects.h"

#include "image/exr.h"

#include <string.h>

struct layer_alias {
    const char *old_name, *name;
};

static const struct layer_alias layer_aliases[] = {
    { "gathered", "indirect_emitters_sky" },
    { "gathered_irradiance", "irradiance_emitters_sky" },
};

// By either name; NULL for a layer that was not renamed.
static const struct layer_alias *find_alias(const char *name)
{
    for (size_t i = 0; i < sizeof layer_aliases / sizeof layer_aliases[0]; i++)
        if (strcmp(layer_aliases[i].old_name, name) == 0 ||
            strcmp(layer_aliases[i].name, name) == 0)
            return &layer_aliases[i];
    return NULL;
}

static void warn_once(struct ag_context *context, const struct layer_alias *alias, const char *path)
{
    if (context->warned_layer_name) return;
    context->warned_layer_name = true;
    host_log(&context->host, LOG_WARNING,
             "%s%slayer %s is now %s; the old name will be removed in the next release",
             path ? path : "", path ? ": " : "", alias->old_name, alias->name);
}

const char *api_layer_name(struct ag_context *context, const char *name)
{
    const struct layer_alias *alias = find_alias(name);
    if (!alias || strcmp(alias->name, name) == 0) return name;
    warn_once(context, alias, NULL);
    return alias->name;
}

static bool has_layer(struct host *host, const char *path, const char *layer)
{
    char *names = exr_layer_names(host, path), *rest = names;
    bool has = false;
    for (const char *name; rest && (name = strsep(&rest, "\n"));) has |= strcmp(name, layer) == 0;
    host_free(host, names);
    return has;
}

bool api_read_layer(struct ag_context *context, const char *path, const char *layer,
                    struct image *out)
{
    struct host *host = &context->host;
    const struct layer_alias *alias = layer ? find_alias(layer) : NULL;
    if (!alias) return exr_read(host, path, layer, out);
    layer = api_layer_name(context, layer);
    if (has_layer(host, path, alias->old_name) && !has_layer(host, path, layer)) {
        warn_once(context, alias, path);
        layer = alias->old_name;
    }
    return exr_read(host, path, layer, out);
}
