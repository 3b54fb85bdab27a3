// Meshes of unit size at the origin; each returns the mesh.
#pragma once

#include "bake/tensors.h"
#include "scene/pose.h"
#include "trace/trace.h"

int sphere_fixture_add(struct scene *scene, int material); // within 1e-4 of it
// A hemispherical bowl, single surfaces that are seen from within: every point of it sees the bowl
// by a form factor of ½ and the opening by the other half.
int bowl_fixture_add(struct scene *scene, int material);
// The inside of a cube without a lid, of edges of 2: ten triangles.
int crate_fixture_add(struct scene *scene, int material);

// A scene of one such mesh, to trace.
struct traced_shape {
    struct scene *scene;
    struct scene_pose pose;
    struct trace_scene *trace;
};
void traced_shape_open(struct traced_shape *shape, const struct material *material,
                       int (*add)(struct scene *, int material));
void traced_shape_close(struct traced_shape *shape);

// The tensor of this name of a bake of one object: its names have the key of the mesh.
const struct tensor *baked_tensor(const struct tensors *bake, const char *name);
