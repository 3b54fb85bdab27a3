// All techniques, in the order in which they are listed.
#pragma once

#include "techniques/technique.h"

extern const struct technique *const techniques[];        // ends with NULL
const struct technique *technique_find(const char *name); // NULL: unknown
// Accepts "view", and "technique.view" for a view that two techniques have; old names too. NULL:
// none.
const struct technique_debug_view *technique_find_view(const struct technique *technique,
                                                       const char *name);
// Has the required members and a name of [a-z0-9]+; every registered technique does, and names are
// unique (asserted).
bool technique_is_sound(const struct technique *technique);
