// Modular radiance transfer (Loos 2015, chapters 3 and 4), and delta radiance transfer (chapter 5),
// which adds objects inside blocks.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_mrt;
extern const struct technique technique_drt;
