// Undo and redo of what the user changed: the scene and the methods. Camera, exposure and what is
// shown are no steps: they change all the time and are brought back by the panels.
#pragma once

#include <stdbool.h>

struct viewer;
struct undo;

#define UNDO_METHOD "method"

// The present state is the first step. NULL: out of memory.
struct undo *undo_open(const struct viewer *v);
void undo_close(struct undo *undo); // accepts NULL
// Something has changed: it becomes a step when the mouse is let go. index: -1: there is one alone.
void undo_note(struct viewer *v, const char *what, int index);
void undo_step(struct viewer *v, bool held); // each frame; held: the mouse still changes it
// What is undone or done again next: "light 2"; NULL: nothing.
const char *undo_previous(const struct undo *undo);
const char *undo_next(const struct undo *undo);
// False, with a message, if there is nothing or the scene refuses.
bool undo_back(struct viewer *v);
bool undo_forward(struct viewer *v);
