// A frame_fixture lit by a GI stack that bakes: opening it runs the bakes in memory.
#pragma once

#include "frame/frame_fixture.h"
#include "techniques/gi_baked.h"

struct baked_fixture {
    struct gi_spec spec;
    struct gi_baked baked;
    struct gi *gi;
};

// Also opens and finishes the frame_fixture.
void baked_fixture_open(struct baked_fixture *run, struct frame_fixture *s, const char *text);
void baked_fixture_close(struct baked_fixture *run, struct frame_fixture *s);
