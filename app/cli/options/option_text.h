// Defaults and ranges of the catalogue's options, as text.
#pragma once

#include <afterglow/catalogue.h>

bool option_is(const struct ag_option_info *option, const char *type);
// Item `index` of "first|second|…"; "" past the end.
const char *option_choice(const char *choices, int index, char out[64]);
const char *option_default(const struct ag_option_info *option, char out[64]);
// " (range)" on one line; "" for switches.
void option_range(const struct ag_option_info *option, char out[512]);
