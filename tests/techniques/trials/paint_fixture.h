// Painted light in a scene of a baked_fixture, by position and normal of texels.
#pragma once

#include "scene/charts/charts.h"
#include "scene/statics.h"
#include "techniques/baked_fixture.h"

struct paint_fixture {
    struct frame_fixture *s;
    struct gi *gi;
    struct scene_statics statics;
    struct charts charts;
    float *lux; // [height][width][3] of a side
};

// After baked_fixture_open, and before baked_fixture_close.
void paint_fixture_open(struct paint_fixture *p, struct frame_fixture *s,
                        const struct baked_fixture *run);
void paint_fixture_close(struct paint_fixture *p);
// Paints both sides of the light map. Texels of gutters get light that is to be ignored.
void paint_fixture_paint(struct paint_fixture *p, vec3s (*lux)(vec3s position, vec3s normal));
// The same with values for each texel, [texels of both sides][3].
void paint_fixture_set(struct paint_fixture *p, const float *lux);
// Sets all paint to 0, without values.
void paint_fixture_clear(struct paint_fixture *p);
