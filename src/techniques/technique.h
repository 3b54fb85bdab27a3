// The interface of a technique: one const struct, data first, then functions in the order of their
// calls. A frame is lit by a GI stack, whose spec is written as
// "source+delta+visibility+reflection", for example "lpv" or "mrt+dnrt+vo+ssr".
#pragma once

#include "bake/bake.h"
#include "core/option.h"
#include "frame/frame.h"
#include "gpu/gpu.h"
#include "scene/pose.h"
#include "techniques/common/light_map/paint.h"
#include "techniques/common/probes/volume.h"

// In the order in which they record.
enum technique_role {
    ROLE_SOURCE,
    ROLE_DELTA,
    ROLE_VISIBILITY,
    // Blends reflections into FRAME_SPECULAR, which has the source's by then: 0 where it writes
    // none.
    ROLE_REFLECTION,
    ROLE_COUNT
};

enum technique_capability {
    CAN_MOVE_GEOMETRY = 1,
    CAN_MOVE_LIGHTS = 2,
    NEEDS_BAKE = 4,
    MAKES_SPECULAR = 8,
    PUBLISHES_PROBES = 16,
    GATHERS_EMISSION = 32, // emissive surfaces light others
    KEEPS_GEOMETRY = 64,   // `follow` follows materials alone
};

// Changes, for `invalidate`. frame_view has those of lights and of movable geometry, too, for a
// history that follows them.
enum technique_change {
    CHANGED_GEOMETRY = 1, // static instances added or removed
    CHANGED_MATERIAL = 2,
    CHANGED_LIGHT = 4,  // punctual lights or sky
    CHANGED_CAMERA = 8, // a cut
    CHANGED_OPTIONS = 16,
    CHANGED_MOVABLE = 32, // instances moved, or movable ones were added, removed or deformed
};

struct technique_debug_view {
    const char *name, *help;
    const char *old_name; // of the last release, still accepted with a warning; NULL: none
};
// Options that `quality=NAME` sets, as "steps=4,dim=16", before other options of the spec apply.
// "": the defaults.
struct technique_preset {
    const char *name, *options;
};
// gi.c draws the view of this name from the technique's probes; debug_view is not called.
#define PROBES_VIEW      "probes"
#define PROBES_VIEW_HELP "white spheres at the probes and surfaces lit by them; needs probes=true"

struct charts; // scene/charts/charts.h
struct charts_search;

struct technique_create {
    struct host *host;
    struct gpu *gpu;
    const struct scene_pose *pose;
    const void *options;
    uint32_t width, height;
};

struct technique_bake {
    const struct scene_pose *pose; // outlives the bake
    const void *options;
    bool full_report; // add stages whose tensors are BAKE_REPORTED
    bool all_objects; // of a delta: all instances count as movable, as those of an asset
};

struct technique {
    const char *name;   // stable, [a-z0-9]+
    const char *title;  // a few words
    const char *paper;  // one-line citation
    const char *folder; // shared with another technique; NULL: the technique's name
    enum technique_role role;
    uint32_t capabilities; // technique_capability bits
    uint32_t needs;        // frame_need bits
    int bake_version;      // 0: no bake
    const char *bake_name; // of the technique that has the same bake; NULL: the technique's name
    struct option_table options;
    const struct technique_preset *presets; // by ascending cost; ends with a NULL name; may be NULL
    const struct technique_debug_view *debug_views; // ends with a NULL name; may be NULL
    // Bytes of the private state, which technique.c allocates zeroed. It begins with the options,
    // which technique.c writes: before `create`, and after `set_options`.
    size_t state_size;

    // All but record may be NULL. `state` is the private state. Objects and scopes are
    // named without the technique's name: gi.c has it pushed as their owner.
    // The GPU objects of a state whose view `number` has this size, 0 × 0: none. Those before
    // `create` are of view 0; of further views only rows `of_view` count. Options of effect LIVE
    // and INVALIDATE do not change the table.
    void (*objects)(const void *options, int number, uint32_t width, uint32_t height,
                    struct gpu_objects *out);
    // frame_need bits of these options, in addition to `needs`.
    uint32_t (*more_needs)(const void *options);
    // false: it cannot run on this device and scene; host_fail has the reason.
    bool (*check)(const struct technique_create *how);
    // Chooses what the options leave to the size of the scene, the longest side of its bounds; 0:
    // unknown. The choice is beside the rows of their table, which stay. Before `objects`.
    void (*fit)(void *options, float scene_size_m);
    // Replaces options that leave a choice to the scene by the choice: those of effect REBAKE, of
    // which a bake is identified. Idempotent.
    bool (*resolve)(struct host *host, const struct scene_pose *pose, void *options);
    // The block map for these options as JSON, owned by the caller; NULL: host_fail has the reason.
    char *(*block_map)(struct host *host, const struct scene_pose *pose, const void *options);
    // The block map of a JSON text, likewise.
    char *(*read_block_map)(struct host *host, const char *json);
    // Adds the stages of a bake for these options, resolved; see bake/README.md. `how` outlives the
    // bake.
    bool (*bake)(struct bake_plan *plan, const struct technique_bake *how);
    // Adds members to the report of a complete bake. After a run bake_reported has the
    // BAKE_REPORTED tensors too, after reading a file it has not.
    bool (*bake_report)(struct report *report, struct bake *bake, const struct technique_bake *how);
    // Writes the data of a complete bake, whose content is untrusted, for other programs into an
    // existing folder: each file completely or not at all, index.json last. `how`: as for `bake`.
    // NULL: it has no such data.
    bool (*bake_export)(struct host *host, const struct tensors *bake,
                        const struct technique_bake *how, const char *folder);
    bool (*create)(void *state, const struct technique_create *how);
    // After `create`: copies or uploads the data of a bake, whose identity has been checked and
    // whose content is untrusted (tensors_expect). The tensors end with the call.
    bool (*load)(void *state, const struct tensors *bake);
    // A view has this size, and objects for it: view 0 that of `create` until then. 0 × 0: the view
    // has ended.
    bool (*resize)(void *state, int view, uint32_t width, uint32_t height);
    // Those of the state are about to become these: only effects LIVE and INVALIDATE. NULL:
    // `invalidate` with CHANGED_OPTIONS.
    void (*set_options)(void *state, const void *options);
    void (*invalidate)(void *state, uint32_t changes); // technique_change bits
    // Before each frame is recorded, with the pose that it shows: follows changes of surfaces, with
    // KEEPS_GEOMETRY of materials alone, and warns of what it cannot follow. Of techniques without
    // it or CAN_MOVE_GEOMETRY gi.c warns. `wait`: the frame shows them, however long it takes.
    void (*follow)(void *state, const struct scene_pose *pose, bool wait);
    // Whether its bake lacks what `follow` has found, which another bake has. NULL: never.
    bool (*lacks_bake)(const void *state);
    // Whether the light of the newest frame is older than what it shows, and further frames bring
    // it. NULL: never.
    bool (*is_updating)(const void *state);
    // No allocation, no wait, no failure. `update` is the light that all views share: volumes,
    // voxels, probes; once a frame, with the first view. `record` is what a view's pixels get of
    // it; once a view. A technique without `update` shares nothing: each view has a state of its
    // own, for which it is view 0.
    void (*update)(void *state, struct gpu_cmd *cmd, const struct frame_view *view);
    void (*record)(void *state, struct gpu_cmd *cmd, const struct frame_view *view);
    void (*debug_view)(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                       const char *name,
                       gpu_image out); // RGBA16F of the frame's size, scaled radiance
    // With PUBLISHES_PROBES: the volume that the newest update filled. false: the option `probes`
    // is off.
    bool (*probes)(void *state, struct probe_volume *out);
    // For a delta that needs the probes of its source: called before each `update`.
    void (*set_probes)(void *state, const struct probe_volume *source);
    // The light map: the charts of static surfaces (scene/statics.h), and for each side and colour
    // a layer of irradiance along the surface's normal and vector irradiance, scaled radiance,
    // RGBA16F, that the newest update filled.
    // Options of `has_light_map` may be without; NULL: none are.
    bool (*has_light_map)(const void *options);
    // begin: as of charts_wish.
    bool (*charts)(const struct scene_pose *statics, const void *options, struct host *host,
                   const struct charts_search *begin, struct charts *out);
    gpu_image (*light_map)(void *state);
    // Painted first-order light of the light map's texels, which `update` records.
    struct light_map_paint *(*paint)(void *state);
    void (*destroy)(void *state); // before that of `objects`; accepts any half-built state
    // Bytes of GPU memory for these options, beside that of `objects`: of what `load` creates.
    uint64_t (*memory_estimate)(const void *options);
};

// Whether it has a light map with these options.
static inline bool technique_has_light_map(const struct technique *technique, const void *options)
{
    return technique->light_map && (!technique->has_light_map || technique->has_light_map(options));
}

// ---- technique.c: a technique with its objects. The owner is pushed by the caller.

// The pipelines of its objects, for a compiler.
bool technique_compile(const struct technique *technique, const void *options,
                       struct gpu *compiler);
bool technique_create(const struct technique *technique, void *state,
                      const struct technique_create *how);
void technique_set_options(const struct technique *technique, void *state, const void *options);
bool technique_resize(const struct technique *technique, struct gpu *gpu, void *state,
                      const void *options, int view, uint32_t width, uint32_t height);
// Accepts any half-built state.
void technique_destroy(const struct technique *technique, struct gpu *gpu, void *state,
                       const void *options);
// Bytes of GPU memory, without creating anything.
uint64_t technique_memory(const struct technique *technique, const void *options, uint32_t width,
                          uint32_t height);
// The part of technique_memory that a further view of this size adds. shared: it shares the memory
// of the first view (gpu_image_desc.alias).
uint64_t technique_view_memory(const struct technique *technique, const void *options,
                               uint32_t width, uint32_t height, bool shared);
