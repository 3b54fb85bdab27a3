// Environment light from the command line: "FILE[:rotation=DEG,strength=S,turn=DEG]" or
// "sun-sky[:elevation=DEG,azimuth=DEG,turbidity=T,rotation=DEG,strength=S,turn=DEG]".
#pragma once

#include <afterglow/environment.h>

enum { ENVIRONMENT_PATH = 4096 };

struct environment_value {
    char path[ENVIRONMENT_PATH]; // "": the clear sky
    struct ag_sun_sky_desc sky;
    struct ag_environment_use use;
    float turn; // rotation from one frame to the next, rad
};
// False for wrong values, with *why.
bool value_environment(const char *text, struct environment_value *out, const char **why);
// Reads the image or makes the sky.
enum ag_result environment_make(struct ag_context *context, const struct environment_value *value,
                                struct ag_environment **out);
// Turns the environment of a scene to its rotation in a frame.
enum ag_result environment_turn(struct ag_scene *scene, const struct ag_environment *environment,
                                const struct environment_value *value, int frame);
