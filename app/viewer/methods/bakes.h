// Bakes of the running method: from files, or run on a thread beside the frames.
#pragma once

#include "viewer/state.h"

enum { VIEWER_BAKES = 4 };

// Runs a method, with the bakes that it needs. Where a file is missing, a thread makes it and
// frames go on with the old method: bakes_step then exchanges it. False after a failure, with a
// message.
bool bakes_set_gi(struct viewer *v, struct rendering *rendering, const char *gi);
// The same where `gi` runs already, and files that its options name have changed.
bool bakes_begin_gi_again(struct viewer *v, struct rendering *rendering, const char *gi);
// Takes over what the thread has finished.
void bakes_step(struct viewer *v);
bool bakes_running(const struct viewer *v);
// Share of the bake that is done, 0…1, its stage and the seconds that are left.
double bakes_progress(struct viewer *v, char stage[64], double *seconds_left);
void bakes_cancel(struct viewer *v); // waits for the thread, which stops within a second
void bakes_cancel_part(struct viewer *v, bool other); // the same for a bake of that part alone
