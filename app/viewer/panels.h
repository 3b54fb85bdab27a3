// The side bar. Each tab has a file of its own.
#pragma once

#include "state.h"

void panels_draw(struct viewer *v);
