// Whether the ranks of a team bake the same.
#pragma once

#include "bake/bake_state.h"

// The identity of a bake as text, owned by the caller: names and values, each with its zero. NULL:
// out of memory.
char *membership_print(struct host *host, const struct bake *bake, size_t *size);
// The first difference of another rank's text, as a sentence about `rank`. False: there is none.
bool membership_difference(const struct bake *bake, int rank, const char *text, size_t size,
                           char *out, size_t out_size);
