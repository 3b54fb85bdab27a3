// Undo and redo of what the user changed: the scene and the methods. Camera, exposure and what is
// shown are no steps: they change all the time and are brought back by the panels.
#pragma once

#include <stdbool.h>

struct viewer;
struct undo;

// The present state is the first step. NULL: out of memory.
struct undo *undo_open(const struct viewer *v);
void undo_close(struct undo *undo); // accepts NULL
// Each frame: a change that viewer_note told becomes a step when the mouse is let go. held: the
// mouse still changes it.
void undo_step(struct viewer *v, bool held);
// The change that is undone, or done again, next: "light 2"; NULL: there is none.
const char *undo_previous(const struct viewer *v);
const char *undo_next(const struct viewer *v);
// False, with a message, if there is nothing or the scene refuses.
bool undo_back(struct viewer *v);
bool undo_forward(struct viewer *v);
