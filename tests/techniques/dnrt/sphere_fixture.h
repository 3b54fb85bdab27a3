// A mesh of a unit sphere at the origin, within 1e-4 of it.
#pragma once

#include "scene/scene.h"

int sphere_fixture_add(struct scene *scene, int material); // returns the mesh
