// Places indoors and outdoors.
#pragma once

#include "techniques/mrt/level/map/map_cells.h"

// Greatest distance at which a surface is a roof or a wall: a dome for the sky is none.
float mrt_roof_reach(struct box3 scene);
// Whether nearly all rays from a point meet the front of a surface within `reach`, straight up too.
bool mrt_is_enclosed(const struct raycast *raycast, vec3s point, float reach);
// Whether a box around a scene is no room: from places in it most rays leave it, or see solids.
bool mrt_box_is_open(const struct raycast *raycast, struct box3 box);
// Whether a cell is no room: open to the sky, or a part of the outdoors that has a room in it.
bool mrt_cell_is_outside(const struct mrt_cells *cells, const int at[3]);
// Whether rays along the axes mostly meet backs.
bool mrt_is_in_solid(const struct mrt_cells *cells, vec3s point);
// Whether a cell is the inside of a wall or an object: no twentieth of it is air.
bool mrt_cell_is_solid(const struct mrt_cells *cells, const int at[3]);
