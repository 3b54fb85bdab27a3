// Bakes dictionaries.
#include "techniques/mrt/mrt_bake_fixture.h"

#include "framework/test.h"

#include <stdio.h>

#define OPTION(...) OPTION_ROW(struct mrt_dictionary_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "techniques/mrt/dictionary/dictionary_options.def"
};
#undef OPTION

static const struct option_table table = OPTION_TABLE(struct mrt_dictionary_options, rows, NULL);

const struct option_table *mrt_dictionary_option_table(void)
{
    return &table;
}

struct mrt_dictionary_options mrt_fixture_options(void)
{
    struct mrt_dictionary_options options;
    option_defaults(mrt_dictionary_option_table(), &options);
    options.lightfield_positions = 6;
    options.lightfield_directions = 12;
    options.lightfield_supersampling = 4;
    return options;
}

struct bake *mrt_fixture_plan(const struct mrt_dictionary_options *options, int version)
{
    const struct bake_identity identity = {
        .technique = "mrt", .version = version, .options = "", .program = "test"
    };
    struct bake *bake = bake_create(test_host(), &identity);
    CHECK(bake && mrt_dictionary_bake(bake_plan_of(bake), options, false));
    return bake;
}

struct bake *mrt_fixture_bake(const struct mrt_dictionary_options *options, int threads, bool full)
{
    const struct bake_identity identity = {
        .technique = "mrt", .version = 1, .options = "", .program = "test"
    };
    struct bake *bake = bake_create(test_host(), &identity);
    CHECK(bake && mrt_dictionary_bake(bake_plan_of(bake), options, full));
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = threads }));
    return bake;
}

const float *mrt_fixture_tensor(const struct bake *bake, const char *what, int cube)
{
    char name[64];
    snprintf(name, sizeof name, "cube/%d/%s", cube, what);
    const struct tensor *tensor = tensors_find(bake_reported(bake), name);
    CHECK(tensor != NULL);
    return tensor->data;
}

char *mrt_fixture_report(struct bake *bake, const struct mrt_dictionary_options *options)
{
    struct report *report = report_create(test_host());
    CHECK(report && mrt_dictionary_report(report, bake, options));
    char *text = host_strdup(test_host(), report_text(report));
    report_destroy(report);
    return text;
}
