// The tabs of the side bar.
#pragma once

#include "viewer/state.h"

void panel_view(struct viewer *v);
void panel_path(struct viewer *v); // a section of panel_view
void panel_light(struct viewer *v);
void panel_method(struct viewer *v);
void panel_compare(struct viewer *v);
void panel_cost(struct viewer *v);
void panel_inspect(struct viewer *v);

// Parts of tabs.
void panel_pixel(struct viewer *v);
void panel_probes(struct viewer *v);
void panel_texels(struct viewer *v);
void panel_paint(struct viewer *v);
void panel_blocks(struct viewer *v);
void panel_block_edit(struct viewer *v); // a part of it

// Names of the techniques for which `has` is true, with commas.
void panel_list_techniques(bool (*has)(int technique), char *out, size_t size);

// Edits the method of a rendering: that of the right part of a split screen, or the first.
void panel_edit_method(struct viewer *v, bool other);
