// The tabs of the side bar.
#pragma once

#include "state.h"

void panel_view(struct viewer *v);
void panel_light(struct viewer *v);
void panel_method(struct viewer *v);
void panel_cost(struct viewer *v);
void panel_inspect(struct viewer *v);
