// A method as the user chooses it: a source, a delta, a visibility and a reflection technique of
// the catalogue, each with all its options. Options of techniques that are not chosen keep their
// values.
#pragma once

#include <afterglow/afterglow.h>

enum { METHOD_TECHNIQUES = 24, METHOD_OPTIONS = 40, METHOD_VALUE = 768, METHOD_SPEC = 8192 };
enum method_role { ROLE_SOURCE, ROLE_DELTA, ROLE_VISIBILITY, ROLE_REFLECTION, ROLE_COUNT };

struct method {
    int chosen[ROLE_COUNT]; // indices of the catalogue; -1: none
    char values[METHOD_TECHNIQUES][METHOD_OPTIONS][METHOD_VALUE]; // as in a GI spec
};

extern const char *const method_roles[ROLE_COUNT]; // "source" …

// The source none, and the defaults of all options.
void method_init(struct method *method);
// Takes what a spec with all options states, as ag_renderer_gi returns it.
void method_parse(struct method *method, const char *gi);
// The GI spec: techniques and the options that differ from their defaults.
void method_print(const struct method *method, char out[METHOD_SPEC]);
// The default of an option, as in a GI spec.
void method_default(const struct ag_option_info *option, char out[METHOD_VALUE]);
double method_number(const char *value); // also of "true" and "false"
// The index of a choice's value in its names, which '|' separates; -1: none.
int method_choice(const struct ag_option_info *option, const char *value);
// Names of a choice, at most `capacity`, in `buffer`.
int method_choices(const struct ag_option_info *option, char *buffer, size_t size,
                   const char **names, int capacity);
// A GI spec in which techniques without options, and without a bake, have the preset "low".
void method_lower(const char *gi, char out[METHOD_SPEC]);
// Sets the options of a preset, the others to their defaults.
void method_set_preset(struct method *method, int technique, int preset);
