// The clip map: grids of the same resolution around the camera, each with voxels half as large as
// those of the previous one.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/clipmap/clipmap_shared.h"
#include "techniques/vct/clipmap/grid.h"
#include "techniques/vct/vct_shared.h"

// A grid; that of the first level covers the whole scene.
struct vct_clip {
    struct vct_grid grid;     // of this frame
    struct vct_grid lit_grid; // when the light volume was filled
    struct box3 cone_box;     // see vct_grid_cone_box
    bool moved;               // it is another grid than that of the previous frame
};

struct vct_clipmap {
    struct vct_clip levels[VCT_MAX_CLIPS];
    int count;
    const struct scene *scene; // of the grids
    uint64_t draw_list;        // of scene_gpu
};

enum vct_clipmap_change { // bits
    VCT_NO_EXTENT = 1,    // of the scene: there are no grids
    VCT_OTHER_DRAWS = 2,  // than in the previous frame
    VCT_OTHER_GRID = 4,   // of the whole scene: its light is gone
};

// Fits the grids to the scene and the camera. Returns what has changed.
uint32_t vct_clipmap_update(struct vct_clipmap *map, int resolution, const struct frame_view *view);
// The light volume has been filled from these grids.
void vct_clipmap_note_lit(struct vct_clipmap *map);
enum vct_clip_table_of {
    VCT_OF_PIXELS,      // boxes around the camera
    VCT_OF_VOXEL_RAYS,  // whole grids
    VCT_OF_VOXEL_CONES, // whole grids, as they were when the light volume was filled
};

// The uniform block "vct_clipmap".
struct vct_clip_table vct_clipmap_table(const struct vct_clipmap *map, int resolution,
                                        enum vct_clip_table_of of);
// Side of the finest texel of the light volume, m.
float vct_clipmap_texel_m(const struct vct_clipmap *map);
// The longest side of the grid of the whole scene, m.
float vct_clipmap_longest_side_m(const struct vct_clipmap *map);
