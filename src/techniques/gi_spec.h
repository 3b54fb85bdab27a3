// What gi.c and the tests need of the parser beyond gi.h.
#pragma once

#include "techniques/gi.h"

#define GI_MAX_TEXT 4096 // characters of a sum

// As gi_spec_parse, with these techniques instead of the registered ones; ends with NULL. The first
// is the source of a sum that names none.
bool gi_spec_parse_among(struct gi_spec *spec, struct host *host, const char *text,
                         const struct technique *const *known);
bool gi_spec_copy(struct gi_spec *spec, const struct gi_spec *from);
