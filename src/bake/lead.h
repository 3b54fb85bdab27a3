// Rank 0 of a team: deals out tasks to the others as they become free, and keeps their results.
#pragma once

#include "bake/run_state.h"

// Waits until every rank takes part and prepares; refuses those that bake something else. NULL:
// failed, and the others have been told. Ends with lead_destroy.
struct lead *lead_create(struct bake *bake, const struct bake_run_options *options);
void lead_destroy(struct lead *lead);
// With a bake that is complete without a run: the others end.
bool lead_dismiss(struct lead *lead);

// A run: the journal is begun, then waves are dealt, then the others end. ok: it was not
// cancelled and did not fail.
bool lead_begin(struct bake_run *run);
void lead_begin_wave(struct bake_run *run);
void lead_end(struct bake_run *run, bool ok);
// Takes messages and deals out tasks; false: a rank was asked to stop. Calling thread only.
bool lead_poll(struct bake_run *run);
// Running tasks of the others are cancelled.
void lead_stop(struct bake_run *run);
// Whether some other rank takes part.
bool lead_has_others(const struct lead *lead);
// The threads of the other ranks that take part, together.
int lead_threads(const struct lead *lead);
