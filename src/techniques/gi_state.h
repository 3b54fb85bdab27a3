// State of a GI stack, for gi.c and gi_change.c.
#pragma once

#include "techniques/gi.h"

#include "techniques/common/probes/view.h"

// A further view of the frame.
struct gi_view {
    uint32_t width, height;    // 0: there is no such view
    void *state[GI_MAX_TERMS]; // of techniques that share nothing; else NULL
};

struct gi {
    struct host *host;
    struct gpu *gpu;
    struct gi_spec spec;
    uint32_t width, height; // of view 0
    void *state[GI_MAX_TERMS];
    struct gi_view views[FRAME_MAX_VIEWS]; // the first is not used
    bool warned_fixed[GI_MAX_TERMS];       // the warning of gi_invalidate
    int debug_term;                        // the technique of the debug view
    const char *debug_name;                // NULL: none
    gpu_image debug_image;
    struct probe_view probe_view; // created with its first use
};

// Whether each view has a state of its own.
static inline bool gi_is_per_view(const struct technique *technique)
{
    return !technique->update;
}

// Checks and creates one technique, for all views that it has a common state for, or for one. After
// a failure *state is half-built, or NULL.
bool gi_create_state(const struct gi *gi, const struct technique *technique, const void *options,
                     const struct tensors *bake, const struct scene_pose *pose, int view,
                     void **state);
void gi_destroy_state(const struct gi *gi, const struct technique *technique, const void *options,
                      void *state);
