// Setters of the options, and the table of options.def.
#include "option_table.h"
#include "cli/values.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    MAX_FRAMES = 1000000,
    MAX_FRAME_SAMPLES = 4096,
    MAX_SPP = 1000000,
    MIN_AUTO_SPP = 32,
    DEFAULT_AUTO_SPP = 4096,
    MAX_BOUNCES = 1000000
};
enum { MAX_THREADS = 1024, MAX_SHARDS = 10000 };

// ---- switches and texts

#define SWITCH(member)                                                                             \
    static bool set_##member(struct arguments *a, const char *value, const char **why)             \
    {                                                                                              \
        (void)value, (void)why;                                                                    \
        a->member = true;                                                                          \
        return true;                                                                               \
    }
SWITCH(follow_links)
SWITCH(no_scene_lights)
SWITCH(direct_only)
SWITCH(indirect_only)
SWITCH(no_guiding)
SWITCH(antialias)
SWITCH(obscurance_sphere)
SWITCH(resume)
SWITCH(no_cache)
SWITCH(denoise)
SWITCH(update)
SWITCH(no_bake)
SWITCH(force)
SWITCH(merge)
SWITCH(report_full)
SWITCH(all_objects)
SWITCH(clear)
SWITCH(all)
SWITCH(ignore_nan)
SWITCH(json)
SWITCH(quiet)
SWITCH(verbose)
SWITCH(help)

// The option `name` stores its value in the member.
#define TEXT(name, member)                                                                         \
    static bool set_##name(struct arguments *a, const char *value, const char **why)               \
    {                                                                                              \
        (void)why;                                                                                 \
        a->member = value;                                                                         \
        return true;                                                                               \
    }
TEXT(folder, output)
TEXT(camera, camera)
TEXT(animation, animation)
TEXT(aov, aov)
TEXT(debug_view, debug_view)
TEXT(frame_options, frame_options)
TEXT(stats, stats)
TEXT(device, device)
TEXT(report, report)
TEXT(layer, layer)
TEXT(split, split)
TEXT(script, script)
TEXT(screenshot, screenshot)
TEXT(session, session)

// ---- checked values

static bool set_int(const char *value, long low, long high, int *out)
{
    long number = 0;
    const bool ok = value_int(value, low, high, &number);
    *out = (int)number;
    return ok;
}

static bool set_gi(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->gi = value;
    a->has_gi = true;
    return true;
}

static bool set_blocks(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->blocks = value;
    return true;
}

static bool add_method(struct arguments *a, const char *value, const char **why)
{
    *why = "at most 16 methods";
    if (a->method_count == MAX_METHODS) return false;
    a->methods[a->method_count++] = value;
    return true;
}

static bool set_output(struct arguments *a, const char *value, const char **why)
{
    *why = "the file name must end in .png or .exr";
    a->output = value;
    return has_extension(value, "png") || has_extension(value, "exr");
}

static bool set_size(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be WxH, each 1 to 16384";
    return value_size(value, &a->width, &a->height);
}

static bool set_scale(struct arguments *a, const char *value, const char **why)
{
    double scale;
    *why = "it must be 0.1 to 2";
    if (!value_number(value, &scale) || scale < 0.1 || scale > 2.0) return false;
    a->scale = (float)scale;
    return true;
}

static bool set_eye(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be three numbers, x,y,z";
    a->has_eye = true;
    return value_floats(value, 3, a->eye);
}

static bool set_target(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be three numbers, x,y,z";
    a->has_target = true;
    return value_floats(value, 3, a->target);
}

static bool set_fov(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 0.001 to 179.999 degrees";
    a->has_fov = true;
    return value_number(value, &a->fov_deg) && a->fov_deg >= 0.001 && a->fov_deg <= 179.999;
}

static bool set_time(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be a number of seconds";
    return value_number(value, &a->time_s);
}

static bool set_time_step(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be a number of seconds";
    return value_number(value, &a->time_step_s);
}

static bool set_frames(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 1 to 1000000";
    return set_int(value, 1, MAX_FRAMES, &a->frames);
}

static bool set_frame_samples(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 1 to 4096";
    return set_int(value, 1, MAX_FRAME_SAMPLES, &a->frame_samples);
}

static bool add_light(struct arguments *a, const char *value, const char **why)
{
    *why = "at most 64 lights";
    if (a->light_count == MAX_LIGHTS) return false;
    a->light_texts[a->light_count] = value;
    return value_light(value, &a->lights[a->light_count++], why);
}

static bool set_scene_scale(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 0.000001 to 1000000 metres per unit of the file";
    a->has_scene_scale = true;
    return value_floats(value, 1, &a->scene_scale) && a->scene_scale >= 1e-6f &&
           a->scene_scale <= 1e6f;
}

static bool set_sky(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be three numbers of at least 0, r,g,b";
    a->has_sky = true;
    return value_floats(value, 3, a->sky) && a->sky[0] >= 0 && a->sky[1] >= 0 && a->sky[2] >= 0;
}

static bool set_environment(struct arguments *a, const char *value, const char **why)
{
    a->environment = value;
    return value_environment(value, &a->environment_value, why);
}

static bool set_exposure(struct arguments *a, const char *value, const char **why)
{
    double ev = 0.0;
    const int rule = value_index(METERING_NAMES, value);
    *why = "it must be an EV from -100 to 100, or one of: " METERING_NAMES;
    a->has_exposure = rule < 0;
    a->rule = rule < 0 ? NULL : value;
    a->metering = rule < 0 ? AG_METERING_MEAN : (enum ag_metering)rule;
    if (rule >= 0) return true;
    a->exposure_ev = value_number(value, &ev) ? (float)ev : NAN;
    return a->exposure_ev >= -100.0f && a->exposure_ev <= 100.0f;
}

static bool set_tonemap(struct arguments *a, const char *value, const char **why)
{
    const int curve = value_index(TONEMAP_NAMES, value);
    *why = "it must be one of: " TONEMAP_NAMES;
    if (curve < 0) return false;
    a->curve = value;
    a->tonemap = (enum ag_tonemap)curve;
    return true;
}

static bool set_seed(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be a whole number of at most 64 bits";
    return value_seed(value, &a->seed);
}

static bool set_spp(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 1 to 1000000";
    a->has_spp = true;
    return set_int(value, 1, MAX_SPP, &a->spp);
}

// "auto:noise=PERCENT[,max=N]"
static bool set_auto_spp(struct arguments *a, char *text, const char **why)
{
    static const char NOISE[] = "noise=", MAX[] = "max=";
    char *rest = NULL;
    bool has_noise = false;
    a->spp = DEFAULT_AUTO_SPP;
    for (char *item = strtok_r(text, ",", &rest); item; item = strtok_r(NULL, ",", &rest)) {
        double percent = 0.0;
        if (strncmp(item, NOISE, sizeof NOISE - 1) == 0) {
            *why = "noise must be 0.01 to 50 percent";
            has_noise = value_number(item + sizeof NOISE - 1, &percent) && percent >= 0.01 &&
                        percent <= 50.0;
            if (!has_noise) return false;
            a->spp_noise = percent / 100.0;
        } else if (strncmp(item, MAX, sizeof MAX - 1) == 0) {
            *why = "max must be 32 to 1000000 paths";
            if (!set_int(item + sizeof MAX - 1, MIN_AUTO_SPP, MAX_SPP, &a->spp)) return false;
        } else {
            *why = "it is N or auto:noise=PERCENT[,max=N]";
            return false;
        }
    }
    *why = "it is N or auto:noise=PERCENT[,max=N]";
    return has_noise;
}

static bool set_bake_spp(struct arguments *a, const char *value, const char **why)
{
    static const char AUTO[] = "auto:";
    char text[64];
    if (strncmp(value, AUTO, sizeof AUTO - 1) != 0) {
        const bool ok = set_spp(a, value, why);
        *why = "it must be 1 to 1000000, or auto:noise=PERCENT[,max=N]";
        return ok;
    }
    a->has_spp = true;
    *why = "it is N or auto:noise=PERCENT[,max=N]";
    const int length = snprintf(text, sizeof text, "%s", value + sizeof AUTO - 1);
    return length > 0 && (size_t)length < sizeof text && set_auto_spp(a, text, why);
}

static bool set_bounces(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 0 to 1000000";
    return set_int(value, 0, MAX_BOUNCES, &a->bounces);
}

static bool set_obscurance_radius(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be more than 0 and at most 1000000 m";
    return value_floats(value, 1, &a->obscurance_radius_m) && a->obscurance_radius_m > 0.0f &&
           a->obscurance_radius_m <= 1e6f;
}

static bool set_occlusion_decay(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 0 to 1000000 1/m";
    return value_floats(value, 1, &a->occlusion_decay_per_m) && a->occlusion_decay_per_m >= 0.0f &&
           a->occlusion_decay_per_m <= 1e6f;
}

static bool set_reference(struct arguments *a, const char *value, const char **why)
{
    *why = "the file name must end in .exr";
    a->reference = value;
    return has_extension(value, "exr");
}

static bool set_bound(const char *value, double *out, const char **why)
{
    *why = "it must be a number of at least 0";
    return value_number(value, out) && *out >= 0.0;
}

static bool set_max_flip(struct arguments *a, const char *value, const char **why)
{
    return set_bound(value, &a->max_flip, why);
}

static bool set_max_relmse(struct arguments *a, const char *value, const char **why)
{
    return set_bound(value, &a->max_relmse, why);
}

static bool set_max_ms(struct arguments *a, const char *value, const char **why)
{
    return set_bound(value, &a->max_ms, why);
}

static bool set_bake_output(struct arguments *a, const char *value, const char **why)
{
    *why = "the file name must end in .safetensors";
    a->output = value;
    return has_extension(value, "safetensors");
}

static bool set_lightmap(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be the name of a folder";
    a->lightmap = value;
    return value[0] != 0;
}

// "exr,png": bits in the order of the list.
static bool set_lightmap_format(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be a list of these: " LIGHTMAP_FORMAT_NAMES;
    a->lightmap_formats = 0;
    for (const char *at = value;; at++) {
        char name[8];
        const size_t length = strcspn(at, ",");
        if (length >= sizeof name) return false;
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        const int format = value_index(LIGHTMAP_FORMAT_NAMES, name);
        if (format < 0) return false;
        a->lightmap_formats |= 1u << format;
        at += length;
        if (!*at) return true;
    }
}

static bool set_page(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be a multiple of 8, from 64 to 16384 texels";
    return set_int(value, 64, 16384, &a->page) && a->page % 8 == 0;
}

static bool set_probes(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be the name of a folder";
    a->probes = value;
    return value[0] != 0;
}

static bool set_export(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be the name of a folder";
    a->exported = value;
    return value[0] != 0;
}

static bool add_bake_file(struct arguments *a, const char *value, const char **why)
{
    *why = "at most 8 files";
    if (a->bake_file_count == MAX_BAKE_FILES) return false;
    a->bake_files[a->bake_file_count++] = value;
    return true;
}

static bool set_threads(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 1 to 1024";
    return set_int(value, 1, MAX_THREADS, &a->threads);
}

// "I/N", 0 ≤ I < N.
static bool set_shard(struct arguments *a, const char *value, const char **why)
{
    char index[16];
    long shard = 0, count = 0;
    const char *slash = strchr(value, '/');
    *why = "it must be I/N with 0 <= I < N, N at most 10000";
    if (!slash || (size_t)(slash - value) >= sizeof index) return false;
    snprintf(index, sizeof index, "%.*s", (int)(slash - value), value);
    if (!value_int(slash + 1, 1, MAX_SHARDS, &count)) return false;
    if (!value_int(index, 0, count - 1, &shard)) return false;
    a->shard = (int)shard;
    a->shard_count = (int)count;
    return true;
}

static bool set_max_memory(struct arguments *a, const char *value, const char **why)
{
    long mib = 0;
    *why = "it must be a whole number of MiB, at least 1";
    bool ok = value_int(value, 1, INT32_MAX, &mib);
    a->max_memory_mib = mib;
    return ok;
}

static bool set_map(struct arguments *a, const char *value, const char **why)
{
    *why = "the file name must end in .png";
    a->map = value;
    return has_extension(value, "png");
}

static bool set_metric(struct arguments *a, const char *value, const char **why)
{
    const int metric = value_index(METRIC_NAMES, value);
    *why = "it must be one of: " METRIC_NAMES;
    if (metric < 0) return false;
    a->metric = (enum ag_difference)metric;
    return true;
}

static bool set_mask(struct arguments *a, const char *value, const char **why)
{
    size_t length = strcspn(value, "=");
    *why = "it must be the name of a layer, or LAYER=THRESHOLD";
    if (length == 0 || length >= sizeof a->mask_layer) return false;
    snprintf(a->mask_layer, sizeof a->mask_layer, "%.*s", (int)length, value);
    a->mask_threshold = 0.0;
    return !value[length] || value_number(value + length + 1, &a->mask_threshold);
}

// ---- the table

struct row {
    const char *name, *value; // name NULL: a heading, `help`
    unsigned commands;        // command_bit
    option_setter *set;
    const char *help;
};

static const struct row rows[] = {
#define OPTION(name, value, commands, set, help) { name, value, commands, set, help },
#define GROUP(title)                             { NULL, NULL, 0, NULL, title },
#include "options.def"
#undef OPTION
#undef GROUP
};
enum { ROW_COUNT = sizeof rows / sizeof rows[0] };
_Static_assert(sizeof rows / sizeof rows[0] <= (size_t)MAX_OPTIONS, "callers list fewer");

bool command_option_get(const struct command *command, int index, struct command_option *out)
{
    const char *heading = NULL;
    for (int i = 0; i < ROW_COUNT; i++) {
        const struct row *row = &rows[i];
        if (!row->name) heading = row->help;
        if (!(row->commands & command->bit) || index-- > 0) continue;
        *out = (struct command_option){ row->name, row->value, heading, row->help, row->set };
        return true;
    }
    return false;
}

bool command_option_find(const struct command *command, const char *name, size_t length,
                         struct command_option *out)
{
    for (int i = 0; command_option_get(command, i, out); i++)
        if (strlen(out->name) == length && memcmp(out->name, name, length) == 0) return true;
    return false;
}
