// Precomputed radiance transfer (Sloan, Kautz & Snyder 2002).
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_prt;
