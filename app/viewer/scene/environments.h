// The environment of a scene: the one that it was opened with, none, or an image from a file. Each
// copy of the scene has one of these, in its own context.
#pragma once

#include <afterglow/afterglow.h>

enum { ENVIRONMENT_PATH_SIZE = 1024 };
enum environment_source { ENVIRONMENT_OF_SCENE, ENVIRONMENT_NONE, ENVIRONMENT_FILE };
extern const char *const environment_sources[3]; // "scene", "none", "file"

struct environment_choice {
    enum environment_source source;
    char path[ENVIRONMENT_PATH_SIZE]; // of the file, .hdr or .exr
    float strength;                   // factor of its light
    float rotation;                   // about +y, rad, counterclockwise seen from above
};
bool environment_choices_same(const struct environment_choice *a,
                              const struct environment_choice *b);

struct environments {
    struct ag_context *context;
    struct ag_scene *scene;
    struct ag_environment *first, *loaded; // NULL: none
    char path[ENVIRONMENT_PATH_SIZE];      // of the loaded one
};

// Takes the environment that the scene has, and sets *first to it. environments_end accepts zero.
enum ag_result environments_begin(struct environments *e, struct ag_context *context,
                                  struct ag_scene *scene, struct environment_choice *first);
void environments_end(struct environments *e);
// Gives the scene an environment; a file is read once in a row. After a failure nothing has
// changed.
enum ag_result environments_set(struct environments *e, const struct environment_choice *choice);
