// Bakes of techniques: the identity from their options, the plan from their `bake`.
#include "techniques/gi_bake.h"

enum { VALUE_SIZE = 64 };

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

char *gi_bake_options(struct host *host, const struct technique *technique, const void *options)
{
    char *text = host_strdup(host, "");
    for (size_t i = 0; text && i < technique->options.count; i++) {
        const struct option_row *row = &technique->options.rows[i];
        char value[VALUE_SIZE];
        if (row->effect != REBAKE) continue;
        option_print(row, options, value, sizeof value);
        char *longer = host_sprintf(host, "%s%s%s=%s", text, text[0] ? "," : "", row->name, value);
        host_free(host, text);
        text = longer;
    }
    return text;
}

struct bake *gi_bake_create(struct host *host, const struct technique *technique,
                            const struct technique_bake *how, struct bake_identity identity)
{
    char *options = gi_bake_options(host, technique, how->options);
    identity.technique = technique->name;
    identity.version = technique->bake_version;
    identity.options = options;
    struct bake *bake = options ? bake_create(host, &identity) : NULL;
    host_free(host, options);
    if (!bake || technique->bake(bake_plan_of(bake), how)) return bake;
    bake_destroy(bake);
    return NULL;
}

static bool bake_term(struct gi_baked *out, struct host *host, const struct gi_spec *spec,
                      const struct scene_pose *pose, int i)
{
    const struct bake_run_options options = { .threads = 0 };
    const struct bake_identity identity = { .program = "" };
    out->how[i] = (struct technique_bake){ .pose = pose, .options = spec->options[i] };
    out->owned[i] = gi_bake_create(host, spec->technique[i], &out->how[i], identity);
    if (!out->owned[i] || !bake_run(out->owned[i], &options)) return false;
    out->bakes.of_term[i] = bake_tensors(out->owned[i]);
    return true;
}

bool gi_bake_all(struct gi_baked *out, struct host *host, const struct gi_spec *spec,
                 const struct scene_pose *pose)
{
    *out = (struct gi_baked){ .owned = { NULL } };
    for (int i = 0; i < spec->count; i++)
        if (spec->technique[i]->bake_version != 0 && !bake_term(out, host, spec, pose, i))
            return false;
    return true;
}

void gi_baked_finish(struct gi_baked *baked)
{
    for (int i = 0; i < GI_MAX_TERMS; i++) bake_destroy(baked->owned[i]);
    *baked = (struct gi_baked){ .owned = { NULL } };
}
