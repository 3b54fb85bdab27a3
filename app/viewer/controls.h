// Mouse and keys in the image.
#pragma once

#include "state.h"

void controls_event(struct viewer *v, const struct event *event);
void controls_step(struct viewer *v, float seconds); // keys that are held
