// Parses the command line, and prints it again.
#include "arguments.h"
#include "cli/options/option_table.h"
#include "shell/words.h"

#include <afterglow/catalogue.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

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

static enum status unknown_option(const struct command *command, const char *word)
{
    const char *known[MAX_OPTIONS];
    char name[64];
    struct command_option option;
    int count = 0;
    for (; count < MAX_OPTIONS && command_option_get(command, count, &option); count++)
        known[count] = option.name;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word, "="), word);
    const char *nearest = ag_nearest_name(name, known, count);
    if (nearest) return wrong_usage("unknown option %s: did you mean %s?", name, nearest);
    return wrong_usage("unknown option %s: see afterglow %s --help", name, command->name);
}

// Parses words[*at] and, if the value is a separate word, the next one.
static enum status parse_option(const struct command *command, int count, char **words, int *at,
                                struct arguments *out)
{
    const char *word = words[*at], *name = long_name(word), *equals = strchr(word, '=');
    struct command_option option;
    if (!command_option_find(command, name, strcspn(name, "="), &option))
        return unknown_option(command, word);
    const char *value = equals ? equals + 1 : NULL;
    if (!option.value && value)
        return wrong_usage("wrong option %s: %s takes no value", word, option.name);
    if (option.value && !value) {
        if (++*at >= count)
            return wrong_usage("wrong option %s: its value %s is missing", word, option.value);
        value = words[*at];
    }
    if (value && !value[0])
        return wrong_usage("wrong option %s: its value %s is empty", option.name, option.value);
    const char *why = NULL;
    if (option.set(out, value, &why)) return DONE;
    return wrong_usage("wrong value %s %s: %s", option.name, value, why);
}

// The value of an option in a list of frame options; false: it has none.
static bool listed_value(const char *options, const char *name, char out[16])
{
    const size_t length = strlen(name);
    for (; options; options = strchr(options, ',') ? strchr(options, ',') + 1 : NULL) {
        if (strncmp(options, name, length) != 0 || options[length] != '=') continue;
        options += length + 1;
        snprintf(out, 16, "%.*s", (int)strcspn(options, ","), options);
        return true;
    }
    return false;
}

// An option of the command line that is a frame option, too, and its values.
struct display_option {
    const char *option, *name, *names;
};

// `given` is its value on the command line, or NULL; *value changes if it is a frame option.
static enum status choose_display(struct arguments *a, const struct display_option *of,
                                  const char *given, int *value)
{
    char listed[16];
    const bool is_listed = listed_value(a->frame_options, of->name, listed);
    if (given && is_listed)
        return wrong_usage("cannot use %s with --frame-options %s=%s: choose one", of->option,
                           of->name, listed);
    const int chosen = is_listed ? value_index(of->names, listed) : -1;
    if (chosen >= 0) *value = chosen; // the library refuses others
    if (!given) return DONE;
    const size_t used = strlen(a->display_options);
    const int wrote = snprintf(a->display_options + used, sizeof a->display_options - used,
                               "%s%s=%s", used > 0 ? "," : "", of->name, given);
    if (wrote >= (int)(sizeof a->display_options - used))
        return wrong_usage("cannot use --frame-options: the list is too long");
    return DONE;
}

static enum status choose_displays(struct arguments *a)
{
    static const struct display_option curves = { "--tonemap", "tonemap", TONEMAP_NAMES };
    static const struct display_option rules = { "--exposure", "metering", METERING_NAMES };
    int curve = (int)a->tonemap, rule = (int)a->metering;
    if (a->frame_options && (a->curve || a->rule) &&
        snprintf(a->display_options, sizeof a->display_options, "%s", a->frame_options) >=
            (int)sizeof a->display_options)
        return wrong_usage("cannot use --frame-options: the list is too long");
    enum status status = choose_display(a, &curves, a->curve, &curve);
    if (status == DONE) status = choose_display(a, &rules, a->rule, &rule);
    a->tonemap = (enum ag_tonemap)curve;
    a->metering = (enum ag_metering)rule;
    return status;
}

const char *arguments_frame_options(const struct arguments *a)
{
    return a->display_options[0] ? a->display_options : a->frame_options;
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
    if (command->bit == INFO && a->has_gi && !a->blocks)
        return wrong_usage("cannot use --gi: it requires --blocks");
    if (a->reference && a->has_spp)
        return wrong_usage("cannot use --spp with --reference %s: its samples are fixed",
                           a->reference);
    return DONE;
}

static struct arguments defaults_of(const struct command *command)
{
    const int frames = command->bit == COMPARE ? 8 : command->bit == VIEW ? 0 : 1;
    return (struct arguments){ .gi = "none",
                               .width = 1280,
                               .height = 720,
                               .frames = frames,
                               .frame_samples = 1,
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
    enum status status = check_together(command, out);
    return status == DONE ? choose_displays(out) : status;
}

// ---- the command line again

void arguments_command(const char *command, const struct arguments *arguments, char *out,
                       size_t size)
{
    struct words words = { out, size, 0 };
    words_add(&words, "afterglow %s", command);
    for (int i = 0; i < arguments->word_count; i++) words_add_word(&words, arguments->words[i]);
}
