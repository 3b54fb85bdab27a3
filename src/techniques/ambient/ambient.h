// The reflected light of the whole scene, spread evenly.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_ambient;
