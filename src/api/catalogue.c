// Catalogue of techniques, frame options and built-in scenes, from their tables.
#include "api/objects.h"

#include "frame/frame.h"
#include "scene/builtin/builtin.h"
#include "techniques/registry.h"

static const char *type_name(enum option_type type)
{
    switch (type) {
    case OPTION_TYPE_int32:
        return "int";
    case OPTION_TYPE_float32:
        return "float";
    case OPTION_TYPE_bool8:
        return "bool";
    case OPTION_TYPE_choice:
        break;
    case OPTION_TYPE_text:
        return "text";
    }
    return "choice";
}

static const char *effect_name(enum option_effect effect)
{
    switch (effect) {
    case LIVE:
        return "live";
    case INVALIDATE:
        return "invalidate";
    case RESIZE:
        return "resize";
    case RECREATE:
        return "recreate";
    case REBAKE:
        break;
    }
    return "rebake";
}

static bool option_get(const struct option_table *table, int index, struct ag_option_info *out)
{
    if (!out || index < 0 || (size_t)index >= table->count) return false;
    const struct option_row *row = &table->rows[index];
    *out = (struct ag_option_info){ .name = row->name,
                                    .type = type_name(row->type),
                                    .initial = row->initial,
                                    .min = row->min,
                                    .max = row->max,
                                    .unit = row->unit,
                                    .effect = effect_name(row->effect),
                                    .help = row->help,
                                    .expert = row->expert };
    return true;
}

static const struct technique *technique_at(int index)
{
    for (int i = 0; index >= 0 && techniques[i]; i++)
        if (i == index) return techniques[i];
    return NULL;
}

static int debug_view_count(const struct technique *technique)
{
    int count = 0;
    while (technique->debug_views && technique->debug_views[count].name) count++;
    return count;
}

static int preset_count(const struct technique *technique)
{
    int count = 0;
    while (technique->presets && technique->presets[count].name) count++;
    return count;
}

bool ag_technique_get(int index, struct ag_technique_info *out)
{
    static const char *const role_names[] = { [ROLE_SOURCE] = "source",
                                              [ROLE_DELTA] = "delta",
                                              [ROLE_VISIBILITY] = "visibility",
                                              [ROLE_REFLECTION] = "reflection" };
    const struct technique *technique = technique_at(index);
    if (!technique || !out) return false;
    uint32_t can = technique->capabilities;
    *out = (struct ag_technique_info){ .name = technique->name,
                                       .title = technique->title,
                                       .paper = technique->paper,
                                       .role = role_names[technique->role],
                                       .moving_geometry = can & CAN_MOVE_GEOMETRY,
                                       .moving_lights = can & CAN_MOVE_LIGHTS,
                                       .needs_bake = can & NEEDS_BAKE,
                                       .makes_specular = can & MAKES_SPECULAR,
                                       .publishes_probes = can & PUBLISHES_PROBES,
                                       .has_lightmap = technique->light_map != NULL,
                                       .exports_bake = technique->bake_export != NULL,
                                       .option_count = (int)technique->options.count,
                                       .preset_count = preset_count(technique),
                                       .debug_view_count = debug_view_count(technique) };
    return true;
}

bool ag_technique_option_get(int technique, int index, struct ag_option_info *out)
{
    const struct technique *found = technique_at(technique);
    return found && option_get(&found->options, index, out);
}

bool ag_technique_preset_get(int technique, int index, const char **name, const char **options)
{
    const struct technique *found = technique_at(technique);
    if (!found || index < 0 || index >= preset_count(found)) return false;
    if (name) *name = found->presets[index].name;
    if (options) *options = found->presets[index].options;
    return true;
}

bool ag_technique_debug_view_get(int technique, int index, const char **name, const char **help)
{
    const struct technique *found = technique_at(technique);
    if (!found || index < 0 || index >= debug_view_count(found)) return false;
    if (name) *name = found->debug_views[index].name;
    if (help) *help = found->debug_views[index].help;
    return true;
}

int ag_technique_debug_view_find(int technique, const char *name)
{
    const struct technique *within = technique_at(technique);
    const struct technique_debug_view *view =
        within && name ? technique_find_view(within, name) : NULL;
    return view ? (int)(view - within->debug_views) : -1;
}

bool ag_frame_option_get(int index, struct ag_option_info *out)
{
    return option_get(&frame_option_table, index, out);
}

static const struct builtin_scene *builtin_at(int index)
{
    for (int i = 0; index >= 0 && builtin_scenes[i]; i++)
        if (i == index) return builtin_scenes[i];
    return NULL;
}

bool ag_builtin_scene_get(int index, struct ag_builtin_scene_info *out)
{
    const struct builtin_scene *scene = builtin_at(index);
    if (!scene || !out) return false;
    *out = (struct ag_builtin_scene_info){ .name = scene->name,
                                           .title = scene->title,
                                           .option_count = (int)scene->options.count };
    return true;
}

bool ag_builtin_scene_option_get(int scene, int index, struct ag_option_info *out)
{
    const struct builtin_scene *found = builtin_at(scene);
    return found && option_get(&found->options, index, out);
}

const char *ag_nearest_name(const char *name, const char *const *known, int count)
{
    if (!name || !known || count <= 0) return NULL;
    return nearest_name(name, known, (size_t)count);
}
