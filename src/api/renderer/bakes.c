// The bakes of a renderer: those of its description, or files of the folder that the host names.
#include "api/renderer/bakes.h"

#include "api/bake_state.h"
#include "techniques/gi_bake.h"

#include <string.h>
#include <unistd.h>

static bool same_bake(const struct technique *a, const struct technique *b)
{
    return strcmp(gi_bake_name(a), gi_bake_name(b)) == 0;
}

static const struct bake *find_given(const struct ag_renderer_desc *desc, const struct bake *wanted,
                                     const struct technique *technique, bool *of_technique)
{
    for (int i = 0; i < desc->bake_count; i++) {
        const struct ag_bake *given = desc->bakes[i];
        if (!given || api_bake_is_reference(given) ||
            !same_bake(given->spec.technique[given->term], technique))
            continue;
        *of_technique = true;
        if (bake_is_complete(given->bake) && bake_fits(given->bake, wanted)) return given->bake;
    }
    return NULL;
}

static bool load_part(struct host *host, const char *folder, struct bake *bake, int part)
{
    char key[HASH128_TEXT];
    bake_part_key(bake, part, key);
    char *path = host_sprintf(host, "%s/%s.safetensors", folder, key);
    const bool ok = path && access(path, R_OK) == 0 && bake_load_part(bake, part, path);
    host_free(host, path);
    return ok;
}

static bool load_from_folder(struct host *host, const char *folder, struct bake *bake)
{
    bool ok = folder != NULL;
    for (int part = 0; ok && part < bake_part_count(bake); part++)
        ok = load_part(host, folder, bake, part);
    return ok;
}

static bool fail_missing(struct host *host, const struct ag_renderer_desc *desc,
                         const char *technique, bool of_technique)
{
    if (of_technique)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot use the bake of %s: it is incomplete, or of other options or "
                         "another scene",
                         technique);
    if (desc->bake_folder)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot use %s: %s has no bake for these options and scene; bake it first",
                         technique, desc->bake_folder);
    return host_fail(host, FAIL_ARGUMENT, "cannot use %s: it needs a bake; bake it first",
                     technique);
}

// may_lack: the technique goes on with the bake that it has.
static bool find_one(struct renderer_bakes *bakes, struct host *host,
                     const struct ag_renderer_desc *desc, const struct gi_spec *spec,
                     const struct scene_pose *pose, int term, bool may_lack)
{
    const struct technique *technique = spec->technique[term];
    bakes->how[term] = (struct technique_bake){ .pose = pose, .options = spec->options[term] };
    const struct bake_identity identity = { .program = api_program() };
    struct bake *wanted = gi_bake_create(host, technique, &bakes->how[term], identity);
    bakes->own[term] = wanted;
    if (!wanted) return false;
    bool of_technique = false;
    const struct bake *given = find_given(desc, wanted, technique, &of_technique);
    if (!given && !of_technique && load_from_folder(host, desc->bake_folder, wanted))
        given = wanted;
    if (!given) return may_lack || fail_missing(host, desc, technique->name, of_technique);
    bakes->found.of_term[term] = bake_tensors(given);
    return true;
}

bool renderer_bakes_find(struct renderer_bakes *bakes, struct host *host,
                         const struct ag_renderer_desc *desc, const struct gi_spec *spec,
                         const struct gi *running, const struct scene_pose *pose)
{
    for (int i = 0; i < spec->count; i++) {
        const int from = running ? gi_continues(running, spec, i) : -1;
        if (spec->technique[i]->bake_version != 0 && (from < 0 || gi_lacks_bake(running, from)) &&
            !find_one(bakes, host, desc, spec, pose, i, from >= 0))
            return false;
    }
    return true;
}

enum ag_result renderer_bakes_check(const char *function, struct ag_context *context,
                                    const struct ag_bake *const *bakes, int count)
{
    AG_REQUIRE_FOR(function, context, count >= 0 && (bakes || count == 0),
                   "bake_count %d does not fit bakes", count);
    return AG_OK;
}

void renderer_bakes_finish(struct renderer_bakes *bakes)
{
    for (int i = 0; i < GI_MAX_TERMS; i++) bake_destroy(bakes->own[i]);
}
