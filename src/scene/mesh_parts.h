// Connected parts of a mesh: triangles connected by corners of equal position, whatever their
// normals and texture coordinates.
#pragma once

#include "core/host.h"
#include "scene/scene.h"

// Writes the part of each triangle; parts are numbered in the order of their first triangles.
// Returns their number, or -1 without memory.
int mesh_parts(struct host *host, const struct mesh *mesh, uint32_t *part_of_triangle);
