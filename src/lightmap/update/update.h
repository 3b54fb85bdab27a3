// Updates of a light map by paths: light of an earlier bake is kept where a change of the scene
// does not reach. Texels that are baked again get the bytes of a full bake.
//
// - match.c: instances and charts of both scenes that are equal;
// - before.c: the scene as it was, for the path tracer;
// - couple.c: both scenes choose the same lights for the same random numbers;
// - reach.c: which texels a change reaches, by estimates of the difference;
// - update.c: the stages of the bake.
#pragma once

#include "lightmap/gather.h"
#include "lightmap/update/record.h"
#include "scene/statics.h"

// ---- match.c

#define UPDATE_NONE UINT32_MAX

struct update_match {
    struct host *host;
    uint32_t *was;     // [now.instance_count] the instance of the same shape; UPDATE_NONE
    bool *same;        // [now.instance_count] and with the same surface
    bool *gone;        // [was.instance_count] is in no instance of now
    uint32_t *row_was; // [rows of now] the row of the earlier bake; UPDATE_NONE
    // Boxes around instances that have changed, as they were and as they are, each wider by its own
    // size: a point elsewhere is inside geometry if it was.
    struct box3 *near;
    struct box3 *boxes;  // themselves: boxes of the instances
    bool *near_is_small; // has few texels, which are baked again
    uint32_t near_count;
    uint32_t changed; // instances that were moved, added, removed or have another material
    uint32_t without; // rows without an earlier one
    bool same_lights;
};
// charts: of `now`. update_match_finish accepts zero.
bool update_match_init(struct update_match *out, struct host *host,
                       const struct lightmap_record *was, const struct lightmap_record *now,
                       const struct charts *charts);
void update_match_finish(struct update_match *match);
enum update_near { UPDATE_FAR, UPDATE_NEAR, UPDATE_BESIDE }; // BESIDE: in a small box
enum update_near update_near_change(const struct update_match *match, vec3s position);
// Whether two lights emit the same.
bool update_same_light(const struct world_light *a, const struct world_light *b);

// ---- before.c

// The scene of the earlier bake: instance i is that of now where both have the same shape. Others
// follow, and are read from the folder's copy of the scene. Shares all else with the scene of now,
// which must outlive it. update_before_finish accepts zero.
struct update_before {
    struct host *host;
    struct host quiet;  // the copy's warnings were given for the scene
    struct scene *file; // NULL: not needed
    struct scene_pose file_pose;
    struct scene_statics file_statics;
    struct scene scene;
    struct scene_pose pose;
    int added; // appended instances
};
bool update_before_init(struct update_before *out, struct host *host, const char *folder,
                        const struct scene_pose *now, const struct lightmap_record *was,
                        const struct update_match *match);
void update_before_finish(struct update_before *before);

// ---- couple.c

// Views of both scenes with one table of emitters, in which each has those of the other at no
// radiance: unbiased in both, and a random number chooses the same emitter. They share all else
// with the scenes. Punctual lights of `before` are replaced by those of the record, in the order of
// `now`. update_coupled_finish accepts zero.
struct update_coupled {
    struct host *host;
    struct trace_scene before, now;
    bool own_tables; // the scenes' emitters differ
};
bool update_coupled_init(struct update_coupled *out, struct host *host, struct trace_scene *before,
                         const struct trace_scene *now, const struct lightmap_record *was);
void update_coupled_finish(struct update_coupled *coupled);

// ---- reach.c

// Estimates of a texel: paths in both scenes with the same random numbers. All texels have one pair
// of halves, those whose surroundings seem to have changed have more.
enum { UPDATE_HALF_PATHS = 1, UPDATE_PAIRS = 8, UPDATE_PROBE_FLOATS = 8 };
struct update_probe {
    float change[3]; // now − before, lux
    float value[3];  // now, lux
    float variance;  // of one path's luminance, lux²
    float touched;   // 1: the texel is new, or its points are others; baked again
};
_Static_assert(sizeof(struct update_probe) == UPDATE_PROBE_FLOATS * sizeof(float), "a row");
// Sets suspects[row] of rows to look at again. samples: paths of a texel.
bool update_suspects(struct host *host, const struct charts *charts,
                     const struct update_probe *probes, int samples, uint8_t *suspects);
// Sets again[row] of rows to bake again.
bool update_reach(struct host *host, const struct charts *charts, const struct update_probe *probes,
                  int samples, uint8_t *again);

// ---- update.c

#define LIGHTMAP_AGAIN "texels/again" // U8 [texels of both sides], 1: baked again

struct lightmap_update {
    const struct lightmap_bake *how;
    const char *folder;
    // Taken over, also on failure: the record of the folder, and the charts of the scene.
    struct lightmap_record *was;
    struct charts *charts;
};
struct lightmap_change {
    uint32_t instances;          // changed
    bool lights;                 // some have changed
    uint32_t texels;             // of both sides
    const struct charts *charts; // of the plan
};
// In place of lightmap_add_stages. FAIL_FORMAT: the folder cannot be updated, the sentence says
// why.
bool lightmap_add_update_stages(struct bake_plan *plan, const struct lightmap_update *update,
                                struct lightmap_change *change);
