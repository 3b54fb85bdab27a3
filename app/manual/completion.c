// What the completions of both shells list.
#include "completion.h"

#include <afterglow/afterglow.h>

#include <string.h>

static void append(char *out, size_t size, const char *prefix, const char *word, const char *suffix)
{
    const size_t used = strlen(out);
    snprintf(out + used, size - used, "%s%s%s%s", used ? " " : "", prefix, word, suffix);
}

static void append_techniques(char *out, size_t size)
{
    struct ag_technique_info technique;
    struct ag_option_info option;
    const char *preset;
    append(out, size, "", "none", "");
    for (int i = 0; ag_technique_get(i, &technique); i++) {
        char prefix[80];
        append(out, size, "", technique.name, "");
        snprintf(prefix, sizeof prefix, "%s:", technique.name);
        for (int k = 0; ag_technique_option_get(i, k, &option); k++)
            append(out, size, prefix, option.name, "=");
        snprintf(prefix, sizeof prefix, "%s:quality=", technique.name);
        for (int k = 0; ag_technique_preset_get(i, k, &preset, NULL); k++)
            append(out, size, prefix, preset, "");
    }
}

static void append_debug_views(char *out, size_t size)
{
    struct ag_technique_info technique;
    const char *view;
    for (int i = 0; ag_technique_get(i, &technique); i++)
        for (int k = 0; ag_technique_debug_view_get(i, k, &view, NULL); k++)
            append(out, size, "", view, "");
}

void completion_words(const struct command_option *option, char *out, size_t size)
{
    struct ag_option_info frame;
    out[0] = 0;
    if (strcmp(option->name, "--gi") == 0) append_techniques(out, size);
    if (strcmp(option->name, "--debug-view") == 0) append_debug_views(out, size);
    if (strcmp(option->name, "--frame-options") == 0)
        for (int i = 0; ag_frame_option_get(i, &frame); i++) append(out, size, "", frame.name, "=");
    if (strcmp(option->name, "--metric") == 0)
        append(out, size, "", "mae mse relmse ssim flip flip_hdr", "");
}

bool completion_is_path(const struct command_option *option)
{
    const char *value = option->value ? option->value : "";
    return strncmp(value, "FILE", 4) == 0 || strcmp(value, "DIR") == 0;
}

void completion_scenes(char *out, size_t size)
{
    struct ag_builtin_scene_info scene;
    out[0] = 0;
    for (int i = 0; ag_builtin_scene_get(i, &scene); i++) append(out, size, "@", scene.name, "");
}
