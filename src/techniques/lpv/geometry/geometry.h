// The geometry volume, the occluders of the light (Martin 2012, sec. 3.2.2; Hong 2015,
// sec. 2.5.2.4). docs/notes/lpv.md compares its sources.
#pragma once

#include <stdbool.h>

struct frame_view;
struct gpu_cmd;
struct lpv;

// Discards the cached static geometry.
void lpv_geometry_invalidate(struct lpv *lpv);
// Nothing where the option `geometry` is off.
void lpv_record_geometry(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);

// geometry_maps.c, geometry_scene.c: the two sources. The second returns false where the cached
// volume is still valid.
void lpv_record_geometry_maps(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
bool lpv_record_geometry_scene(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
