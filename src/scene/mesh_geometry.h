// Bounds, flat normals and tangents of a mesh. Functions that add vertices replace all arrays of
// the mesh by new ones from the arena; the old arrays, which meshes may share, stay unchanged.
#pragma once

#include "scene/scene.h"

// A new mesh of `count` vertices: vertex i is a copy of the old vertex source[i], in every array
// and morph target. Indices are kept: the caller replaces them. False when out of memory; the mesh
// is then unchanged.
bool mesh_gather(struct arena *arena, struct mesh *mesh, const uint32_t *source, uint32_t count);

// Bounds of the rest positions; empty for a mesh without vertices.
// A unit tangent orthogonal to a unit normal, w = ±1. Arbitrary where the tangent has length zero,
// is parallel to the normal, or is not finite.
vec4s mesh_unit_tangent(vec3s normal, vec4s tangent);
struct box3 mesh_bounds(const struct mesh *mesh);

// Flat normals, which glTF 2.0 requires where normals are absent: each triangle gets three vertices
// of its own with the normal of its plane (+y for a degenerate triangle). False when out of memory;
// the mesh is then unchanged.
bool mesh_make_normals(struct arena *arena, struct mesh *mesh);
// The flat normals of such a mesh after its positions changed.
void mesh_update_normals(struct mesh *mesh);

// Tangents along the u axis of `map` (after its transform), averaged over the triangles at a
// vertex, weighted by angle. Vertices shared by mirrored and unmirrored triangles are duplicated.
// Needs normals. A mesh without the map's texture coordinates keeps tangents NULL. False when out
// of memory; the mesh is then unchanged.
bool mesh_make_tangents(struct arena *arena, struct mesh *mesh, const struct texture_use *map);
// The tangents of a mesh after its positions or normals changed; their signs stay. False when out
// of memory; the tangents are then unchanged.
bool mesh_update_tangents(struct host *host, struct mesh *mesh, const struct texture_use *map);
