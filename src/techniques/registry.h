// All techniques, in the order of `afterglow list`.
#pragma once

#include "techniques/technique.h"

extern const struct technique *const techniques[]; // ends with NULL
// Accepts "view", "technique.view" (for a view that two techniques have) and old names. NULL: none.
const struct technique_debug_view *technique_find_view(const struct technique *technique,
                                                       const char *name);
// Whether the library was built without a technique of this name.
bool technique_left_out(const char *name);
// "radiosity, ort": those that `has` accepts, for messages. Names beyond the size are cut.
void technique_list(bool (*has)(const struct technique *technique), char *out, size_t size);
