// Offset radiance transfer maps (Sunshine-Hill & Faloutsos 2006).
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_ort;
