// State of a GI stack, for gi.c and gi_change.c.
#pragma once

#include "techniques/gi.h"

#include "techniques/common/probe_view.h"

struct gi {
    struct host *host;
    struct gpu *gpu;
    struct gi_spec spec;
    uint32_t width, height;
    void *state[GI_MAX_TERMS];
    bool said_fixed[GI_MAX_TERMS]; // the warning of gi_invalidate
    int debug_term;                // the technique of the debug view
    const char *debug_name;        // NULL: none
    gpu_image debug_image;
    struct probe_view probe_view; // created with its first use
};

// Checks and creates one technique. After a failure *state is half-built, or NULL.
bool gi_create_state(const struct gi *gi, const struct technique *technique, const void *options,
                     const struct tensors *bake, const struct scene_pose *pose, void **state);
void gi_destroy_state(const struct gi *gi, const struct technique *technique, void *state);
