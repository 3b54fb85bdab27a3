// Damaged bakes: a bake of a frame_fixture, of which tensors are changed before it is loaded.
//
//     struct damage_fixture u = { 0 };
//     fixture_init(&u.s, gpu); // and its geometry
//     damage_open(&u, "radiosity", 0);
//     *(float *)damage_own(&u, damage_index(&u, "regions/scale")) = NAN;
//     CHECK(!damage_loads(&u));
//     damage_restore(&u, i);
//     damage_close(&u);
#pragma once

#include "frame/frame_fixture.h"
#include "techniques/gi_baked.h"

struct damage_fixture {
    struct frame_fixture s;
    struct gi_spec spec;
    struct gi_baked baked;
    int term;                   // whose bake is damaged
    const struct tensors *from; // the whole bake
    struct tensor *at;          // a copy of its tensors, whose data may be replaced
    struct tensors set;
};

void damage_open(struct damage_fixture *u, const char *text, int term); // also opens u->s
void damage_close(struct damage_fixture *u);
size_t damage_index(const struct damage_fixture *u, const char *tensor);
// A copy of the tensor's data of exactly its size: the sanitizer sees reads beyond it.
void *damage_own(struct damage_fixture *u, size_t tensor);
void damage_restore(struct damage_fixture *u, size_t tensor);
// A bake that is accepted renders a frame, too. A refusal is FAIL_FORMAT with a message.
bool damage_loads(struct damage_fixture *u);
// It is refused with one line that has this text.
void damage_check_refused(struct damage_fixture *u, const char *message);

// Instead of fixture_init: a closed room with a light and an emissive block.
void damage_open_room(struct damage_fixture *u, struct gpu *gpu, const char *text);
// Each tensor that is missing, or smaller along an axis, is refused by name.
void damage_check_tensors(struct damage_fixture *u);
// Each tensor of floats of which one element is not finite is refused by name.
void damage_check_finite(struct damage_fixture *u);
// A tensor of halves draws with large, negative and random values.
void damage_check_halves(struct damage_fixture *u, const char *tensor);
