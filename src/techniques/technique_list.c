// Lists of techniques, of any registry.
#include "techniques/registry.h"

#include <stdio.h>

void technique_list(bool (*has)(const struct technique *technique), char *out, size_t size)
{
    size_t used = 0;
    out[0] = 0;
    for (size_t i = 0; techniques[i] && used < size; i++) {
        if (!has(techniques[i])) continue;
        const int wrote =
            snprintf(out + used, size - used, "%s%s", used ? ", " : "", techniques[i]->name);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}
