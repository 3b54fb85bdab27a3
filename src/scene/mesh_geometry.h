// What meshes need and files leave out: bounds, flat normals, tangents. The functions that make
// vertices replace all arrays of a mesh by new ones from the arena and leave the old ones as they
// were: they may be shared.
#pragma once

#include "scene/scene.h"

// A new mesh of `count` vertices: vertex i is a copy of the old vertex source[i], in every array
// and morph target. Indices are kept: the caller replaces them. False when out of memory; the mesh
// is then unchanged.
bool mesh_gather(struct arena *arena, struct mesh *mesh, const uint32_t *source, uint32_t count);

// Of the rest positions; empty for a mesh without vertices.
struct box3 mesh_bounds(const struct mesh *mesh);

// Flat shading, as glTF 2.0 asks where normals are absent: each triangle gets three vertices of its
// own, with the normal of its plane (+y where it has no area). False when out of memory; the mesh
// is then unchanged.
bool mesh_make_normals(struct arena *arena, struct mesh *mesh);

// Tangents along the u of `map`, its transform included, averaged over the triangles at a vertex by
// their angles. Vertices where mirrored and unmirrored mapping meet are doubled. Needs normals. A
// mesh without the map's texture coordinates keeps tangents NULL. False when out of memory; the
// mesh is then unchanged.
bool mesh_make_tangents(struct arena *arena, struct mesh *mesh, const struct texture_use *map);
