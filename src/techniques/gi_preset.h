// Presets of techniques: the key `quality` of a term of a sum, as in "lpv:quality=low,steps=8".
#pragma once

#include "techniques/technique.h"

#define GI_QUALITY "quality" // a key beside the technique's options, none of which has this name

// Fills `values` with the defaults, what the preset named in the text sets, and the text's other
// items, in this order, wherever the name stands. false says which name or value is wrong, and what
// there is.
bool gi_options_read(struct host *host, const struct technique *technique, const char *text,
                     void *values);
