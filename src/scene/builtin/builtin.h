// The built-in scenes, made by code.
#pragma once

#include "scene/scene.h"

#include "core/option.h"

struct builtin_scene {
    const char *name;  // without the @
    const char *title; // one line
    struct option_table options;
    bool (*build)(struct scene *scene, const void *options);
};

extern const struct builtin_scene *const builtin_scenes[]; // NULL-terminated

// `spec` is "@name" or "@name:key=value,…". An unknown name is an error that suggests the nearest
// one.
struct scene *builtin_load(struct host *host, const char *spec);
