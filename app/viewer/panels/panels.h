// The side bar. Each tab has a file of its own.
#pragma once

#include "viewer/state.h"

void panels_draw(struct viewer *v);
