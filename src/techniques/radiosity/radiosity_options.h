// Options of the technique.
#pragma once

#include "core/option.h"

struct radiosity_options {
#define OPTION OPTION_FIELD
#include "techniques/radiosity/radiosity_options.def"
#undef OPTION
};
