// Block maps that are made: one block for the whole scene, or boxes in its connected free space.
#pragma once

#include "scene/pose.h"

#include "techniques/mrt/level/block_map.h"

// One closed cube warped to the bounding box of the scene (Loos 2015, section 3.6.2).
bool mrt_map_single(struct host *host, const struct scene_pose *pose, struct mrt_block_map *map);

// Boxes in the free space that is connected with the seeds (positions of the camera and the
// lights), and in rooms that are too small in their scene for its planes; openings where they
// touch. Walls that follow no axis are replaced by the box around them. If no seed is inside a
// room, the default camera is one; without any room the same as mrt_map_single.
bool mrt_map_auto(struct host *host, const struct scene_pose *pose, const vec3s *seeds,
                  size_t seed_count, struct mrt_block_map *map);
