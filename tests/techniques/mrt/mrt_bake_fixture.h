// A baked dictionary, for tests. Failures end the test.
#pragma once

#include "bake/bake.h"

#include "techniques/mrt/dictionary/dictionary.h"

// All options with their defaults.
const struct option_table *mrt_dictionary_option_table(void);
// The defaults with a lightfield of a sixteenth of the samples; its errors are about the same.
struct mrt_dictionary_options mrt_fixture_options(void);
// A bake that has not run, of a bake version; mrt_fixture_bake has 1. Destroy it.
struct bake *mrt_fixture_plan(const struct mrt_dictionary_options *options, int version);
// A complete bake. threads 0: all cores. Destroy it.
struct bake *mrt_fixture_bake(const struct mrt_dictionary_options *options, int threads, bool full);
// Data of the tensor cube/CUBE/WHAT, in the file or in the report.
const float *mrt_fixture_tensor(const struct bake *bake, const char *what, int cube);
// The members of its report as JSON, owned by the caller.
char *mrt_fixture_report(struct bake *bake, const struct mrt_dictionary_options *options);
