// The identity of a bake in the metadata of its files, and a hash of the whole content. Numbers are
// those of the C locale, so that a file serves in every one.
#include "bake/bake_state.h"

#include "core/c_locale.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char KIND[] = "afterglow.kind", TECHNIQUE[] = "afterglow.technique",
                  VERSION[] = "afterglow.bake_version", OPTIONS[] = "afterglow.options",
                  SCENE[] = "afterglow.scene", SEED[] = "afterglow.seed",
                  PROGRAM[] = "afterglow.program", SECONDS[] = "afterglow.seconds",
                  STAGE_SECONDS[] = "afterglow.stage_seconds", GI[] = "afterglow.gi",
                  SCENE_NAME[] = "afterglow.scene_name", SCENE_SCALE[] = "afterglow.scene_scale";
static const char PARTIAL[] = "partial", ANY_SCENE[] = "any";

// ---- metadata

static void add_metadata(struct identity_text *text, const char *key, const char *value)
{
    text->metadata[text->count++] = (struct tensor_metadata){ key, value };
}

static void add_scene(struct identity_text *text, const struct bake_identity *id)
{
    if (id->scene_name) add_metadata(text, SCENE_NAME, id->scene_name);
    if (!(id->scene_scale > 0.0f) || id->scene_scale == 1.0f) return;
    c_locale_print(text->scale, sizeof text->scale, "%.9g", (double)id->scene_scale);
    add_metadata(text, SCENE_SCALE, text->scale);
}

void identity_print(const struct bake *bake, const char *kind, double seconds,
                    struct identity_text *out)
{
    const struct bake_identity *id = &bake->identity;
    *out = (struct identity_text){ 0 };
    snprintf(out->version, sizeof out->version, "%d", id->version);
    snprintf(out->seed, sizeof out->seed, "%" PRIu64, id->seed);
    snprintf(out->scene, sizeof out->scene, "%s", ANY_SCENE);
    if (bake->plan.depends_on_scene) hash128_print(bake->plan.scene, out->scene);
    add_metadata(out, KIND, kind);
    add_metadata(out, TECHNIQUE, id->technique);
    add_metadata(out, VERSION, out->version);
    add_metadata(out, OPTIONS, id->options);
    add_metadata(out, SCENE, out->scene);
    add_metadata(out, SEED, out->seed);
    add_metadata(out, PROGRAM, id->program);
    if (strcmp(kind, PARTIAL) == 0 && id->gi) add_metadata(out, GI, id->gi);
    if (strcmp(kind, PARTIAL) == 0) add_scene(out, id);
    if (isnan(seconds)) return;
    c_locale_print(out->seconds, sizeof out->seconds, "%.3f", seconds);
    add_metadata(out, SECONDS, out->seconds);
}

void identity_print_part(const struct bake *bake, int part, double seconds,
                         struct identity_text *out)
{
    identity_print(bake, IDENTITY_BAKE, seconds, out);
    hash128_print(bake->plan.parts[part - 1].key, out->scene);
}

void identity_key(const struct identity_text *text, char out[HASH128_TEXT])
{
    struct hash128 key = { 0 };
    for (size_t i = 0; i < text->count; i++)
        if (strcmp(text->metadata[i].key, PROGRAM) != 0)
            key = hash128_add_text(hash128_add_text(key, text->metadata[i].key),
                                   text->metadata[i].value);
    hash128_print(key, out);
}

void bake_key(const struct bake *bake, char out[HASH128_TEXT])
{
    struct identity_text text;
    identity_print(bake, IDENTITY_BAKE, (double)NAN, &text);
    identity_key(&text, out);
}

bool identity_write(struct host *host, const char *path, struct identity_text *text,
                    const struct tensor *at, size_t count)
{
    struct tensors set = { at, count, text->metadata, text->count };
    hash128_print(tensors_content(&set), text->content);
    add_metadata(text, TENSORS_CONTENT, text->content);
    set.metadata_count = text->count;
    return safetensors_write(host, path, &set);
}

// ---- checks

bool identity_fail(struct host *host, const char *path, const char *why)
{
    return host_fail(host, FAIL_FORMAT, "cannot use %s: %s", path, why);
}

static bool differs(const struct tensors *set, const char *key, const char *wanted)
{
    const char *value = tensors_metadata(set, key);
    return !value || strcmp(value, wanted) != 0;
}

static bool fail_value(struct host *host, const char *path, const char *what,
                       const struct tensors *set, const char *key, const char *wanted)
{
    const char *value = tensors_metadata(set, key);
    return host_fail(host, FAIL_FORMAT, "cannot use %s: its %s is %.200s, not %.200s", path, what,
                     value ? value : "not stated", wanted);
}

static bool fail_options(struct host *host, const char *path, const struct tensors *set,
                         const char *wanted)
{
    char differences[600];
    const char *value = tensors_metadata(set, OPTIONS);
    if (!value) return identity_fail(host, path, "it does not state its options");
    option_differences(value, wanted, differences, sizeof differences);
    if (!differences[0]) return identity_fail(host, path, "its list of options is wrong");
    return host_fail(host, FAIL_FORMAT, "cannot use %s: it has other options: %s", path,
                     differences);
}

bool identity_check(struct host *host, const struct bake *bake, const char *kind, const char *path,
                    const struct tensors *set)
{
    struct identity_text text;
    identity_print(bake, kind, (double)NAN, &text);
    if (!tensors_metadata(set, KIND))
        return identity_fail(host, path, "it is not a bake of this program");
    if (differs(set, KIND, kind)) return fail_value(host, path, "kind", set, KIND, kind);
    if (differs(set, TECHNIQUE, bake->identity.technique))
        return fail_value(host, path, "technique", set, TECHNIQUE, bake->identity.technique);
    if (differs(set, VERSION, text.version))
        return fail_value(host, path, "bake version", set, VERSION, text.version);
    if (differs(set, OPTIONS, bake->identity.options))
        return fail_options(host, path, set, bake->identity.options);
    // Parts are found by their tensors, in a bake of any scene.
    const bool of_parts = bake->plan.part_count > 0 && strcmp(kind, IDENTITY_BAKE) == 0;
    if (!of_parts && differs(set, SCENE, text.scene))
        return identity_fail(host, path,
                             bake->identity.of_light ? "it is of another scene or of other light"
                                                     : "it is of another scene");
    // Partial results of two seeds are no bake of either.
    if (strcmp(kind, IDENTITY_BAKE) != 0 && differs(set, SEED, text.seed))
        return fail_value(host, path, "seed", set, SEED, text.seed);
    return tensors_check_content(host, path, set);
}

double identity_seconds(const struct tensors *set)
{
    const char *text = tensors_metadata(set, SECONDS);
    char *end = NULL;
    const double seconds = text ? c_locale_parse(text, &end) : (double)NAN;
    return text && *end == 0 && seconds >= 0.0 && isfinite(seconds) ? seconds : (double)NAN;
}

// ---- seconds by stage, as "name=1.25;name=…"

// In the arena of the plan; NULL: out of memory.
static const char *print_stage_seconds(struct bake *bake, int part)
{
    enum { NUMBER = 32 };
    const struct bake_plan *plan = &bake->plan;
    size_t size = 1, used = 0;
    for (int s = 0; s < plan->stage_count; s++) size += strlen(plan->stages[s].what.name) + NUMBER;
    char *text = arena_alloc(&bake->plan.arena, size, 1);
    for (int s = 0; text && s < plan->stage_count; s++)
        if (part == 0 || plan->stages[s].what.part == part)
            used +=
                (size_t)c_locale_print(text + used, size - used, "%s%s=%.4g", used > 0 ? ";" : "",
                                       plan->stages[s].what.name, plan->stages[s].seconds);
    return text;
}

// NaN: not stated.
static double parse_stage_seconds(const char *text, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = text; at; at = strchr(at, ';'), at = at ? at + 1 : NULL) {
        if (strncmp(at, name, length) != 0 || at[length] != '=') continue;
        const double seconds = c_locale_parse(at + length + 1, NULL);
        return seconds >= 0.0 && isfinite(seconds) ? seconds : (double)NAN;
    }
    return (double)NAN;
}

double identity_stage_seconds(const struct tensors *set, const char *stage)
{
    return parse_stage_seconds(tensors_metadata(set, STAGE_SECONDS), stage);
}

// Seconds are known after a run, not after reading a file without them.
bool identity_add_run(struct bake *bake, int part, struct identity_text *text)
{
    add_scene(text, &bake->identity);
    if (isnan(bake->seconds)) return true;
    const char *stages = print_stage_seconds(bake, part);
    if (stages) add_metadata(text, STAGE_SECONDS, stages);
    return stages != NULL;
}

// ---- what a file is of

bool bake_file_technique(struct host *host, const char *path, char *out, size_t size)
{
    struct safetensors file;
    if (!safetensors_read(host, path, &file)) return false;
    const char *name = tensors_metadata(&file.set, TECHNIQUE);
    if (name) snprintf(out, size, "%s", name);
    safetensors_finish(host, &file);
    return name || identity_fail(host, path, "it is not a bake of this program");
}

// 1 in a file without the entry, NaN for a text that is no number.
static float scale_of(const struct tensors *set)
{
    const char *text = tensors_metadata(set, SCENE_SCALE);
    char *end = NULL;
    if (!text) return 1.0f;
    const float scale = (float)c_locale_parse(text, &end);
    return end != text && *end == 0 ? scale : NAN;
}

static bool read_origin(struct host *host, const char *path, const struct tensors *set,
                        struct bake_origin *out)
{
    const char *gi = tensors_metadata(set, GI), *name = tensors_metadata(set, SCENE_NAME);
    const char *seed = tensors_metadata(set, SEED), *options = tensors_metadata(set, OPTIONS);
    const char *technique = tensors_metadata(set, TECHNIQUE);
    if (differs(set, KIND, PARTIAL) || !gi || !name || !seed || !options || !technique)
        return identity_fail(host, path, "it is not part of a bake, as --shard writes it");
    out->technique = host_strdup(host, technique);
    out->options = host_strdup(host, options);
    out->gi = host_strdup(host, gi);
    out->scene_name = host_strdup(host, name);
    out->seed = strtoull(seed, NULL, 10);
    out->scene_scale = scale_of(set);
    return out->technique && out->options && out->gi && out->scene_name;
}

void bake_origin_finish(struct host *host, struct bake_origin *origin)
{
    host_free(host, origin->technique);
    host_free(host, origin->options);
    host_free(host, origin->gi);
    host_free(host, origin->scene_name);
    *origin = (struct bake_origin){ 0 };
}

bool bake_partial_origin(struct host *host, const char *path, struct bake_origin *out)
{
    struct safetensors file;
    *out = (struct bake_origin){ 0 };
    if (!safetensors_read(host, path, &file)) return false;
    const bool ok = read_origin(host, path, &file.set, out);
    safetensors_finish(host, &file);
    if (!ok) bake_origin_finish(host, out);
    return ok;
}
