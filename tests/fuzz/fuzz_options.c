// An option string, for the options of each technique, of each built-in scene and of the frame.
// Accepted options are printed and read again: the values are the same.
#include "fuzz/fuzz.h"

#include "core/option.h"
#include "scene/builtin/builtin.h"
#include "techniques/registry.h"

#include <string.h>

enum { TEXT_SIZE = 8192, VALUE_SIZE = 64 };

static void print(const struct option_table *table, const void *options, char text[TEXT_SIZE])
{
    char value[VALUE_SIZE];
    size_t used = 0;
    text[0] = 0;
    for (size_t i = 0; i < table->count; i++) {
        option_print(&table->rows[i], options, value, sizeof value);
        const int length = snprintf(text + used, TEXT_SIZE - used, "%s%s=%s", i ? "," : "",
                                    table->rows[i].name, value);
        FUZZ_CHECK(length > 0 && (size_t)length < TEXT_SIZE - used);
        used += (size_t)length;
    }
}

static void parse(const struct option_table *table, const char *text)
{
    char printed[TEXT_SIZE];
    void *options = calloc(1, table->size + 1), *again = calloc(1, table->size + 1);
    FUZZ_CHECK(options && again);
    option_defaults(table, options);
    option_defaults(table, again);
    const bool ok = option_parse(fuzz_host(), table, "fuzz", text, options);
    FUZZ_CHECK(ok || option_difference(table, options, again) < 0);
    print(table, options, printed);
    FUZZ_CHECK(option_parse(fuzz_host(), table, "fuzz", printed, again));
    FUZZ_CHECK(option_difference(table, options, again) < 0);
    free(options);
    free(again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size);
    for (int i = 0; techniques[i]; i++) parse(&techniques[i]->options, text);
    for (int i = 0; builtin_scenes[i]; i++) parse(&builtin_scenes[i]->options, text);
    free(text);
    return 0;
}
