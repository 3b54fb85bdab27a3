// A GI spec. What was accepted is printed and read again: the text is the same.
#include "fuzz/fuzz.h"

#include "techniques/gi.h"

#include "core/host.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size);
    struct gi_spec spec, again;
    if (gi_spec_parse(&spec, fuzz_host(), text)) {
        char *printed = gi_spec_print(&spec);
        FUZZ_CHECK(printed);
        if (gi_spec_parse(&again, fuzz_host(), printed)) {
            char *twice = gi_spec_print(&again);
            FUZZ_CHECK(twice && strcmp(printed, twice) == 0);
            host_free(fuzz_host(), twice);
            gi_spec_finish(&again);
        }
        (void)gi_memory_estimate(&spec, 640, 360);
        host_free(fuzz_host(), printed);
        gi_spec_finish(&spec);
    }
    free(text);
    return 0;
}
