// The last step of every imported mesh. Internal to src/scene/import.
#pragma once

#include "scene/import/import_context.h"

// The least and greatest index; false where one lies beyond vertex_count. The mesh has triangles.
bool import_check_indices(struct import *import, const struct mesh *mesh, uint32_t *low,
                          uint32_t *high);

// Bounds, flat normals where there are none, tangents where the material's normal map asks for
// them; drops the vertices that no triangle uses and tangents that nobody needs. Checks that every
// attribute is finite.
bool import_finish_mesh(struct import *import, struct mesh *mesh);
