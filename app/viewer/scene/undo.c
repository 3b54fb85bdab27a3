#include "undo.h"

#include "changes.h"
#include "viewer/operations.h"
#include "viewer/methods/running.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 64, WHAT_SIZE = 48 };

struct state {
    char what[WHAT_SIZE]; // changed since the step before
    struct edits edits;
    char gi[METHOD_SPEC], other_gi[METHOD_SPEC]; // of the right part; "": none
    struct blocks blocks;
    struct dabs paint;
};

struct undo {
    struct state *steps[STEPS]; // the oldest first
    int count, at;              // at: index of the present one
};

static void forget(struct state *state)
{
    if (state) blocks_close(&state->blocks);
    if (state) dabs_close(&state->paint);
    free(state);
}

static struct state *take(const struct viewer *v, const char *what)
{
    struct state *state = calloc(1, sizeof *state);
    if (!state || !blocks_copy(&state->blocks, &v->block_edit.blocks) ||
        !dabs_copy(&state->paint, &v->paint.dabs)) {
        forget(state);
        return NULL;
    }
    snprintf(state->what, sizeof state->what, "%s", what);
    state->edits = v->edits;
    snprintf(state->gi, sizeof state->gi, "%s", v->gi);
    snprintf(state->other_gi, sizeof state->other_gi, "%s", v->split ? v->other_gi : "");
    return state;
}

struct undo *undo_open(const struct viewer *v)
{
    struct undo *undo = calloc(1, sizeof *undo);
    if (undo) undo->steps[0] = take(v, "");
    if (undo && undo->steps[0]) {
        undo->count = 1;
        return undo;
    }
    free(undo);
    return NULL;
}

void undo_close(struct undo *undo)
{
    for (int i = 0; undo && i < undo->count; i++) forget(undo->steps[i]);
    free(undo);
}

// Steps that were undone are forgotten; the oldest makes room.
static void push(struct undo *undo, struct state *state)
{
    while (undo->count > undo->at + 1) forget(undo->steps[--undo->count]);
    if (undo->count == STEPS) {
        forget(undo->steps[0]);
        memmove(undo->steps, undo->steps + 1, (STEPS - 1) * sizeof *undo->steps);
        undo->count--;
    }
    undo->at = undo->count;
    undo->steps[undo->count++] = state;
}

static bool runs(const struct viewer *v, const struct state *state)
{
    return strcmp(v->gi, state->gi) == 0 &&
           strcmp(v->split ? v->other_gi : "", state->other_gi) == 0;
}

void undo_step(struct viewer *v, bool held)
{
    struct undo *undo = v->undo;
    if (!undo || !v->change[0] || held) return;
    const bool method = strcmp(v->change, CHANGE_METHOD) == 0;
    if (method && runs(v, undo->steps[undo->at])) { // after a bake, for a step that was restored
        v->change[0] = 0;
        return;
    }
    struct state *state = take(v, v->change);
    v->change[0] = 0;
    if (state)
        push(undo, state);
    else
        viewer_warn(v, "the last change cannot be undone: out of memory");
}

const char *undo_previous(const struct viewer *v)
{
    const struct undo *undo = v->undo;
    if (!undo) return NULL;
    if (v->change[0]) return v->change;
    return undo->at > 0 ? undo->steps[undo->at]->what : NULL;
}

const char *undo_next(const struct viewer *v)
{
    const struct undo *undo = v->undo;
    const bool exists = undo && !v->change[0] && undo->at + 1 < undo->count;
    return exists ? undo->steps[undo->at + 1]->what : NULL;
}

static bool restore_methods(struct viewer *v, const struct state *state)
{
    if (strcmp(v->gi, state->gi) != 0 && !viewer_set_gi(v, state->gi)) return false;
    if (strcmp(v->split ? v->other_gi : "", state->other_gi) == 0) return true;
    return viewer_set_split(v, state->other_gi[0] ? state->other_gi : NULL);
}

static bool go_to(struct viewer *v, int step)
{
    struct undo *undo = v->undo;
    const struct state *state = undo->steps[step];
    v->restoring = true;
    const bool done = viewer_restore(v, &state->edits) && restore_methods(v, state);
    block_edit_restore(v, &state->blocks);
    paint_restore(v, &state->paint);
    v->restoring = false;
    undo->at = step;
    viewer_change(v);
    return done;
}

bool undo_back(struct viewer *v)
{
    undo_step(v, false);
    const char *what = undo_previous(v);
    if (!what) {
        viewer_say(v, "there is nothing to undo");
        return false;
    }
    const bool done = go_to(v, v->undo->at - 1);
    if (done) viewer_say(v, "undone: %s", what);
    return done;
}

bool undo_forward(struct viewer *v)
{
    const char *what = undo_next(v);
    if (!what) {
        viewer_say(v, "there is nothing to do again");
        return false;
    }
    const bool done = go_to(v, v->undo->at + 1);
    if (done) viewer_say(v, "done again: %s", what);
    return done;
}
