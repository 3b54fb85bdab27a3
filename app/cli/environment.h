// Environment light from the command line: "FILE[:rotation=DEG,strength=S]" or
// "sun-sky[:elevation=DEG,azimuth=DEG,turbidity=T,rotation=DEG,strength=S]".
#pragma once

#include <afterglow/environment.h>

enum { ENVIRONMENT_PATH = 4096 };

struct environment_value {
    char path[ENVIRONMENT_PATH]; // "": the clear sky
    struct ag_sun_sky_desc sky;
    struct ag_environment_use use;
};
// False for wrong values, with *why.
bool value_environment(const char *text, struct environment_value *out, const char **why);
// Reads the image or makes the sky.
enum ag_result environment_make(struct ag_context *context, const struct environment_value *value,
                                struct ag_environment **out);
// Makes the environment the scene's.
enum ag_result environment_apply(struct ag_context *context, struct ag_scene *scene,
                                 const struct environment_value *value);
