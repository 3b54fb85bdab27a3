// Scene, technique and options of a cached file, from its own header.
#pragma once

#include "cache.h"

#include <afterglow/context.h>

enum { CACHE_TEXT = 512 };
#define CACHE_PATH_TRACING "path tracing"

struct cache_content {
    char scene[CACHE_TEXT];     // as typed; "": the file does not state it
    char technique[CACHE_TEXT]; // of a bake; CACHE_PATH_TRACING of a reference; "" likewise
    char options[CACHE_TEXT];   // of the technique, or the view of a reference
};
// Reads the header alone. A left-over may end anywhere: its members are then "".
void cache_describe(struct ag_context *context, const struct cache_entry *entry,
                    struct cache_content *out);
// The options of a bake that are not the technique's defaults.
void cache_set_options(const struct cache_content *content, char out[CACHE_TEXT]);
