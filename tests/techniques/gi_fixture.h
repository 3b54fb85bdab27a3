// GI stacks for tests of all techniques. Techniques that bake get a small bake: it obeys the same
// laws. Failures end the test.
#pragma once

#include "frame/frame_fixture.h"
#include "techniques/gi.h"

// Numbers that need another bake have their smallest value.
void gi_fixture_parse(struct gi_spec *spec, const char *text);
// Bakes what the spec needs; a bake is kept for the next stack with the same options.
struct gi *gi_fixture_create(struct gpu *gpu, const struct gi_spec *spec,
                             const struct scene_pose *pose, uint32_t width, uint32_t height);
// The same for a frame_fixture that is open: its next frames are lit by the stack. Options are
// those of the text; the second has them as gi_fixture_parse.
struct gi *gi_fixture_light(struct frame_fixture *s, const char *text);
struct gi *gi_fixture_light_small(struct frame_fixture *s, const char *text);
