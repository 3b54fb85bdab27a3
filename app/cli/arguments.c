// Parses the options of all commands, which options.def lists.
#include "arguments.h"
#include "values.h"
#include "cli/terminal/wrapped.h"

#include <afterglow/catalogue.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HELP_COLUMN = 24, MAX_FRAMES = 1000000, MAX_SPP = 1000000, MAX_BOUNCES = 1000000 };
enum { MAX_THREADS = 1024, MAX_SHARDS = 10000 };

// Stores a value; false with *why, what a valid value is, for a wrong one.
typedef bool setter(struct arguments *a, const char *value, const char **why);

static bool set_gi(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->gi = value;
    a->has_gi = true;
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

static bool set_folder(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->output = value;
    return true;
}

static bool set_size(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be WxH, each 1 to 16384";
    return value_size(value, &a->width, &a->height);
}

static bool set_camera(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->camera = value;
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

static bool set_animation(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->animation = value;
    return true;
}

static bool set_frames(struct arguments *a, const char *value, const char **why)
{
    long frames = 0;
    *why = "it must be 1 to 1000000";
    bool ok = value_int(value, 1, MAX_FRAMES, &frames);
    a->frames = (int)frames;
    return ok;
}

static bool add_light(struct arguments *a, const char *value, const char **why)
{
    *why = "at most 64 lights";
    if (a->light_count == MAX_LIGHTS) return false;
    a->light_texts[a->light_count] = value;
    return value_light(value, &a->lights[a->light_count++], why);
}

static bool set_follow_links(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->follow_links = true;
    return true;
}

static bool set_scene_scale(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be 0.000001 to 1000000 metres per unit of the file";
    a->has_scene_scale = true;
    return value_floats(value, 1, &a->scene_scale) && a->scene_scale >= 1e-6f &&
           a->scene_scale <= 1e6f;
}

static bool set_no_scene_lights(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->no_scene_lights = true;
    return true;
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
    *why = "it must be an EV from -100 to 100";
    bool ok = value_number(value, &ev) && ev >= -100.0 && ev <= 100.0;
    a->has_exposure = true;
    a->exposure_ev = (float)ev;
    return ok;
}

static bool set_aov(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->aov = value;
    return true;
}

static bool set_debug_view(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->debug_view = value;
    return true;
}

static bool set_frame_options(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->frame_options = value;
    return true;
}

static bool set_stats(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->stats = value;
    return true;
}

static bool set_device(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->device = value;
    return true;
}

static bool set_seed(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be a whole number of at most 64 bits";
    return value_seed(value, &a->seed);
}

static bool set_spp(struct arguments *a, const char *value, const char **why)
{
    long spp = 0;
    *why = "it must be 1 to 1000000";
    bool ok = value_int(value, 1, MAX_SPP, &spp);
    a->spp = (int)spp;
    a->has_spp = true;
    return ok;
}

static bool set_bounces(struct arguments *a, const char *value, const char **why)
{
    long bounces = 0;
    *why = "it must be 0 to 1000000";
    bool ok = value_int(value, 0, MAX_BOUNCES, &bounces);
    a->bounces = (int)bounces;
    return ok;
}

static bool set_direct_only(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->direct_only = true;
    return true;
}

static bool set_indirect_only(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->indirect_only = true;
    return true;
}

static bool set_no_guiding(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->no_guiding = true;
    return true;
}

static bool set_antialias(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->antialias = true;
    return true;
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

static bool set_obscurance_sphere(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->obscurance_sphere = true;
    return true;
}

static bool set_resume(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->resume = true;
    return true;
}

static bool set_reference(struct arguments *a, const char *value, const char **why)
{
    *why = "the file name must end in .exr";
    a->reference = value;
    return has_extension(value, "exr");
}

static bool set_no_cache(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->no_cache = true;
    return true;
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

static bool set_export(struct arguments *a, const char *value, const char **why)
{
    *why = "it must be the name of a folder";
    a->exported = value;
    return value[0] != 0;
}

static bool set_denoise(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->denoise = true;
    return true;
}

static bool add_bake_file(struct arguments *a, const char *value, const char **why)
{
    *why = "at most 8 files";
    if (a->bake_file_count == MAX_BAKE_FILES) return false;
    a->bake_files[a->bake_file_count++] = value;
    return true;
}

static bool set_no_bake(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->no_bake = true;
    return true;
}

static bool set_force(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->force = true;
    return true;
}

static bool set_merge(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->merge = true;
    return true;
}

static bool set_threads(struct arguments *a, const char *value, const char **why)
{
    long threads = 0;
    *why = "it must be 1 to 1024";
    bool ok = value_int(value, 1, MAX_THREADS, &threads);
    a->threads = (int)threads;
    return ok;
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

static bool set_report(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->report = value;
    return true;
}

static bool set_report_full(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->report_full = true;
    return true;
}

static bool set_clear(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->clear = true;
    return true;
}

static bool set_all(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->all = true;
    return true;
}

static bool set_layer(struct arguments *a, const char *value, const char **why)
{
    (void)why;
    a->layer = value;
    return true;
}

static bool set_map(struct arguments *a, const char *value, const char **why)
{
    *why = "the file name must end in .png";
    a->map = value;
    return has_extension(value, "png");
}

// The position in a list "first second …"; -1: it is not in the list.
static int index_in(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (int i = 0; list[0]; i++) {
        const size_t next = strcspn(list, " ");
        if (next == length && memcmp(list, word, length) == 0) return i;
        list += next + (list[next] == ' ');
    }
    return -1;
}

static bool set_metric(struct arguments *a, const char *value, const char **why)
{
    const int metric = index_in(METRIC_NAMES, value);
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

static bool set_ignore_nan(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->ignore_nan = true;
    return true;
}

static bool set_json(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->json = true;
    return true;
}

static bool set_quiet(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->quiet = true;
    return true;
}

static bool set_verbose(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->verbose = true;
    return true;
}

static bool set_help(struct arguments *a, const char *value, const char **why)
{
    (void)value, (void)why;
    a->help = true;
    return true;
}

struct option {
    const char *name, *value; // name NULL: a heading, `help`
    unsigned commands;        // command_bit
    setter *set;
    const char *help;
};

static const struct option options[] = {
#define OPTION(name, value, commands, set, help) { name, value, commands, set, help },
#define GROUP(title)                             { NULL, NULL, 0, NULL, title },
#include "options.def"
#undef OPTION
#undef GROUP
};
enum { OPTION_COUNT = sizeof options / sizeof options[0] };

// ---- parsing

static const char *long_name(const char *word)
{
    static const char *const names[][2] = { { "-q", "--quiet" },
                                            { "-v", "--verbose" },
                                            { "-h", "--help" } };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(word, names[i][0]) == 0) return names[i][1];
    return word;
}

// The option named by `word` up to its '='; NULL: none.
static const struct option *option_find(const struct command *command, const char *word)
{
    word = long_name(word);
    size_t length = strcspn(word, "=");
    for (int i = 0; i < OPTION_COUNT; i++)
        if ((options[i].commands & command->bit) && strlen(options[i].name) == length &&
            strncmp(options[i].name, word, length) == 0)
            return &options[i];
    return NULL;
}

static enum status unknown_option(const struct command *command, const char *word)
{
    const char *known[OPTION_COUNT];
    char name[64];
    int count = 0;
    for (int i = 0; i < OPTION_COUNT; i++)
        if (options[i].commands & command->bit) known[count++] = options[i].name;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word, "="), word);
    const char *nearest = ag_nearest_name(name, known, count);
    if (nearest) return wrong_usage("unknown option %s: did you mean %s?", name, nearest);
    return wrong_usage("unknown option %s: see afterglow %s --help", name, command->name);
}

// Parses words[*at] and, if the value is a separate word, the next one.
static enum status parse_option(const struct command *command, int count, char **words, int *at,
                                struct arguments *out)
{
    const char *word = words[*at], *equals = strchr(word, '=');
    const struct option *option = option_find(command, word);
    if (!option) return unknown_option(command, word);
    const char *value = equals ? equals + 1 : NULL;
    if (!option->value && value)
        return wrong_usage("wrong option %s: %s takes no value", word, option->name);
    if (option->value && !value) {
        if (++*at >= count)
            return wrong_usage("wrong option %s: its value %s is missing", word, option->value);
        value = words[*at];
    }
    if (value && !value[0])
        return wrong_usage("wrong option %s: its value %s is empty", option->name, option->value);
    const char *why = NULL;
    if (option->set(out, value, &why)) return DONE;
    return wrong_usage("wrong value %s %s: %s", option->name, value, why);
}

static enum status check_together(const struct command *command, const struct arguments *a)
{
    static const char *const files[] = { "SCENE", "A", "B" };
    if (a->positional_count < command->positional_count) {
        const char *missing = files[command->positional_count == 1 ? 0 : 1 + a->positional_count];
        return wrong_usage("cannot %s: %s is missing (afterglow %s %s)", command->name, missing,
                           command->name, command->usage);
    }
    if (a->has_eye != a->has_target)
        return wrong_usage("cannot use --%s: it requires --%s", a->has_eye ? "eye" : "target",
                           a->has_eye ? "target" : "eye");
    if (!isfinite(a->time_s + (a->frames - 1) * a->time_step_s))
        return wrong_usage("cannot use --time-step: the time after %d frames is not finite",
                           a->frames);
    if (a->camera && a->has_eye)
        return wrong_usage("cannot use --camera %s with --eye and --target: choose one camera",
                           a->camera);
    if (a->has_eye && a->eye[0] == a->target[0] && a->eye[1] == a->target[1] &&
        a->eye[2] == a->target[2])
        return wrong_usage("cannot use --eye: it is the same point as --target");
    if (a->direct_only && a->indirect_only)
        return wrong_usage("cannot use --direct-only with --indirect-only: choose one");
    if (a->reference && a->has_spp)
        return wrong_usage("cannot use --spp with --reference %s: its samples are fixed",
                           a->reference);
    return DONE;
}

static struct arguments defaults_of(const struct command *command)
{
    bool compare = command->bit == COMPARE;
    return (struct arguments){ .gi = "none",
                               .width = 1280,
                               .height = 720,
                               .frames = compare ? 8 : 1,
                               .fov_deg = 60.0,
                               .spp = 64,
                               .scene_scale = 1.0f,
                               .bounces = -1,
                               .obscurance_radius_m = 0.5f,
                               .max_flip = -1.0,
                               .max_relmse = -1.0,
                               .max_ms = -1.0 };
}

enum status arguments_parse(const struct command *command, int count, char **words,
                            struct arguments *out)
{
    *out = defaults_of(command);
    out->words = words;
    out->word_count = count;
    bool only_files = false; // after "--"
    for (int i = 0; i < count; i++) {
        if (!only_files && strcmp(words[i], "--") == 0) {
            only_files = true;
        } else if (!only_files && words[i][0] == '-' && words[i][1]) {
            enum status status = parse_option(command, count, words, &i, out);
            if (status != DONE) return status;
            if (out->help) return DONE;
        } else if (out->positional_count ==
                   (out->merge ? MAX_POSITIONAL
                               : command->positional_count + command->optional_count)) {
            return wrong_usage("unexpected argument %s: afterglow %s %s", words[i], command->name,
                               command->usage);
        } else if (!words[i][0]) {
            return wrong_usage("cannot %s: a file name is empty", command->name);
        } else {
            out->positional[out->positional_count++] = words[i];
        }
    }
    return check_together(command, out);
}

// ---- the command line again

static size_t append(char *out, size_t size, size_t used, const char *text, size_t length)
{
    for (size_t i = 0; i < length && used + 1 < size; i++) out[used++] = text[i];
    out[used] = 0;
    return used;
}

static size_t append_quoted(char *out, size_t size, size_t used, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "@%+=:,./_-";
    if (word[0] && word[strspn(word, plain)] == 0)
        return append(out, size, used, word, strlen(word));
    used = append(out, size, used, "'", 1);
    for (const char *c = word; *c; c++)
        used = append(out, size, used, *c == '\'' ? "'\\''" : c, *c == '\'' ? 4 : 1);
    return append(out, size, used, "'", 1);
}

void arguments_command(const char *command, const struct arguments *arguments, char *out,
                       size_t size)
{
    size_t used = append(out, size, 0, "afterglow ", 10);
    used = append(out, size, used, command, strlen(command));
    for (int i = 0; i < arguments->word_count; i++) {
        used = append(out, size, used, " ", 1);
        used = append_quoted(out, size, used, arguments->words[i]);
    }
}

// ---- help

bool arguments_option(const struct command *command, int index, struct command_option *out)
{
    const char *heading = NULL;
    for (int i = 0; i < OPTION_COUNT; i++) {
        const struct option *o = &options[i];
        if (!o->name) heading = o->help;
        if (!(o->commands & command->bit) || index-- > 0) continue;
        *out = (struct command_option){ o->name, o->value, heading, o->help };
        return true;
    }
    return false;
}

static void print_option(const struct command_option *option)
{
    int wrote = printf("  %s%s%s", option->name, option->value ? " " : "",
                       option->value ? option->value : "");
    if (wrote >= HELP_COLUMN) wrote = printf("\n") - 1;
    printf("%*s", HELP_COLUMN - wrote, "");
    print_wrapped(HELP_COLUMN, option->help);
}

static void print_options(const struct command *command)
{
    const char *heading = NULL;
    struct command_option option;
    for (int i = 0; arguments_option(command, i, &option); i++) {
        if (option.heading != heading) printf("\n%s:\n", option.heading);
        heading = option.heading;
        print_option(&option);
    }
}

void arguments_help(const struct command *command)
{
    printf("Usage: afterglow %s%s%s\n\n%s\nExamples:\n%s", command->name,
           command->usage[0] ? " " : "", command->usage, command->text, command->examples);
    print_options(command);
}
