// Screen-space ambient occlusion with points in a sphere.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_ssao;
