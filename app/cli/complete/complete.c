#include "complete.h"
#include "candidates.h"
#include "cli/commands.h"
#include "cli/options/option_table.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

// ---- values

struct value {
    const struct command *command;
    const char *typed;
};

static void offer_list(const struct value *v, const char *words)
{
    char name[32];
    const struct candidate_word word = { v->typed, 0, v->typed };
    for (; *words; words += strcspn(words, " "), words += *words == ' ') {
        snprintf(name, sizeof name, "%.*s", (int)strcspn(words, " "), words);
        candidate(&word, name, "", "");
    }
}

static void offer_gi(const struct value *v)
{
    candidates_gi(v->typed);
}

static void offer_layers(const struct value *v)
{
    candidates_layers(v->typed,
                      v->command->bit == REFERENCE ? ag_reference_layer_name : ag_layer_name);
}

static void offer_frame_options(const struct value *v)
{
    candidates_frame_options(v->typed);
}

static void offer_debug_views(const struct value *v)
{
    candidates_debug_views(v->typed);
}

static void offer_metrics(const struct value *v)
{
    offer_list(v, METRIC_NAMES);
}

static void offer_curves(const struct value *v)
{
    offer_list(v, TONEMAP_NAMES);
}

static void offer_meterings(const struct value *v)
{
    offer_list(v, METERING_NAMES);
}

static const char *lightmap_format(int index)
{
    static const char *const names[] = { "exr", "ktx2", "png" };
    return index < (int)(sizeof names / sizeof *names) ? names[index] : NULL;
}

static void offer_lightmap_formats(const struct value *v)
{
    candidates_layers(v->typed, lightmap_format);
}

static void offer_lights(const struct value *v)
{
    offer_list(v, "sun: point: spot: area:");
}

static void offer_environments(const struct value *v)
{
    offer_list(v, "sun-sky sun-sky: sun-sky:elevation= sun-sky:azimuth= sun-sky:turbidity=");
    printf(":files\n");
}

static void offer_animations(const struct value *v)
{
    offer_list(v, "none");
}

static const struct {
    const char *option;
    void (*offer)(const struct value *value);
} known[] = { { "--gi", offer_gi },
              { "--aov", offer_layers },
              { "--layer", offer_layers },
              { "--mask", offer_layers },
              { "--frame-options", offer_frame_options },
              { "--debug-view", offer_debug_views },
              { "--metric", offer_metrics },
              { "--tonemap", offer_curves },
              { "--exposure", offer_meterings },
              { "--lightmap-format", offer_lightmap_formats },
              { "--light", offer_lights },
              { "--environment", offer_environments },
              { "--animation", offer_animations } };

static bool is_path(const struct command_option *option)
{
    return strncmp(option->value, "FILE", 4) == 0 || strcmp(option->value, "DIR") == 0;
}

static void offer_values(const struct command *command, const struct command_option *option,
                         const char *typed)
{
    const struct value value = { command, typed };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (strcmp(known[i].option, option->name) != 0) continue;
        known[i].offer(&value);
        return;
    }
    if (is_path(option)) printf(":files\n");
}

// ---- options

// The option with a value that the first `length` characters name.
static bool find_option(const struct command *command, const char *name, size_t length,
                        struct command_option *out)
{
    return command_option_find(command, name, length, out) && out->value;
}

static void offer_options(const struct command *command, const char *typed)
{
    const struct candidate_word word = { typed, 0, typed };
    struct command_option option;
    for (int i = 0; command_option_get(command, i, &option); i++)
        candidate(&word, option.name, "", option.help);
}

// ---- the command line

static void offer_commands(const char *typed, bool all)
{
    const struct candidate_word word = { typed, 0, typed };
    const struct command *command;
    for (int i = 0; (command = command_get(i)); i++)
        candidate(&word, command->name, "", command->summary);
    if (!all) return;
    candidate(&word, "help", "", "show the help of a command");
    candidate(&word, "--help", "", "show the commands");
    candidate(&word, "--version", "", "show the version");
}

// Words that are no option, nor the value of one, before the last one.
static int count_arguments(const struct command *command, int count, char *const *words)
{
    struct command_option option;
    int arguments = 0;
    for (int i = 0; i + 1 < count; i++) {
        if (find_option(command, words[i], strlen(words[i]), &option))
            i++;
        else
            arguments += words[i][0] != '-';
    }
    return arguments;
}

static bool has_word(int count, char *const *words, const char *word)
{
    for (int i = 0; i + 1 < count; i++)
        if (strcmp(words[i], word) == 0) return true;
    return false;
}

static void offer_arguments(const struct command *command, int index, const char *typed)
{
    if (command->bit == LIST && index == 0) candidates_names(typed);
    if (command->bit == LIST || index >= command->positional_count) return;
    if (command->bit != DIFF) candidates_scene(typed);
    if (typed[0] != '@') printf(":files\n");
}

// words: after the command.
static void complete_command(const struct command *command, int count, char *const *words)
{
    const char *typed = words[count - 1], *before = count > 1 ? words[count - 2] : "";
    const char *equals = strchr(typed, '=');
    struct command_option option;
    if (find_option(command, before, strlen(before), &option)) {
        offer_values(command, &option, typed);
    } else if (equals && find_option(command, typed, (size_t)(equals - typed), &option)) {
        candidates_prefix(typed, (int)(equals + 1 - typed));
        offer_values(command, &option, equals + 1);
    } else if (typed[0] == '-') {
        offer_options(command, typed);
    } else if (has_word(count, words, "--merge")) {
        printf(":files\n");
    } else {
        offer_arguments(command, count_arguments(command, count, words), typed);
    }
}

void complete(int count, char *const *words)
{
    if (count < 1) return;
    const struct command *command = command_find(words[0]);
    if (count == 1)
        offer_commands(words[0], true);
    else if (count == 2 && strcmp(words[0], "help") == 0)
        offer_commands(words[1], false);
    else if (command)
        complete_command(command, count - 1, words + 1);
}
