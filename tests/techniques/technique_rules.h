// Rules for each entry of the registry.
#pragma once

#include "techniques/registry.h"

const struct technique *technique_find(const char *name); // NULL: unknown
// The required members are set and the name is [a-z0-9]+.
bool technique_is_sound(const struct technique *technique);
