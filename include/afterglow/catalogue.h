/// Catalogue of techniques, options, presets, debug views and built-in scenes. No context needed;
/// any thread.
#ifndef AFTERGLOW_CATALOGUE_H
#define AFTERGLOW_CATALOGUE_H

#include <afterglow/types.h>

AG_BEGIN

struct ag_option_info {
    const char *name;
    const char *type;         ///< "int", "float", "bool", "choice" or "text"
    double initial, min, max; ///< initial: the default; of a choice, its index; 0 for texts
    /// The names of a choice, separated by '|'; the meaning of a text, such as "path". A text is
    /// empty by default; its commas are written %2C, plus signs %2B, percent signs %25.
    const char *unit;
    const char *effect; ///< of a change: "live", "invalidate", "resize", "recreate" or "rebake"
    const char *help;
    bool expert; ///< without gain in measurements, for comparisons, or of a method's inside
    uint64_t reserved[3]; ///< 0; see ABI in types.h
};

struct ag_technique_info {
    const char *name, *title, *paper;
    const char *role; ///< "source", "delta", "visibility" or "reflection"
    /// moving_geometry: its light follows objects that move, as drt's does those in free space.
    bool moving_geometry, moving_lights, needs_bake, makes_specular, publishes_probes;
    bool has_lightmap; ///< see lightmap.h
    bool exports_bake; ///< see ag_bake_export
    int option_count, preset_count, debug_view_count;
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};

/// Each function returns false if an index is out of range. Strings are static. Thread: any.
AG_API bool ag_technique_get(int index, struct ag_technique_info *out);
/// Thread: any.
AG_API bool ag_technique_option_get(int technique, int index, struct ag_option_info *out);
/// A preset, chosen by `name:quality=PRESET`: *options is "key=value,key=value", or "" for the
/// defaults. Options given beside the preset override it. name and options may be NULL.
/// Thread: any.
AG_API bool ag_technique_preset_get(int technique, int index, const char **name,
                                    const char **options);
/// Thread: any.
AG_API bool ag_technique_debug_view_get(int technique, int index, const char **name,
                                        const char **help);
/// Index of the debug view with this name or former name; -1: none. Thread: any.
AG_API int ag_technique_debug_view_find(int technique, const char *name);
/// Thread: any.
AG_API bool ag_frame_option_get(int index, struct ag_option_info *out);

struct ag_builtin_scene_info {
    const char *name, *title; ///< name without @
    int option_count;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API bool ag_builtin_scene_get(int index, struct ag_builtin_scene_info *out);
/// Thread: any.
AG_API bool ag_builtin_scene_option_get(int scene, int index, struct ag_option_info *out);

/// The known name closest to a misspelled one, for "did you mean …?"; NULL if none is close.
/// Thread: any.
AG_API const char *ag_nearest_name(const char *name, const char *const *known, int count);

AG_END

#endif
