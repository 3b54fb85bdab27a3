// Presets of techniques: the key `quality` of a GI spec, as in "lpv:quality=low,steps=8".
#pragma once

#include "techniques/technique.h"

#define GI_QUALITY "quality" // no option of a technique has this name

// Fills `values` with the defaults, then the preset named anywhere in the text, then the text's
// other items. false: the message has the wrong name or value and the known ones.
bool gi_options_read(struct host *host, const struct technique *technique, const char *text,
                     void *values);
