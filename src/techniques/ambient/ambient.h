// Uniform ambient irradiance from the scene's reflected flux.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_ambient;
