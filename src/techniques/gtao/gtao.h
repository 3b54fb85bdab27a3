// Ground-truth ambient occlusion.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_gtao;
