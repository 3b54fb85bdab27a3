// Options of offset radiance transfer maps.
#pragma once

#include "core/option.h"

struct ort_options {
#define OPTION OPTION_FIELD
#include "techniques/ort/ort_options.def"
#undef OPTION
};

enum { ORT_ROWS_EXACT, ORT_ROWS_PAPER };
enum { ORT_RADIOSITY, ORT_SCATTERING, ORT_BOTH };
enum { ORT_EXPONENTIAL }; // of materials: others have the dipole
enum { ORT_AVERAGE, ORT_MAXIMUM };
enum { ORT_HALF, ORT_BYTE };
enum { ORT_TILES, ORT_SLICES };
