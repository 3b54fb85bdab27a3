// A GI stack: the techniques of a GI spec such as "lpv:steps=8,dim=32+vo" or "lpv:quality=low". It
// is the frame's indirect hook.
#pragma once

#include "techniques/technique.h"

#define GI_MAX_TERMS ROLE_COUNT

// A parsed spec: at most one technique of each role, sorted as source, delta, visibility,
// reflection. There is always a source: "vo" is "ambient+vo".
struct gi_spec {
    struct host *host;
    int count;
    const struct technique *technique[GI_MAX_TERMS];
    void *options[GI_MAX_TERMS];
    bool added_source; // the text names other techniques, without a source
};
// "" is "none". Errors name the unknown technique or option and the nearest known one.
bool gi_spec_parse(struct gi_spec *spec, struct host *host, const char *text);
void gi_spec_finish(struct gi_spec *spec); // accepts zero
// Chooses what the options leave to the size of the scene (technique.fit).
void gi_spec_fit(struct gi_spec *spec, float scene_size_m);
// The same with a scene's bounds.
void gi_spec_fit_pose(struct gi_spec *spec, const struct scene_pose *pose);
// The spec with all options, owned by the caller.
char *gi_spec_print(const struct gi_spec *spec);
bool gi_spec_gathers_emission(const struct gi_spec *spec);

struct gi;
// Complete bakes of the spec's terms, needed during the call only; NULL: none.
struct gi_bakes {
    const struct tensors *of_term[GI_MAX_TERMS];
};
// Checks and creates each technique, which loads its bake then. The spec is copied.
struct gi *gi_create_baked(struct host *host, struct gpu *gpu, const struct gi_spec *spec,
                           const struct gi_bakes *bakes, const struct scene_pose *pose,
                           uint32_t width, uint32_t height);
void gi_destroy(struct gi *gi);
bool gi_resize(struct gi *gi, uint32_t width, uint32_t height);
// Adds a view of the same light, 1 to FRAME_MAX_VIEWS − 1, or changes its size. 0 × 0 removes it.
// false: there is no such view any more.
bool gi_resize_view(struct gi *gi, int view, const struct scene_pose *pose, uint32_t width,
                    uint32_t height);
// changes: technique_change bits. A technique that cannot follow them warns once and continues.
void gi_invalidate(struct gi *gi, uint32_t changes);
// Before each frame, with its pose, once the changes are known. `wait`: for work beside frames.
void gi_follow(struct gi *gi, const struct scene_pose *pose, bool wait);
// Whether further frames bring light that is not yet that of the scene.
bool gi_is_updating(const struct gi *gi);
// Whether a technique cannot follow moving geometry, and has not yet warned.
bool gi_would_warn_of_movement(const struct gi *gi);
// The animation has moved surfaces since the creation: such techniques warn once.
void gi_warn_of_movement(struct gi *gi);
// Applies another spec's options to the running stack. false, and nothing changed: it names other
// techniques, or changes options that need another stack (their effect is stronger than
// INVALIDATE).
bool gi_set_options(struct gi *gi, const struct gi_spec *spec);
// The running term that continues as this one of another spec, since set_options suffices; -1: the
// technique is created again.
int gi_continues(const struct gi *gi, const struct gi_spec *spec, int term);
// Whether the bake of a running term lacks what the scene now has (technique.lacks_bake).
bool gi_lacks_bake(const struct gi *gi, int term);
// Exchanges the running stack for that of another spec; `bakes` has those of the terms created
// again. A term that lacks a bake is created again if there is one. A debug view ends unless its
// technique stays. false: nothing changed.
bool gi_change(struct gi *gi, const struct gi_spec *spec, const struct gi_bakes *bakes,
               const struct scene_pose *pose);
struct frame_indirect gi_hook(struct gi *gi); // refers to gi
// The debug view shown instead of colour from the next frame on; NULL: none. false: no technique
// has it; the message names the known ones.
bool gi_set_debug_view(struct gi *gi, const char *name);
// The image of the debug view; none if no view is set.
gpu_image gi_debug_image(const struct gi *gi);
bool gi_has_debug_view(const struct gi *gi);
// The stack's probe volume of the newest frame; false: no technique publishes one; the message
// names the option that does.
bool gi_probes(const struct gi *gi, struct probe_volume *out);
// The term whose technique has a light map that the newest update filled; host_fail where none has.
bool gi_light_map(const struct gi *gi, int *term, gpu_image *out);
// Sets the painted light of texels, from the next update on. false, and nothing changed: no
// technique takes it, or as light_map_paint_set.
bool gi_paint(struct gi *gi, const struct light_map_area *area);
float gi_painted(const struct gi *gi); // largest painted irradiance, lux
uint64_t gi_memory_estimate(const struct gi_spec *spec, uint32_t width, uint32_t height);
uint32_t gi_spec_needs(const struct gi_spec *spec);           // frame_need bits
uint32_t gi_term_needs(const struct gi_spec *spec, int term); // those of one technique
// Bytes that a further view of this size adds; apart: it shares no memory.
uint64_t gi_view_memory_estimate(const struct gi_spec *spec, uint32_t width, uint32_t height,
                                 bool apart);
