// Options of the technique.
#pragma once

#include "core/option.h"

enum radiosity_transfer { RADIOSITY_SPARSE, RADIOSITY_LOWRANK }; // option `transfer`

struct radiosity_options {
#define OPTION OPTION_FIELD
#include "techniques/radiosity/radiosity_options.def"
#undef OPTION
};
