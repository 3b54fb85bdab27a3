// GI stacks for tests of all techniques. Techniques that bake get a small bake: it obeys the same
// laws. Failures end the test.
#pragma once

#include "techniques/gi.h"

// Numbers that need another bake have their smallest value.
void gi_fixture_parse(struct gi_spec *spec, const char *text);
// Bakes what the spec needs; a bake is kept for the next stack with the same options.
struct gi *gi_fixture_create(struct gpu *gpu, const struct gi_spec *spec,
                             const struct scene_pose *pose, uint32_t width, uint32_t height);
