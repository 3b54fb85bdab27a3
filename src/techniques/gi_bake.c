// Bakes of techniques: the identity from their options, the plan from their `bake`.
#include "techniques/gi_bake.h"

#include <string.h>

int gi_spec_bakes(const struct gi_spec *spec, int index, int *term)
{
    int count = 0;
    *term = -1;
    for (int i = 0; i < spec->count; i++) {
        if (spec->technique[i]->bake_version == 0) continue;
        if (count++ == index) *term = i;
    }
    return count;
}

const char *gi_bake_name(const struct technique *technique)
{
    return technique->bake_name ? technique->bake_name : technique->name;
}

char *gi_bake_options(struct host *host, const struct technique *technique, const void *options)
{
    char *text = host_strdup(host, "");
    for (size_t i = 0; text && i < technique->options.count; i++) {
        const struct option_row *row = &technique->options.rows[i];
        char value[OPTION_VALUE_SIZE];
        if (row->effect != REBAKE) continue;
        option_print(row, options, value, sizeof value);
        char *longer = host_sprintf(host, "%s%s%s=%s", text, text[0] ? "," : "", row->name, value);
        host_free(host, text);
        text = longer;
    }
    return text;
}

bool gi_bake_resolve(struct host *host, const struct technique *technique,
                     const struct scene_pose *pose, void *options)
{
    return !technique->resolve || technique->resolve(host, pose, options);
}

// Stages may refer to `how` and its options: the bake keeps them.
static bool add_stages(struct bake *bake, const struct technique *technique,
                       const struct technique_bake *how)
{
    const size_t size = technique->options.size;
    struct bake_plan *plan = bake_plan_of(bake);
    struct technique_bake *kept = bake_plan_alloc(plan, 1, sizeof *kept);
    void *options = bake_plan_alloc(plan, 1, size ? size : 1);
    if (!kept || !options) return false;
    if (size > 0) memcpy(options, how->options, size);
    *kept = *how;
    kept->options = options;
    return technique->bake(plan, kept);
}

static struct bake *create_resolved(struct host *host, const struct technique *technique,
                                    const struct technique_bake *how, struct bake_identity identity)
{
    char *options = gi_bake_options(host, technique, how->options);
    identity.technique = gi_bake_name(technique);
    identity.version = technique->bake_version;
    identity.options = options;
    struct bake *bake = options ? bake_create(host, &identity) : NULL;
    host_free(host, options);
    if (!bake || add_stages(bake, technique, how)) return bake;
    bake_destroy(bake);
    return NULL;
}

struct bake *gi_bake_create(struct host *host, const struct technique *technique,
                            const struct technique_bake *how, struct bake_identity identity)
{
    const size_t size = technique->options.size;
    struct technique_bake resolved = *how;
    void *options = host_alloc(host, 1, size ? size : 1);
    if (!options) return NULL;
    if (size > 0) memcpy(options, how->options, size);
    resolved.options = options;
    const bool ok = gi_bake_resolve(host, technique, how->pose, options);
    struct bake *bake = ok ? create_resolved(host, technique, &resolved, identity) : NULL;
    host_free(host, options);
    return bake;
}
