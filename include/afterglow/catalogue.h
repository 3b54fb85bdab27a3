/// What the library offers: techniques, their options and debug views, built-in scenes.
#ifndef AFTERGLOW_CATALOGUE_H
#define AFTERGLOW_CATALOGUE_H

#include <afterglow/types.h>

AG_BEGIN

struct ag_option_info {
    const char *name;
    const char *type; ///< "int", "float", "bool" or "choice"
    double initial, min, max;
    const char *unit;   ///< for choices: the names, separated by '|'
    const char *effect; ///< "live", "invalidate", "resize", "recreate" or "rebake"
    const char *help;
};

struct ag_technique_info {
    const char *name, *title, *paper;
    const char *role; ///< "source", "delta" or "visibility"
    bool moving_geometry, moving_lights, needs_bake, makes_specular, publishes_probes;
    int option_count, preset_count, debug_view_count;
};

/// Each returns false past the end. Strings live for ever.
AG_API bool ag_technique_get(int index, struct ag_technique_info *out);
AG_API bool ag_technique_option_get(int technique, int index, struct ag_option_info *out);
/// What `name:quality=PRESET` sets, as "key=value,key=value", before the options that stand beside
/// it; "" is the defaults.
AG_API bool ag_technique_preset_get(int technique, int index, const char **name,
                                    const char **options);
AG_API bool ag_technique_debug_view_get(int technique, int index, const char **name,
                                        const char **help);
/// Index of the debug view of this name, or of this name in the last release; -1: none.
AG_API int ag_technique_debug_view_find(int technique, const char *name);
AG_API bool ag_frame_option_get(int index, struct ag_option_info *out);

struct ag_builtin_scene_info {
    const char *name, *title; ///< name without the @
    int option_count;
};
AG_API bool ag_builtin_scene_get(int index, struct ag_builtin_scene_info *out);
AG_API bool ag_builtin_scene_option_get(int scene, int index, struct ag_option_info *out);

/// The known name that was probably meant, for "did you mean …?"; NULL when none is near.
AG_API const char *ag_nearest_name(const char *name, const char *const *known, int count);

AG_END

#endif
