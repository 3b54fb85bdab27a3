// The light that dnrt takes of a source's probes.
#pragma once

#include "techniques/baked_fixture.h"

// Irradiance at a point between probes that do not say what they see, over normals, lux.
void probe_fixture_at(struct baked_fixture *run, struct frame_fixture *s, vec3s point,
                      float c[3][9]);
