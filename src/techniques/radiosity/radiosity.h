// Radiosity of static geometry under lights that change.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_radiosity;
