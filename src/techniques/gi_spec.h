// The parser's interface for gi.c and the tests, beyond gi.h.
#pragma once

#include "techniques/gi.h"

#define GI_MAX_TEXT 4096 // characters of a spec

// As gi_spec_parse, with `known` instead of the registered techniques; it ends with NULL. The first
// one is the source of an empty spec, and of a visibility or reflection technique alone where
// there is no `ambient`.
bool gi_spec_parse_among(struct gi_spec *spec, struct host *host, const char *text,
                         const struct technique *const *known);
bool gi_spec_copy(struct gi_spec *spec, const struct gi_spec *from);
