// Modular radiance transfer (Loos 2015, chapters 3 and 4).
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_mrt;
