#include "techniques/gi_baked.h"

#include "techniques/kept_bake.h"

static bool bake_term(struct gi_baked *out, struct host *host, const struct gi_spec *spec,
                      const struct scene_pose *pose, int i)
{
    const struct bake_identity identity = { .program = "" };
    out->how[i] = (struct technique_bake){ .pose = pose, .options = spec->options[i] };
    out->owned[i] = gi_bake_create(host, spec->technique[i], &out->how[i], identity);
    if (!out->owned[i] || !kept_bake_run(out->owned[i])) return false;
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

struct gi *gi_create(struct host *host, struct gpu *gpu, const struct gi_spec *spec,
                     const struct scene_pose *pose, uint32_t width, uint32_t height)
{
    const struct gi_bakes none = { { NULL } };
    return gi_create_baked(host, gpu, spec, &none, pose, width, height);
}
