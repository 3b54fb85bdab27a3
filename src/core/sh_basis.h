// Internal to sh*.c: the basis in double precision.
#pragma once

#include "core/sh.h"

void sh_eval_double(int bands, const double direction[3], double *out);
