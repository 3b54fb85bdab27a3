// For the files of sh.h only: the basis in double precision, which rotation and products start
// from.
#pragma once

#include "core/sh.h"

void sh_eval_double(int bands, const double direction[3], double *out);
