// Validation and completion of imported meshes. Internal to src/scene/import.
#pragma once

#include "scene/import/import_context.h"

// The smallest and the largest index; false if one is not below vertex_count. Needs triangles.
bool import_check_indices(struct import *import, const struct mesh *mesh, uint32_t *low,
                          uint32_t *high);

// Removes unused vertices and unneeded tangents, checks that every attribute is finite, generates
// missing flat normals, the tangents that a normal map needs, and bounds.
bool import_finish_mesh(struct import *import, struct mesh *mesh);
