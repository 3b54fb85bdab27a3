// Marks in the image: lights, the box of the surface that was clicked, probes, blocks.
#pragma once

#include "viewer/state.h"

void overlay_lights(const struct viewer *v);
void overlay_selection(const struct viewer *v);
void overlay_probes(struct viewer *v);
void overlay_blocks(const struct viewer *v); // those that are edited
