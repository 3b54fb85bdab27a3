// All techniques, in the order in which they are listed.
#pragma once

#include "techniques/technique.h"

extern const struct technique *const techniques[]; // ends with NULL
const struct technique *technique_find(const char *name); // NULL: unknown
